"""Straight lines along which inputs move during a step: FMI takes a value and a derivative at its beginning.

Where a source shows its derivatives a', b' at both ends of the step beside its values a, b, the line is the
one nearest (least squares) to the cubic curve through these. It has the mean and the first moment of the
curve, so that what integrates the input hardly tells it from the curve:

    mean = (a + b)/2 + h (a' - b')/12        slope = (6/5 (b - a) - h/10 (a' + b'))/h

Else it is the chord. What steps.c does is the same, operation by operation.
"""

from ctypes import c_double
from typing import NamedTuple


class Line(NamedTuple):
    """Where the numbers of a line are.

    Attributes:
        sent: the input as it was set last, in the unit of the FMU.
        factor: what that unit is multiplied by to be that of the other numbers.
        end: the source at the end of the step; None: not known, the line follows the derivative.
        before: the derivative of the source at the beginning of the step; None: not known.
        after: at its end.
    """

    sent: c_double
    factor: float
    end: c_double | None = None
    before: c_double | None = None
    after: c_double | None = None


def slope(line: Line, h: float) -> float:
    """In the unit of the FMU by s, for a step of h s."""
    if line.end is None:
        assert line.before is not None
        return line.before.value / line.factor
    way = line.end.value / line.factor - line.sent.value
    if line.before is None or line.after is None:
        return way / h
    return (1.2 * way - 0.1 * h * ((line.before.value + line.after.value) / line.factor)) / h


def start(line: Line, h: float) -> float:
    """At the beginning of a step of h s, in the unit of the FMU."""
    if line.end is None or line.before is None or line.after is None:
        return line.sent.value
    way = line.end.value / line.factor - line.sent.value
    mean = line.sent.value + 0.5 * way + h * ((line.before.value - line.after.value) / line.factor) / 12.0
    return mean - 0.5 * h * slope(line, h)
