"""Whether the motor signals are trusted: they are until they fail, and again when they have proved themselves.

They fail when they were bad for longer than t_bad, when the wheel speed has contradicted the motor speed
for longer than t_apart, or when the damping feeds the oscillation. They have proved themselves when they
were good and uncontradicted for t_proof. After an oscillation that was fed this is not enough, for a wrong
speed may agree with itself: the wheel speed must be there to agree, the damping torque be small, and all
that for a time that doubles with every such oscillation; or the car has come to rest.
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Boolean, Real
from ..block.operators import clip, logical_and, logical_not, logical_or, minimum, where

LONGEST = 32.0
"""Proof that is asked for at the most, over t_proof."""


class TrustState(NamedTuple):
    """State of the trust in the motor signals."""

    proof: Annotated[float, Real("s", "time for which they have proved themselves, up to what is needed")]
    needed: Annotated[float, Real("s", "time for which they must prove themselves")]
    caught: Annotated[bool, Boolean("with them the damping fed the oscillation")]


def start(p: Any) -> TrustState:
    return TrustState(proof=p.t_proof, needed=p.t_proof, caught=False)


def is_trusted(x: TrustState) -> Any:
    return x.proof >= x.needed


def update(
    x: TrustState, bad: Any, apart: Any, feeding: Any, confirmed: Any, against: Any, resting: Any, T_s: Any, p: Any
) -> TrustState:
    """The state after one sample.

    Args:
        bad, apart: time in s since the motor signals were good, and since they were not contradicted.
        feeding: whether the damping feeds the oscillation.
        confirmed: whether the wheel speed is a witness and the damping torque small.
        against: whether the motor turns against a demand that pushes the car.
        resting: whether the car is at rest.
    """
    failing = logical_or(logical_or(bad > p.t_bad, apart > p.t_apart), feeding)
    caught = logical_and(logical_or(x.caught, feeding), logical_not(resting))
    good = logical_and(bad <= 0.0, apart <= 0.0)
    convincing = logical_and(good, logical_or(logical_not(caught), confirmed))
    doubled = where(feeding, minimum(2.0 * x.needed, LONGEST * p.t_proof), x.needed)
    needed = where(resting, p.t_proof, doubled)
    step = where(against, -T_s, T_s)
    proving = where(convincing, clip(x.proof + step, 0.0, needed), 0.0)
    proof = where(failing, 0.0, where(is_trusted(x), needed, proving))
    return TrustState(proof=proof, needed=needed, caught=logical_and(caught, proof < needed))
