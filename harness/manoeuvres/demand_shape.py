"""What a demand of straight lines is: a step or none, and where it rests. Metrics refer to that."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

from .signals import Lines

RISE = 0.5
"""Longest time in s in which a step rises: about four periods of a drive train. What takes longer is a ramp, to which
the drive train responds with no swing that settles."""

RESTS = 0.45
"""Shortest time in s of a plateau, the piece that the metric `plateau_swing` looks at."""


class Rest(NamedTuple):
    """A piece of constant demand."""

    begin: float
    end: float
    value: float


def step_of(demand: Lines) -> tuple[float, float] | None:
    """Instant in s and height of the one step that the demand makes; None if it makes none, or something else."""
    times, values = demand.times, demand.values
    changes = [k for k, (before, after) in enumerate(pairwise(values)) if before != after]
    if not changes or times[changes[-1] + 1] - times[changes[0]] > RISE:
        return None
    way = values[-1] - values[0]
    one_way = all((values[k + 1] - values[k]) * way > 0.0 for k in changes)
    return (float(times[changes[0]]), float(way)) if one_way else None


def plateau_ends(demand: Lines) -> tuple[float, ...]:
    """The instants in s at which the demand leaves a constant value between two changes that it has held for RESTS."""
    rests: list[Rest] = []
    for (begin, value), (end, other) in pairwise(zip(demand.times, demand.values, strict=True)):
        if value == other and end > begin:
            if rests and rests[-1].end == begin and rests[-1].value == value:
                begin = rests.pop().begin
            rests.append(Rest(float(begin), float(end), float(value)))
    held = [rest for rest in rests if rest.end - rest.begin >= RESTS - 1e-9]
    return tuple(rest.end for rest in held if rest.begin > demand.times[0] and rest.end < demand.times[-1])
