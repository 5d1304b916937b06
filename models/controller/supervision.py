"""What surrounds an estimator and a law: which signals to trust, when to act, and within what limits.

In every sample the estimator goes one sample on and takes what was measured, the law says what to add
to the driver's demand. Motor signals that cannot be trusted lead to fallback: the demand is passed
through, the estimator starts anew from what it gets. A lost, late or absurd wheel speed only ends the
mode that uses it. A demand that is not finite counts as zero. At rest the damping fades out and the
estimator is held. Modes fade within t_fade; T_ref is finite and within T_max whatever comes in.
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Boolean, Enumeration, Integer, Real, merged
from ..block.operators import branch, clip, is_finite, logical_and, where
from ..block.types import SampledBlock
from ..vehicle import CAR
from . import rest
from . import signal_monitor as monitor
from .fading import toward
from .parts import Estimator, Law, Motion
from .signal_monitor import MonitorState

T_S = 0.002
"""Sample time in s."""

OFF, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED, FALLBACK = 1.0, 2.0, 3.0, 4.0


class Parameters(NamedTuple):
    """Of the supervision, for every controller."""

    T_max: Annotated[float, Real("N.m", "limit of the torque reference", 1.0, 2000.0)] = CAR.T_max
    t_fade: Annotated[float, Real("s", "time to fade between modes", 0.002, 5.0)] = 0.1
    t_bad: Annotated[float, Real("s", "bad motor signals for so long lead to fallback", 0.0, 1.0)] = 0.02
    t_frozen: Annotated[float, Real("s", "a speed or torque unchanged for so long is frozen", 0.01, 10.0)] = 0.1
    t_stale: Annotated[float, Real("s", "no message for so long ends the mode with wheel speed", 0.01, 10.0)] = 0.1
    T_still: Annotated[float, Real("N.m", "largest demand at rest", 0.0, 20.0)] = 2.0
    omega_still: Annotated[float, Real("rad/s", "largest motor speed at rest", 0.0, 20.0)] = 3.0
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
    """State of a controller; those of its parts are records."""

    estimator: Any
    law: Any
    monitor: MonitorState
    level: Annotated[float, Real("1", "share of the damping that acts")]
    quiet: Annotated[float, Real("s", "time without demand and motion")]
    added: Annotated[float, Real("N.m", "what full damping adds; held while signals are bad")]
    T_ref: Annotated[float, Real("N.m", "torque reference")]
    T_damp: Annotated[float, Real("N.m", "torque added to the demand")]
    ahead: Motion
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


def demand(u: Input, p: Any) -> Any:
    """The driver's demand in N.m within the limits; zero where it is not finite."""
    return clip(where(is_finite(u.T_driver), u.T_driver, 0.0), -p.T_max, p.T_max)


def status(enable: Any, trusted: Any, wheel: Any) -> Any:
    damping = where(wheel, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED)
    return where(enable, where(trusted, damping, FALLBACK), OFF)


def output(x: State, u: Input, p: Any) -> Output:
    return Output(
        T_ref=x.T_ref,
        T_damp=x.T_damp,
        T_gear_hat=x.ahead.T_gear,
        phi_hat=x.ahead.phi,
        omega_2_hat=x.ahead.omega_2,
        status=x.status,
    )


def supervised(name: str, description: str, module: str, estimator: Estimator, law: Law) -> SampledBlock:
    """A controller as a block: its parameters are those of the estimator, of the law and of the supervision.

    Args:
        name, description, module: see `models.block.types`.
    """

    def start(u: Input, p: Any) -> State:
        """Estimate from the motor signals of t = 0, the driver's demand passed through."""
        T_driver = demand(u, p)
        signals, wheel = monitor.start(u, p), monitor.has_wheel_speed(u, p)
        e = estimator.start(signals.omega_1, signals.T_mot, wheel, p)
        motion = estimator.motion(e, p)
        return State(
            estimator=e,
            law=law.start(motion, p),
            monitor=signals,
            level=where(u.enable, 1.0, 0.0),
            quiet=where(rest.is_still(T_driver, signals.omega_1, p), rest.longest(p), 0.0),
            added=0.0,
            T_ref=T_driver,
            T_damp=0.0,
            ahead=motion,
            status=status(u.enable, True, wheel),
        )

    def measured(x: State, u: Input, p: Any) -> tuple[Any, MonitorState]:
        """The states of the estimator and of the monitor with the signals of this sample."""
        T_mot = monitor.torque(u.T_mot_est, x.monitor.T_mot, p)
        e = estimator.predict(x.estimator, 0.5 * (x.monitor.T_mot + T_mot), T_S, p)
        omega_1_hat = estimator.motion(e, p).omega_1
        e = estimator.take_motor_speed(e, monitor.near_speed(u.omega_1_meas, omega_1_hat, p), p)
        usable = monitor.is_usable(x.monitor, u, estimator.motion(e, p).omega_2, p)
        e = branch(usable, lambda: estimator.take_wheel_speed(e, monitor.message(u), T_S, p), lambda: e)
        return e, monitor.update(x.monitor, u, omega_1_hat, x.T_ref, usable, T_S, p)

    def update(x: State, u: Input, p: Any) -> State:
        e, signals = measured(x, u, p)
        trusted = monitor.trusts_motor(signals, p)
        omega_1 = monitor.speed(u.omega_1_meas, estimator.motion(e, p).omega_1, p)
        e = branch(trusted, lambda: e, lambda: estimator.restart(e, omega_1, signals.T_mot, p))

        T_driver = demand(u, p)
        still = rest.is_still(T_driver, signals.omega_1, p)
        quiet = rest.quiet_time(x.quiet, still, T_S, p)
        resting = rest.share(quiet, p)
        e = branch(resting >= 1.0, lambda: estimator.restart(e, 0.0, 0.0, p), lambda: e)

        def later(h: Any) -> Motion:
            return estimator.motion_after(e, signals.T_mot, h, p)

        acting, adding = law.update(x.law, estimator.motion(e, p), later, T_driver, T_S, p)
        added = where(trusted, adding, x.added)
        level = toward(x.level, where(logical_and(u.enable, trusted), 1.0, 0.0), T_S, p)
        T_ref = clip(T_driver + level * (1.0 - resting) * added, -p.T_max, p.T_max)
        wheel = logical_and(monitor.hears_wheels(signals, u, p), trusted)
        return State(
            estimator=estimator.finish(e, wheel, T_S, p),
            law=acting,
            monitor=signals,
            level=level,
            quiet=quiet,
            added=added,
            T_ref=T_ref,
            T_damp=T_ref - T_driver,
            ahead=later(T_S),
            status=status(u.enable, trusted, wheel),
        )

    return SampledBlock(
        name=name,
        description=description,
        module=module,
        Parameters=merged("Parameters", estimator.Parameters, law.Parameters, Parameters),
        Input=Input,
        State=State,
        Output=Output,
        start=start,
        output=output,
        update=update,
        sample_time=T_S,
        tolerates_bad_input=True,
    )
