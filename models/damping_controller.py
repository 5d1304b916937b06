"""Active damping of the drive train by the motor (paper, Fig. 6): estimator and damping control.

The estimator (torque_estimator) is run once a sample, its estimate taken T_pred ahead, to when the
torque will act; the damping law (damping_law) adds to the driver's demand what opposes the twisting
motion and vanishes when stationary. The damping torque is limited to T_damp_max; modes fade within
t_fade. The literal form of the paper, an imperfect derivative of the estimated gear torque (Sugiura
and Hori 1996) behind an observer without load, is lambda_v = k_d = T_pred = 0, L_T_l = Lw_T_l =
L_can_T_l = 0, T_land = T_max.

A motor speed or torque that is not finite, out of range, jumping or frozen is not used; if that lasts,
the driver's demand is passed through (fallback). A lost, late or absurd wheel speed only ends the mode
that uses it. A demand that is not finite counts as zero. At rest (neither demand nor motion) the
damping fades out and the estimator is held, until there is one or the other.
"""

from typing import Annotated, Any, NamedTuple

from .block.declaration import Boolean, Enumeration, Integer, Real
from .block.operators import branch, clip, is_finite, logical_and, minimum, where
from .block.types import SampledBlock
from .controller import damping_law as law
from .controller import gains as design
from .controller import signal_monitor as motor_signals
from .controller import torque_estimator as estimator
from .controller.signal_monitor import MotorSignals, plausible
from .controller.torque_estimator import HISTORY, Estimate
from .vehicle import HalfGap, MotorInertia

T_S = 0.002
"""Sample time in s."""

OFF, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED, FALLBACK = 1.0, 2.0, 3.0, 4.0


