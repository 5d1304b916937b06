"""The operations of the model equations that work on floats and on symbols alike.

A model never branches on data with `if`: it calls `where`, `maximum` or `minimum`, so that the
same function can be called with symbols and traced. A symbol is any object with the arithmetic and
comparison operators, a method of the same name for each function below (`x.sin()`), and
`condition.where(value, otherwise)`, `condition.logical_and(other)` and so on for the result of a
comparison; `x % y` is Python's, with the sign of y. Both values of `where` are always computed, so
neither may raise.

Annotations of model functions say float and bool: a symbol passes for either.
"""

import math
import sys
from collections.abc import Callable, Sequence
from typing import Any, Protocol, TypeVar, cast

from .declaration import is_tuple

Number = TypeVar("Number", bound=float)
Values = TypeVar("Values")


class Symbol(Protocol):
    """What a symbol has beside the operators of Python."""

    def where(self, value: Values, otherwise: Values, /) -> Values: ...
    def logical_and(self, other: bool, /) -> bool: ...
    def logical_or(self, other: bool, /) -> bool: ...
    def logical_not(self) -> bool: ...
    def sin(self) -> float: ...
    def cos(self) -> float: ...
    def atan(self) -> float: ...
    def tanh(self) -> float: ...
    def sqrt(self) -> float: ...
    def log(self) -> float: ...
    def exp(self) -> float: ...
    def floor(self) -> float: ...


def symbol(number: float) -> Symbol:
    """What passes for a number or a truth value, and is none."""
    return cast(Symbol, number)


LARGEST = sys.float_info.max
"""The largest finite number."""


def where(condition: bool, value: Number, otherwise: Number) -> Number:
    """`value` where the condition holds, else `otherwise`."""
    if condition is True:
        return value
    if condition is False:
        return otherwise
    return symbol(condition).where(value, otherwise)


def branch(condition: bool, value: Callable[[], Values], otherwise: Callable[[], Values]) -> Values:
    """`value()` where the condition holds, else `otherwise()`: for what is costly and rarely needed.

    Both return tuples of the same shape, nested or named. With truth values only one of them is called;
    with symbols both are, as with `where`.
    """
    if condition is True:
        return value()
    if condition is False:
        return otherwise()
    return _joined(condition, value(), otherwise())


def _joined(condition: bool, value: Values, otherwise: Values) -> Values:
    if not (is_tuple(value) and is_tuple(otherwise)):
        return symbol(condition).where(value, otherwise)
    make = cast(Callable[[list[Any]], Any], getattr(type(value), "_make", tuple))
    return make([_joined(condition, a, b) for a, b in zip(value, otherwise, strict=True)])


# maximum, minimum and clip are the hot spots of every model: they save themselves the call of `where`, and with > and <
# they are one instruction of most processors


def maximum(a: float, b: float) -> float:
    above = a > b
    return a if above is True else b if above is False else symbol(above).where(a, b)


def minimum(a: float, b: float) -> float:
    below = a < b
    return a if below is True else b if below is False else symbol(below).where(a, b)


def clip(x: float, lower: float, upper: float) -> float:
    """x limited to [lower, upper]; NaN becomes a limit."""
    return minimum(maximum(x, lower), upper)


def sign(x: float) -> float:
    return where(x > 0.0, 1.0, where(x < 0.0, -1.0, 0.0))


def logical_and(a: bool, b: bool) -> bool:
    if a.__class__ is bool and b.__class__ is bool:
        return a and b
    return symbol(a).logical_and(b) if a.__class__ is not bool else symbol(b).logical_and(a)


def logical_or(a: bool, b: bool) -> bool:
    if a.__class__ is bool and b.__class__ is bool:
        return a or b
    return symbol(a).logical_or(b) if a.__class__ is not bool else symbol(b).logical_or(a)


def logical_not(a: bool) -> bool:
    return not a if a.__class__ is bool else symbol(a).logical_not()


def is_finite(x: float) -> bool:
    """False for NaN and both infinities; written with comparisons, so that it traces."""
    return abs(x) <= LARGEST


def sin(x: float) -> float:
    try:
        return math.sin(x)
    except TypeError:
        return symbol(x).sin()
    except ValueError:
        return math.nan


def cos(x: float) -> float:
    try:
        return math.cos(x)
    except TypeError:
        return symbol(x).cos()
    except ValueError:
        return math.nan


def atan(x: float) -> float:
    try:
        return math.atan(x)
    except TypeError:
        return symbol(x).atan()


def tanh(x: float) -> float:
    try:
        return math.tanh(x)
    except TypeError:
        return symbol(x).tanh()


def sqrt(x: float) -> float:
    try:
        return math.sqrt(x)
    except TypeError:
        return symbol(x).sqrt()


def log(x: float) -> float:
    try:
        return math.log(x)
    except TypeError:
        return symbol(x).log()


def exp(x: float) -> float:
    try:
        return math.exp(x)
    except TypeError:
        return symbol(x).exp()


def floor(x: float) -> float:
    try:
        return float(math.floor(x))
    except TypeError:
        return symbol(x).floor()


def element(values: Sequence[Number], position: float) -> Number:
    """The value at the whole part of a position; the first or the last one beyond either end."""
    if position.__class__ is float:
        return values[min(max(int(position), 0), len(values) - 1)]
    result = values[0]
    for k, value in enumerate(values[1:], 1):
        result = where(position >= float(k), value, result)
    return result


def interpolate(values: Sequence[float], position: float) -> float:
    """Linear interpolation between values[0], values[1], ...; held beyond either end."""
    position = clip(position, 0.0, len(values) - 1.0)
    if position.__class__ is float:
        left = min(int(position), len(values) - 2)
        return values[left] + (position - left) * (values[left + 1] - values[left])
    start = element([float(k) for k in range(len(values) - 1)], position)
    left, right = element(values[:-1], position), element(values[1:], position)
    return left + (position - start) * (right - left)
