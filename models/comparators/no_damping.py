"""No damping: the driver's demand is passed through, within the same limits and as late.

T_damp = 0
"""

from typing import NamedTuple

from ..controller.interfaces import Addition, Motion
from ..controller.supervised_controller import supervised
from . import measured_speeds


class Nothing(NamedTuple):
    """The law has neither parameters nor a state."""


class NoLaw:
    """The law."""

    Parameters = Nothing

    def start(self, motion: Motion, T_driver: float, p: Nothing) -> Nothing:
        return Nothing()

    def update(
        self, x: Nothing, motion: Motion, expected: Motion, T_driver: float, T_s: float, p: Nothing
    ) -> tuple[Nothing, Addition]:
        return x, Addition(damping=0.0, landing=0.0)


BLOCK = supervised(
    name="NoDamping",
    description="Comparator: no damping, the driver's demand is passed through",
    module=__name__,
    estimator=measured_speeds,
    law=NoLaw(),
)
