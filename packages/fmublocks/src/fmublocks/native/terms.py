"""Terms of a block that depend on few of its arguments: C computes them once, when these are set.

Those of the parameters alone stand behind these, those of parameters and inputs are computed once for all stages of a
step. Python computes them every time, by the same operations, so that the bits are the same.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from typing import Any

import numpy as np

from .arithmetic import COMPUTED, TRUTH_VALUES, Graph, Node

TERMS = "terms"
"""What C calls the array of those that stand behind the parameters."""


class Terms(Graph):
    """Those of some functions of a block; equal ones are one.

    Args:
        name: what C calls the array of them.
    """

    def __init__(self, name: str) -> None:
        super().__init__([])
        self._name = name
        self._places: dict[int, int] = {}

    def take(self, graph: Graph, vectors: Sequence[int]) -> None:
        """Takes the terms out of a graph that depend on its inputs of these numbers alone: they become inputs."""
        self.inputs = [graph.inputs[vector] for vector in vectors]
        same = dict(self._same(graph, vectors))
        for k in sorted(_first(graph, lambda k: k in same and _is_term(graph.nodes[k]))):
            place = self._places.setdefault(same[k], len(self._places))
            self.outputs[place] = same[k]
            graph.nodes[k] = Node("INPUT", (), (len(graph.inputs), place))
        graph.inputs.append(self.names())

    def by_inputs(self) -> Iterator[tuple[tuple[str, ...], Graph]]:
        """Which elements of the first vector terms depend on, and a graph of those that depend on the same ones."""
        alike: dict[tuple[str, ...], dict[int, int]] = {}
        for place, k in self.outputs.items():
            alike.setdefault(self._inputs_of(k), {})[place] = k
        for inputs, outputs in alike.items():
            part = copy(self)
            part.outputs = outputs
            yield inputs, part

    def _inputs_of(self, k: int) -> tuple[str, ...]:
        of = copy(self)
        of.outputs = {0: k}
        inputs = sorted(self.nodes[n] for n in of.users() if self.nodes[n].operation in ("INPUT", "ELEMENT"))
        return tuple(self.inputs[0][node.place[1]] for node in inputs if node.place[0] == 0)

    def names(self) -> list[str]:
        """What C calls each of them."""
        return [f"{self._name}[{n}]" for n in range(len(self.outputs))]

    def _same(self, graph: Graph, vectors: Sequence[int]) -> Iterator[tuple[int, int]]:
        """The nodes of a graph that need no other inputs, and the same ones here."""
        same: dict[int, int] = {}
        for k, node in enumerate(graph.nodes):
            if node.operation in ("INPUT", "ELEMENT"):
                of, element = node.place
                if of not in vectors:
                    continue
                node = node._replace(value=(vectors.index(of), element))
            if all(operand in same for operand in node.operands):
                same[k] = self.number(node._replace(operands=tuple(same[operand] for operand in node.operands)))
                yield k, same[k]

    def values(self, parameters: Sequence[float]) -> list[float]:
        """Those that depend on parameters alone, for values of these."""
        p, value_of = np.array(parameters, float), dict[int, Any]()
        with np.errstate(all="ignore"):
            for k in sorted(self.users()):
                value_of[k] = _value(self.nodes[k], p, value_of)
        return [float(value_of[k]) for _, k in sorted(self.outputs.items())]


def _value(node: Node, p: np.ndarray, value_of: Mapping[int, Any]) -> Any:
    operands = [value_of[k] for k in node.operands]
    match node.operation:
        case "CONSTANT":
            return np.float64(node.number)
        case "INPUT":
            return p[node.place[1]]
        case "INDEX":
            return int(np.clip(np.nan_to_num(operands[0]), 0.0, node.number))
        case "ELEMENT":
            return p[node.place[1] + operands[0]]
        case operation:
            return COMPUTED[operation](*operands)


def _is_term(node: Node) -> bool:
    """Whether it is worth a place: a number that takes more than a change of sign."""
    return bool(node.operands) and node.operation not in (*TRUTH_VALUES, "INDEX", "NEG")


def _first(graph: Graph, wanted: Callable[[int], bool]) -> set[int]:
    """The wanted nodes that the outputs need, without those that only wanted ones need."""
    first, seen, waiting = set[int](), set[int](), list(graph.outputs.values())
    while waiting:
        k = waiting.pop()
        if k in seen:
            continue
        seen.add(k)
        if wanted(k):
            first.add(k)
        else:
            waiting += graph.nodes[k].operands
    return first
