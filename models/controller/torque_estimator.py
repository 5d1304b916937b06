"""Estimator of the gear torque: the paper's third-order nonlinear Kalman filter (section V).

    J_1 domega_1/dt = T_mot - T_gear
    J_2 domega_2/dt = T_l + (1 - lambda_v) T_gear
           dphi/dt  = omega_1 - omega_2          T_gear = C b(phi, phi_B)

The vehicle takes the share lambda_v of the gear torque; T_l is the rest of the load, a slow state.
With lambda_v = 0 and no gain on T_l this is literally the paper's observer. Between samples the
model is integrated by the leapfrog method. The measured motor speed corrects it at every sample,
the wheel speed when a message arrives; what that tells is omega_2 behind a lag of T_age. The constant gains come from
a Riccati equation (harness, design). Those of a message act with `share`, which fades from 0 to 1 while messages come.
An estimate whose twist is beyond what the drive train can bear begins anew.

Wheels that spin or lock leave the vehicle behind, and the road that catches them is a load that steps. The model has
neither, and shows it: its innovations drift, or the slow load becomes larger than any vehicle's. `slip` then fades to
a set of gains for a load that may change fast, at once, and back within t_grip.

The gap is the one that was learned (learned_gap). What is learned at the end of a crossing moves the estimated twist
with the flank, so that the gear torque stays.

The model looks the same from a train that rolls along: only differences of speeds are in it. So the speeds of the
estimate are counted from the motor speed that was measured last. They are small numbers then, and single precision
rounds them as little as the twist, which is the integral of their difference.
"""

from collections.abc import Sequence
from typing import Annotated, NamedTuple, cast

from fmublocks.block.declaration import Real, merged
from fmublocks.block.operators import branch, clip, maximum, where

from ..physics.backlash import dead_zone
from ..physics.vehicle import CAR, HalfGap, MotorInertia, Stiffness, WheelInertia, added_speed
from . import learned_gap
from .fading import faded
from .gains import GAINS
from .interfaces import Motion
from .learned_gap import GapState

LARGEST_TORQUE = 4.0
"""Gear torque over T_max beyond which an estimate is none: a step of the demand from -T_max to T_max swings to 3 on a
spring without damping, and an impact through the gap adds less than 1."""


class ModelParameters(NamedTuple):
    J_1: MotorInertia = CAR.J_1
    J_2: WheelInertia = CAR.J_2
    C: Stiffness = CAR.C
    phi_B: HalfGap = CAR.phi_B
    lambda_v: Annotated[float, Real("1", "share of the gear torque that the vehicle takes", 0.0, 0.99)] = GAINS[
        "lambda_v"
    ]
    L_omega_1: Annotated[float, Real("1", "gain on omega_1_hat", -2.0, 2.0, tunable=True)] = GAINS["L_omega_1"]
    L_omega_2: Annotated[float, Real("1", "gain on omega_2_hat", -2.0, 2.0, tunable=True)] = GAINS["L_omega_2"]
    L_phi: Annotated[float, Real("s", "gain on phi_hat", -0.1, 0.1, tunable=True)] = GAINS["L_phi"]
    L_T_l: Annotated[float, Real("N.m.s/rad", "gain on the load", -10.0, 10.0, tunable=True)] = GAINS["L_T_l"]
    L_can_omega_1: Annotated[float, Real("1", "gain of a message on omega_1_hat", -2.0, 2.0, tunable=True)] = GAINS[
        "L_can_omega_1"
    ]
    L_can_omega_2: Annotated[float, Real("1", "gain of a message on omega_2_hat", -2.0, 2.0, tunable=True)] = GAINS[
        "L_can_omega_2"
    ]
    L_can_phi: Annotated[float, Real("s", "gain of a message on phi_hat", -0.1, 0.1, tunable=True)] = GAINS["L_can_phi"]
    L_can_T_l: Annotated[float, Real("N.m.s/rad", "gain of a message on the load", -10.0, 10.0, tunable=True)] = GAINS[
        "L_can_T_l"
    ]
    T_age: Annotated[float, Real("s", "age of a message on arrival", 0.002, 0.1, tunable=True)] = GAINS["T_age"]
    Ls_omega_1: Annotated[float, Real("1", "gain on omega_1_hat, while the wheels slip", -2.0, 2.0, tunable=True)] = (
        GAINS["Ls_omega_1"]
    )
    Ls_omega_2: Annotated[float, Real("1", "gain on omega_2_hat, while the wheels slip", -20.0, 20.0, tunable=True)] = (
        GAINS["Ls_omega_2"]
    )
    Ls_phi: Annotated[float, Real("s", "gain on phi_hat, while the wheels slip", -0.1, 0.1, tunable=True)] = GAINS[
        "Ls_phi"
    ]
    Ls_T_l: Annotated[
        float, Real("N.m.s/rad", "gain on the load, while the wheels slip", -100.0, 100.0, tunable=True)
    ] = GAINS["Ls_T_l"]
    slip_drift: Annotated[
        float, Real("1", "mean innovation from which on the wheels slip, over T_max T_s/J_1", 1e-3, 100.0, tunable=True)
    ] = 0.45
    slip_load: Annotated[
        float, Real("1", "slow load from which on the wheels slip, over T_max", 1e-3, 4.0, tunable=True)
    ] = 0.11
    t_drift: Annotated[float, Real("s", "time over which the mean innovation is taken", 0.002, 1.0, tunable=True)] = (
        0.01
    )
    t_grip: Annotated[float, Real("s", "time after which slip is forgotten", 0.002, 10.0, tunable=True)] = 1.0


