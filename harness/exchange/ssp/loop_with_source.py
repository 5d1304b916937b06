"""The loop with a source of its own, because tools that open a system give it no demand, brake and slope."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from ...base.errors import DrivelineError
from ...cosimulation.system import Connection, System
from ...cosimulation.wiring import Fit
from ...manoeuvres.manoeuvre import Manoeuvre
from ...manoeuvres.signals import Lines

SOURCE = "manoeuvre"
"""Name of the source in the loop."""

SIGNALS = ("T_driver", "T_brake", "slope")
"""Of a manoeuvre, and outputs of the FMU Manoeuvre."""


def with_source(system: System, source: Path) -> System:
    """The loop whose demand, brake and slope come from the FMU Manoeuvre, a file."""
    fed = [port for port in system.inputs if port.variable in SIGNALS]
    sources = tuple(Connection(f"{SOURCE}.{port.variable}", port.name, port.unit) for port in fed)
    return replace(
        system,
        instances={SOURCE: source, **system.instances},
        connections=(*sources, *system.connections),
        inputs=tuple(port for port in system.inputs if port not in fed),
        own=system.own | {SOURCE},
    )


def points(manoeuvre: Manoeuvre, fitted: Fit) -> dict[str, float]:
    """Parameters `manoeuvre.time_1`, `manoeuvre.T_driver_1`, ... with which that FMU makes the signals of a manoeuvre.

    Args:
        fitted: the loop with that FMU, which tells how many points it has.

    Raises:
        DrivelineError: a signal is not made of straight lines, or they have too many corners.
    """
    signals = {name: getattr(manoeuvre, name) for name in SIGNALS}
    if curved := next((name for name, signal in signals.items() if not isinstance(signal, Lines)), None):
        raise DrivelineError(
            f"{manoeuvre.name}: {curved} is not made of straight lines, and other tools are given nothing else; "
            "take another manoeuvre, or a file with its points (docs/manoeuvres.md)"
        )
    corners = _corners(signals)
    most = sum(name.startswith("time_") for name in fitted.interfaces[SOURCE].variables)
    if len(corners) > most:
        raise DrivelineError(
            f"{manoeuvre.name}: its lines have {len(corners)} points; other tools are given at most {most}"
        )
    return {
        f"{SOURCE}.{name}_{k}": value
        for k, corner in enumerate(corners, 1)
        for name, value in zip(("time", *SIGNALS), corner, strict=True)
    }


def _corners(signals: Mapping[str, Lines]) -> list[tuple[float, ...]]:
    """Instant in s and values of all signals where one of them has a corner; where one jumps, before and after it."""
    found = []
    for time in sorted({float(time) for signal in signals.values() for time in signal.times}):
        before = tuple(float(signal.before(time)) for signal in signals.values())
        after = tuple(float(signal(time)) for signal in signals.values())
        found += [(time, *values) for values in dict.fromkeys((before, after))]
    return found