class Parameters(NamedTuple):
    J_1: MotorInertia = 0.055
    J_2: Annotated[float, Real("kg.m2", "inertia from the gear to the wheels, motor side", 0.001, 100.0)] = 0.30
    C: Annotated[float, Real("N.m/rad", "stiffness of the drive train, motor side", 1.0, 1e5)] = 117.4
    phi_B: HalfGap = 0.157
    lambda_v: Annotated[float, Real("1", "share of the gear torque that the vehicle takes", 0.0, 0.99)] = (
        design.lambda_v
    )
    L_omega_1: Annotated[float, Real("1", "gain on omega_1_hat, without wheel speed", -2.0, 2.0)] = design.L_omega_1
    L_omega_2: Annotated[float, Real("1", "gain on omega_2_hat, without wheel speed", -2.0, 2.0)] = design.L_omega_2
    L_phi: Annotated[float, Real("s", "gain on phi_hat, without wheel speed", -0.1, 0.1)] = design.L_phi
    L_T_l: Annotated[float, Real("N.m.s/rad", "gain on the load, without wheel speed", -10.0, 10.0)] = design.L_T_l
    Lw_omega_1: Annotated[float, Real("1", "gain on omega_1_hat, with wheel speed", -2.0, 2.0)] = design.Lw_omega_1
    Lw_omega_2: Annotated[float, Real("1", "gain on omega_2_hat, with wheel speed", -2.0, 2.0)] = design.Lw_omega_2
    Lw_phi: Annotated[float, Real("s", "gain on phi_hat, with wheel speed", -0.1, 0.1)] = design.Lw_phi
    Lw_T_l: Annotated[float, Real("N.m.s/rad", "gain on the load, with wheel speed", -10.0, 10.0)] = design.Lw_T_l
    L_can_omega_1: Annotated[float, Real("1", "gain of a message on omega_1_hat", -2.0, 2.0)] = design.L_can_omega_1
    L_can_omega_2: Annotated[float, Real("1", "gain of a message on omega_2_hat", -2.0, 2.0)] = design.L_can_omega_2
    L_can_phi: Annotated[float, Real("s", "gain of a message on phi_hat", -0.1, 0.1)] = design.L_can_phi
    L_can_T_l: Annotated[float, Real("N.m.s/rad", "gain of a message on the load", -10.0, 10.0)] = design.L_can_T_l
    T_age: Annotated[float, Real("s", "age of a message on arrival", 0.002, 0.064)] = design.T_age
    T_pred: Annotated[float, Real("s", "time that the estimate is taken ahead", 0.0, 0.02)] = design.T_pred
    k_d: Annotated[float, Real("N.m.s/rad", "damping over the speed difference", 0.0, 20.0)] = design.k_d
    k_gap: Annotated[float, Real("1", "factor on k_d inside the gap", 0.0, 2.0)] = design.k_gap
    k_T: Annotated[float, Real("1", "damping over the gear torque", 0.0, 5.0)] = design.k_T
    omega_w: Annotated[float, Real("rad/s", "corner frequency of the washout", 0.0, 400.0)] = design.omega_w
    T_land: Annotated[float, Real("N.m", "limit of the demand inside the gap", 0.0, 2000.0)] = design.T_land
    t_land: Annotated[float, Real("s", "longest duration of that limit", 0.0, 1.0)] = design.t_land
    T_damp_max: Annotated[float, Real("N.m", "limit of the damping torque", 0.0, 2000.0)] = 60.0
    T_max: Annotated[float, Real("N.m", "limit of the torque reference", 1.0, 2000.0)] = 180.0
    t_fade: Annotated[float, Real("s", "time to fade between modes", 0.002, 5.0)] = 0.1
    t_bad: Annotated[float, Real("s", "bad motor signals for so long lead to fallback", 0.0, 1.0)] = 0.02
    t_frozen: Annotated[float, Real("s", "a speed unchanged for so long is frozen", 0.01, 10.0)] = 0.1
    t_stale: Annotated[float, Real("s", "no message for so long ends the mode with wheel speed", 0.01, 10.0)] = 0.1
    T_rest: Annotated[float, Real("N.m", "largest demand at rest", 0.0, 20.0)] = 2.0
    omega_rest: Annotated[float, Real("rad/s", "largest motor speed at rest", 0.0, 20.0)] = 3.0
    t_rest: Annotated[float, Real("s", "time below both after which the car is at rest", 0.0, 10.0)] = 0.3
    omega_max: Annotated[float, Real("rad/s", "largest plausible speed", 10.0, 5000.0)] = 2000.0
    e_max: Annotated[float, Real("rad/s", "largest plausible error of the estimated speeds", 1.0, 1000.0)] = 40.0


class Input(NamedTuple):
    T_driver: Annotated[float, Real("N.m", "torque demanded by the driver")] = 0.0
    omega_1_meas: Annotated[float, Real("rad/s", "measured speed of the motor")] = 0.0
    T_mot_est: Annotated[float, Real("N.m", "air-gap torque as motor control estimates it")] = 0.0
    omega_2_can: Annotated[float, Real("rad/s", "received speed of the driven wheels, motor side")] = 0.0
    valid: Annotated[bool, Boolean("the received wheel speed is above its minimum")] = False
    counter: Annotated[int, Integer("one more with every message that arrives")] = 0
    enable: Annotated[bool, Boolean("damping on")] = True


class State(NamedTuple):
    omega_1: Annotated[float, Real("rad/s", "estimated speed of the motor")]
    omega_2: Annotated[float, Real("rad/s", "estimated speed of the wheels, motor side")]
    phi: Annotated[float, Real("rad", "estimated twist")]
    T_l: Annotated[float, Real("N.m", "estimated slow part of the load torque")]
    past: Annotated[tuple[float, ...], Real("rad/s", "estimates of omega_2 of the last samples, newest first")]
    T_mot: Annotated[float, Real("N.m", "torque estimate used last")]
    omega_1_last: Annotated[float, Real("rad/s", "motor speed received last")]
    T_mot_last: Annotated[float, Real("N.m", "torque estimate received last")]
    omega_1_unchanged: Annotated[float, Real("s", "time since that speed changed")]
    T_mot_unchanged: Annotated[float, Real("s", "time since that torque changed")]
    bad: Annotated[float, Real("s", "time since the motor signals were good")]
    counter: Annotated[float, Real("1", "counter of the message received last")]
    silence: Annotated[float, Real("s", "time since a usable message")]
    share: Annotated[float, Real("1", "share of the gains with wheel speed")]
    level: Annotated[float, Real("1", "share of the damping that acts")]
    washout: Annotated[float, Real("N.m", "stationary part of the damping law")]
    landing: Annotated[float, Real("s", "time spent in the gap")]
    quiet: Annotated[float, Real("s", "time without demand and motion")]
    added: Annotated[float, Real("N.m", "what full damping adds; held while signals are bad")]
    T_ref: Annotated[float, Real("N.m", "torque reference")]
    T_damp: Annotated[float, Real("N.m", "torque added to the demand")]
    ahead: Annotated[tuple[float, ...], Real("1", "estimate for the instant at which T_ref appears")]
    status: Annotated[Any, Real("1", "number of the status")]


