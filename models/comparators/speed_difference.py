"""Proportional feedback of the speed difference, with the wheel speed as late as the bus delivers it.

    T_damp = -k_delta s/(s + omega_delta) (omega_1 - omega_2_can)

Nothing while no wheel speed comes, as below 5 km/h. The washout takes away what the delay makes of a car that
speeds up, and an error of the wheel radius; omega_delta = 0 leaves it out.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real

from ..controller.damping_law import washed_out
from ..controller.interfaces import Addition, Motion
from ..controller.supervised_controller import supervised
from . import measured_speeds


class DifferenceParameters(NamedTuple):
    k_delta: Annotated[
        float, Real("N.m.s/rad", "damping over the speed difference", 0.0, 200.0, search=(0.2, 10.0), tunable=True)
    ] = 2.37
    omega_delta: Annotated[
        float, Real("rad/s", "corner frequency of its washout", 0.0, 400.0, search=(0.5, 200.0), tunable=True)
    ] = 13.1


class DifferenceState(NamedTuple):
    """State of the washout of the speed difference."""

    slow: Annotated[float, Real("rad/s", "part of the speed difference that does not change")]


class Difference:
    """The law."""

    Parameters = DifferenceParameters

    def start(self, motion: Motion, T_driver: float, p: DifferenceParameters) -> DifferenceState:
        return DifferenceState(slow=0.0)

    def update(
        self,
        x: DifferenceState,
        motion: Motion,
        expected: Motion,
        T_driver: float,
        T_s: float,
        p: DifferenceParameters,
    ) -> tuple[DifferenceState, Addition]:
        difference = motion.omega_1 - motion.omega_2
        slow = washed_out(x.slow, difference, p.omega_delta, T_s)
        return DifferenceState(slow), Addition(damping=-p.k_delta * (difference - x.slow), landing=0.0)


BLOCK = supervised(
    name="SpeedDifference",
    description="Comparator: damping by the difference of motor speed and received wheel speed",
    module=__name__,
    estimator=measured_speeds,
    law=Difference(),
)
