"""Functions of numbers as the operations that they make."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from fmublocks.native.arithmetic import COMPUTED, Node, Recording, TracedGraph, TracedSymbol, node_of
from fmublocks.native.trace import Traced, leaves


def recorded(of: Callable[..., Any], *vectors: Sequence[str]) -> TracedGraph:
    """Those of a function of as many numbers as these vectors have names in C; it gives one number or many."""
    recording = Recording()
    symbols = [
        TracedSymbol(recording, recording.number(Node("INPUT", (), (vector, element))))
        for vector, names in enumerate(vectors)
        for element in range(len(names))
    ]
    values = [node_of(value, recording) for value in leaves((of(*symbols),))]
    return TracedGraph(recording, values, range(len(vectors)), vectors)


def computed(function: Traced, *arguments: Sequence[float]) -> list[float]:
    """What a traced function makes of numbers."""
    numbers = dict(zip(function.vectors, arguments, strict=True))
    value_of = values(function.recording, function.values, lambda vector, element: numbers[vector][element])
    return [float(value_of[k]) for k in function.values]


def values(recording: Recording, needed: Sequence[int], input_value: Callable[[int, int], Any]) -> Mapping[int, Any]:
    """Those of nodes, by their numbers."""
    value_of: dict[int, Any] = {}
    with np.errstate(all="ignore"):
        for k in recording.needed(needed):
            node = recording.nodes[k]
            if node.operation == "INPUT":
                value_of[k] = np.float64(input_value(*node.place))
            elif node.operation == "CONSTANT":
                value_of[k] = np.float64(node.number)
            else:
                value_of[k] = COMPUTED[node.operation](*(value_of[operand] for operand in node.operands))
    return value_of
