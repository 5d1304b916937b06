"""Derivatives of recorded operations along given rates of what they depend on, in forward mode.

A rate that is zero is no node at all, so that what does not move takes no operations.
"""

from collections.abc import Callable, Iterable, Mapping

from .arithmetic import Recording

Rate = int | None
"""The node of a rate; None: it is zero."""


def rates(recording: Recording, values: Iterable[int], moving: Mapping[int, int]) -> list[int]:
    """The nodes of the rates of values.

    Args:
        moving: nodes that move, and the nodes of their rates.
    """
    values, algebra = list(values), _Algebra(recording)
    rate_of: dict[int, Rate] = dict(moving)
    for k in recording.needed(values):
        if k not in rate_of:
            operands = recording.nodes[k].operands
            rate_of[k] = algebra.rate(k, [rate_of[operand] for operand in operands])
    return [algebra.node(rate_of[k]) for k in values]


class _Algebra:
    """Operations on nodes that leave out what changes nothing."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording

    def node(self, rate: Rate) -> int:
        """Of a rate that may be zero."""
        return self._recording.constant(0.0) if rate is None else rate

    def rate(self, k: int, rates: list[Rate]) -> Rate:
        """That of a node whose operands have these."""
        operation, operands, _ = self._recording.nodes[k]
        if operation == "CHOICE":
            return self._choice(operands[0], *rates[1:])
        if all(rate is None for rate in rates):
            return None
        match operation:
            case "ADD":
                return self._plus(*rates)
            case "SUB":
                return self._plus(rates[0], self._negative(rates[1]))
            case "NEG":
                return self._negative(rates[0])
            case "MUL":
                return self._plus(self._times(operands[1], rates[0]), self._times(operands[0], rates[1]))
            case "DIV":
                part = self._over(rates[0], operands[1])
                return self._plus(part, self._negative(self._times(self._op("DIV", k, operands[1]), rates[1])))
            case "FLOOR" | "LT" | "LE" | "EQ" | "NE" | "AND" | "OR" | "NOT":
                return None
            case "FMOD" if rates[1] is None:
                return rates[0]
        if operation not in PARTIAL:
            raise TypeError(f"{operation.lower()} has no derivative here")
        return self._times(PARTIAL[operation](self._recording, k, operands[0]), rates[0])

    def _op(self, operation: str, *operands: int) -> int:
        return self._recording.after(operation, *operands)

    def _plus(self, a: Rate, b: Rate) -> Rate:
        if a is None or b is None:
            return b if a is None else a
        if a == b:
            return self._op("TWICE", a)
        if self._recording.nodes[b].operation == "NEG":
            return self._op("SUB", a, *self._recording.nodes[b].operands)
        if self._recording.nodes[a].operation == "NEG":
            return self._op("SUB", b, *self._recording.nodes[a].operands)
        return self._op("ADD", a, b)

    def _negative(self, a: Rate) -> Rate:
        if a is None:
            return None
        node = self._recording.nodes[a]
        return node.operands[0] if node.operation == "NEG" else self._op("NEG", a)

    def _times(self, a: int, rate: Rate) -> Rate:
        if rate is None or self._recording.is_constant(a, 0.0):
            return None
        if self._recording.is_constant(a, 1.0):
            return rate
        if self._recording.is_constant(rate, 1.0):
            return a
        for factor, other in ((a, rate), (rate, a)):
            if self._recording.nodes[factor].operation == "NEG":
                (inner,) = self._recording.nodes[factor].operands
                return self._negative(self._times(inner, other))
            if self._recording.is_constant(factor, -1.0):
                return self._negative(other)
        if self._recording.nodes[a].operation == "INV":
            return self._op("DIV", rate, *self._recording.nodes[a].operands)
        return self._op("MUL", a, rate)

    def _over(self, rate: Rate, b: int) -> Rate:
        return None if rate is None else self._op("DIV", rate, b)

    def _choice(self, condition: int, value: Rate, otherwise: Rate) -> Rate:
        if value == otherwise:
            return value
        return self._op("CHOICE", condition, self.node(value), self.node(otherwise))


PARTIAL: Mapping[str, Callable[[Recording, int, int], int]] = {
    "SIN": lambda of, f, x: of.after("COS", x),
    "COS": lambda of, f, x: of.after("NEG", of.after("SIN", x)),
    "ATAN": lambda of, f, x: of.after("INV", of.after("ADD", of.constant(1.0), of.after("SQ", x))),
    "TANH": lambda of, f, x: of.after("SUB", of.constant(1.0), of.after("SQ", f)),
    "SQRT": lambda of, f, x: of.after("INV", of.after("TWICE", f)),
    "EXP": lambda of, f, x: f,
    "LOG": lambda of, f, x: of.after("INV", x),
    "FABS": lambda of, f, x: of.after("SIGN", x),
}
"""Of functions of one number x, whose value is f."""
