"""Active damping of electric drive trains: the closed loop of FMI 2.0 co-simulation FMUs, from Python.

    import driveline

    tipin = driveline.MANOEUVRES["tipin15"]
    results = driveline.simulate(tipin, plant="ValidationVehicle")
    print(driveline.evaluate(results, tipin).settling_time)  # in s

What stands in `__init__.pyi` is public; all else can change from one release to the next. A name is imported when it
is asked for first, so that a program waits for nothing that it does not use. `help(driveline.simulate)` tells of one.
"""

import sys
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path

from toolground.public_names import public_names

_CHECKOUT = Path(__file__).resolve().parents[1]


class _InCheckout:
    """Finds the folders of a checkout that are packages of this one, and none of its others."""

    def find_spec(self, fullname: str, path: object, target: object = None) -> ModuleSpec | None:
        package, _, name = fullname.partition(".")
        if package == __name__ and name in ("models", "fmus", "harness"):
            return PathFinder.find_spec(fullname, [str(_CHECKOUT)])
        return None


if (_CHECKOUT / "build_fmus.py").is_file():
    sys.meta_path.insert(0, _InCheckout())  # type: ignore[arg-type]  # importlib.abc takes 50 ms


def _public_names() -> str:
    """The public names by their purpose, for `help`."""
    text = ""
    for line in Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8").splitlines():
        if line.startswith("# "):
            text, width = f"{text}\n\n{line[2:]}\n   ", 3
        elif name := line.partition(" as ")[2]:
            text, width = (f"{text}\n    {name}", 4) if width + len(name) > 90 else (f"{text} {name}", width + 1)
            width += len(name)
    return text


__doc__ = f"{__doc__}{_public_names()}\n"

_find, __dir__ = public_names(__name__, __file__)


def __getattr__(name: str) -> object:
    if name == "__all__" and sys._getframe(1).f_globals.get("__name__") != "pydoc":  # its page has no room for all
        return [public for public in __dir__() if _is_installed(public)]
    return _find(name)


def _is_installed(name: str) -> bool:
    """Whether a public name needs no extra that is not here."""
    from toolground.errors import MissingExtra

    try:
        __getattr__(name)
    except MissingExtra:
        return False
    return True
