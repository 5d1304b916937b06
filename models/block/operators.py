"""The operations of the model equations that work on floats and on symbols alike.

A model never branches on data with `if`: it calls `where`, `maximum` or `minimum`, so that the
same function can be called with symbols and traced. A symbol is any object with the arithmetic and
comparison operators, a method of the same name for each function below (`x.sin()`), and
`condition.where(value, otherwise)`, `condition.logical_and(other)` and so on for the result of a
comparison; `x % y` is Python's, with the sign of y. Both values of `where` are always computed, so
neither may raise.
"""

import math
import sys
from collections.abc import Callable, Sequence
from typing import Any

LARGEST = sys.float_info.max
"""The largest finite number."""


def where(condition: Any, value: Any, otherwise: Any) -> Any:
    """`value` where the condition holds, else `otherwise`."""
    if condition is True:
        return value
    if condition is False:
        return otherwise
    return condition.where(value, otherwise)


def branch(condition: Any, value: Callable[[], Any], otherwise: Callable[[], Any]) -> Any:
    """`value()` where the condition holds, else `otherwise()`: for what is costly and rarely needed.

    Both return tuples of the same shape, nested or named. With truth values only one of them is called;
    with symbols both are, as with `where`.
    """
    if condition is True:
        return value()
    if condition is False:
        return otherwise()
    return _joined(condition, value(), otherwise())


def _joined(condition: Any, value: Any, otherwise: Any) -> Any:
    if not isinstance(value, tuple):
        return where(condition, value, otherwise)
    make = getattr(type(value), "_make", tuple)
    return make([_joined(condition, a, b) for a, b in zip(value, otherwise, strict=True)])


# maximum, minimum and clip are the hot spots of every model: they save themselves the call of `where`


def maximum(a: Any, b: Any) -> Any:
    above = a >= b
    return a if above is True else b if above is False else above.where(a, b)


def minimum(a: Any, b: Any) -> Any:
    below = a <= b
    return a if below is True else b if below is False else below.where(a, b)


def clip(x: Any, lower: Any, upper: Any) -> Any:
    """x limited to [lower, upper]; NaN becomes a limit."""
    return minimum(maximum(x, lower), upper)


def sign(x: Any) -> Any:
    return where(x > 0.0, 1.0, where(x < 0.0, -1.0, 0.0))


def logical_and(a: Any, b: Any) -> Any:
    if a.__class__ is bool and b.__class__ is bool:
        return a and b
    return a.logical_and(b) if a.__class__ is not bool else b.logical_and(a)


def logical_or(a: Any, b: Any) -> Any:
    if a.__class__ is bool and b.__class__ is bool:
        return a or b
    return a.logical_or(b) if a.__class__ is not bool else b.logical_or(a)


def logical_not(a: Any) -> Any:
    return not a if a.__class__ is bool else a.logical_not()


def is_finite(x: Any) -> Any:
    """False for NaN and both infinities; written with comparisons, so that it traces."""
    return abs(x) <= LARGEST


def sin(x: Any) -> Any:
    try:
        return math.sin(x)
    except TypeError:
        return x.sin()
    except ValueError:
        return math.nan


def cos(x: Any) -> Any:
    try:
        return math.cos(x)
    except TypeError:
        return x.cos()
    except ValueError:
        return math.nan


def atan(x: Any) -> Any:
    try:
        return math.atan(x)
    except TypeError:
        return x.atan()


def tanh(x: Any) -> Any:
    try:
        return math.tanh(x)
    except TypeError:
        return x.tanh()


def sqrt(x: Any) -> Any:
    try:
        return math.sqrt(x)
    except TypeError:
        return x.sqrt()


def log(x: Any) -> Any:
    try:
        return math.log(x)
    except TypeError:
        return x.log()


def floor(x: Any) -> Any:
    try:
        return float(math.floor(x))
    except TypeError:
        return x.floor()


def interpolate(values: Sequence[Any], position: Any) -> Any:
    """Linear interpolation between values[0], values[1], ...; held beyond either end."""
    position = clip(position, 0.0, len(values) - 1.0)
    if position.__class__ is float:
        left = min(int(position), len(values) - 2)
        return values[left] + (position - left) * (values[left + 1] - values[left])
    start, left, right = 0.0, values[0], values[1]
    for k in range(1, len(values) - 1):
        beyond = position >= float(k)
        start = where(beyond, float(k), start)
        left, right = where(beyond, values[k], left), where(beyond, values[k + 1], right)
    return left + (position - start) * (right - left)
