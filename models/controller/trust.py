"""Whether the motor signals are trusted: they are until they fail, and again when they have proved themselves.

They fail when they were bad for longer than t_bad, when the wheel speed has contradicted the motor speed
for longer than t_apart, when the damping feeds the oscillation, or when the motor sets off against its torque.
They have proved themselves when they were good and uncontradicted for t_proof. After the last two this is not
enough, for a wrong speed may agree with itself: the wheel speed must be there to agree, the damping torque be
small, and all that for a time that doubles each time; or the car has come to rest.
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Boolean, Real
from ..block.operators import logical_and, logical_not, logical_or, minimum, where

LONGEST = 32.0
"""Proof that is asked for at the most, over t_proof."""


class TrustState(NamedTuple):
    """State of the trust in the motor signals."""

    proof: Annotated[float, Real("s", "time for which they have proved themselves, up to what is needed")]
    needed: Annotated[float, Real("s", "time for which they must prove themselves")]
    caught: Annotated[bool, Boolean("they were seen to be wrong though they agree with themselves")]


def start(p: Any) -> TrustState:
    return TrustState(proof=p.t_proof, needed=p.t_proof, caught=False)


def is_trusted(x: TrustState) -> Any:
    return x.proof >= x.needed


def update(
    x: TrustState, bad: Any, apart: Any, lying: Any, confirmed: Any, resting: Any, T_s: Any, p: Any
) -> TrustState:
    """The state after one sample.

    Args:
        bad, apart: time in s since the motor signals were good, and since they were not contradicted.
        lying: whether the damping feeds the oscillation, or the motor has just set off against its torque.
        confirmed: whether the wheel speed is a witness and the damping torque small.
        resting: whether the car is at rest.
    """
    failing = logical_or(logical_or(bad > p.t_bad, apart > p.t_apart), lying)
    caught = logical_and(logical_or(x.caught, lying), logical_not(resting))
    good = logical_and(bad <= 0.0, apart <= 0.0)
    convincing = logical_and(good, logical_or(logical_not(caught), confirmed))
    doubled = where(lying, minimum(2.0 * x.needed, LONGEST * p.t_proof), x.needed)
    needed = where(resting, p.t_proof, doubled)
    proving = where(convincing, minimum(x.proof + T_s, needed), 0.0)
    proof = where(failing, 0.0, where(is_trusted(x), needed, proving))
    return TrustState(proof=proof, needed=needed, caught=logical_and(caught, proof < needed))
