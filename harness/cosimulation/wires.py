"""The calls of a loop in the order in which they are made."""

from collections.abc import Iterable, Mapping, Sequence
from ctypes import c_double
from itertools import chain
from typing import NamedTuple

from .calls import Call, advance, receives, sends
from .instance import Instance
from .row import Layout
from .steps import MakeSteps, Steps
from .system import Connection, Scheme


class Wires(NamedTuple):
    """What the FMUs are bound to in all runs that give the same inputs.

    Attributes:
        layout: of the row.
        row: the instant at work.
        hand_over: calls that bring outputs to inputs, one instance after the other.
        steps: makes the steps.
    """

    layout: Layout
    row: bytearray
    hand_over: list[Call]
    steps: Mapping[Scheme, Steps]


def wired(
    instances: Sequence[Instance],
    connections: Iterable[Connection],
    inputs: Sequence[str],
    step_size: c_double,
    make_steps: MakeSteps,
) -> Wires:
    """Binds the FMUs to a row of memory.

    Args:
        inputs: `instance.variable` of those that are given from outside.
        step_size: communication step in s, as it is when the steps are made.
    """
    layout = Layout({instance.name: instance.interface for instance in instances}, inputs)
    row = bytearray(layout.dtype.itemsize)
    sources = {name: name for name in inputs} | {target: source for source, target, _ in connections}
    send = [sends(instance, sources, row, layout) for instance in instances]
    step = [[advance(instance, row, step_size)] for instance in instances]
    receive = [receives(instance, row, layout) for instance in instances]
    one_by_one, together = zip(send, step, receive, strict=True), (send, step, receive)
    orders = {Scheme.GAUSS_SEIDEL: one_by_one, Scheme.JACOBI: together}
    calls = {scheme: [*chain(*chain(*order))] for scheme, order in orders.items()}
    return Wires(
        layout,
        row,
        [*chain(*chain(*zip(send, receive, strict=True)))],
        {scheme: make_steps(order, row, layout.known) for scheme, order in calls.items()},
    )