Parameters = merged("Parameters", ModelParameters, learned_gap.Parameters)


class AllParameters(ModelParameters):
    """With those of the supervision that it takes beside its own: a type of p, never made."""

    T_max: float
    t_fade: float


class Estimate(NamedTuple):
    """State of the estimator's model, motor side; its speeds are counted from a base."""

    omega_1: Annotated[float, Real("rad/s", "estimated speed of the motor, from the base")]
    omega_2: Annotated[float, Real("rad/s", "estimated speed of the wheels, motor side, from the base")]
    phi: Annotated[float, Real("rad", "estimated twist")]
    T_l: Annotated[float, Real("N.m", "estimated slow part of the load torque")]


class EstimatorState(NamedTuple):
    """State of the torque estimator."""

    base: Annotated[float, Real("rad/s", "motor speed measured last, from which the speeds of the estimate count")]
    estimate: Estimate
    late: Annotated[float, Real("rad/s", "estimate of omega_2 as a message that arrives now would tell it")]
    share: Annotated[float, Real("1", "share of the gains of a message")]
    drift: Annotated[float, Real("rad/s", "mean of the recent innovations")]
    slip: Annotated[float, Real("1", "share of the gains for wheels that slip")]
    gap: GapState


def start(omega_1: float, T_mot: float, wheel: bool, p: AllParameters) -> EstimatorState:
    gap = learned_gap.start(cast(learned_gap.Parameters, p))
    estimate = at_rest_with(T_mot, gap.phi_B, p)
    return EstimatorState(omega_1, estimate, omega_1, where(wheel, 1.0, 0.0), drift=0.0, slip=0.0, gap=gap)


def restart(x: EstimatorState, omega_1: float, T_mot: float, p: AllParameters) -> EstimatorState:
    estimate = at_rest_with(T_mot, x.gap.phi_B, p)
    gap = learned_gap.forget_crossing(x.gap)
    return x._replace(base=omega_1, estimate=estimate, late=omega_1, drift=0.0, slip=0.0, gap=gap)


