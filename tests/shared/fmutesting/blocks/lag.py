"""A lag of first order: T dy/dt = u - y."""

from typing import Annotated, NamedTuple

from fmublocks import ContinuousBlock, Fmu, Real


class Parameters(NamedTuple):
    T: Annotated[float, Real("s", "time constant", 1e-3, 1e3)] = 0.5


class Input(NamedTuple):
    u: Annotated[float, Real("1", "input")] = 0.0


class State(NamedTuple):
    y: Annotated[float, Real("1", "output")]


def derivative(x: State, u: Input, p: Parameters) -> State:
    return State((u.u - x.y) / p.T)


BLOCK = ContinuousBlock(
    name="Lag",
    description="Lag of first order",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=State,
    start=lambda u, p: State(0.0),
    derivative=derivative,
    output=lambda x, u, p: x,
    step_size=0.01,
)

FMU = Fmu(BLOCK, stop_time=10.0)
