"""An estimator that is no more than the measured speeds, between samples those of a rigid drive train.

J domega_1/dt = T_mot
"""

from typing import Annotated, Any, NamedTuple

from models.block.declaration import Real
from models.block.operators import where
from models.controller.parts import Motion


class Parameters(NamedTuple):
    J: Annotated[float, Real("kg.m2", "inertia of motor and vehicle, motor side", 0.001, 100.0)] = 2.0


class SpeedState(NamedTuple):
    """State of the estimator of the speeds."""

    omega_1: Annotated[float, Real("rad/s", "speed of the motor")]
    omega_2: Annotated[float, Real("rad/s", "speed in the last message, motor side")]
    T_mot: Annotated[float, Real("N.m", "motor torque of the last sample")]
    wheel: Annotated[float, Real("1", "1 while the wheel speed is in use")]


def start(omega_1: Any, T_mot: Any, wheel: Any, p: Any) -> SpeedState:
    return SpeedState(omega_1, omega_1, T_mot, where(wheel, 1.0, 0.0))


def restart(x: SpeedState, omega_1: Any, T_mot: Any, p: Any) -> SpeedState:
    return SpeedState(omega_1, omega_1, T_mot, x.wheel)


def predict(x: SpeedState, T_mot: Any, T_s: Any, p: Any) -> SpeedState:
    return x._replace(omega_1=x.omega_1 + T_s * T_mot / p.J, T_mot=T_mot)


def take_motor_speed(x: SpeedState, omega_1: Any, p: Any) -> SpeedState:
    return x._replace(omega_1=omega_1)


def take_wheel_speed(x: SpeedState, omega_2: Any, T_s: Any, p: Any) -> SpeedState:
    return x._replace(omega_2=omega_2)


def finish(x: SpeedState, wheel: Any, T_s: Any, p: Any) -> SpeedState:
    return x._replace(wheel=where(wheel, 1.0, 0.0))


def motion(x: SpeedState, p: Any) -> Motion:
    return Motion(x.omega_1, x.omega_2, phi=0.0, T_gear=x.T_mot)


def motion_after(x: SpeedState, T_mot: Any, h: Any, p: Any) -> Motion:
    return motion(predict(x, T_mot, h, p), p)
