"""Public names of a package that are imported when they are asked for first, so that a program waits for nothing that
it does not use: its `__init__.pyi` says which module has each."""

import re
from collections.abc import Callable
from functools import cache
from importlib import import_module
from pathlib import Path
from threading import RLock
from typing import Any

_IMPORTING = RLock()
"""Threads that import modules that import each other would get them half imported."""


def public_names(package: str, file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """What finds a public name of a package, and what lists them: its `__getattr__` and `__dir__`.

    Args:
        file: its `__init__.py`, beside which `__init__.pyi` has a line `from MODULE import NAME as NAME` for each.
    """

    @cache
    def places() -> dict[str, tuple[str, str]]:
        stub = Path(file).with_suffix(".pyi").read_text(encoding="utf-8")
        lines = re.findall(r"^from (\S+) import (\w+) as (\w+)$", stub, re.MULTILINE)
        return {name: (module, there) for module, there, name in lines}

    def find(name: str) -> Any:
        if name not in places():
            from .known_names import meant

            near = meant(name, places())
            raise AttributeError(f"module {package!r} has no attribute {name!r}{near and '; ' + near}")
        module, there = places()[name]
        with _IMPORTING:
            holder = vars(import_module(module, package))
            return holder[there] if there in holder else import_module(f"{module}.{there}", package)

    return find, lambda: sorted(places())
