"""A number that is not known yet, as a node of a graph of operations."""

from typing import Any

from ..symbol import Symbol
from .arithmetic import Recording


class TracedSymbol(Symbol):
    """A real number or a truth value (0 or 1).

    Attributes:
        recording: the graph.
        node: its number there.
    """

    __slots__ = ("node", "recording")

    def __init__(self, recording: Recording, node: int) -> None:
        self.recording, self.node = recording, node

    def after(self, operation: str, *operands: Any) -> "TracedSymbol":
        nodes = (node_of(each, self.recording) for each in operands)
        return TracedSymbol(self.recording, self.recording.after(operation, *nodes))


def node_of(value: Any, recording: Recording) -> int:
    """The node of a symbol, a number or a truth value."""
    return value.node if isinstance(value, TracedSymbol) else recording.constant(float(value))
