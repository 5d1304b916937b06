"""Damping law: what is added to the driver's demand, given the estimated motion of the drive train.

Where the teeth touch, the changing part of the twisting motion is opposed,

    T_damp = -s/(s + omega_w) [k_d omega + k_T T_gear]          omega = omega_1 - omega_2

Between the flanks the motor is alone with its inertia. It is led to the flank that the demand will push against, which
is d away, with the speed from which a share of that demand would still brake it to what the teeth may land with,

    T_ref = k_gap k_d (omega_land - omega)                       no more than T_next
    omega_land^2 = (landing_share T/sqrt(C J_1))^2 + 2 landing_brake T d/J_1    T: T_next, at most T_gap
    T_next = T_driver + demand_lead s/(s + omega_slow) T_driver

with T_ref, omega and T counted towards that flank. An impact with landing_share T/sqrt(C J_1) alone twists the drive
train to the torque landing_share T. What the landing has withheld comes back with the time constant t_return. A landing
lasts t_land at most, and a demand that is next to nothing has none. All that with the motion T_pred ahead, when the
torque will act.
"""

from typing import Annotated, NamedTuple

from ..block.declaration import Real
from ..block.operators import clip, logical_and, maximum, minimum, sqrt, where
from ..physics.vehicle import CAR, HalfGap, MotorInertia, Stiffness
from .gains import GAINS
from .interfaces import Addition, Motion


class Parameters(NamedTuple):
    J_1: MotorInertia = CAR.J_1
    C: Stiffness = CAR.C
    phi_B: HalfGap = CAR.phi_B
    T_pred: Annotated[
        float, Real("s", "time that the estimate is taken ahead", 0.0, 0.02, search=(0.0, 0.006), tunable=True)
    ] = GAINS["T_pred"]
    k_d: Annotated[
        float, Real("N.m.s/rad", "damping over the speed difference", 0.0, 200.0, search=(0.3, 10.0), tunable=True)
    ] = GAINS["k_d"]
    k_T: Annotated[float, Real("1", "damping over the gear torque", 0.0, 5.0, search=(0.001, 5.0))] = GAINS["k_T"]
    omega_w: Annotated[
        float, Real("rad/s", "corner frequency of the washout", 0.0, 400.0, search=(0.5, 300.0), tunable=True)
    ] = GAINS["omega_w"]
    k_gap: Annotated[float, Real("1", "factor on k_d inside the gap", 0.0, 2.0, search=(0.1, 2.0), tunable=True)] = (
        GAINS["k_gap"]
    )
    T_gap: Annotated[
        float,
        Real(
            "N.m",
            "largest torque that the speed of a landing is derived from",
            0.0,
            2000.0,
            search=(20.0, 180.0),
            tunable=True,
        ),
    ] = GAINS["T_gap"]
    landing_share: Annotated[
        float,
        Real(
            "1",
            "twist that an impact alone may make, over that of the demand",
            0.0,
            5.0,
            search=(0.0, 1.5),
            tunable=True,
        ),
    ] = GAINS["landing_share"]
    landing_brake: Annotated[
        float,
        Real("1", "torque that can brake before an impact, over the demand", 0.0, 5.0, search=(0.0, 1.5), tunable=True),
    ] = GAINS["landing_brake"]
    demand_lead: Annotated[
        float,
        Real(
            "1", "expected further change of the demand, over the recent one", 0.0, 5.0, search=(0.0, 2.0), tunable=True
        ),
    ] = GAINS["demand_lead"]
    omega_slow: Annotated[
        float, Real("rad/s", "corner frequency that tells what is recent", 0.0, 400.0, search=(3.0, 60.0), tunable=True)
    ] = GAINS["omega_slow"]
    t_return: Annotated[
        float,
        Real(
            "s",
            "time within which the torque that a landing withheld comes back",
            0.002,
            1.0,
            search=(0.002, 0.03),
            tunable=True,
        ),
    ] = GAINS["t_return"]
    t_land: Annotated[float, Real("s", "longest duration of a landing", 0.0, 1.0)] = GAINS["t_land"]


class AllParameters(Parameters):
    """With those of the supervision that it takes beside its own: a type of p, never made."""

    T_add_max: float
    T_still: float


class LawState(NamedTuple):
    """State of the damping law."""

    washout: Annotated[float, Real("N.m", "stationary part of what is fed back")]
    slow: Annotated[float, Real("N.m", "demand as it was, behind a lag")]
    afloat: Annotated[float, Real("s", "time spent in the gap under a demand")]
    withheld: Annotated[float, Real("N.m", "torque that the landing withholds")]


def start(motion: Motion, T_driver: float, p: Parameters) -> LawState:
    return LawState(washout=fed_back(motion, p), slow=T_driver, afloat=0.0, withheld=0.0)


def update(
    x: LawState, motion: Motion, expected: Motion, T_driver: float, T_s: float, p: AllParameters
) -> tuple[LawState, Addition]:
    ahead = Motion(*(now + p.T_pred / T_s * (then - now) for now, then in zip(motion, expected, strict=True)))
    changing = fed_back(ahead, p)
    damping = clip(x.washout - changing, -p.T_add_max, p.T_add_max)
    T_next = T_driver + p.demand_lead * (T_driver - x.slow)

    pushing = logical_and(abs(T_driver) > p.T_still, T_driver * T_next > 0.0)
    floating = logical_and(in_gap(motion, p), pushing)
    afloat = where(floating, minimum(x.afloat + T_s, p.t_land + T_s), 0.0)
    landing = logical_and(floating, afloat < p.t_land + 0.5 * T_s)
    withheld = where(landing, T_driver + damping - landing_torque(ahead, T_next, p), x.withheld)
    left = where(landing, 1.0, 1.0 - T_s / p.t_return)
    x = LawState(
        washout=washed_out(x.washout, changing, p.omega_w, T_s),
        slow=washed_out(x.slow, T_driver, p.omega_slow, T_s),
        afloat=afloat,
        withheld=left * withheld,
    )
    return x, Addition(damping=damping, landing=-withheld)


def in_gap(motion: Motion, p: Parameters) -> bool:
    return abs(motion.phi) < p.phi_B


def fed_back(motion: Motion, p: Parameters) -> float:
    """The torque in N.m that the washout leaves the changing part of."""
    k_d = p.k_d * where(in_gap(motion, p), p.k_gap, 1.0)
    return k_d * (motion.omega_1 - motion.omega_2) + p.k_T * motion.T_gear


def washed_out(stationary: float, value: float, corner: float, T_s: float) -> float:
    """The stationary part of `value` at the next sample, behind a washout with that corner frequency (rad/s)."""
    return stationary + corner * T_s * (value - stationary)


def landing_torque(motion: Motion, T_next: float, p: Parameters) -> float:
    """T_ref in N.m that leads the teeth to the flank which the demand T_next (N.m) pushes against."""
    side = where(T_next > 0.0, 1.0, -1.0)
    omega, d = side * (motion.omega_1 - motion.omega_2), maximum(p.phi_B - side * motion.phi, 0.0)
    T = minimum(abs(T_next), p.T_gap)
    touching = p.landing_share * T / sqrt(p.C * p.J_1)
    omega_land = sqrt(touching * touching + 2.0 * p.landing_brake * T * d / p.J_1)
    k = p.k_gap * p.k_d
    return side * minimum(k * (omega_land - omega), maximum(abs(T_next), -k * omega))
