"""What surrounds an estimator and a law: which signals to trust, when to act, and within what limits.

In every sample the estimator goes one sample on and takes what was measured, the law says what to add
to the driver's demand. Motor signals that have failed lead to fallback: the demand is passed through,
estimator and law restart, until the signals have healed. A lost, late or absurd wheel speed
only ends the mode that uses it. A demand that is not finite counts as zero. At rest the damping fades out
and the estimator is held. Modes fade within t_fade. Whatever comes in, T_ref is finite and within T_max,
and takes no more than T_take_max from the demand and adds no more than T_add_max to it; T_add_max is also
what the damping alone may take.
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Boolean, Enumeration, Integer, Real
from ..block.operators import clip, is_finite, logical_and, logical_not, logical_or, maximum, where
from ..physics.vehicle import CAR, MotorInertia, MotorLag
from . import launch_direction as departure
from . import oscillation_monitor as swings
from . import signal_trust as trust
from . import standstill
from .interfaces import Addition, Motion
from .launch_direction import LaunchState
from .oscillation_monitor import SwingState
from .signal_monitor import MonitorState
from .signal_trust import TrustState
from .wheel_monitor import WheelState

T_S = 0.002
"""Sample time in s."""

OFF, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED, FALLBACK = 1.0, 2.0, 3.0, 4.0


class Parameters(NamedTuple):
    """Of the supervision, for every controller."""

    T_max: Annotated[float, Real("N.m", "limit of the torque reference", 1.0, 2000.0)] = CAR.T_max
    tau: MotorLag = CAR.tau
    J_1: MotorInertia = CAR.J_1
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
    omega_max: Annotated[float, Real("rad/s", "largest plausible speed", 10.0, 5000.0)] = 3000.0
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
    launch_direction: LaunchState
    swings: SwingState
    trust: TrustState
    level: Annotated[float, Real("1", "share of the damping that acts")]
    quiet: Annotated[float, Real("s", "time without demand and motion")]
    since_rest: Annotated[float, Real("s", "time since the car was at rest")]
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


def is_suspect(signals: MonitorState, wheel_state: WheelState) -> Any:
    """Whether the motor signals are bad in this sample, or do not match the wheel speed."""
    return logical_or(signals.bad > 0.0, wheel_state.mismatch_time > 0.0)


def is_launching(x: State) -> Any:
    """Whether the car was at rest a moment ago."""
    return x.since_rest < standstill.LAUNCH


def trust_after(
    x: State, signals: MonitorState, wheel_state: WheelState, launch: LaunchState, resting: Any, p: Any
) -> TrustState:
    """The trust in the motor signals with those of this sample; `resting`: the car is at rest."""
    wrong_direction = logical_and(departure.is_against(launch), logical_not(departure.is_against(x.launch_direction)))
    confirmed = logical_and(wheel_state.reference_valid, swings.is_calm(x.opposing, p))
    implausible = logical_or(swings.feeds(x.swings), wrong_direction)
    mismatch_time = maximum(wheel_state.mismatch_time, where(launch.wrong_sign, T_S, 0.0))
    return trust.update(x.trust, signals.bad, mismatch_time, implausible, confirmed, resting, T_S, p)


def damping_limited(added: Addition, p: Any) -> Addition:
    return added._replace(damping=clip(added.damping, -p.T_add_max, p.T_add_max))


def limited(torque: Any, T_driver: Any, p: Any) -> Any:
    """What may be added to the demand: in its direction up to T_add_max, against it up to T_take_max."""
    lower = where(T_driver > 0.0, p.T_take_max, p.T_add_max)
    upper = where(T_driver < 0.0, p.T_take_max, p.T_add_max)
    return clip(torque, -lower, upper)
