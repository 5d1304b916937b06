"""What surrounds an estimator and a law: which signals to trust, when to act, and within what limits.

In every sample the estimator goes one sample on and takes what was measured, the law says what to add
to the driver's demand. Motor signals that have failed lead to fallback: the demand is passed through,
estimator and law start anew, until the signals have proved themselves. A lost, late or absurd wheel speed
only ends the mode that uses it. A demand that is not finite counts as zero. At rest the damping fades out
and the estimator is held. Modes fade within t_fade. Whatever comes in, T_ref is finite and within T_max,
and takes no more than T_take_max from the demand and adds no more than T_add_max to it; T_add_max is also
what the damping alone may take.
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Boolean, Enumeration, Integer, Real, merged
from ..block.operators import branch, clip, is_finite, logical_and, logical_not, logical_or, where
from ..block.types import SampledBlock
from ..vehicle import CAR, MotorLag
from . import rest, swings, trust
from . import signal_monitor as monitor
from . import wheel_monitor as wheels
from .fading import toward
from .parts import Addition, Estimator, Law, Motion
from .signal_monitor import MonitorState
from .swings import SwingState
from .trust import TrustState
from .wheel_monitor import WheelState

T_S = 0.002
"""Sample time in s."""

OFF, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED, FALLBACK = 1.0, 2.0, 3.0, 4.0


class Parameters(NamedTuple):
    """Of the supervision, for every controller."""

    T_max: Annotated[float, Real("N.m", "limit of the torque reference", 1.0, 2000.0)] = CAR.T_max
    tau: MotorLag = CAR.tau
    T_take_max: Annotated[
        float, Real("N.m", "largest torque taken from the demand, by damping and landing", 0.0, 2000.0)
    ] = 100.0
    T_add_max: Annotated[float, Real("N.m", "largest torque added to the demand, or taken by damping", 0.0, 2000.0)] = (
        60.0
    )
    t_fade: Annotated[float, Real("s", "time to fade between modes", 0.002, 5.0)] = 0.1
    t_bad: Annotated[float, Real("s", "bad motor signals for so long lead to fallback", 0.0, 1.0)] = 0.02
    t_apart: Annotated[float, Real("s", "contradiction by the wheel speed for so long leads to it", 0.0, 1.0)] = 0.1
    t_proof: Annotated[float, Real("s", "good motor signals for so long end the fallback", 0.01, 1.0)] = 0.15
    t_frozen: Annotated[float, Real("s", "a motor speed unchanged for so long is frozen", 0.01, 10.0)] = 0.1
    t_stale: Annotated[float, Real("s", "no message for so long ends the mode with wheel speed", 0.01, 10.0)] = 0.1
    T_still: Annotated[float, Real("N.m", "largest demand at rest", 0.0, 20.0)] = 2.0
    omega_still: Annotated[float, Real("rad/s", "largest motor speed at rest", 0.0, 20.0)] = 3.0
    t_rest: Annotated[float, Real("s", "time below both after which the car is at rest", 0.0, 10.0)] = 0.3
    omega_max: Annotated[float, Real("rad/s", "largest plausible speed", 10.0, 5000.0)] = 2000.0
    e_max: Annotated[float, Real("rad/s", "largest distance of a usable wheel speed", 1.0, 1000.0)] = 40.0
    e_jump: Annotated[float, Real("rad/s", "largest jump of the motor speed in a sample", 1.0, 1000.0)] = 8.0
    e_wheel: Annotated[float, Real("rad/s", "largest distance of the motor from the wheel speed", 1.0, 1000.0)] = 30.0


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
    wheels: WheelState
    swings: SwingState
    trust: TrustState
    level: Annotated[float, Real("1", "share of the damping that acts")]
    quiet: Annotated[float, Real("s", "time without demand and motion")]
    opposing: Annotated[float, Real("N.m", "what the law would damp with")]
    added: Addition
    T_ref: Annotated[float, Real("N.m", "torque reference")]
    T_damp: Annotated[float, Real("N.m", "torque added to the demand")]
    T_landing: Annotated[float, Real("N.m", "part of it that lets the teeth land softly")]
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
    T_landing: Annotated[float, Real("N.m", "part of T_damp that lets the teeth land softly")]


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
        T_landing=x.T_landing,
    )


def is_doubtful(signals: MonitorState, heard: WheelState) -> Any:
    """Whether the motor signals are bad in this sample, or contradicted."""
    return logical_or(signals.bad > 0.0, heard.apart > 0.0)


def damping_limited(added: Addition, p: Any) -> Addition:
    return added._replace(damping=clip(added.damping, -p.T_add_max, p.T_add_max))


def limited(torque: Any, T_driver: Any, p: Any) -> Any:
    """What may be added to the demand: in its direction up to T_add_max, against it up to T_take_max."""
    lower = where(T_driver > 0.0, p.T_take_max, p.T_add_max)
    upper = where(T_driver < 0.0, p.T_take_max, p.T_add_max)
    return clip(torque, -lower, upper)


def supervised(name: str, description: str, module: str, estimator: Estimator, law: Law) -> SampledBlock:
    """A controller as a block: its parameters are those of the estimator, of the law and of the supervision.

    Args:
        name, description, module: see `models.block.types`.
    """

    def start(u: Input, p: Any) -> State:
        """Estimate from the motor signals of t = 0, the driver's demand passed through."""
        T_driver = demand(u, p)
        signals, wheel = monitor.start(u, p), wheels.has_wheel_speed(u, p)
        e = estimator.start(signals.omega_1, signals.T_mot, wheel, p)
        motion = estimator.motion(e, p)
        return State(
            estimator=e,
            law=law.start(motion, p),
            monitor=signals,
            wheels=wheels.start(u, signals.omega_1, signals.T_mot, p),
            swings=swings.start(T_driver),
            trust=trust.start(p),
            level=where(u.enable, 1.0, 0.0),
            quiet=where(rest.is_still(T_driver, signals.omega_1, p), rest.longest(p), 0.0),
            opposing=0.0,
            added=Addition(0.0, 0.0),
            T_ref=T_driver,
            T_damp=0.0,
            T_landing=0.0,
            ahead=motion,
            status=status(u.enable, True, wheel),
        )

    def measured(x: State, u: Input, p: Any) -> tuple[Any, MonitorState, WheelState]:
        """The states of the estimator and of the monitors with the signals of this sample."""
        T_mot = monitor.torque(u.T_mot_est, x.monitor.loop, p)
        e = estimator.predict(x.estimator, 0.5 * (x.monitor.T_mot + T_mot), T_S, p)
        omega_1_hat = estimator.motion(e, p).omega_1
        increment = omega_1_hat - estimator.motion(x.estimator, p).omega_1
        pushed = logical_and(demand(u, p) > monitor.PUSH * p.T_max, x.wheels.silence >= p.t_stale)
        signals = monitor.update(x.monitor, u, pushed, omega_1_hat, increment, x.T_ref, T_S, p)
        e = estimator.take_motor_speed(e, signals.omega_1, p)
        omega_2_hat = estimator.motion(e, p).omega_2
        heard = wheels.update(x.wheels, u, signals.omega_1, signals.T_mot, omega_2_hat, T_S, p)
        e = branch(heard.usable, lambda: estimator.take_wheel_speed(e, heard.omega_2, T_S, p), lambda: e)
        return e, signals, heard

    def update(x: State, u: Input, p: Any) -> State:
        e, signals, heard = measured(x, u, p)
        T_driver = demand(u, p)
        quiet = rest.quiet_time(x.quiet, rest.is_still(T_driver, signals.omega_1, p), T_S, p)
        resting = rest.share(quiet, p)

        confirmed = logical_and(heard.witness, swings.is_calm(x.opposing, p))
        feeding = swings.feeds(x.swings)
        trusting = trust.update(
            x.trust, signals.bad, heard.apart, feeding, confirmed, signals.against, resting >= 1.0, T_S, p
        )
        trusted = trust.is_trusted(trusting)
        wheel = logical_and(wheels.hears_wheels(heard, u, p), trusted)

        doubtful = logical_or(is_doubtful(signals, heard), is_doubtful(x.monitor, x.wheels))
        afresh = logical_and(doubtful, logical_not(trusted))
        e = branch(afresh, lambda: estimator.restart(e, signals.omega_1, signals.T_mot, p), lambda: e)
        e = branch(resting >= 1.0, lambda: estimator.restart(e, 0.0, 0.0, p), lambda: e)

        def later(h: Any) -> Motion:
            return estimator.motion_after(e, signals.T_mot, h, p)

        motion = estimator.motion(e, p)
        before = branch(afresh, lambda: law.start(motion, p), lambda: x.law)
        acting, adding = law.update(before, motion, later, T_driver, T_S, p)
        added = branch(trusted, lambda: damping_limited(adding, p), lambda: x.added)
        level = toward(x.level, where(logical_and(u.enable, trusted), 1.0, 0.0), T_S, p)
        share = level * (1.0 - resting)
        T_ref = clip(T_driver + limited(share * (added.damping + added.landing), T_driver, p), -p.T_max, p.T_max)
        return State(
            estimator=estimator.finish(e, wheel, T_S, p),
            law=acting,
            monitor=signals,
            wheels=heard,
            swings=swings.update(x.swings, share * added.damping, T_driver, trusted, T_S, p),
            trust=trusting,
            level=level,
            quiet=quiet,
            opposing=adding.damping,
            added=added,
            T_ref=T_ref,
            T_damp=T_ref - T_driver,
            T_landing=limited(share * added.landing, T_driver, p),
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
