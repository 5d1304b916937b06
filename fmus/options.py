"""Options that more than one command has."""

from argparse import ArgumentParser
from pathlib import Path

PARAMETER_FILES = {
    "--vehicle": "what belongs to the car, for every block that has it",
    "--parameters": "what is set in the controller, as `driveline design` writes it",
}


def add_parameter_files(parser: ArgumentParser) -> None:
    """Adds --vehicle and --parameters, the files of `fmus.parameter_files`."""
    for option, meaning in PARAMETER_FILES.items():
        action = parser.add_argument(option, type=Path, metavar="FILE.toml", help=meaning)
        action.complete = "file"  # type: ignore[attr-defined]
