"""Estimator of the gear torque: the paper's third-order nonlinear Kalman filter (section V).

    J_1 domega_1/dt = T_mot - T_gear
    J_2 domega_2/dt = T_l + (1 - lambda) T_gear
           dphi/dt  = omega_1 - omega_2          T_gear = C b(phi, phi_B)

The vehicle takes the share lambda of the gear torque; T_l is the rest of the load, a slow state.
With lambda = 0 and no gain on T_l this is literally the paper's observer. Between samples the
model is integrated by the leapfrog method. The measured motor speed corrects it at every sample,
the wheel speed when a message arrives, against the estimate of T_age before: so old is the message.
The constant gains come from a Riccati equation (harness, design), one set for each mode; `share` fades
from the set without (0) to the set with the wheel speed (1).

Wheels that spin or lock leave the vehicle behind, and the road that catches them is a load that steps. The model has
neither, and shows it: its innovations drift, or the slow load becomes larger than any vehicle's. `slip` then fades to
a set of gains for a load that may change fast, at once, and back within t_grip.

The model looks the same from a train that rolls along: only differences of speeds are in it. So the speeds of the
estimate are counted from the motor speed that was measured last. They are small numbers then, and single precision
rounds them as little as the twist, which is the integral of their difference.
"""

from typing import Annotated, NamedTuple

from ..block.declaration import Real
from ..block.operators import clip, interpolate, maximum, minimum, where
from ..physics.backlash import dead_zone
from ..physics.vehicle import CAR, HalfGap, MotorInertia, Stiffness, WheelInertia
from .fading import toward
from .gains import GAINS
from .interfaces import Motion
from .supervision_interface import added_speed

HISTORY = 50
"""Past estimates of omega_2 that are kept, one a sample: the age of messages every 50 ms that are late by as much."""


