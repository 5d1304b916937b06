"""A number that is not known yet, as a CasADi expression."""

import operator
from typing import Any

import casadi

from ..symbol import Symbol


def expression(value: Any) -> casadi.SX:
    """The expression of a symbol, a number or a truth value."""
    return value.expression if isinstance(value, CasadiSymbol) else casadi.SX(float(value))


def _remainder(x: casadi.SX, y: casadi.SX) -> casadi.SX:
    """CasADi's fmod stands for the % of Python, which it is but for the sign; C gets it with Python's."""
    if x.is_constant() and y.is_constant():
        return casadi.SX(float(x) % float(y))
    return casadi.fmod(x, y)


OPERATIONS = {"neg": operator.neg, "pos": operator.pos, "fmod": _remainder}
"""Those that are not functions of CasADi."""


class CasadiSymbol(Symbol):
    """A real number or a truth value (0 or 1)."""

    __slots__ = ("expression",)

    def __init__(self, expression: casadi.SX) -> None:
        self.expression = expression

    def after(self, operation: str, *operands: Any) -> "CasadiSymbol":
        operate = OPERATIONS.get(operation) or getattr(casadi, operation)
        return CasadiSymbol(operate(*map(expression, operands)))
