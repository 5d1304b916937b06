"""Washout of the motor speed: what changes of it is opposed.

T_damp = -k_v s/(s + omega_v) omega_1
"""

from collections.abc import Callable
from typing import Annotated, NamedTuple

from ..block.declaration import Real
from ..controller.damping_law import washed_out
from ..controller.interfaces import Addition, Motion
from ..controller.supervised_controller import supervised
from . import measured_speeds


class WashoutParameters(NamedTuple):
    k_v: Annotated[float, Real("N.m.s/rad", "damping over the motor speed", 0.0, 200.0, search=(0.2, 10.0))] = 1.76
    omega_v: Annotated[float, Real("rad/s", "corner frequency of the washout", 0.0, 400.0, search=(1.0, 200.0))] = 53.3


class WashoutState(NamedTuple):
    """State of the washout of the motor speed."""

    slow: Annotated[float, Real("rad/s", "part of the motor speed that does not change")]


class Washout:
    """The law."""

    Parameters = WashoutParameters

    def start(self, motion: Motion, T_driver: float, p: WashoutParameters) -> WashoutState:
        return WashoutState(motion.omega_1)

    def update(
        self,
        x: WashoutState,
        motion: Motion,
        later: Callable[[float], Motion],
        T_driver: float,
        T_s: float,
        p: WashoutParameters,
    ) -> tuple[WashoutState, Addition]:
        slow = washed_out(x.slow, motion.omega_1, p.omega_v, T_s)
        return WashoutState(slow), Addition(damping=-p.k_v * (motion.omega_1 - x.slow), landing=0.0)


BLOCK = supervised(
    name="SpeedWashout",
    description="Comparator: damping by a washout of the motor speed",
    module=__name__,
    estimator=measured_speeds,
    law=Washout(),
)
