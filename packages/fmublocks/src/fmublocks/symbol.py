"""What stands for a number when a function of a block is called to learn what it computes."""

from collections.abc import Callable
from typing import Any

Operator = Callable[..., Any]


def _operator(name: str) -> Operator:
    return lambda *operands: operands[0].after(name, *operands)


def _operators(name: str) -> tuple[Operator, Operator]:
    """The operator with the symbol on the left, and with it on the right alone."""
    return _operator(name), lambda *operands: operands[0].after(name, *reversed(operands))


class Symbol:
    """A number or truth value that is not known: the protocol of `fmublocks.block.operators`.

    A subclass says with `after(operation, *operands)` what an operation makes of its operands, which are
    symbols and numbers; the names of the operations are those of `fmublocks.native.arithmetic`.
    """

    __slots__ = ()

    def __bool__(self) -> bool:
        raise TypeError("what it chooses by is known in a run alone; `operators.where` takes such a condition")

    __add__, __radd__ = _operators("ADD")
    __sub__, __rsub__ = _operators("SUB")
    __mul__, __rmul__ = _operators("MUL")
    __truediv__, __rtruediv__ = _operators("DIV")
    __pow__, __rpow__ = _operators("POW")
    __mod__, __rmod__ = _operators("FMOD")
    __neg__, __abs__ = map(_operator, ("NEG", "FABS"))
    __lt__, __gt__ = _operators("LT")
    __le__, __ge__ = _operators("LE")
    __eq__, __ne__ = map(_operator, ("EQ", "NE"))
    __hash__ = object.__hash__

    def __pos__(self) -> "Symbol":
        return self

    sin, cos, atan, tanh = map(_operator, ("SIN", "COS", "ATAN", "TANH"))
    sqrt, log, exp, floor = map(_operator, ("SQRT", "LOG", "EXP", "FLOOR"))
    where, logical_and, logical_or, logical_not = map(_operator, ("CHOICE", "AND", "OR", "NOT"))
