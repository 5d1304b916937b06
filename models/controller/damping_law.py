"""Damping law: what is added to the driver's demand, given the estimated motion of the drive train.

The changing part of the twisting motion is opposed,

    T_damp = -s/(s + omega_w) k_d omega          omega = omega_1 - omega_2, T_pred ahead

and a change of the demand is shaped: a part of it is added at once, and taken back a lag later,

    T_shape = shape_1 (T_driver - T_1) + shape_2 (T_1 - T_2)          T_1, T_2: T_driver behind one and two lags

of the corner frequency omega_shape. It softens the swing that a step begins, and gives back what damping withholds.

Between the flanks the motor is alone with its inertia. It is led to the flank that the demand will push against, which
is d away, with the speed from which T_gap would still brake it to what the teeth may land with,

    omega_land^2 = (landing_share T/sqrt(C J_1))^2 + 2 T_gap d/J_1          T: T_next, at most T_impact
    T_ref = k_gap k_d (omega_land - omega) - landing_brake T_gap omega/(omega_land + |omega|)
    T_next = T_driver + demand_lead s/(s + omega_slow) T_driver

with T_ref, omega, T and T_next counted towards that flank, T_pred_land ahead, when the torque will act. It is at
most T_next. An impact with the first part of omega_land alone twists the drive train to the torque
landing_share T. What the landing has withheld comes back with the time constant t_return. A landing lasts t_land
at most, and a demand that is next to nothing has none.

Where the wheels slip shape, landing_brake and the time for a landing fade, the damping to half: there the road takes
less than is demanded, and the estimate lags. Half swings are those of the full damping: a late motor speed looks like
slip, and what it feeds must show.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real
from fmublocks.block.operators import clip, logical_and, maximum, minimum, sqrt, where

from ..physics.vehicle import CAR, MotorInertia, Stiffness
from .gains import GAINS
from .interfaces import Addition, Motion

LEAST_DISTANCE = 1e-3
"""To the flank, rad: whatever lands has a speed. The estimate knows the distance no better; with less of it the last
bit of single precision moves the torque by 8 mN.m."""


class Parameters(NamedTuple):
    J_1: MotorInertia = CAR.J_1
    C: Stiffness = CAR.C
    T_pred: Annotated[
        float, Real("s", "time that the estimate is taken ahead", 0.0, 0.02, search=(0.0, 0.006), tunable=True)
    ] = GAINS["T_pred"]
    k_d: Annotated[
        float, Real("N.m.s/rad", "damping over the speed difference", 0.0, 200.0, search=(0.3, 10.0), tunable=True)
    ] = GAINS["k_d"]
    omega_w: Annotated[
        float, Real("rad/s", "corner frequency of the washout", 0.0, 400.0, search=(0.5, 300.0), tunable=True)
    ] = GAINS["omega_w"]
    shape_1: Annotated[
        float,
        Real("1", "share of a change of the demand that is added at once", -5.0, 5.0, search=(0.0, 1.5), tunable=True),
    ] = GAINS["shape_1"]
    shape_2: Annotated[float, Real("1", "the same, a lag later", -5.0, 5.0, search=(-1.5, 0.0), tunable=True)] = GAINS[
        "shape_2"
    ]
    omega_shape: Annotated[
        float, Real("rad/s", "corner frequency of that lag", 0.0, 400.0, search=(20.0, 250.0), tunable=True)
    ] = GAINS["omega_shape"]
    k_gap: Annotated[
        float,
        Real(
            "1", "torque of a landing over the error of its speed, over k_d", 0.0, 4.0, search=(0.2, 2.0), tunable=True
        ),
    ] = GAINS["k_gap"]
    T_pred_land: Annotated[
        float,
        Real("s", "time that the estimate is taken ahead for a landing", 0.0, 0.05, search=(0.0, 0.015), tunable=True),
    ] = GAINS["T_pred_land"]
    T_gap: Annotated[
        float, Real("N.m", "torque that brakes before an impact", 0.1, 2000.0, search=(10.0, 150.0), tunable=True)
    ] = GAINS["T_gap"]
    landing_brake: Annotated[
        float, Real("1", "what of it is commanded in advance", 0.0, 5.0, search=(0.0, 3.0), tunable=True)
    ] = GAINS["landing_brake"]
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
    T_impact: Annotated[
        float,
        Real("N.m", "largest demand that an impact is derived from", 0.0, 2000.0, search=(20.0, 180.0), tunable=True),
    ] = GAINS["T_impact"]
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
    first: Annotated[float, Real("N.m", "demand behind the lag of its shape")]
    second: Annotated[float, Real("N.m", "demand behind two of these lags")]
    afloat: Annotated[float, Real("s", "time spent in the gap under a demand")]
    withheld: Annotated[float, Real("N.m", "torque that the landing withholds")]


def start(motion: Motion, T_driver: float, p: Parameters) -> LawState:
    return LawState(p.k_d * motion.omega, T_driver, T_driver, T_driver, afloat=0.0, withheld=0.0)


def update(
    x: LawState, motion: Motion, expected: Motion, T_driver: float, T_s: float, p: AllParameters
) -> tuple[LawState, Addition]:
    omega, change = motion.omega, expected.omega - motion.omega
    fed_back = p.k_d * (omega + p.T_pred / T_s * change)
    grip = 1.0 - motion.slip
    full = clip(x.washout - fed_back, -p.T_add_max, p.T_add_max)
    damping = minimum(1.0, 0.5 + grip) * full
    shape = grip * (p.shape_1 * (T_driver - x.first) + p.shape_2 * (x.first - x.second))
    T_next = T_driver + p.demand_lead * (T_driver - x.slow)

    pushing = logical_and(abs(T_driver) > p.T_still, T_driver * T_next > 0.0)
    floating = logical_and(in_gap(motion), pushing)
    afloat = where(floating, minimum(x.afloat + T_s, p.t_land + T_s), 0.0)
    landing = logical_and(floating, afloat < grip * p.t_land + 0.5 * T_s)
    samples = p.T_pred_land / T_s
    phi = motion.phi + samples * (expected.phi - motion.phi)
    T_land = landing_torque(omega + samples * change, phi, motion.phi_B, T_next, grip * p.landing_brake, p)
    withheld = where(landing, T_driver + damping + shape - T_land, x.withheld)
    kept = where(landing, 1.0, 1.0 - T_s / p.t_return)
    x = LawState(
        washout=washed_out(x.washout, fed_back, p.omega_w, T_s),
        slow=washed_out(x.slow, T_driver, p.omega_slow, T_s),
        first=washed_out(x.first, T_driver, p.omega_shape, T_s),
        second=washed_out(x.second, x.first, p.omega_shape, T_s),
        afloat=afloat,
        withheld=kept * withheld,
    )
    return x, Addition(damping=full, landing=damping - full + shape - withheld)


def in_gap(motion: Motion) -> bool:
    return abs(motion.phi) < motion.phi_B


def washed_out(stationary: float, value: float, corner: float, T_s: float) -> float:
    """The stationary part of `value` at the next sample, behind a washout with that corner frequency (rad/s)."""
    return stationary + corner * T_s * (value - stationary)


def landing_torque(omega: float, phi: float, phi_B: float, T_next: float, brake: float, p: Parameters) -> float:
    """T_ref in N.m that leads the teeth to the flank which the demand T_next (N.m) pushes against.

    Args:
        omega, phi: speed (rad/s) and twist (rad) of the drive train when the torque acts.
        phi_B: half gap, rad.
        brake: what of T_gap is commanded in advance.
    """
    side = where(T_next > 0.0, 1.0, -1.0)
    omega, d = side * omega, phi_B - side * phi
    touching = p.landing_share * minimum(abs(T_next), p.T_impact) / sqrt(p.C * p.J_1)
    omega_land = sqrt(touching * touching + 2.0 * p.T_gap / p.J_1 * maximum(d, LEAST_DISTANCE))
    braking = brake * p.T_gap * omega / (omega_land + abs(omega))
    k = p.k_gap * p.k_d
    return side * minimum(k * (omega_land - omega) - braking, maximum(abs(T_next), -k * omega))
