"""An estimator that is no more than the measured speeds, between samples those of a rigid drive train.

J domega_1/dt = T_mot

The wheel speed is that of the last message, as old as it is; while no wheel speed comes, that of the
motor stands for it. It fades from one to the other.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real
from fmublocks.block.operators import clip, where

from ..controller.fading import faded
from ..controller.interfaces import Motion


class Parameters(NamedTuple):
    J: Annotated[float, Real("kg.m2", "inertia of motor, wheels and vehicle, motor side", 0.001, 100.0)] = 1.87


class AllParameters(Parameters):
    """With those of the supervision that it takes beside its own: a type of p, never made."""

    t_fade: float
    omega_max: float


class SpeedState(NamedTuple):
    """State of the estimator of the speeds."""

    omega_1: Annotated[float, Real("rad/s", "speed of the motor")]
    omega_2: Annotated[float, Real("rad/s", "speed in the last message, motor side")]
    T_mot: Annotated[float, Real("N.m", "motor torque until the next sample")]
    share: Annotated[float, Real("1", "share of the wheel speed, 0 while none comes")]


def start(omega_1: float, T_mot: float, wheel: bool, p: Parameters) -> SpeedState:
    return SpeedState(omega_1, omega_1, T_mot, where(wheel, 1.0, 0.0))


def restart(x: SpeedState, omega_1: float, T_mot: float, p: Parameters) -> SpeedState:
    return SpeedState(omega_1, omega_1, T_mot, x.share)


def take_motor_speed(x: SpeedState, omega_1: float, slips: bool, T_s: float, p: Parameters) -> SpeedState:
    return x._replace(omega_1=omega_1)


def take_wheel_speed(x: SpeedState, omega_2: float, T_s: float, p: Parameters) -> SpeedState:
    return x._replace(omega_2=omega_2)


def learn(x: SpeedState, innovation: float, hold: bool, T_s: float, p: Parameters) -> SpeedState:
    return x


def predict(x: SpeedState, T_mot: float, wheel: bool, T_s: float, p: AllParameters) -> SpeedState:
    share = faded(x.share, wheel, T_s, p.t_fade)
    omega_1 = clip(x.omega_1 + T_s * T_mot / p.J, -p.omega_max, p.omega_max)
    return x._replace(omega_1=omega_1, T_mot=T_mot, share=share)


def motion(x: SpeedState, p: Parameters) -> Motion:
    omega_2 = x.omega_1 - x.share * (x.omega_1 - x.omega_2)
    return Motion(x.omega_1, omega_2, phi=0.0, T_gear=x.T_mot, omega=x.omega_1 - omega_2)
