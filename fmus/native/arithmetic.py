"""The operations of a CasADi function as a graph, and which of them can be left out at run time.

CasADi writes `where` as the sum of two products with a truth value, so that both values are always
computed. Here it becomes a choice again, and what only one side of a choice needs is found, so that
costly operations can be put into a branch.
"""

from collections.abc import Iterable
from typing import NamedTuple

import casadi

ARITHMETIC = ("ADD", "SUB", "MUL", "DIV", "NEG", "SQ", "TWICE", "INV", "FABS", "SIGN", "FLOOR", "CEIL", "SQRT")

TRANSCENDENTAL = ("SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "ATAN2", "SINH", "COSH", "TANH", "EXP", "LOG")

COSTLY = ("FMOD", "POW", "CONSTPOW", *TRANSCENDENTAL)
"""Operations worth a branch."""

TRUTH_VALUES = ("LT", "LE", "EQ", "NE", "NOT", "AND", "OR")

OPERATIONS = {
    getattr(casadi, f"OP_{name}"): name
    for name in (*ARITHMETIC, *COSTLY, *TRUTH_VALUES, "FMIN", "FMAX", "COPYSIGN", "IF_ELSE_ZERO")
}
"""Names of CasADi's operations by their numbers."""


class Node(NamedTuple):
    """One operation.

    Attributes:
        operation: a name in OPERATIONS, "CHOICE" (condition, value, otherwise), "INPUT" or "CONSTANT".
        operands: numbers of other nodes.
        value: number of the input and of its element, or the constant.
    """

    operation: str
    operands: tuple[int, ...] = ()
    value: tuple[int, int] | float = 0.0


Guard = tuple[int, bool]
"""A condition (number of its node) and the value that it must have."""


class Graph:
    """All operations that the outputs need; equal ones are one.

    Attributes:
        nodes: each after its operands.
        outputs: for every element of the output its node.
    """

    def __init__(self, function: casadi.Function) -> None:
        self.nodes: list[Node] = []
        self._numbers: dict[Node, int] = {}
        self.outputs: dict[int, int] = {}
        held: dict[int, int] = {}
        for k in range(function.n_instructions()):
            operation = function.instruction_id(k)
            to, of = function.instruction_output(k), function.instruction_input(k)
            if operation == casadi.OP_INPUT:
                held[to[0]] = self._number(Node("INPUT", (), (of[0], of[1])))
            elif operation == casadi.OP_CONST:
                held[to[0]] = self._number(Node("CONSTANT", (), function.instruction_constant(k)))
            elif operation == casadi.OP_OUTPUT:
                self.outputs[to[1]] = held[of[0]]
            else:
                held[to[0]] = self._operation(OPERATIONS[operation], tuple(held[k] for k in of))

    def _number(self, node: Node) -> int:
        if node not in self._numbers:
            self._numbers[node] = len(self.nodes)
            self.nodes.append(node)
        return self._numbers[node]

    def _operation(self, operation: str, operands: tuple[int, ...]) -> int:
        if operation == "ADD":
            value, otherwise = (self.nodes[k] for k in operands)
            if value.operation == otherwise.operation == "CHOICE":
                condition, negated = value.operands[0], self.nodes[otherwise.operands[0]]
                if negated == Node("NOT", (condition,)):
                    return self._number(Node("CHOICE", (condition, value.operands[1], otherwise.operands[1])))
        if operation == "IF_ELSE_ZERO":
            return self._number(Node("CHOICE", (*operands, self._number(Node("CONSTANT", (), 0.0)))))
        return self._number(Node(operation, operands))

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

    def guards(self) -> dict[int, frozenset[Guard]]:
        """For every needed node under which conditions alone it is; only what saves something costly."""
        guards = self._guards(None)
        worth = {g for k, of in guards.items() if self.nodes[k].operation in COSTLY for g in of}
        return self._guards({condition for condition, _ in worth})

    def _guards(self, conditions: Iterable[int] | None) -> dict[int, frozenset[Guard]]:
        users, guards = self.users(), {}
        results = set(self.outputs.values())
        for k in sorted(users, reverse=True):
            needed = [
                guards[user] | ({side} if side and (conditions is None or side[0] in conditions) else frozenset())
                for user, side in users[k]
            ]
            guards[k] = frozenset() if k in results or not needed else frozenset.intersection(*needed)
        return guards
