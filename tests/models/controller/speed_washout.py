"""A law that opposes what changes of the motor speed: T_damp = -k_v s/(s + omega_v) omega_1."""

from typing import Annotated, Any, NamedTuple

from models.block.declaration import Real
from models.controller.parts import Addition, Motion


class Parameters(NamedTuple):
    k_v: Annotated[float, Real("N.m.s/rad", "damping over the motor speed", 0.0, 20.0)] = 2.0
    omega_v: Annotated[float, Real("rad/s", "corner frequency of the washout", 0.0, 400.0)] = 25.0


class WashoutState(NamedTuple):
    """State of the washout of the motor speed."""

    slow: Annotated[float, Real("rad/s", "part of the motor speed that does not change")]


def start(motion: Motion, p: Any) -> WashoutState:
    return WashoutState(motion.omega_1)


def update(
    x: WashoutState, motion: Motion, later: Any, T_driver: Any, T_s: Any, p: Any
) -> tuple[WashoutState, Addition]:
    changing = motion.omega_1 - x.slow
    return WashoutState(x.slow + p.omega_v * T_s * changing), Addition(damping=-p.k_v * changing, landing=0.0)
