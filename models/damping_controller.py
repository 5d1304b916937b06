"""Active damping of the drive train by the motor (paper, Fig. 6): estimator and damping control.

The estimator (torque_estimator) is run once a sample, its estimate taken T_pred ahead, to when the
torque will act. The damping torque opposes the twisting motion and vanishes when stationary:

    T_damp = -s/(s + omega_w) [k_d (omega_1 - omega_2) + k_T T_gear],   k_d times k_gap in the gap

While the estimated twist is in the gap, for at most t_land, the demand is limited to T_land, so that
the teeth land softly. The damping torque is limited to T_damp_max; what is added to the driver's
demand fades in and out within t_fade. The literal form of the paper, an imperfect derivative of the estimated gear
torque (Sugiura and Hori 1996) behind an observer without load, is lambda_v = k_d = T_pred = 0,
K_T_l = Kw_T_l = H_T_l = 0, T_land = T_max.

A motor speed or torque signal that is not finite, out of range, jumping or frozen is not used; if
that lasts, the driver's demand is passed through (fallback). A lost, late or absurd wheel speed only
ends the mode that uses it. A demand that is not finite counts as zero. At rest (neither demand nor
motion) the damping fades out and the estimator is held, until there is one or the other.
"""

from typing import Annotated, Any, NamedTuple

from . import damping_design as design
from . import torque_estimator as estimator
from .block import Block
from .declaration import Boolean, Enumeration, Integer, Real
from .operators import clip, is_finite, logical_and, logical_not, logical_or, maximum, minimum, where
from .torque_estimator import HISTORY, Estimate
from .vehicle import HalfGap, MotorInertia

T_S = 0.002
"""Sample time in s."""

STILL = 1.0
"""Motor speed in rad/s below which an unchanging measurement is taken for standstill."""

OFF, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED, FALLBACK = 1, 2, 3, 4


class Parameters(NamedTuple):
    J_1: MotorInertia = 0.055
    J_2: Annotated[float, Real("kg.m2", "inertia from the gear to the wheels, motor side", 0.001, 100.0)] = 0.30
    C: Annotated[float, Real("N.m/rad", "stiffness of the drive train, motor side", 1.0, 1e5)] = 117.4
    phi_B: HalfGap = 0.157
    lambda_v: Annotated[float, Real("1", "share of the gear torque that the vehicle takes", 0.0, 0.99)] = (
        design.lambda_v
    )
    K_omega_1: Annotated[float, Real("1", "gain on omega_1_hat, without wheel speed", -2.0, 2.0)] = design.K_omega_1
    K_omega_2: Annotated[float, Real("1", "gain on omega_2_hat, without wheel speed", -2.0, 2.0)] = design.K_omega_2
    K_phi: Annotated[float, Real("s", "gain on phi_hat, without wheel speed", -0.1, 0.1)] = design.K_phi
    K_T_l: Annotated[float, Real("N.m.s/rad", "gain on the load, without wheel speed", -10.0, 10.0)] = design.K_T_l
    Kw_omega_1: Annotated[float, Real("1", "gain on omega_1_hat, with wheel speed", -2.0, 2.0)] = design.Kw_omega_1
    Kw_omega_2: Annotated[float, Real("1", "gain on omega_2_hat, with wheel speed", -2.0, 2.0)] = design.Kw_omega_2
    Kw_phi: Annotated[float, Real("s", "gain on phi_hat, with wheel speed", -0.1, 0.1)] = design.Kw_phi
    Kw_T_l: Annotated[float, Real("N.m.s/rad", "gain on the load, with wheel speed", -10.0, 10.0)] = design.Kw_T_l
    H_omega_1: Annotated[float, Real("1", "gain of a message on omega_1_hat", -2.0, 2.0)] = design.H_omega_1
    H_omega_2: Annotated[float, Real("1", "gain of a message on omega_2_hat", -2.0, 2.0)] = design.H_omega_2
    H_phi: Annotated[float, Real("s", "gain of a message on phi_hat", -0.1, 0.1)] = design.H_phi
    H_T_l: Annotated[float, Real("N.m.s/rad", "gain of a message on the load", -10.0, 10.0)] = design.H_T_l
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
    omega_1_last: Annotated[float, Real("rad/s", "motor speed measured last")]
    unchanged: Annotated[float, Real("s", "time since that measurement changed")]
    bad: Annotated[float, Real("s", "time since the motor signals were good")]
    counter: Annotated[float, Real("1", "counter of the message received last")]
    silence: Annotated[float, Real("s", "time since a usable message")]
    share: Annotated[float, Real("1", "share of the gains with wheel speed")]
    level: Annotated[float, Real("1", "share of the damping that acts")]
    washout: Annotated[float, Real("N.m", "stationary part of the damping law")]
    landing: Annotated[float, Real("s", "time spent in the gap")]
    quiet: Annotated[float, Real("s", "time without demand and motion")]
    T_ref: Annotated[float, Real("N.m", "torque reference")]
    T_damp: Annotated[float, Real("N.m", "torque added to the demand")]
    ahead: Annotated[tuple[float, ...], Real("1", "estimate for the instant at which T_ref appears")]
    status: Annotated[float, Real("1", "status")]


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