class Parameters(NamedTuple):
    J_1: MotorInertia = CAR.J_1
    J_2: WheelInertia = CAR.J_2
    C: Stiffness = CAR.C
    phi_B: HalfGap = CAR.phi_B
    lambda_v: Annotated[float, Real("1", "share of the gear torque that the vehicle takes", 0.0, 0.99)] = GAINS[
        "lambda_v"
    ]
    L_omega_1: Annotated[float, Real("1", "gain on omega_1_hat, without wheel speed", -2.0, 2.0, tunable=True)] = GAINS[
        "L_omega_1"
    ]
    L_omega_2: Annotated[float, Real("1", "gain on omega_2_hat, without wheel speed", -2.0, 2.0, tunable=True)] = GAINS[
        "L_omega_2"
    ]
    L_phi: Annotated[float, Real("s", "gain on phi_hat, without wheel speed", -0.1, 0.1, tunable=True)] = GAINS["L_phi"]
    L_T_l: Annotated[float, Real("N.m.s/rad", "gain on the load, without wheel speed", -10.0, 10.0, tunable=True)] = (
        GAINS["L_T_l"]
    )
    Lw_omega_1: Annotated[float, Real("1", "gain on omega_1_hat, with wheel speed", -2.0, 2.0, tunable=True)] = GAINS[
        "Lw_omega_1"
    ]
    Lw_omega_2: Annotated[float, Real("1", "gain on omega_2_hat, with wheel speed", -2.0, 2.0, tunable=True)] = GAINS[
        "Lw_omega_2"
    ]
    Lw_phi: Annotated[float, Real("s", "gain on phi_hat, with wheel speed", -0.1, 0.1, tunable=True)] = GAINS["Lw_phi"]
    Lw_T_l: Annotated[float, Real("N.m.s/rad", "gain on the load, with wheel speed", -10.0, 10.0, tunable=True)] = (
        GAINS["Lw_T_l"]
    )
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
    Ls_omega_2: Annotated[float, Real("1", "gain on omega_2_hat, while the wheels slip", -2.0, 2.0, tunable=True)] = (
        GAINS["Ls_omega_2"]
    )
    Ls_phi: Annotated[float, Real("s", "gain on phi_hat, while the wheels slip", -0.1, 0.1, tunable=True)] = GAINS[
        "Ls_phi"
    ]
    Ls_T_l: Annotated[
        float, Real("N.m.s/rad", "gain on the load, while the wheels slip", -10.0, 10.0, tunable=True)
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


class AllParameters(Parameters):
    """With those of the supervision that it takes beside its own: a type of p, never made."""

    T_max: float
    t_fade: float
    omega_max: float


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
    past: Annotated[tuple[float, ...], Real("rad/s", "estimates of omega_2 of the last samples, newest first")]
    share: Annotated[float, Real("1", "share of the gains with wheel speed")]
    drift: Annotated[float, Real("rad/s", "mean of the recent innovations")]
    slip: Annotated[float, Real("1", "share of the gains for wheels that slip")]


def start(omega_1: float, T_mot: float, wheel: bool, p: Parameters) -> EstimatorState:
    e = at_rest_with(T_mot, p)
    return EstimatorState(omega_1, e, past=(omega_1,) * HISTORY, share=where(wheel, 1.0, 0.0), drift=0.0, slip=0.0)


def restart(x: EstimatorState, omega_1: float, T_mot: float, p: Parameters) -> EstimatorState:
    return x._replace(base=omega_1, estimate=at_rest_with(T_mot, p), drift=0.0, slip=0.0)


def predict(x: EstimatorState, T_mot: float, T_s: float, p: Parameters) -> EstimatorState:
    return x._replace(estimate=integrated(x.estimate, T_mot, T_s, p))


def take_motor_speed(x: EstimatorState, omega_1: float, T_s: float, p: AllParameters) -> EstimatorState:
    e = counted_from(omega_1 - x.base, x.estimate)
    drift = x.drift - minimum(T_s / p.t_drift, 1.0) * (e.omega_1 + x.drift)
    slip = maximum(slipping(drift, e.T_l, T_s, p), x.slip - minimum(T_s / p.t_grip, 1.0))
    corrected = corrected_by_motor_speed(e, 0.0, x.share, slip, p)
    return x._replace(base=omega_1, estimate=bounded(corrected, omega_1, p), drift=drift, slip=slip)


def slipping(drift: float, T_l: float, T_s: float, p: AllParameters) -> float:
    """How clearly the wheels slip, from 0 to 1, by the mean innovation (rad/s) and the slow load (N.m)."""
    by_drift = abs(drift) / (p.slip_drift * added_speed(p, T_s))
    by_load = abs(T_l) / (p.slip_load * p.T_max)
    return clip(maximum(by_drift, by_load) - 1.0, 0.0, 1.0)


def take_wheel_speed(x: EstimatorState, omega_2: float, T_s: float, p: Parameters) -> EstimatorState:
    return x._replace(estimate=corrected_by_message(x, omega_2, p.T_age / T_s, p))


def finish(x: EstimatorState, wheel: bool, T_s: float, p: AllParameters) -> EstimatorState:
    share = toward(x.share, where(wheel, 1.0, 0.0), T_s, p.t_fade)
    return x._replace(past=(x.base + x.estimate.omega_2, *x.past[:-1]), share=share)


def motion(x: EstimatorState, p: Parameters) -> Motion:
    return seen(x.estimate, x.base, p)


def motion_after(x: EstimatorState, T_mot: float, h: float, p: Parameters) -> Motion:
    return seen(integrated(x.estimate, T_mot, h, p), x.base, p)


def seen(e: Estimate, base: float, p: Parameters) -> Motion:
    return Motion(base + e.omega_1, base + e.omega_2, e.phi, p.C * dead_zone(e.phi, p.phi_B))


def counted_from(omega: float, e: Estimate) -> Estimate:
    """The estimate with its speeds counted from one that is omega (rad/s) above its base."""
    return e._replace(omega_1=e.omega_1 - omega, omega_2=e.omega_2 - omega)


def at_rest_with(T_mot: float, p: Parameters) -> Estimate:
    """Estimate before anything was measured but the base: no twisting motion, the whole motor torque in the gear."""
    flank = where(T_mot > 0.0, p.phi_B, where(T_mot < 0.0, -p.phi_B, 0.0))
    return Estimate(0.0, 0.0, T_mot / p.C + flank, 0.0)


def integrated(e: Estimate, T_mot: float, h: float, p: Parameters) -> Estimate:
    """The estimate h seconds later under the motor torque T_mot (N.m)."""
    phi = e.phi + 0.5 * h * (e.omega_1 - e.omega_2)
    T_gear = p.C * dead_zone(phi, p.phi_B)
    omega_1 = e.omega_1 + h * (T_mot - T_gear) / p.J_1
    omega_2 = e.omega_2 + h * (e.T_l + (1.0 - p.lambda_v) * T_gear) / p.J_2
    return Estimate(omega_1, omega_2, phi + 0.5 * h * (omega_1 - omega_2), e.T_l)


def corrected_by_motor_speed(e: Estimate, omega_1_meas: float, share: float, slip: float, p: Parameters) -> Estimate:
    error = omega_1_meas - e.omega_1

    def gain(without: float, with_wheel_speed: float, slipping: float) -> float:
        L = without + share * (with_wheel_speed - without)
        return L + slip * (slipping - L)

    return Estimate(
        e.omega_1 + error * gain(p.L_omega_1, p.Lw_omega_1, p.Ls_omega_1),
        e.omega_2 + error * gain(p.L_omega_2, p.Lw_omega_2, p.Ls_omega_2),
        e.phi + error * gain(p.L_phi, p.Lw_phi, p.Ls_phi),
        e.T_l + error * gain(p.L_T_l, p.Lw_T_l, p.Ls_T_l),
    )


def corrected_by_message(x: EstimatorState, omega_2_can: float, samples: float, p: Parameters) -> Estimate:
    """Correction by a message that is `samples` samples old; past[k] is the estimate k + 1 samples ago."""
    e = x.estimate
    error = x.share * (omega_2_can - interpolate(x.past, samples - 1.0))
    return Estimate(
        e.omega_1 + error * p.L_can_omega_1,
        e.omega_2 + error * p.L_can_omega_2,
        e.phi + error * p.L_can_phi,
        e.T_l + error * p.L_can_T_l,
    )


def bounded(e: Estimate, base: float, p: AllParameters) -> Estimate:
    """The estimate within what the drive train can bear, whatever was measured at the motor."""
    phi_max = p.phi_B + 4.0 * p.T_max / p.C
    return Estimate(
        clip(e.omega_1, -p.omega_max - base, p.omega_max - base),
        clip(e.omega_2, -p.omega_max - base, p.omega_max - base),
        clip(e.phi, -phi_max, phi_max),
        clip(e.T_l, -4.0 * p.T_max, 4.0 * p.T_max),
    )
