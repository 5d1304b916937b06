"""The calls of a loop in the order in which they are made."""

from collections.abc import Iterable, Mapping, Sequence
from ctypes import c_double, sizeof
from typing import NamedTuple

from .calls import Call, advance, moves, receives, receives_rates, sends, sent
from .input_lines import Line
from .instance import Instance
from .row_layout import Layout
from .schedule import Action, Get, GetRates, Move, Schedule, Set, Step, Transfer, schedule
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
    every: Mapping[str, int] | None = None,
) -> Wires:
    """Binds the FMUs to a row of memory.

    Args:
        inputs: `instance.variable` of those that are given from outside.
        step_size: communication step in s, as it is when the steps are made.
        every: instances that make a step every so many steps.

    Raises:
        WiringError: the scheme does not suit the system.
    """
    every = every or {}
    plan = schedule(scheme, fitted.system, fitted.interfaces, every)
    memory = _memory(Layout(fitted.interfaces, inputs), plan)
    binding = _Binding(fitted, instances, inputs, step_size, memory, every)
    begin, end = binding.calls(plan.begin), [call._replace(lead=1) for call in binding.calls(plan.end)]
    read = schedule(Scheme.GAUSS_SEIDEL, fitted.system, fitted.interfaces).begin
    hand_over = binding.calls(action for action in read if not isinstance(action, Step))
    steps = make_steps(begin, end, memory.row, memory.layout.known)
    return Wires(memory.layout, memory.row, hand_over, steps)


class _Memory(NamedTuple):
    """The row, and at which byte behind its columns each output derivative is, by the output and whether at the end."""

    layout: Layout
    row: bytearray
    rates: Mapping[tuple[str, bool], int]


def _memory(layout: Layout, plan: Schedule) -> _Memory:
    """Zeros, with room for the output derivatives that are read."""
    size = layout.dtype.itemsize
    rates: dict[tuple[str, bool], int] = {}
    for action in plan.begin:
        if isinstance(action, GetRates):
            for name in action.outputs:
                rates[f"{action.instance}.{name}", action.at_end] = size
                size += sizeof(c_double)
    return _Memory(layout, bytearray(size), rates)


class _Binding:
    """Makes the calls of actions, which work on the memory."""

    def __init__(
        self,
        fitted: Fit,
        instances: Sequence[Instance],
        inputs: Sequence[str],
        step_size: c_double,
        memory: _Memory,
        every: Mapping[str, int],
    ) -> None:
        self._every = every
        self._instances = {instance.name: instance for instance in instances}
        self._feeds = {target: source for source, target, _ in fitted.system.connections}
        self._step_size = step_size
        self._memory = memory
        sources = {name: name for name in inputs} | self._feeds
        self._sends = {
            name: sends(instance, sources, memory.row, memory.layout) for name, instance in self._instances.items()
        }

    def calls(self, actions: Iterable[Action]) -> list[Call]:
        """Those of actions; the step of an instance, and what comes after it, is counted by the end of the step."""
        calls: list[Call] = []
        stepped: set[str] = set()
        for action in actions:
            if isinstance(action, Step):
                stepped.add(action.instance)
            due = {"every": self._every.get(action.instance, 1), "lead": int(action.instance in stepped)}
            calls += [call._replace(**due) for call in self._bound(action)]
        return calls

    def _bound(self, action: Action) -> list[Call]:
        layout, row, rates = self._memory
        name = action.instance
        instance = self._instances[name]
        match action:
            case Set():
                return self._sends[name]
            case Step():
                return [advance(instance, row, self._step_size, self._every.get(name, 1))]
            case Get(_, outputs):
                return receives(instance, row, layout, outputs)
            case GetRates(_, outputs, at_end):
                return [receives_rates(instance, row, outputs, rates[f"{name}.{outputs[0]}", at_end])]
            case Move(_, variables, transfer):
                lines = [self._line(instance, variable, transfer) for variable in variables]
                return moves(instance, variables, lines, self._step_size)

    def _line(self, instance: Instance, variable: str, transfer: Transfer) -> Line:
        """Along which a source lets an input move."""
        layout, row, rates = self._memory
        source = self._feeds[f"{instance.name}.{variable}"]
        end, after = layout.offset(source), rates.get((source, True))
        if transfer is Transfer.EXTRAPOLATED:
            end = after = None
        places = end, rates.get((source, False)), after
        numbers = (None if place is None else c_double.from_buffer(row, place) for place in places)
        # of the calls that set inputs, the first is that for Reals
        last = sent(self._sends[instance.name][0], variable)
        return Line(last, instance.interface.factors.get(variable, 1.0), *numbers)
