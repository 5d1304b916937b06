"""The box of parameters in which a controller must be good: how car and sensors differ from what it assumes."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from ...fmus.building.one_car import SHAFTS, WHEELS
from .loop_parameters import loop_parameters, loop_records


class Deviation(NamedTuple):
    """Of the true car and its sensors from the car of the vehicle file, which is what the controller assumes.

    Attributes:
        J_2, C, phi_B, tau, m: factors on the inertia of the wheels, the stiffness of the drive train, its gap, the lag
            of the motor and the mass of the car.
        delay: mean transport delay of the wheel speed in s, see `_delays`; None: as that of the car.
        g_T, o_T: gain and offset (N.m) of the estimate of the motor torque.
        g_w2: gain of the wheel speed.
        loss: probability that a message is lost.
    """

    J_2: float = 1.0
    C: float = 1.0
    phi_B: float = 1.0
    tau: float = 1.0
    m: float = 1.0
    delay: float | None = None
    g_T: float = 1.0
    o_T: float = 0.0
    g_w2: float = 1.0
    loss: float = 0.0


NOMINAL = Deviation()

BOX: Mapping[str, tuple[float, float]] = {
    "J_2": (0.5, 2.0),
    "C": (0.5, 2.0),
    "phi_B": (0.0, 3.0),
    "tau": (0.5, 1.5),
    "m": (0.5, 1.5),
    "delay": (0.0, 0.04),
    "g_T": (0.9, 1.1),
    "o_T": (-1.5, 1.5),
    "g_w2": (0.98, 1.02),
}
"""The least and the most of each deviation."""

DOUBLINGS = ("J_2", "C")
"""The factors that are as often between 1/2 and 1 as between 1 and 2: their logarithm is uniform in the box."""

LOSS = 0.1
"""In all of the box."""

SPREAD, SHORTEST = 0.01, 0.001
"""Of the transport delay, up and down, and the shortest that the bus has, in s."""

SCALED = {
    "J_2": ("J_2", *WHEELS),
    "C": ("C", *SHAFTS),
    "phi_B": ("phi_B",),
    "tau": ("tau",),
    "m": ("m", "F_z0", "J_y"),
}
"""What a factor multiplies, in the blocks that have it."""

SCREENING = "++-+++---+-"
"""First run of the design of Plackett and Burman (Biometrika 33, 1946) for up to 11 factors in 12 runs: the next ten
are this one turned round, and in the last all are low. Each factor is high in half of the runs, and in half of those
in which another one is."""


def screening() -> list[tuple[bool, ...]]:
    """For each of the 12 runs which of the 11 factors are high."""
    rows = [SCREENING[-k:] + SCREENING[:-k] for k in range(len(SCREENING))]
    return [tuple(sign == "+" for sign in row) for row in [*rows, "-" * len(SCREENING)]]


def corner(high: Mapping[str, bool]) -> Deviation:
    """The corner of the box at which these deviations have their most, and the others their least."""
    return Deviation(loss=LOSS, **{name: bounds[high[name]] for name, bounds in BOX.items()})


def deviating(values: Mapping[str, Any], plant: str, controller: str, deviation: Deviation) -> dict[str, Any]:
    """Parameters of the loop, `instance.name` -> value, with a plant and a controller of ours.

    Args:
        values: entries of parameter files, which reach every block that has the name.
        deviation: of all blocks but the controller.
    """
    of_loop = loop_parameters(values, plant, controller)
    blocks = {
        place: {name: of_loop.get(f"{place}.{name}", value) for name, value in record()._asdict().items()}
        for place, record in loop_records(plant, controller).items()
    }
    return of_loop | changed(blocks, deviation)


def changed(blocks: Mapping[str, Mapping[str, Any]], deviation: Deviation) -> dict[str, float]:
    """The parameters of a loop, `instance.name` -> value, that a deviation changes: of all blocks but the controller.

    Args:
        blocks: the parameters of each block without the deviation, by its place.
    """
    return {
        f"{place}.{name}": value
        for place, start in blocks.items()
        if place != "controller"
        for name, value in _changed(start, deviation).items()
    }


def _changed(start: Mapping[str, Any], deviation: Deviation) -> dict[str, float]:
    """The parameters of a block that a deviation changes from what they are."""
    sensors = {name: getattr(deviation, name) for name in ("g_T", "o_T", "g_w2", "loss")} | _delays(deviation)
    factors = {name: getattr(deviation, factor) for factor, names in SCALED.items() for name in names}
    scaled = {name: factor * start[name] for name, factor in factors.items() if name in start}
    nominal = {name: getattr(NOMINAL, name, None) for name in sensors}
    changed = scaled | {name: value for name, value in sensors.items() if name in start and value != nominal[name]}
    return {name: value for name, value in changed.items() if value != start[name]}


def _delays(deviation: Deviation) -> dict[str, float]:
    """Shortest and longest transport delay in s: SPREAD less and more than the mean one, or less where that is less."""
    if deviation.delay is None:
        return {}
    spread = min(SPREAD, deviation.delay)
    return {name: max(deviation.delay + d, SHORTEST) for name, d in (("d_min", -spread), ("d_max", spread))}