class Output(NamedTuple):
    T_ref: Annotated[float, Real("N.m", "torque demanded of the motor")]
    T_damp: Annotated[float, Real("N.m", "torque added to the driver's demand")]
    T_gear_hat: Annotated[float, Real("N.m", "estimated gear torque, motor side")]
    phi_hat: Annotated[float, Real("rad", "estimated twist of the drive train, motor side")]
    omega_2_hat: Annotated[float, Real("rad/s", "estimated speed of the wheels, motor side")]
    status: Annotated[
        int,
        Enumeration(
            "Status",
            "what the controller does",
            (
                ("off", "the driver's demand is passed through"),
                ("damping_with_wheel_speed", "damping, motor and wheel speed are used"),
                ("damping_without_wheel_speed", "damping, only the motor speed is used"),
                ("fallback", "signals cannot be trusted, the driver's demand is passed through"),
            ),
        ),
    ]


def start(u: Input, p: Parameters) -> State:
    """Estimate from the motor signals of t = 0, the driver's demand passed through."""
    T_driver = demand(u, p)
    omega_1, T_mot = motor_signals.speed(u.omega_1_meas, 0.0, p), motor_signals.torque(u.T_mot_est, 0.0, p)
    e = estimator.at_rest_with(omega_1, T_mot, p)
    wheel = logical_and(u.valid, plausible(u.omega_2_can, p.omega_max))
    return State(
        *e,
        past=(omega_1,) * HISTORY,
        T_mot=T_mot,
        omega_1_last=omega_1,
        T_mot_last=T_mot,
        omega_1_unchanged=0.0,
        T_mot_unchanged=0.0,
        bad=0.0,
        counter=1.0 * u.counter,
        silence=where(wheel, 0.0, p.t_stale),
        share=where(wheel, 1.0, 0.0),
        level=where(u.enable, 1.0, 0.0),
        washout=law.motion(e, p),
        landing=0.0,
        quiet=where(law.is_still(T_driver, omega_1, p), p.t_rest + p.t_fade, 0.0),
        added=0.0,
        T_ref=T_driver,
        T_damp=0.0,
        ahead=tuple(e),
        status=status(u.enable, True, wheel),
    )


def demand(u: Input, p: Parameters) -> Any:
    """The driver's demand within the limits; zero where it is not finite."""
    return clip(where(is_finite(u.T_driver), u.T_driver, 0.0), -p.T_max, p.T_max)


def status(enable: Any, trusted: Any, wheel: Any) -> Any:
    damping = where(wheel, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED)
    return where(enable, where(trusted, damping, FALLBACK), OFF)


def toward(value: Any, target: Any, p: Parameters) -> Any:
    """value, one sample nearer to the target."""
    step = T_S / p.t_fade
    return value + clip(target - value, -step, step)


