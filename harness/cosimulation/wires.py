"""The calls of a loop in the order in which they are made."""

from collections.abc import Sequence
from ctypes import c_double, sizeof
from typing import NamedTuple

from .calls import Call, advance, moves, receives, receives_rates, sends, sent
from .instance import Instance
from .lines import Line
from .row import Layout
from .schedule import Action, Get, GetRates, Move, Set, Step, Transfer, schedule
from .steps import MakeSteps, Steps
from .system import Scheme
from .wiring import Fit


class Wires(NamedTuple):
    """What the FMUs are bound to in all runs that give the same inputs under the same scheme.

    Attributes:
        layout: of the row.
        row: the instant at work, and behind it output derivatives.
        hand_over: calls that bring outputs to inputs, one instance after the other.
        steps: makes the steps.
    """

    layout: Layout
    row: bytearray
    hand_over: list[Call]
    steps: Steps


def wired(
    fitted: Fit,
    instances: Sequence[Instance],
    inputs: Sequence[str],
    scheme: Scheme,
    step_size: c_double,
    make_steps: MakeSteps,
) -> Wires:
    """Binds the FMUs to a row of memory.

    Args:
        inputs: `instance.variable` of those that are given from outside.
        step_size: communication step in s, as it is when the steps are made.

    Raises:
        WiringError: the scheme does not suit the system.
    """
    plan = schedule(scheme, fitted.system, fitted.interfaces)
    layout = Layout(fitted.interfaces, inputs)
    rates = [
        (f"{action.instance}.{name}", action.at_end)
        for action in plan.begin
        if isinstance(action, GetRates)
        for name in action.outputs
    ]
    places = {rate: layout.dtype.itemsize + sizeof(c_double) * n for n, rate in enumerate(rates)}
    row = bytearray(layout.dtype.itemsize + sizeof(c_double) * len(rates))
    feeds = {target: source for source, target, _ in fitted.system.connections}
    sources = {name: name for name in inputs} | feeds
    by_name = {instance.name: instance for instance in instances}
    send = {name: sends(instance, sources, row, layout) for name, instance in by_name.items()}

    def bound(action: Action) -> list[Call]:
        name = action.instance
        instance = by_name[name]
        match action:
            case Set():
                return send[name]
            case Step():
                return [advance(instance, row, step_size)]
            case Get(_, outputs):
                return receives(instance, row, layout, outputs)
            case GetRates(_, outputs, at_end):
                return [receives_rates(instance, row, outputs, places[f"{name}.{outputs[0]}", at_end])]
            case Move(_, variables, transfer):
                return moves(instance, variables, [line(name, v, transfer) for v in variables], step_size)

    def line(name: str, variable: str, transfer: Transfer) -> Line:
        source = feeds[f"{name}.{variable}"]
        place = [layout.offset(source), places.get((source, False)), places.get((source, True))]
        if transfer is Transfer.EXTRAPOLATED:
            place[0] = place[2] = None
        end, before, after = (None if p is None else c_double.from_buffer(row, p) for p in place)
        # of the calls that set inputs, the first is that for Reals
        last = sent(send[name][0], variable)
        return Line(last, by_name[name].interface.factors.get(variable, 1.0), end, before, after)

    begin, end = ([call for action in actions for call in bound(action)] for actions in plan)
    read = schedule(Scheme.GAUSS_SEIDEL, fitted.system, fitted.interfaces).begin
    hand_over = [call for action in read if not isinstance(action, Step) for call in bound(action)]
    return Wires(layout, row, hand_over, make_steps(begin, end, row, layout.known))
