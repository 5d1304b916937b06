"""Operations as a graph, and which of them can be left out at run time.

What only one side of a choice needs is found, so that it can be put into a branch. A choice between equal values is
that value, and so is a limitation to limits between which it is already. One among the elements of an array, by the
whole part of a number, is a look-up.
"""

import operator
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..symbol import Symbol

TRUTH_VALUES = ("LT", "LE", "EQ", "NE", "NOT", "AND", "OR")

COMPUTED: dict[str, Callable[..., Any]] = {
    "ADD": operator.add,
    "SUB": operator.sub,
    "MUL": operator.mul,
    "DIV": operator.truediv,
    "NEG": operator.neg,
    "SQ": np.square,
    "TWICE": partial(operator.mul, 2.0),
    "INV": partial(operator.truediv, 1.0),
    "FABS": abs,
    "SIGN": np.sign,
    "FLOOR": np.floor,
    "FMOD": operator.mod,
    "POW": operator.pow,
    "LT": operator.lt,
    "LE": operator.le,
    "EQ": operator.eq,
    "NE": operator.ne,
    "AND": np.logical_and,
    "OR": np.logical_or,
    "NOT": np.logical_not,
    "CHOICE": np.where,
    "SQRT": np.sqrt,
    "LOG": np.log,
    "EXP": np.exp,
    "SIN": np.sin,
    "COS": np.cos,
    "ATAN": np.arctan,
    "TANH": np.tanh,
    "WHOLE": np.float64,
}
"""What operations make of numbers."""

LOOKED_UP = 4
"""Choices by the whole part of a number that are worth a look-up."""


class Node(NamedTuple):
    """One operation.

    Attributes:
        operation: a name in COMPUTED, as "CHOICE" (condition, value, otherwise) or "WHOLE" (an index as a real number);
            "INPUT", "CONSTANT", "INDEX" (the whole part of a number, not less than 0 and not more than the value) or
            "ELEMENT" (of an array, by an index from its element in `value`).
        operands: numbers of other nodes.
        value: number of the input and of its element, or the constant.
    """

    operation: str
    operands: tuple[int, ...] = ()
    value: tuple[int, int] | float = 0.0

    @property
    def place(self) -> tuple[int, int]:
        """Number of the input and of its element."""
        assert isinstance(self.value, tuple)
        return self.value

    @property
    def number(self) -> float:
        """The constant."""
        assert not isinstance(self.value, tuple)
        return self.value


Guard = tuple[int, bool]
"""A condition (number of its node) and the value that it must have."""


class Ladder(NamedTuple):
    """Choices by the whole part of a number: n <= position ? v[n] : (... 1 <= position ? v[1] : v[0]).

    Attributes:
        position: node of the number.
        first: v[0].
        count: n.
    """

    position: int
    first: Node
    count: int  # pyright: ignore[reportIncompatibleMethodOverride]


class Graph:
    """Operations, equal ones of which are one; at first there are none.

    Attributes:
        inputs: for every input of the function and each of its elements what C calls it.
        nodes: each after its operands.
        outputs: for every element of the output its node.
    """

    def __init__(self, inputs: Sequence[Sequence[str]]) -> None:
        self.inputs = list(inputs)
        self.nodes: list[Node] = []
        self.outputs: dict[int, int] = {}
        self._numbers: dict[Node, int] = {}

    def number(self, node: Node) -> int:
        """That of an operation, which is added if it is new."""
        if node not in self._numbers:
            self._numbers[node] = len(self.nodes)
            self.nodes.append(node)
        return self._numbers[node]

    def users(self) -> dict[int, list[tuple[int, Guard | None]]]:
        """For every node that the outputs need: who uses it, and on which side of a choice."""
        users: dict[int, list[tuple[int, Guard | None]]] = {k: [] for k in self.outputs.values()}
        for k in range(len(self.nodes) - 1, -1, -1):
            if k not in users:
                continue
            node = self.nodes[k]
            for place, operand in enumerate(node.operands):
                side = (node.operands[0], place == 1) if node.operation == "CHOICE" and place else None
                users.setdefault(operand, []).append((k, side))
        return users

    def guards(self, least: int = 1) -> dict[int, frozenset[Guard]]:
        """For every needed node under which conditions alone it is; only those that save so many operations."""
        guards = self._guards(None)
        saved = Counter(condition for k, of in guards.items() if self.nodes[k].operands for condition, _ in of)
        return self._guards({condition for condition, count in saved.items() if count >= least})

    def _guards(self, conditions: Iterable[int] | None) -> dict[int, frozenset[Guard]]:
        users = self.users()
        guards: dict[int, frozenset[Guard]] = {}
        results, none = set(self.outputs.values()), frozenset[Guard]()
        for k in sorted(users, reverse=True):
            needed = [
                guards[user] | ({side} if side and (conditions is None or side[0] in conditions) else none)
                for user, side in users[k]
            ]
            guards[k] = none if k in results or not needed else frozenset.intersection(*needed)
        return guards


