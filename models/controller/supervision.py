"""What surrounds an estimator and a law: which signals to trust, when to act, and within what limits.

In every sample the estimator takes what was measured, the law says what to add to the driver's demand, and
the estimator goes one sample on. Motor signals that have failed lead to fallback: the demand is passed through,
estimator and law restart, until the signals have healed (causes). A lost, late or absurd wheel speed
only ends the mode that uses it. A demand that is not finite counts as zero. At rest the damping fades out
and the estimator is held. Modes fade within t_fade. Whatever comes in, T_ref is finite and within T_max,
and takes no more than T_take_max from the demand and adds no more than T_add_max to it; T_add_max is also
what the damping alone may take.
"""

from typing import Annotated, Generic, NamedTuple, TypeVar

from fmublocks.block.declaration import Enumeration, Real
from fmublocks.block.operators import clip, is_finite, where

from . import causes
from .launch import LaunchState
from .motor_signals import MotorState
from .oscillation import SwingState
from .supervision_interface import Input, Parameters
from .trust import TrustState
from .wheel_messages import WheelState

E = TypeVar("E")
L = TypeVar("L")
"""States of the estimator and of the law."""

OFF, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED, FALLBACK = 1, 2, 3, 4


class State(NamedTuple, Generic[E, L]):
    """State of a controller; those of its parts are records."""

    estimator: E
    law: L
    motor: MotorState
    wheel: WheelState
    swings: SwingState
    launch: LaunchState
    trust: TrustState
    level: Annotated[float, Real("1", "share of the damping that acts")]
    quiet: Annotated[float, Real("s", "time without demand and motion")]
    T_ref: Annotated[float, Real("N.m", "torque reference")]
    T_damp: Annotated[float, Real("N.m", "torque added to the demand")]
    status: Annotated[int, Real("1", "number of the status")]


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
    cause: Annotated[int, causes.OUTPUT]
    phi_B_hat: Annotated[float, Real("rad", "half gap as it was learned; phi_B_0 takes it at the next start")]


def demand(u: Input, p: Parameters) -> float:
    """The driver's demand in N.m within the limits; zero where it is not finite."""
    return clip(where(is_finite(u.T_driver), u.T_driver, 0.0), -p.T_max, p.T_max)


def status(enable: bool, trusted: bool, wheel: bool) -> int:
    return where(enable, where(trusted, where(wheel, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED), FALLBACK), OFF)


def limited(torque: float, T_driver: float, p: Parameters) -> float:
    """What may be added to the demand: in its direction up to T_add_max, against it up to T_take_max."""
    lower = where(T_driver > 0.0, p.T_take_max, p.T_add_max)
    upper = where(T_driver < 0.0, p.T_take_max, p.T_add_max)
    return clip(torque, -lower, upper)
