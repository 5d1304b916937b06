"""An FMU that is declared in a Python file of the user's own."""

import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

from .fmu import Fmu


class NoFmu(Exception):
    """The file declares no FMU; the text says why."""


def fmu_in(path: Path) -> Fmu:
    """What the file at `path` calls FMU; the file is run for it.

    Raises:
        NoFmu: there is no such file or it declares none; its name is that of a module that is in use.
    """
    if not path.is_file():
        raise NoFmu(f"there is no file {path}")
    if path.stem in sys.modules:
        raise NoFmu(f"{path}: a module called {path.stem} is in use; give the file another name")
    spec = spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise NoFmu(f"{path} is not a Python file")
    module = module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    fmu = getattr(module, "FMU", None)
    if not isinstance(fmu, Fmu):
        raise NoFmu(f"{path} has no line `FMU = Fmu(BLOCK, stop_time=10.0)`")
    return fmu
