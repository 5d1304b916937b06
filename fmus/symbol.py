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
    """A number or truth value that is not known: the protocol of `models.block.operators`.

    A subclass says with `after(operation, *operands)` what an operation makes of its operands, which are
    symbols and numbers; the operations have CasADi's names.
    """

    __slots__ = ()

    def __bool__(self) -> bool:
        raise TypeError("a model function branches on data; it must call `where` of models.block.operators")

    __add__, __radd__ = _operators("plus")
    __sub__, __rsub__ = _operators("minus")
    __mul__, __rmul__ = _operators("times")
    __truediv__, __rtruediv__ = _operators("rdivide")
    __pow__, __rpow__ = _operators("power")
    __mod__, __rmod__ = _operators("fmod")
    __neg__, __pos__, __abs__ = map(_operator, ("neg", "pos", "fabs"))
    __lt__, __le__, __gt__, __ge__ = map(_operator, ("lt", "le", "gt", "ge"))
    __eq__, __ne__ = map(_operator, ("eq", "ne"))
    __hash__ = object.__hash__

    sin, cos, atan, tanh = map(_operator, ("sin", "cos", "atan", "tanh"))
    sqrt, log, exp, floor = map(_operator, ("sqrt", "log", "exp", "floor"))
    where, logical_and, logical_or, logical_not = map(_operator, ("if_else", "logic_and", "logic_or", "logic_not"))
