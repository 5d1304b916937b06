"""The calls of a loop in the order in which they are made."""

from collections.abc import Callable, Sequence
from ctypes import c_double, sizeof
from typing import NamedTuple

from .calls import Call, advance, receives, receives_rates, sends, sends_rates
from .instance import Instance
from .row import Layout
from .schedule import Action, Get, GetRates, Set, SetRates, Step, Transfer, schedule
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
    rates = [f"{a.instance}.{name}" for a in plan.begin if isinstance(a, GetRates) for name in a.outputs]
    places = {name: layout.dtype.itemsize + sizeof(c_double) * n for n, name in enumerate(rates)}
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
            case GetRates():
                return [receives_rates(instance, row, places)]
            case SetRates(_, variables, transfer):
                lines = transfer is Transfer.INTERPOLATED
                place: Callable[[str], int] = layout.offset if lines else places.__getitem__
                ends = [place(feeds[f"{name}.{variable}"]) for variable in variables]
                # of the calls that set its inputs, the first is that for Reals
                return [sends_rates(instance, variables, ends, row, send[name][0], step_size if lines else None)]

    begin, end = ([call for action in actions for call in bound(action)] for actions in plan)
    read = schedule(Scheme.GAUSS_SEIDEL, fitted.system, fitted.interfaces).begin
    hand_over = [call for action in read if not isinstance(action, Step) for call in bound(action)]
    return Wires(layout, row, hand_over, make_steps(begin, end, row, layout.known))
