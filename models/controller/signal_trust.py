"""Whether the motor signals are trusted: they are until they fail, and again when they have healed.

They fail when they were bad for longer than t_bad, when wheel speed and motor speed do not match for longer
than t_apart, and when they are implausible: the damping feeds the oscillation, or the motor sets off against
its torque.
They have healed when they were good and without mismatch for the heal time t_proof. The last two failures are
latched, for a wrong speed may agree with itself: then the wheel speed must be a valid reference that agrees, the
damping torque be small, and all that for a heal time that doubles each time; or the car has come to rest.
"""

from typing import Annotated, NamedTuple

from ..block.declaration import Boolean, Real
from ..block.operators import logical_and, logical_not, logical_or, minimum, where
from .supervision_interface import Parameters

LONGEST = 32.0
"""Longest heal time, over t_proof."""


class TrustState(NamedTuple):
    """State of the trust in the motor signals."""

    heal_time: Annotated[float, Real("s", "time for which they have been healing, up to what is needed")]
    needed: Annotated[float, Real("s", "heal time that is needed")]
    latched: Annotated[bool, Boolean("a failure is latched: they were implausible")]


def start(p: Parameters) -> TrustState:
    return TrustState(heal_time=p.t_proof, needed=p.t_proof, latched=False)


def is_trusted(x: TrustState) -> bool:
    return x.heal_time >= x.needed


def update(
    x: TrustState,
    bad: float,
    mismatch_time: float,
    implausible: bool,
    confirmed: bool,
    resting: bool,
    T_s: float,
    p: Parameters,
) -> TrustState:
    """The state after one sample.

    Args:
        bad, mismatch_time: time in s since the motor signals were good, and since they matched the wheel speed.
        implausible: whether the damping feeds the oscillation, or the motor has just set off against its torque.
        confirmed: whether the wheel speed is a valid reference and the damping torque small.
        resting: whether the car is at rest.
    """
    failing = logical_or(logical_or(bad > p.t_bad, mismatch_time > p.t_apart), implausible)
    latched = logical_and(logical_or(x.latched, implausible), logical_not(resting))
    good = logical_and(bad <= 0.0, mismatch_time <= 0.0)
    convincing = logical_and(good, logical_or(logical_not(latched), confirmed))
    doubled = where(implausible, minimum(2.0 * x.needed, LONGEST * p.t_proof), x.needed)
    needed = where(resting, p.t_proof, doubled)
    proving = where(convincing, minimum(x.heal_time + T_s, needed), 0.0)
    heal_time = where(failing, 0.0, where(is_trusted(x), needed, proving))
    return TrustState(heal_time=heal_time, needed=needed, latched=logical_and(latched, heal_time < needed))
