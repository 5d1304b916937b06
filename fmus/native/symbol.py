"""A number that is not known yet, as a CasADi expression."""

from collections.abc import Callable
from typing import Any

import casadi


def expression(value: Any) -> casadi.SX:
    """The expression of a symbol, a number or a truth value."""
    return value.expression if isinstance(value, Symbol) else casadi.SX(float(value))


def _unary(operation: Callable[[Any], Any]) -> Callable[[Any], "Symbol"]:
    return lambda x: Symbol(operation(x.expression))


def _binary(operation: Callable[[Any, Any], Any]) -> Callable[[Any, Any], "Symbol"]:
    return lambda x, y: Symbol(operation(x.expression, expression(y)))


def _reflected(operation: Callable[[Any, Any], Any]) -> Callable[[Any, Any], "Symbol"]:
    return lambda y, x: Symbol(operation(expression(x), y.expression))


class Symbol:
    """A real number or a truth value (0 or 1); follows the protocol of `models.block.operators`."""

    __slots__ = ("expression",)

    def __init__(self, expression: casadi.SX) -> None:
        self.expression = expression

    def __bool__(self) -> bool:
        raise TypeError("a model function branches on data; it must call `where` of models.block.operators")

    __add__, __radd__ = _binary(casadi.plus), _reflected(casadi.plus)
    __sub__, __rsub__ = _binary(casadi.minus), _reflected(casadi.minus)
    __mul__, __rmul__ = _binary(casadi.times), _reflected(casadi.times)
    __truediv__, __rtruediv__ = _binary(casadi.rdivide), _reflected(casadi.rdivide)
    __pow__, __rpow__ = _binary(casadi.power), _reflected(casadi.power)
    __lt__, __le__ = _binary(casadi.lt), _binary(casadi.le)
    __gt__, __ge__ = _binary(casadi.gt), _binary(casadi.ge)
    __eq__, __ne__ = _binary(casadi.eq), _binary(casadi.ne)  # pyright: ignore[reportAssignmentType]
    __neg__, __pos__, __abs__ = _unary(lambda x: -x), _unary(lambda x: x), _unary(casadi.fabs)
    __hash__ = object.__hash__

    sin, cos, atan, tanh = _unary(casadi.sin), _unary(casadi.cos), _unary(casadi.atan), _unary(casadi.tanh)
    sqrt, log, floor = _unary(casadi.sqrt), _unary(casadi.log), _unary(casadi.floor)
    logical_and, logical_or = _binary(casadi.logic_and), _binary(casadi.logic_or)
    logical_not = _unary(casadi.logic_not)

    def __mod__(self, y: Any) -> "Symbol":
        """CasADi's fmod stands for the % of Python, which it is but for the sign; C gets it with Python's."""
        x, y = self.expression, expression(y)
        if x.is_constant() and y.is_constant():
            return Symbol(casadi.SX(float(x) % float(y)))
        return Symbol(casadi.fmod(x, y))

    def where(self, value: Any, otherwise: Any) -> "Symbol":
        return Symbol(casadi.if_else(self.expression, expression(value), expression(otherwise)))