class Motor(NamedTuple):
    """What is made of the signals of motor control at one sample."""

    omega_1: Any
    T_mot: Any
    good: Any
    unchanged: Any
    bad: Any


def start(u: Input, p: Parameters) -> State:
    """Estimate from the motor signals of t = 0, the driver's demand passed through."""
    T_driver = demand(u, p)
    omega_1 = where(plausible(u.omega_1_meas, p.omega_max), u.omega_1_meas, 0.0)
    T_mot = where(plausible(u.T_mot_est, 2.0 * p.T_max), u.T_mot_est, 0.0)
    e = estimator.at_rest_with(omega_1, T_mot, p)
    wheel = logical_and(u.valid, plausible(u.omega_2_can, p.omega_max))
    return State(
        *e,
        past=(omega_1,) * HISTORY,
        T_mot=T_mot,
        omega_1_last=omega_1,
        unchanged=0.0,
        bad=0.0,
        counter=1.0 * u.counter,
        silence=where(wheel, 0.0, p.t_stale),
        share=where(wheel, 1.0, 0.0),
        level=where(u.enable, 1.0, 0.0),
        washout=damping_law(e, p),
        landing=0.0,
        quiet=where(is_still(T_driver, omega_1, p), p.t_rest + p.t_fade, 0.0),
        T_ref=T_driver,
        T_damp=0.0,
        ahead=tuple(e),
        status=where(u.enable, where(wheel, 1.0 * WITH_WHEEL_SPEED, 1.0 * WITHOUT_WHEEL_SPEED), 1.0 * OFF),
    )


def plausible(signal: Any, limit: Any) -> Any:
    """False as well for NaN."""
    return logical_and(is_finite(signal), abs(signal) <= limit)


def demand(u: Input, p: Parameters) -> Any:
    return clip(where(is_finite(u.T_driver), u.T_driver, 0.0), -p.T_max, p.T_max)


def in_gap(e: Estimate, p: Parameters) -> Any:
    return abs(e.phi) < p.phi_B


def damping_law(e: Estimate, p: Parameters) -> Any:
    """The torque in N.m to be washed out and opposed."""
    k_d = p.k_d * where(in_gap(e, p), p.k_gap, 1.0)
    return k_d * (e.omega_1 - e.omega_2) + p.k_T * estimator.gear_torque(e, p)


def motor_signals(x: State, u: Input, omega_1_hat: Any, p: Parameters) -> Motor:
    """The motor signals where they are good; else the speed that was predicted, the last torque."""
    T_good = plausible(u.T_mot_est, 2.0 * p.T_max)
    finite = plausible(u.omega_1_meas, p.omega_max)
    omega_1 = where(finite, u.omega_1_meas, omega_1_hat)
    near = abs(omega_1 - omega_1_hat) <= p.e_max
    unchanged = where(u.omega_1_meas == x.omega_1_last, x.unchanged + T_S, 0.0)
    frozen = logical_and(unchanged >= p.t_frozen, abs(omega_1) > STILL)
    good = logical_and(logical_and(T_good, finite), logical_and(near, logical_not(frozen)))
    return Motor(
        omega_1=where(near, omega_1, omega_1_hat),
        T_mot=where(T_good, u.T_mot_est, x.T_mot),
        good=good,
        unchanged=minimum(unchanged, p.t_frozen),
        bad=where(good, 0.0, minimum(x.bad + T_S, p.t_bad + T_S)),
    )


