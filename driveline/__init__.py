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

_MODULES = {
    "operators": "models.block",
    "plant": "models.physics",
    "vehicle": "models.physics",
    "torque_estimator": "models.controller",
    "measured_speeds": "models.comparators",
}
"""Public names that are modules, with the package of each."""

_IMPORTING = RLock()
"""Threads that import modules that import each other would get them half imported."""


@cache
def _lazy() -> tuple:
    """What imports a public name, and what lists them, as `__init__.pyi` declares them."""
    from lazy_loader import attach_stub  # not above: `driveline --help` asks for no name

    return attach_stub(__name__, __file__)


def __getattr__(name: str) -> object:
    if name == "__all__":
        return __dir__()
    with _IMPORTING:
        find, names, _ = _lazy()
        if name not in names():
            from .fmus.names import meant

            near = meant(name, names())
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}{near and '; ' + near}")
        if name in _MODULES:
            import_module(f".{_MODULES[name]}.{name}", __name__)
        return find(name)


def __dir__() -> list[str]:
    return _lazy()[1]()
