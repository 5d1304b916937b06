"""The loop with a source of its own, because tools that open a system give it no inputs."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import cast

from fmuloop.system import Connection, System
from fmuloop.wiring import Fit
from toolground.errors import UserError

from ...manoeuvres.manoeuvre import Manoeuvre
from ...manoeuvres.signals import FlatSine, Held, Lines, Signal, lines

SOURCE = "manoeuvre"
"""Name of the source in the loop."""

SIGNALS = ("T_driver", "T_brake", "slope")
"""Of a manoeuvre, and outputs of the FMU Manoeuvre; it has `enable` beside them."""

BITS = 50
"""In a number of that FMU."""


def with_source(system: System, source: Path) -> System:
    """The loop whose inputs come from the FMU Manoeuvre, a file."""
    fed = [port for port in system.inputs if port.variable in (*SIGNALS, "enable")]
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
        fitted: the loop with that FMU, which tells how many points and bits it has.

    Raises:
        UserError: brake or slope is not made of straight lines, the demand neither of them nor a sine nor of two
            values; or they have too many corners or bits.
    """
    known = fitted.interfaces[SOURCE].variables
    demand, others = _demand(manoeuvre)
    signals = {"T_driver": demand, "T_brake": manoeuvre.T_brake, "slope": manoeuvre.slope}
    if curved := next((name for name, signal in signals.items() if not isinstance(signal, Lines)), None):
        also = ", a sine or a binary torque" if curved == "T_driver" else ""
        raise UserError(
            f"{manoeuvre.name}: {curved} is not made of straight lines{also}, and other tools are given nothing else; "
            "take another manoeuvre, or a file with its points (docs/manoeuvres.md)"
        )
    corners = _corners(cast(Mapping[str, Lines], signals))
    most = sum(name.startswith("time_") for name in known)
    if len(corners) > most:
        raise UserError(f"{manoeuvre.name}: its lines have {len(corners)} points; other tools are given at most {most}")
    if isinstance(manoeuvre.T_driver, Held) and any(name not in known for name in others):
        raise UserError(
            f"{manoeuvre.name}: its binary torque has {len(manoeuvre.T_driver.values)} bits; other tools are given at "
            f"most {BITS * sum(name.startswith('bits_') for name in known)}"
        )
    placed = {
        f"{name}_{k}": value
        for k, corner in enumerate(corners, 1)
        for name, value in zip(("time", *SIGNALS), corner, strict=True)
    }
    return {f"{SOURCE}.{name}": value for name, value in (placed | others).items()}


def _demand(manoeuvre: Manoeuvre) -> tuple[Signal, dict[str, float]]:
    """The lines of the demand, and the parameters of what comes on them; the demand itself if it is neither."""
    demand = manoeuvre.T_driver
    if isinstance(demand, FlatSine):
        wave = {name: getattr(demand, name) for name in ("amplitude", "frequency", "steepness")}
        return lines((0.0, demand.mean)), {f"sine_{name}": value for name, value in wave.items()}
    if isinstance(demand, Held):
        values = [float(value) for value in demand.values]
        low, high = min(values), max(values)
        if set(values) <= {low, high}:
            binary = {"bit_amplitude": 0.5 * (high - low), "bit_time": demand.interval}
            return lines((0.0, 0.5 * (high + low))), binary | _packed([value == high for value in values])
    return demand, {}


def _packed(bits: list[bool]) -> dict[str, float]:
    """Numbers `bits_1`, `bits_2`, ... of so many bits, the first one the lowest."""
    words = [bits[k : k + BITS] for k in range(0, len(bits), BITS)]
    return {f"bits_{n}": float(sum(bit << k for k, bit in enumerate(word))) for n, word in enumerate(words, 1)}


def _corners(signals: Mapping[str, Lines]) -> list[tuple[float, ...]]:
    """Instant in s and values of all signals where one of them has a corner; where one jumps, before and after it."""
    corners = []
    for time in sorted({float(time) for signal in signals.values() for time in signal.times}):
        before = tuple(float(signal.before(time)) for signal in signals.values())
        after = tuple(float(signal(time)) for signal in signals.values())
        corners += [(time, *values) for values in dict.fromkeys((before, after))]
    return corners
