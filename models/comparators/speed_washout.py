"""Washout of the motor speed: what changes of it is opposed.

T_damp = -k_v s^2/(s^2 + 2 zeta_v omega_v s + omega_v^2) omega_1

Of second order, so that a car which gains speed steadily is not opposed; for a large zeta_v it becomes the washout of
first order, s/(s + 2 zeta_v omega_v). Sampled by the trapezoidal rule, which is stable at any corner frequency.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real

from ..controller.interfaces import Addition, Motion
from ..controller.supervised_controller import supervised
from . import measured_speeds


class WashoutParameters(NamedTuple):
    k_v: Annotated[
        float, Real("N.m.s/rad", "damping over the motor speed", 0.0, 200.0, search=(0.2, 10.0), tunable=True)
    ] = 2.32
    omega_v: Annotated[
        float, Real("rad/s", "corner frequency of the washout", 0.0, 400.0, search=(1.0, 200.0), tunable=True)
    ] = 9.50
    zeta_v: Annotated[float, Real("1", "damping ratio of the washout", 0.1, 10.0, search=(0.2, 5.0), tunable=True)] = (
        0.373
    )


class WashoutState(NamedTuple):
    """State of the washout of the motor speed."""

    slow: Annotated[float, Real("rad/s", "motor speed without what is fast")]
    steady: Annotated[float, Real("rad/s", "rate of `slow` over omega_v")]


class Washout:
    """The law."""

    Parameters = WashoutParameters

    def start(self, motion: Motion, T_driver: float, p: WashoutParameters) -> WashoutState:
        return WashoutState(motion.omega_1, 0.0)

    def update(
        self,
        x: WashoutState,
        motion: Motion,
        expected: Motion,
        T_driver: float,
        T_s: float,
        p: WashoutParameters,
    ) -> tuple[WashoutState, Addition]:
        # dslow/dt = omega_v steady, dsteady/dt = omega_v fast, fast = omega_1 - slow - 2 zeta_v steady
        g = 0.5 * p.omega_v * T_s
        fast = (motion.omega_1 - x.slow - (2.0 * p.zeta_v + g) * x.steady) / (1.0 + 2.0 * p.zeta_v * g + g * g)
        slow = x.slow + 2.0 * g * (x.steady + g * fast)
        return WashoutState(slow, x.steady + 2.0 * g * fast), Addition(damping=-p.k_v * fast, landing=0.0)


BLOCK = supervised(
    name="SpeedWashout",
    description="Comparator: damping by a washout of the motor speed",
    module=__name__,
    estimator=measured_speeds,
    law=Washout(),
)
