"""The poles and margins of the loop as one thing about the car changes, which the controller does not know of."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from .linear_loop import LoopParts, loop_parts
from .margins import Margins, margins
from .modes import Mode, alone, drive_train_mode, is_stable, swinging_poles
from .operating_point import Point


class Sweep(NamedTuple):
    """What changes.

    Attributes:
        name, unit: for tables and figures.
        values: in that unit.
        point: the point with one of the values.
        factor: whether values are factors, drawn on a logarithmic scale.
    """

    name: str
    unit: str
    values: tuple[float, ...]
    point: Callable[[Point, float], Point]
    factor: bool = True


STIFFNESSES, INERTIAS = ("C", "k_s"), ("J_1",)
"""What they are called in the plants."""


def _scaled(names: tuple[str, ...]) -> Callable[[Point, float], Point]:
    def scaled(point: Point, factor: float) -> Point:
        p = point.of("plant", point.plant)
        return point.with_parameters(plant={name: factor * getattr(p, name) for name in names if name in p._fields})

    return scaled


FACTORS = tuple(float(value) for value in np.geomspace(0.5, 2.0, 13))

SWEEPS = (
    Sweep("speed", "km/h", tuple(np.geomspace(5.0, 130.0, 13).tolist()), lambda p, v: replace(p, v=v / 3.6)),
    Sweep("stiffness", "of nominal", FACTORS, _scaled(STIFFNESSES)),
    Sweep("inertia of the motor", "of nominal", FACTORS, _scaled(INERTIAS)),
    Sweep(
        "further dead time",
        "ms",
        tuple(np.linspace(0.0, 24.0, 13).tolist()),
        lambda p, d: replace(p, late=p.late + 1e-3 * d),
        factor=False,
    ),
)


class Swept(NamedTuple):
    """The loop with one value.

    Attributes:
        poles: those that swing, in 1/s.
        mode: of the drive train.
        margins: None if it is not stable.
    """

    value: float
    poles: np.ndarray
    mode: Mode
    margins: Margins | None


def swept(point: Point, sweep: Sweep) -> Iterator[Swept]:
    """The loop of a point with every value of a sweep, with the mean of its samples."""
    parts: LoopParts | None = None
    for value in sweep.values:
        there = sweep.point(point, value)
        parts = parts if parts and parts.serve(there) else loop_parts(there)
        loop = parts.loop(there.late).mean
        mode = drive_train_mode(loop, alone(there).frequency)
        yield Swept(value, swinging_poles(loop), mode, margins(loop) if is_stable(loop) else None)
