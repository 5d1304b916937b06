"""The torque that the motor should have: the demand behind the torque loop (paper, eq. (1)), known to the controller.

    tau dT_mot/dt = r          tau dr/dt = T_ref - T_mot - sqrt(2) r

integrated by the trapezoidal rule, sample by sample. An estimate of the torque that is far from it is wrong, or
the motor does not do what is demanded.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real

from .supervision_interface import Parameters

SQRT_2 = 2.0**0.5


class LoopState(NamedTuple):
    """State of the torque loop."""

    T_mot: Annotated[float, Real("N.m", "torque that the motor should have")]
    r: Annotated[float, Real("N.m", "its rate times tau")] = 0.0


def update(x: LoopState, T_ref: float, T_s: float, p: Parameters) -> LoopState:
    """The state after a sample with the demand T_ref (N.m)."""
    h = 0.5 * T_s / p.tau
    r = (x.r + h * (T_ref - x.T_mot)) / (1.0 + SQRT_2 * h + h * h)
    return LoopState(x.T_mot + 2.0 * h * r, 2.0 * r - x.r)


def agrees(x: LoopState, T_mot_est: float, p: Parameters) -> bool:
    """Whether an estimate (N.m) can be that of this torque; one that is no number cannot."""
    return abs(T_mot_est - x.T_mot) <= p.T_off * p.T_max + p.g_off * abs(x.T_mot)
