"""An oscillator without damping: dx/dt = v, dv/dt = -omega^2 x."""

from typing import Annotated, NamedTuple

from fmublocks import ContinuousBlock, Fmu, Real


class Parameters(NamedTuple):
    omega: Annotated[float, Real("rad/s", "angular frequency", 0.0, 1e3)] = 6.0
    x_0: Annotated[float, Real("m", "position at the start", -1e3, 1e3)] = 1.0


class Input(NamedTuple):
    pass


class State(NamedTuple):
    x: Annotated[float, Real("m", "position")]
    v: Annotated[float, Real("m/s", "speed")]


BLOCK = ContinuousBlock(
    name="Oscillator",
    description="Oscillator without damping",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=State,
    start=lambda u, p: State(p.x_0, 0.0),
    derivative=lambda x, u, p: State(x.v, -p.omega * p.omega * x.x),
    output=lambda x, u, p: x,
    step_size=0.01,
)

FMU = Fmu(BLOCK, stop_time=10.0)
