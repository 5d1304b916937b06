"""What is done in a step and in which order, as data: a schedule for each scheme.

Gauss-Seidel steps one instance after the other and hands each the newest outputs: an instance that
comes later gets what those before it put out at the end of the step. Jacobi gives all of them the
outputs of the beginning of the step.

The propagated scheme gives all of them the values of the beginning, too, but lets continuous signals
move over the step: along a straight line that fits what the source did (input_lines.py) where that has been
stepped before, else along the derivative of the source. At the end, outputs go on to inputs along the declared
dependencies, so that every output is that of its instant, with the inputs of that instant.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from enum import Enum
from typing import NamedTuple

from .feedthrough import Feedthrough
from .interface import Interface
from .system import Scheme, System


class Transfer(Enum):
    """How an input that a continuous signal feeds goes on during a step."""

    INTERPOLATED = "interpolated"
    EXTRAPOLATED = "extrapolated"
    HELD = "held"


class Set(NamedTuple):
    """All inputs of an instance are set."""

    instance: str


class Step(NamedTuple):
    """An instance makes the communication step."""

    instance: str


class Get(NamedTuple):
    """Outputs of an instance are read."""

    instance: str
    outputs: Sequence[str]


class GetRates(NamedTuple):
    """Output derivatives of an instance are read, at the beginning of the step or at its end."""

    instance: str
    outputs: Sequence[str]
    at_end: bool = False


class Move(NamedTuple):
    """Inputs of an instance are set to move during the step: they interpolate, or extrapolate."""

    instance: str
    inputs: Sequence[str]
    transfer: Transfer


Action = Set | Step | Get | GetRates | Move


class Schedule(NamedTuple):
    """The actions of a step.

    Attributes:
        begin: with what is known of the beginning of the step.
        end: with what is known of its end.
    """

    begin: Sequence[Action]
    end: Sequence[Action] = ()


def schedule(
    scheme: Scheme, system: System, interfaces: Mapping[str, Interface], slow: Collection[str] = ()
) -> Schedule:
    """The schedule of a system, whose instances step in the order of the interfaces.

    Args:
        slow: instances with longer steps; what goes in and comes out of them is held.

    Raises:
        WiringError: propagation meets an algebraic loop.
    """
    if scheme is Scheme.PROPAGATED:
        return _propagated(system, interfaces, slow)
    send = [Set(name) for name in interfaces]
    step = [Step(name) for name in interfaces]
    receive = [Get(name, [v.name for v in interface.of_causality("output")]) for name, interface in interfaces.items()]
    if scheme is Scheme.JACOBI:
        return Schedule([*send, *step, *receive])
    return Schedule([action for actions in zip(send, step, receive, strict=True) for action in actions])


def transfers(system: System, interfaces: Mapping[str, Interface], slow: Collection[str] = ()) -> dict[str, Transfer]:
    """How the propagated scheme treats each input of a continuous FMU that a continuous output feeds."""
    order = list(interfaces)
    feedthrough = Feedthrough(system, interfaces)
    transfer_of: dict[str, Transfer] = {}
    for source, target, _ in system.connections:
        (giver, output), (taker, taken) = source.split(".", 1), target.split(".", 1)
        is_ready = source in feedthrough.undeclared or not feedthrough.inputs[source]
        if not (_is_continuous(interfaces[giver], output) and _any_continuous(interfaces[taker])):
            continue
        if not interfaces[taker].can_move(taken) or {giver, taker} & {*slow}:
            transfer_of[target] = Transfer.HELD
        elif order.index(giver) < order.index(taker) and is_ready:
            transfer_of[target] = Transfer.INTERPOLATED
        elif _claims(interfaces[giver]).maxOutputDerivativeOrder:
            transfer_of[target] = Transfer.EXTRAPOLATED
        else:
            transfer_of[target] = Transfer.HELD
    return transfer_of


def described(transfer_of: Mapping[str, Transfer]) -> str:
    """What to say of these transfers."""
    how = [f"{name} is {transfer.value}" for name, transfer in transfer_of.items()]
    return f"over a step {', '.join(how)}" if how else "over a step every input is held"


def _claims(interface: Interface):
    claims = interface.description.coSimulation
    assert claims is not None
    return claims


def _is_continuous(interface: Interface, output: str) -> bool:
    variable = interface.variables[output]
    return variable.type == "Real" and variable.variability in (None, "continuous")


def _any_continuous(interface: Interface) -> bool:
    return any(_is_continuous(interface, v.name) for v in interface.of_causality("output"))


def _propagated(system: System, interfaces: Mapping[str, Interface], slow: Collection[str]) -> Schedule:
    feedthrough = Feedthrough(system, interfaces)
    how = transfers(system, interfaces, slow)
    feeds = {target: source for source, target, _ in system.connections}
    lines, tangents = (
        _by_instance(n for n in how if how[n] is t) for t in (Transfer.INTERPOLATED, Transfer.EXTRAPOLATED)
    )
    ends = _by_instance(feeds[name] for name in how if how[name] is Transfer.INTERPOLATED)
    rates = _by_instance(feeds[name] for name in how if how[name] is not Transfer.HELD)
    rates = {name: outputs for name, outputs in rates.items() if _claims(interfaces[name]).maxOutputDerivativeOrder}
    begin: list[Action] = [
        *(Set(name) for name in interfaces),
        *(GetRates(*item) for item in rates.items()),
        *(Move(*item, Transfer.EXTRAPOLATED) for item in tangents.items()),
    ]
    known: set[str] = set()
    for name, interface in interfaces.items():
        if name in lines:
            begin.append(Move(name, lines[name], Transfer.INTERPOLATED))
        begin.append(Step(name))
        if name in ends:
            free = [v.name for v in interface.of_causality("output") if not feedthrough.inputs[f"{name}.{v.name}"]]
            begin.append(Get(name, list(dict.fromkeys([*free, *ends[name]]))))
            known.update(f"{name}.{output}" for output in free)
            if name in rates:
                begin.append(GetRates(name, ends[name], at_end=True))
    return Schedule(begin, list(_propagation(feedthrough, known)))


def _propagation(feedthrough: Feedthrough, known: set[str]) -> Iterator[Action]:
    for outputs in feedthrough.propagation(known):
        ((instance, names),) = _by_instance(outputs).items()
        if any(feedthrough.inputs[output] for output in outputs):
            yield Set(instance)
        yield Get(instance, names)


def _by_instance(names: Iterable[str]) -> dict[str, list[str]]:
    """Variables by instance, of names `instance.variable`, each once."""
    variables: dict[str, list[str]] = {}
    for instance, _, variable in (name.partition(".") for name in dict.fromkeys(names)):
        variables.setdefault(instance, []).append(variable)
    return variables