def estimate(x: State, u: Input, p: Parameters) -> tuple[Estimate, Motor, Any]:
    """The corrected estimate, the motor signals, the time since the last usable message."""
    before = Estimate(x.omega_1, x.omega_2, x.phi, x.T_l)
    T_mot = where(plausible(u.T_mot_est, 2.0 * p.T_max), u.T_mot_est, x.T_mot)
    e = estimator.predict(before, 0.5 * (x.T_mot + T_mot), T_S, p)
    motor = motor_signals(x, u, e.omega_1, p)
    e = estimator.correct_by_motor_speed(e, motor.omega_1, x.share, p)

    samples = p.T_age / T_S
    omega_2_can = where(is_finite(u.omega_2_can), u.omega_2_can, 0.0)
    near = abs(omega_2_can - e.omega_2) <= p.e_max
    new = logical_and(logical_and(u.counter != x.counter, u.valid), plausible(u.omega_2_can, p.omega_max))
    usable = logical_and(new, near)
    corrected = estimator.correct_by_wheel_speed(e, omega_2_can, x.past, samples, x.share, p)
    e = Estimate(*(where(usable, a, b) for a, b in zip(corrected, e, strict=True)))

    lost = logical_and(motor.bad > p.t_bad, plausible(u.omega_1_meas, p.omega_max))
    fresh = estimator.at_rest_with(motor_speed(u, e, p), motor.T_mot, p)
    e = Estimate(*(where(lost, a, b) for a, b in zip(fresh, e, strict=True)))
    silence = where(usable, 0.0, minimum(x.silence + T_S, p.t_stale))
    return estimator.bounded(e, p), motor, silence


def motor_speed(u: Input, e: Estimate, p: Parameters) -> Any:
    return where(plausible(u.omega_1_meas, p.omega_max), u.omega_1_meas, e.omega_1)


def is_still(T_driver: Any, omega_1: Any, p: Parameters) -> Any:
    """Neither demand nor motion."""
    return logical_and(abs(T_driver) <= p.T_rest, abs(omega_1) <= p.omega_rest)


def resting(quiet: Any, p: Parameters) -> Any:
    """From 0 to 1 as the damping fades out at rest, `quiet` s after the last demand or motion."""
    return clip((quiet - p.t_rest) / p.t_fade, 0.0, 1.0)


def toward(value: Any, target: Any, p: Parameters) -> Any:
    """value, one sample nearer to the target."""
    step = T_S / p.t_fade
    return value + clip(target - value, -step, step)


def update(x: State, u: Input, p: Parameters) -> State:
    e, motor, silence = estimate(x, u, p)
    T_driver = demand(u, p)
    quiet = where(is_still(T_driver, motor.omega_1, p), minimum(x.quiet + T_S, p.t_rest + p.t_fade), 0.0)
    rest = resting(quiet, p)
    e = Estimate(*(where(rest >= 1.0, 0.0, value) for value in e))
    trusted = motor.bad <= p.t_bad
    wheel = logical_and(logical_and(u.valid, silence < p.t_stale), trusted)
    level = toward(x.level, where(logical_and(u.enable, trusted), 1.0, 0.0), p)

    e_pred = estimator.predict(e, motor.T_mot, p.T_pred, p)
    law = damping_law(e_pred, p)
    landing = where(in_gap(e, p), minimum(x.landing + T_S, p.t_land + T_S), 0.0)
    soft = logical_and(landing > 0.0, landing <= p.t_land)
    T_soft = where(soft, clip(T_driver, -p.T_land, p.T_land), T_driver)
    T_damp = level * (1.0 - rest) * (T_soft - T_driver + clip(x.washout - law, -p.T_damp_max, p.T_damp_max))
    T_ref = clip(T_driver + T_damp, -p.T_max, p.T_max)

    damping = where(wheel, 1.0 * WITH_WHEEL_SPEED, 1.0 * WITHOUT_WHEEL_SPEED)
    return State(
        *e,
        past=(e.omega_2, *x.past[:-1]),
        T_mot=motor.T_mot,
        omega_1_last=where(is_finite(u.omega_1_meas), u.omega_1_meas, 0.0),
        unchanged=motor.unchanged,
        bad=motor.bad,
        counter=1.0 * u.counter,
        silence=silence,
        share=toward(x.share, where(wheel, 1.0, 0.0), p),
        level=level,
        washout=x.washout + minimum(p.omega_w * T_S, 1.0) * (law - x.washout),
        landing=landing,
        quiet=quiet,
        T_ref=T_ref,
        T_damp=T_ref - T_driver,
        ahead=tuple(estimator.predict(e, motor.T_mot, T_S, p)),
        status=where(u.enable, where(trusted, damping, 1.0 * FALLBACK), 1.0 * OFF),
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


BLOCK = Block(
    name="DampingController",
    description="Active damping of the drive train: nonlinear torque estimator and damping control",
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
