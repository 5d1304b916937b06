"""What follows from the state of a continuous block, which a host that integrates sees beside the variables."""

from ..block.declaration import Real, variables
from ..block.types import Block, ContinuousBlock
from .units import rate_unit
from .variables import Variable, interface


def state_name(field: str) -> str:
    """What an FMU calls a state; outputs may have the name of the field."""
    return f"x.{field}"


def rate_name(name: str) -> str:
    """What an FMU calls the derivative of a variable."""
    return f"der({name})"


def rate(of: Variable, reference: int, causality: str, description: str, start: float | None = None) -> Variable:
    """The derivative of a variable, as a variable with that value reference."""
    declaration = Real(rate_unit(of.declaration.unit if isinstance(of.declaration, Real) else ""), description)
    return Variable(reference, rate_name(of.name), causality, declaration, start, of.reference)


def states(block: Block) -> tuple[Variable, ...]:
    """All states in the order of declaration, then their derivatives in that order; none for a sampled block."""
    if not isinstance(block, ContinuousBlock):
        return ()
    first = len(interface(block))
    declared = [(v.name, v.declaration) for v in variables(block.State) if isinstance(v.declaration, Real)]
    shown = [
        Variable(reference, state_name(name), "local", declaration, None)
        for reference, (name, declaration) in enumerate(declared, first)
    ]
    return (*shown, *(rate(v, v.reference + len(shown), "local", f"rate of change of {v.name}") for v in shown))


def event_indicators(block: Block) -> tuple[Variable, ...]:
    """The event indicators, which are variables in FMI 3.0 alone; none for a sampled block."""
    if not isinstance(block, ContinuousBlock):
        return ()
    u, p = block.Input(), block.Parameters()
    first = len(interface(block)) + len(states(block))
    return tuple(
        Variable(first + n, f"event_indicator[{n + 1}]", "local", Real("1", "changes its sign at an event"), None)
        for n in range(len(block.event_indicators(block.start(u, p), u, p)))
    )


MOVES = "rate at which the input moves during communication steps"


def shown_by_fmi3(block: Block) -> tuple[Variable, ...]:
    """What FMI 3.0 has beside the interface: states, event indicators, the time, and for each Real input of a
    continuous block its rate of change.

    FMI 2.0 has a function that lets inputs move during a step, FMI 3.0 has none.
    """
    listed, exchanged = interface(block), states(block) + event_indicators(block)
    time = Variable(len(listed) + len(exchanged), "time", "independent", Real("s", "time"), None)
    inputs = [v for v in listed if v.causality == "input" and isinstance(v.declaration, Real)]
    moving = inputs if isinstance(block, ContinuousBlock) else []
    rates = (rate(v, time.reference + 1 + v.reference, "input", MOVES, 0.0) for v in moving)
    return (*exchanged, time, *rates)