def estimate(x: State, u: Input, p: Parameters) -> tuple[Estimate, MotorSignals, Any]:
    """The corrected estimate, the motor signals it used, whether a wheel speed was usable."""
    T_mot = motor_signals.torque(u.T_mot_est, x.T_mot, p)
    before = Estimate(x.omega_1, x.omega_2, x.phi, x.T_l)
    e = estimator.predict(before, 0.5 * (x.T_mot + T_mot), T_S, p)
    motor = motor_signals.judged(x, u, e.omega_1, T_S, p)
    e = estimator.correct_by_motor_speed(e, motor.omega_1, x.share, p)

    omega_2_can = where(is_finite(u.omega_2_can), u.omega_2_can, 0.0)
    new = logical_and(u.counter != x.counter, logical_and(u.valid, plausible(u.omega_2_can, p.omega_max)))
    usable = logical_and(new, abs(omega_2_can - e.omega_2) <= p.e_max)
    corrected = branch(
        usable,
        lambda: estimator.correct_by_wheel_speed(e, omega_2_can, x.past, p.T_age / T_S, x.share, p),
        lambda: e,
    )
    return estimator.bounded(corrected, p), motor, usable


def update(x: State, u: Input, p: Parameters) -> State:
    e, motor, usable = estimate(x, u, p)
    bad = where(motor.good, 0.0, minimum(x.bad + T_S, p.t_bad + T_S))
    trusted = bad <= p.t_bad
    omega_1 = motor_signals.speed(u.omega_1_meas, e.omega_1, p)
    e = branch(trusted, lambda: e, lambda: estimator.at_rest_with(omega_1, motor.T_mot, p))

    T_driver = demand(u, p)
    still = law.is_still(T_driver, motor.omega_1, p)
    quiet = where(still, minimum(x.quiet + T_S, p.t_rest + p.t_fade), 0.0)
    rest = law.resting(quiet, p)
    e = branch(rest >= 1.0, lambda: Estimate(0.0, 0.0, 0.0, 0.0), lambda: e)

    motion = law.motion(estimator.predict(e, motor.T_mot, p.T_pred, p), p)
    landing = where(law.in_gap(e, p), minimum(x.landing + T_S, p.t_land + T_S), 0.0)
    softened = law.soft_landing(T_driver, landing, p) - T_driver
    damping = clip(x.washout - motion, -p.T_damp_max, p.T_damp_max)
    added = where(trusted, softened + damping, x.added)
    level = toward(x.level, where(logical_and(u.enable, trusted), 1.0, 0.0), p)
    T_ref = clip(T_driver + level * (1.0 - rest) * added, -p.T_max, p.T_max)

    silence = where(usable, 0.0, minimum(x.silence + T_S, p.t_stale))
    wheel = logical_and(logical_and(u.valid, silence < p.t_stale), trusted)
    return State(
        *e,
        past=(e.omega_2, *x.past[:-1]),
        T_mot=motor.T_mot,
        omega_1_last=where(is_finite(u.omega_1_meas), u.omega_1_meas, 0.0),
        T_mot_last=where(is_finite(u.T_mot_est), u.T_mot_est, 0.0),
        omega_1_unchanged=motor.omega_1_unchanged,
        T_mot_unchanged=motor.T_mot_unchanged,
        bad=bad,
        counter=1.0 * u.counter,
        silence=silence,
        share=toward(x.share, where(wheel, 1.0, 0.0), p),
        level=level,
        washout=law.washed_out(x.washout, motion, T_S, p),
        landing=landing,
        quiet=quiet,
        added=added,
        T_ref=T_ref,
        T_damp=T_ref - T_driver,
        ahead=tuple(estimator.predict(e, motor.T_mot, T_S, p)),
        status=status(u.enable, trusted, wheel),
    )


def output(x: State, u: Input, p: Parameters) -> Output:
    e = Estimate(*x.ahead)
    return Output(
        T_ref=x.T_ref,
        T_damp=x.T_damp,
        T_gear_hat=estimator.gear_torque(e, p),
        phi_hat=e.phi,
        omega_2_hat=e.omega_2,
        status=x.status,
    )


BLOCK = SampledBlock(
    name="DampingController",
    description="Active damping of the drive train: nonlinear torque estimator and damping control",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Output,
    start=start,
    output=output,
    update=update,
    sample_time=T_S,
    tolerates_bad_input=True,
)
