"""The states of a continuous block and their derivatives, which a host that integrates sees beside the variables."""

from ...models.block.declaration import Real, variables
from ...models.block.types import Block, ContinuousBlock
from .units import rate_unit
from .variables import Variable, interface


def state_name(field: str) -> str:
    """What an FMU calls a state; outputs may have the name of the field."""
    return f"x.{field}"


def rate_name(field: str) -> str:
    """What an FMU calls the derivative of a state."""
    return f"der({state_name(field)})"


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
    rates = [
        Variable(
            state.reference + len(shown),
            rate_name(name),
            "local",
            Real(rate_unit(declaration.unit), f"rate of change of {state.name}"),
            None,
            state.reference,
        )
        for state, (name, declaration) in zip(shown, declared, strict=True)
    ]
    return (*shown, *rates)


def event_indicators(block: ContinuousBlock) -> int:
    """How many event indicators a block has."""
    u, p = block.Input(), block.Parameters()
    return len(block.event_indicators(block.start(u, p), u, p))
