"""An FMU that is declared in a Python file of the user's own."""

import sys
from collections.abc import Sequence
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from traceback import extract_tb

from .errors import BuildError
from .fmu import Fmu


def fmu_in(path: Path) -> Fmu:
    """What the file at `path` calls FMU; the file is run for it.

    Raises:
        BuildError: there is no such file, it cannot be run or it declares no FMU; its name is that of another
            module.
    """
    if not path.is_file():
        raise BuildError(f"there is no file {path}")
    name = path.stem
    if _taken(name, path):
        raise BuildError(f"{path}: there is a module called {name}; give the file another name")
    spec = spec_from_file_location(name, path.absolute())
    if spec is None or spec.loader is None:
        raise BuildError(f"{path} is not a Python file")
    module = module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        raise BuildError(f"{place(error, [path])}: it cannot be run: {type(error).__name__}: {error}") from error
    fmu = getattr(module, "FMU", None)
    if not isinstance(fmu, Fmu):
        del sys.modules[name]
        raise BuildError(f"{path} has no line `FMU = Fmu(BLOCK, stop_time=10.0)`")
    return fmu


def place(error: BaseException, files: Sequence[Path]) -> str:
    """The file and the line of it from which an error came, as far as it is in one of some files; else the files."""
    by_name = {str(path.absolute()): path for path in files}
    places = [(frame.filename, frame.lineno) for frame in extract_tb(error.__traceback__)]
    if isinstance(error, SyntaxError):
        places.append((str(error.filename), error.lineno))
    own = [f"{by_name[name]}, line {line}" for name, line in places if name in by_name]
    return own[-1] if own else ", ".join(map(str, files))


def _taken(name: str, path: Path) -> bool:
    """Whether a module of that name would be hidden by the file."""
    if name in sys.modules:
        file = getattr(sys.modules[name], "__file__", None)
        return not (file and Path(file).exists() and path.samefile(file))
    spec = find_spec(name) if name.isidentifier() else None
    if spec is None or spec.origin is None:
        return False
    return not (Path(spec.origin).exists() and path.samefile(spec.origin))
