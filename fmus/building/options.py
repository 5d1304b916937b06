"""Options that more than one command has, and what an option takes for a path."""

from argparse import ArgumentParser, ArgumentTypeError
from pathlib import Path
from tempfile import TemporaryFile

PARAMETER_FILES = {
    "--vehicle": "what belongs to the car, for every block that has it",
    "--parameters": "what is set in the controller, as `driveline design` writes it",
}


def add_parameter_files(parser: ArgumentParser) -> None:
    """Adds --vehicle and --parameters, the files of `fmus.building.parameter_files`."""
    for option, meaning in PARAMETER_FILES.items():
        action = parser.add_argument(option, type=file, metavar="FILE.toml", help=meaning)
        action.complete = "file"  # type: ignore[attr-defined]


def folder(text: str) -> Path:
    """The path of a folder, which may not exist yet."""
    if not text:
        raise ArgumentTypeError("the name of the folder is empty")
    path = Path(text)
    try:
        if path.exists() and not path.is_dir():
            raise ArgumentTypeError(f"{text} is a file; a folder is needed")
    except OSError as error:  # a name that is too long
        raise ArgumentTypeError(error.strerror or str(error)) from error
    return path


def output_folder(text: str) -> Path:
    """The path of a folder that can be written to, or made; tried here, before anything takes long."""
    path = folder(text)
    there = path.absolute()
    try:
        while not there.exists():
            there = there.parent
        with TemporaryFile(dir=there):
            return path
    except OSError as error:
        raise ArgumentTypeError(f"{text} cannot be written to: {there}: {error.strerror}") from error


def file(text: str) -> Path:
    """The path of a file, which may not exist yet."""
    if not text:
        raise ArgumentTypeError("the name of the file is empty")
    path = Path(text)
    try:
        if path.is_dir():
            raise ArgumentTypeError(f"{text} is a folder; a file is needed")
    except OSError as error:  # a name that is too long
        raise ArgumentTypeError(error.strerror or str(error)) from error
    return path