class Recording(Graph):
    """What symbols compute, in its order; nothing is simplified but operations on constants."""

    def __init__(self) -> None:
        super().__init__([])

    def constant(self, value: float) -> int:
        """The node of a number."""
        return self.number(Node("CONSTANT", (), value))

    def is_constant(self, k: int, *values: float) -> bool:
        """Whether a node is a constant, one of these if any are given."""
        node = self.nodes[k]
        return node.operation == "CONSTANT" and (not values or node.value in values)

    def after(self, operation: str, *operands: int) -> int:
        """The node of an operation on others."""
        if operation == "POW":
            return self._power(*operands)
        if all(map(self.is_constant, operands)):
            with np.errstate(all="ignore"):
                numbers = (np.float64(self.nodes[k].number) for k in operands)
                return self.constant(float(COMPUTED[operation](*numbers)))
        return self.number(Node(operation, operands))

    def _power(self, base: int, exponent: int) -> int:
        """By products, where the exponent is a whole number from 1 on."""
        count = self.nodes[exponent].value
        if not (self.is_constant(exponent) and count in range(1, 100)):
            return self.number(Node("POW", (base, exponent)))
        assert not isinstance(count, tuple)
        if count == 1.0:
            return base
        if count % 2.0:
            return self.after("MUL", base, self._power(base, self.constant(count - 1.0)))
        half = self._power(base, self.constant(count / 2.0))
        return self.after("MUL", half, half)

    def needed(self, outputs: Iterable[int]) -> list[int]:
        """The nodes that others need, and these, in their order."""
        needed, waiting = set[int](), list(outputs)
        while waiting:
            k = waiting.pop()
            if k not in needed:
                needed.add(k)
                waiting += self.nodes[k].operands
        return sorted(needed)


class TracedGraph(Graph):
    """The operations of one function.

    Args:
        recording: has them.
        outputs: their nodes there.
        vectors: the numbers there of its inputs.
    """

    def __init__(
        self, recording: Recording, outputs: Sequence[int], vectors: Sequence[int], inputs: Sequence[Sequence[str]]
    ) -> None:
        super().__init__(inputs)
        self._ladders: dict[int, Ladder] = {}
        held: dict[int, int] = {}
        for k in recording.needed(outputs):
            node = recording.nodes[k]._replace(operands=tuple(held[operand] for operand in recording.nodes[k].operands))
            if node.operation == "INPUT":
                vector, element = node.place
                node = node._replace(value=(vectors.index(vector), element))
            held[k] = self._choice(*node.operands) if node.operation == "CHOICE" else self.number(node)
        self.outputs = {element: held[k] for element, k in enumerate(outputs)}

    def _choice(self, condition: int, value: int, otherwise: int) -> int:
        if value == otherwise:
            return value
        ladder = self._ladder(condition, value, otherwise)
        if ladder and ladder.count >= LOOKED_UP:
            index = self.number(Node("INDEX", (ladder.position,), float(ladder.count)))
            whole = ladder.first.operation == "CONSTANT"
            number = self.number(Node("WHOLE", (index,)) if whole else Node("ELEMENT", (index,), ladder.first.value))
        else:
            number = self.number(Node("CHOICE", (condition, value, otherwise)))
        if ladder:
            self._ladders[number] = ladder
        outer = self._limited(number)
        inner = outer and self._limited(outer[0])
        return outer[0] if outer and inner and inner[1:] == outer[1:] else number

    def _limited(self, k: int) -> tuple[int, int, int] | None:
        """x, lower and upper of a node that is clip(x, lower, upper)."""
        if self.nodes[k].operation != "CHOICE":
            return None
        below, above, upper = self.nodes[k].operands
        if self.nodes[above].operation != "CHOICE" or self.nodes[below] != Node("LT", (above, upper)):
            return None
        over, x, lower = self.nodes[above].operands
        return (x, lower, upper) if self.nodes[over] == Node("LT", (lower, x)) else None

    def _ladder(self, condition: int, value: int, otherwise: int) -> Ladder | None:
        """That of a choice, if it is one."""
        comparison = self.nodes[condition]
        if comparison.operation != "LE" or self.nodes[comparison.operands[0]].operation != "CONSTANT":
            return None
        position, count = comparison.operands[1], self.nodes[comparison.operands[0]].value
        below = Ladder(position, self.nodes[otherwise], 0) if count == 1.0 else self._ladders.get(otherwise)
        if below is None or (below.position, below.count + 1.0) != (position, count):
            return None
        ladder = below._replace(count=below.count + 1)
        return ladder if self.nodes[value] == self._after(ladder.first, ladder.count) else None

    def _after(self, first: Node, count: int) -> Node | None:
        """The value so many places after the first of a ladder: a whole number or an element of an array."""
        if first == Node("CONSTANT"):
            return Node("CONSTANT", (), float(count))
        if first.operation != "INPUT":
            return None
        vector, element = first.place
        names = self.inputs[vector][element : element + count + 1]
        is_array = names[0].endswith("]") and len({name.rpartition("[")[0] for name in names}) == 1
        return Node("INPUT", (), (vector, element + count)) if is_array and len(names) > count else None


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
        nodes = (node_of(operand, self.recording) for operand in operands)
        return TracedSymbol(self.recording, self.recording.after(operation, *nodes))


def node_of(value: Any, recording: Recording) -> int:
    """The node of a symbol, a number or a truth value."""
    return value.node if isinstance(value, TracedSymbol) else recording.constant(float(value))
