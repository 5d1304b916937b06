"""What runs of the tests would compute again and again."""

import pickle
import re
from collections.abc import Callable
from hashlib import md5
from importlib import import_module
from pathlib import Path
from typing import Any


class Remembered:
    """Plugin of pytest: what no fault outside of the code of the FMUs changes is computed once, traced sources, pages,
    and what is in the FMUs that run Python.

    Args:
        folder: in which it is kept.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def pytest_configure(self) -> None:
        for build, names in {
            "native": ("block_sources", "documentation"),
            "python": ("documentation", "_resources_and_binaries"),
        }.items():
            packaging: Any = import_module(f"driveline.fmus.{build}.packaging")
            for name in names:
                setattr(packaging, name, remembered(getattr(packaging, name), self._folder))


def remembered(function: Callable[..., Any], folder: Path) -> Callable[..., Any]:
    """The function of an FMU and other arguments, its results for blocks of the project kept in files in a folder."""

    def result(fmu: Any, *others: Any, **named: Any) -> Any:
        if not fmu.block.module.startswith("driveline."):
            return function(fmu, *others, **named)
        starts = [record._field_defaults for record in (fmu.block.Parameters, fmu.block.Input)]
        asked = repr((function.__module__, function.__name__, fmu, starts, others, named))
        key = md5(re.sub(" at 0x[0-9a-f]+", "", asked).encode(), usedforsecurity=False).hexdigest()
        if not (kept := folder / key).exists():
            folder.mkdir(exist_ok=True)
            kept.write_bytes(pickle.dumps(function(fmu, *others, **named)))
        return pickle.loads(kept.read_bytes())

    return result
