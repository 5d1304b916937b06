"""The messages with the wheel speed, on average: without rounding, teeth and chance.

At the end of each cycle the unit sends the mean speed over that cycle; the message arrives after the mean of its
transport delays, and the controller takes it in its next sample.
"""

from typing import NamedTuple

from ....models.controller import T_S
from .operating_point import CAN, Point


class Messages(NamedTuple):
    """In samples of the controller.

    Attributes:
        cycle: from one message to the next.
        delay: from the end of the cycle that it tells of to the sample that takes it.
    """

    cycle: int
    delay: int

    @property
    def age(self) -> float:
        """Mean age in s of what a message says, when it is taken."""
        return (0.5 * self.cycle + self.delay) * T_S


def messages(point: Point) -> Messages:
    """Of the bus of a point.

    What arrives between two samples waits for the later one, half a sample on average.
    """
    p = point.of("can", CAN)
    transport = 0.5 * (p.d_min + max(p.d_min, p.d_max))
    return Messages(max(round(p.T_cyc / T_S), 1), max(round(transport / T_S + 0.5), 1))