def take_motor_speed(x: EstimatorState, omega_1: float, slips: bool, T_s: float, p: AllParameters) -> EstimatorState:
    e = counted_from(omega_1 - x.base, x.estimate)
    drift = x.drift - T_s / p.t_drift * (e.omega_1 + x.drift)
    slip = where(slips, 1.0, maximum(slipping(drift, e.T_l, T_s, p), x.slip - T_s / p.t_grip))
    L, Ls = (p.L_omega_1, p.L_omega_2, p.L_phi, p.L_T_l), (p.Ls_omega_1, p.Ls_omega_2, p.Ls_phi, p.Ls_T_l)
    gains = branch(slip > 0.0, lambda: tuple(a + slip * (b - a) for a, b in zip(L, Ls, strict=True)), lambda: L)
    e = corrected(e, -e.omega_1, gains)
    x = x._replace(base=omega_1, estimate=e, drift=drift, slip=slip)
    plausible = p.C * (abs(e.phi) - x.gap.phi_B) <= LARGEST_TORQUE * p.T_max
    return branch(plausible, lambda: x, lambda: restart(x, omega_1, 0.0, p))


def slipping(drift: float, T_l: float, T_s: float, p: AllParameters) -> float:
    """How clearly the wheels slip, from 0 to 1, by the mean innovation (rad/s) and the slow load (N.m)."""
    by_drift = abs(drift) / (p.slip_drift * added_speed(p, T_s))
    by_load = abs(T_l) / (p.slip_load * p.T_max)
    return clip(maximum(by_drift, by_load) - 1.0, 0.0, 1.0)


def take_wheel_speed(x: EstimatorState, omega_2: float, T_s: float, p: ModelParameters) -> EstimatorState:
    L = (p.L_can_omega_1, p.L_can_omega_2, p.L_can_phi, p.L_can_T_l)
    return x._replace(estimate=corrected(x.estimate, x.share * (omega_2 - x.late), L))


def learn(x: EstimatorState, innovation: float, hold: bool, T_s: float, p: AllParameters) -> EstimatorState:
    e = x.estimate
    gap, moved = learned_gap.update(x.gap, innovation, e.phi, x.slip, hold, T_s, cast(learned_gap.AllParameters, p))
    return x._replace(estimate=e._replace(phi=e.phi + moved), gap=gap)


def predict(x: EstimatorState, T_mot: float, wheel: bool, T_s: float, p: AllParameters) -> EstimatorState:
    return x._replace(
        estimate=integrated(x.estimate, T_mot, x.gap.phi_B, T_s, p),
        late=x.late + T_s / p.T_age * (x.base + x.estimate.omega_2 - x.late),
        share=faded(x.share, wheel, T_s, p.t_fade),
    )


def motion(x: EstimatorState, p: ModelParameters) -> Motion:
    e, phi_B = x.estimate, x.gap.phi_B
    T_gear = p.C * dead_zone(e.phi, phi_B)
    return Motion(x.base + e.omega_1, x.base + e.omega_2, e.phi, T_gear, e.omega_1 - e.omega_2, phi_B, x.slip)


def counted_from(omega: float, e: Estimate) -> Estimate:
    """The estimate with its speeds counted from one that is omega (rad/s) above its base."""
    return e._replace(omega_1=e.omega_1 - omega, omega_2=e.omega_2 - omega)


def at_rest_with(T_mot: float, phi_B: float, p: ModelParameters) -> Estimate:
    """Estimate before anything was measured but the base: no twisting motion, the whole motor torque in the gear."""
    flank = where(T_mot > 0.0, phi_B, where(T_mot < 0.0, -phi_B, 0.0))
    return Estimate(0.0, 0.0, T_mot / p.C + flank, 0.0)


def integrated(e: Estimate, T_mot: float, phi_B: float, h: float, p: ModelParameters) -> Estimate:
    """The estimate h seconds later under the motor torque T_mot (N.m)."""
    phi = e.phi + 0.5 * h * (e.omega_1 - e.omega_2)
    T_gear = p.C * dead_zone(phi, phi_B)
    omega_1 = e.omega_1 + h * (T_mot - T_gear) / p.J_1
    omega_2 = e.omega_2 + h * (e.T_l + (1.0 - p.lambda_v) * T_gear) / p.J_2
    return Estimate(omega_1, omega_2, phi + 0.5 * h * (omega_1 - omega_2), e.T_l)


def corrected(e: Estimate, error: float, L: Sequence[float]) -> Estimate:
    """The estimate after a measurement that was `error` (rad/s) above what it should be, with the gains L."""
    return Estimate(*(value + error * gain for value, gain in zip(e, L, strict=True)))
