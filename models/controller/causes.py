"""Causes for which the damping lets go, a row each: what is found, after how long it counts, how it heals."""

from collections.abc import Mapping
from typing import NamedTuple

from fmublocks.block.declaration import Enumeration
from fmublocks.block.operators import where

NONE, SPEED_RANGE, SPEED_JUMP, SPEED_FROZEN, TORQUE_IMPLAUSIBLE = range(1, 6)
WHEEL_CONTRADICTS, WRONG_DIRECTION, WRONG_LAUNCH, FEEDS, FRAME_LATE = range(6, 11)


class Cause(NamedTuple):
    """A row.

    Attributes:
        number, word: as the output `cause` gives them.
        finding: what is found in a sample.
        after: the parameter with the time for which something is found until it counts; none: it counts at once.
        heals: what ends it.
    """

    number: int
    word: str
    finding: str
    after: str = ""
    heals: str = "good signals for t_proof, of another direction for t_turn"


FAILURES = (
    Cause(SPEED_RANGE, "speed_range", "the motor speed is no number, or leaps beyond omega_max", "t_bad"),
    Cause(SPEED_JUMP, "speed_jump", "the motor speed leaps by more than jump, and no fast change goes on", "t_bad"),
    Cause(SPEED_FROZEN, "speed_frozen", "the motor speed stays the same while the model moves beyond frozen", "t_bad"),
    Cause(TORQUE_IMPLAUSIBLE, "torque_implausible", "the torque estimate is off by more than T_off and g_off", "t_bad"),
    Cause(WHEEL_CONTRADICTS, "wheel_contradicts", "motor and wheels differ by more than apart and g_radius", "t_apart"),
    Cause(WRONG_DIRECTION, "wrong_direction", "the motor turns against the direction on the bus", "t_apart"),
    Cause(
        WRONG_LAUNCH,
        "wrong_launch",
        "the motor sets off from rest against its torque, and turns on against it",
        heals="the same, once it turns the other way, or at rest",
    ),
    Cause(FRAME_LATE, "frame_late", "the frame of motor control is older than t_bad, by its counter"),
)
"""Lead to fallback. Where several are found, the first is the cause."""

CLOCKS = {row.after: [other.number for other in FAILURES if other.after == row.after] for row in FAILURES}
"""The numbers of rows by the time after which these count; a clock runs for all that have the same."""


def first_of(failures: Mapping[int, bool]) -> int:
    """The number of the first row of which something is found, that of none where nothing is.

    Args:
        found: by the numbers of rows, in their order.
    """
    first = NONE
    for number in reversed(failures):
        first = where(failures[number], number, first)
    return first


FEEDING = Cause(
    FEEDS,
    "feeds_oscillation",
    "half swings of the damping torque do not decay, and no change of the demand explains them",
    heals="is forgotten at one half swing a t_forget",
)
"""Leads to less damping, and in the end to none."""

OUTPUT = Enumeration(
    "Cause",
    "why there is no damping, or less",
    (("none", "nothing is wrong"), *((row.word, row.finding) for row in sorted((*FAILURES, FEEDING)))),
)
