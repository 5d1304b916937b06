"""Damping law: what is added to the driver's demand, given the estimated motion of the drive train.

    T_damp = -s/(s + omega_w) [k_d (omega_1 - omega_2) + k_T T_gear],   k_d times k_gap in the gap

with the motion T_pred ahead, when the torque will act. While the estimated twist is in the gap, but for at
most t_land, the demand is limited to T_gap, so that the teeth land softly.
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Real
from ..block.operators import clip, logical_and, minimum, where
from ..vehicle import CAR, HalfGap
from .gains import GAINS
from .parts import Addition, Motion


class Parameters(NamedTuple):
    phi_B: HalfGap = CAR.phi_B
    T_pred: Annotated[float, Real("s", "time that the estimate is taken ahead", 0.0, 0.02, search=(0.0, 0.012))] = (
        GAINS["T_pred"]
    )
    k_d: Annotated[float, Real("N.m.s/rad", "damping over the speed difference", 0.0, 20.0, search=(0.3, 10.0))] = (
        GAINS["k_d"]
    )
    k_gap: Annotated[float, Real("1", "factor on k_d inside the gap", 0.0, 2.0, search=(0.1, 2.0))] = GAINS["k_gap"]
    k_T: Annotated[float, Real("1", "damping over the gear torque", 0.0, 5.0, search=(0.003, 5.0))] = GAINS["k_T"]
    omega_w: Annotated[float, Real("rad/s", "corner frequency of the washout", 0.0, 400.0, search=(0.5, 300.0))] = (
        GAINS["omega_w"]
    )
    T_gap: Annotated[float, Real("N.m", "limit of the demand inside the gap", 0.0, 2000.0, search=(10.0, 150.0))] = (
        GAINS["T_gap"]
    )
    t_land: Annotated[float, Real("s", "longest duration of that limit", 0.0, 1.0, search=(0.02, 0.3))] = GAINS[
        "t_land"
    ]


class LawState(NamedTuple):
    """State of the damping law."""

    washout: Annotated[float, Real("N.m", "stationary part of what is fed back")]
    landing: Annotated[float, Real("s", "time spent in the gap")]


def start(motion: Motion, T_driver: Any, p: Any) -> LawState:
    return LawState(washout=fed_back(motion, p), landing=0.0)


def update(x: LawState, motion: Motion, later: Any, T_driver: Any, T_s: Any, p: Any) -> tuple[LawState, Addition]:
    changing = fed_back(later(p.T_pred), p)
    landing = where(in_gap(motion, p), minimum(x.landing + T_s, p.t_land + T_s), 0.0)
    added = Addition(damping=x.washout - changing, landing=soft_landing(T_driver, landing, p) - T_driver)
    return LawState(washed_out(x.washout, changing, p.omega_w, T_s), landing), added


def in_gap(motion: Motion, p: Any) -> Any:
    return abs(motion.phi) < p.phi_B


def fed_back(motion: Motion, p: Any) -> Any:
    """The torque in N.m that the washout leaves the changing part of."""
    k_d = p.k_d * where(in_gap(motion, p), p.k_gap, 1.0)
    return k_d * (motion.omega_1 - motion.omega_2) + p.k_T * motion.T_gear


def washed_out(stationary: Any, value: Any, corner: Any, T_s: Any) -> Any:
    """The stationary part of `value` at the next sample, behind a washout with that corner frequency (rad/s)."""
    return stationary + minimum(corner * T_s, 1.0) * (value - stationary)


def soft_landing(T_driver: Any, landing: Any, p: Any) -> Any:
    """The demand, limited while the teeth are between the flanks, `landing` s after they left one."""
    soft = logical_and(landing > 0.0, landing <= p.t_land)
    return where(soft, clip(T_driver, -p.T_gap, p.T_gap), T_driver)
