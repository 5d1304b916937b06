"""Active damping of electric drive trains: the closed loop of FMI 2.0 co-simulation FMUs, from Python.

    import driveline

    tipin = driveline.MANOEUVRES["tipin15"]
    results = driveline.simulate(tipin, plant="ValidationVehicle")
    print(driveline.evaluate(results, tipin).settling_time)  # in s

What stands in `__init__.pyi` is public; all else can change from one release to the next. A name is imported when it
is asked for first, so that a program waits for nothing that it does not use.
"""

from functools import cache
from importlib import import_module
from pathlib import Path
from threading import RLock

_CHECKOUT = Path(__file__).resolve().parents[1]
if (_CHECKOUT / "build_fmus.py").is_file():  # its folders models, fmus and harness are packages of this one
    __path__.insert(0, str(_CHECKOUT))

_IMPORTING = RLock()
"""Threads that import modules that import each other would get them half imported."""


@cache
def _public() -> dict[str, tuple[str, str]]:
    """Module and name there of each public name, as `__init__.pyi` declares them."""
    import ast  # not above: `driveline` asks for no name

    from .fmus.source_code import syntax_tree

    declared = syntax_tree(Path(__file__).with_suffix(".pyi").read_bytes())
    return {
        alias.asname or alias.name: (f".{node.module}", alias.name)
        for node in declared.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }


def __getattr__(name: str) -> object:
    if name == "__all__":
        return __dir__()
    if name not in _public():
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{_nearest(name)}")
    place, attribute = _public()[name]
    with _IMPORTING:
        module = import_module(place, __name__)
        if not hasattr(module, attribute):  # a module in a package
            return import_module(f"{place}.{attribute}", __name__)
        globals()[name] = found = getattr(module, attribute)
        return found


def _nearest(name: str) -> str:
    from difflib import get_close_matches

    near = get_close_matches(name, _public(), n=2)
    return f"; did you mean {' or '.join(near)}?" if near else ""


def __dir__() -> list[str]:
    return sorted(_public())
