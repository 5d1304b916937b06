"""The backlash by its describing function: which limit cycles can be, and which are excluded.

Swinging with amplitude A about the middle of the gap, the teeth act on the first harmonic like a spring of N C,

    N = 1 - 2/pi (asin a + a sqrt(1 - a^2)),   a = phi_B/A,   0 for A < phi_B

(A. Gelb, W. E. Vander Velde, "Multiple-Input Describing Functions and Nonlinear System Design", 1968, appendix B).
About any other point, or with a mean torque, N is another number from 0 to 1. It is the share of contact in a mean of
contact and gap that is weighted by cos^2 over the swing; this mean is taken of everything that differs between them:
the spring, the controller's model of it, and the law, which may know the gap. There is a limit cycle where a pole of
that loop is on the unit circle. If they are inside for all N, there is none, about whatever point. That is as good
as the twist that the controller knows is the true one, and as the swing is a sine.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import asin, inf, pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.optimize import root_scalar

from .averaged_messages import messages
from .linear_controller import LinearController, Sample, controller_in_contact_and_gap
from .linear_loop import LinearLoop, assembled
from .linear_plant import LinearPlant, in_contact_and_gap
from .margins import Margins, margins
from .modes import is_stable, modes
from .operating_point import Point

AMPLITUDES = 1.0 + np.geomspace(0.01, 99.0, 24)
"""Over phi_B, at which loops are looked at; N goes from 0.001 to 0.99."""


def describing_function(amplitude: float) -> float:
    """N of a swing with an amplitude over phi_B about the middle of the gap."""
    if amplitude <= 1.0:
        return 0.0
    a = 1.0 / amplitude
    return 1.0 - 2.0 / pi * (asin(a) + a * sqrt(1.0 - a * a))


class Swinging:
    """The loop of a point, with the teeth in contact for a share of the swing."""

    def __init__(self, point: Point) -> None:
        self.point = point
        self._drives = in_contact_and_gap(point)
        self._controllers = controller_in_contact_and_gap(point, self._drives[0])

    def loop(self, N: float, late: float = 0.0) -> LinearLoop:
        """The loop with the describing function N; late: further dead time in s."""
        drive, controller = _mixed_drive(N, *self._drives), _mixed_controller(N, *self._controllers)
        return assembled(drive, controller, messages(self.point), self.point.late + late)

    def swing(self, amplitude: float) -> "Swing":
        """A swing with an amplitude over phi_B."""
        N = describing_function(amplitude)
        loop = self.loop(N)
        stable = is_stable(loop)
        return Swing(amplitude, N, stable, margins(loop) if stable else None)


def _mixed_drive(N: float, contact: LinearPlant, gap: LinearPlant) -> LinearPlant:
    A, C = (N * getattr(contact, name) + (1.0 - N) * getattr(gap, name) for name in ("A", "C"))
    return contact._replace(A=A, C=C)


def _mixed_controller(N: float, contact: LinearController, gap: LinearController) -> LinearController:
    def mixed(name: str) -> Sample:
        pairs = zip(getattr(contact, name), getattr(gap, name), strict=True)
        return Sample(*(N * one + (1.0 - N) * other for one, other in pairs))

    return contact._replace(quiet=mixed("quiet"), message=mixed("message"))


class Swing(NamedTuple):
    """The loop while the teeth swing.

    Attributes:
        amplitude: of the twist about the middle of the gap, over phi_B; infinite in contact.
        N: describing function.
        stable: whether such a swing dies away.
        margins: None if the swing does not die away.
    """

    amplitude: float
    N: float
    stable: bool
    margins: Margins | None


class LimitCycle(NamedTuple):
    """A swing that neither grows nor dies away.

    Attributes:
        amplitude: of the twist about the middle of the gap, over phi_B.
        N: describing function.
        frequency: in Hz.
        lasting: smaller swings grow into it and larger ones shrink to it; otherwise it parts those that die away
            from those that grow.
    """

    amplitude: float
    N: float
    frequency: float
    lasting: bool


def limit_cycles(point: Point, found: Sequence[Swing]) -> list[LimitCycle]:
    """Those that the describing function tells of, between swings of which one dies away and the next does not."""
    loops = Swinging(point)
    cycles = []
    for one, other in pairwise(found):
        if one.stable != other.stable:
            amplitude = _between(lambda a: is_stable(loops.loop(describing_function(a))) - 0.5, one, other)
            N = describing_function(amplitude)
            mode = min(modes(loops.loop(N).mean), key=lambda mode: abs(mode.damping_ratio))
            cycles.append(LimitCycle(amplitude, N, mode.frequency, other.stable))
    return cycles


def _between(function: Callable[[float], float], one: Swing, other: Swing) -> float:
    """The amplitude at which a function changes its sign."""
    largest = 1e4
    bracket = one.amplitude, min(other.amplitude, largest)
    return float(root_scalar(function, bracket=bracket, method="bisect", rtol=1e-6).root)


def swings(point: Point) -> list[Swing]:
    """The loop of a point at all AMPLITUDES and in contact."""
    loops = Swinging(point)
    return [loops.swing(amplitude) for amplitude in (*AMPLITUDES.tolist(), inf)]
