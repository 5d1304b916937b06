"""Linear state feedback, a drive train without a gap being assumed.

    T_damp = -s/(s + omega_w) [k_d (omega_1 - omega_2) + k_T T_gear]

with the motion T_pred ahead. Without a gap there is nothing to land in.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real

from ..controller.damping_law import washed_out
from ..controller.interfaces import Addition, Motion


class Parameters(NamedTuple):
    """Found by `driveline design --search`, see docs/calibration.md."""

    T_pred: Annotated[
        float, Real("s", "time that the estimate is taken ahead", 0.0, 0.02, search=(0.0, 0.006), tunable=True)
    ] = 0.00114
    k_d: Annotated[
        float, Real("N.m.s/rad", "damping over the speed difference", 0.0, 200.0, search=(0.3, 10.0), tunable=True)
    ] = 2.92
    k_T: Annotated[float, Real("1", "damping over the gear torque", 0.0, 5.0, search=(0.001, 5.0))] = 0.0157
    omega_w: Annotated[
        float, Real("rad/s", "corner frequency of the washout", 0.0, 400.0, search=(0.5, 300.0), tunable=True)
    ] = 3.83


class FeedbackState(NamedTuple):
    """State of the feedback."""

    washout: Annotated[float, Real("N.m", "stationary part of what is fed back")]


def start(motion: Motion, T_driver: float, p: Parameters) -> FeedbackState:
    return FeedbackState(fed_back(motion, p))


def update(
    x: FeedbackState, motion: Motion, expected: Motion, T_driver: float, T_s: float, p: Parameters
) -> tuple[FeedbackState, Addition]:
    ahead = Motion(*(now + p.T_pred / T_s * (then - now) for now, then in zip(motion, expected, strict=True)))
    changing = fed_back(ahead, p)
    return FeedbackState(washed_out(x.washout, changing, p.omega_w, T_s)), Addition(x.washout - changing, landing=0.0)


def fed_back(motion: Motion, p: Parameters) -> float:
    """The torque in N.m that the washout leaves the changing part of."""
    return p.k_d * motion.omega + p.k_T * motion.T_gear
