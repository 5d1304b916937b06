"""A PI controller with a limit, whose integral stands still where the limit is reached.

u = k_p e + I    dI/dt = k_i e    e = r - y
"""

from typing import Annotated, Any, NamedTuple

from fmublocks import Fmu, Real, SampledBlock, operators

T_S = 0.01  # s


class Parameters(NamedTuple):
    k_p: Annotated[float, Real("1", "proportional gain", 0.0, 1e3)] = 2.0
    k_i: Annotated[float, Real("1/s", "integral gain", 0.0, 1e3)] = 5.0
    u_max: Annotated[float, Real("1", "limit of the control", 0.0, 1e6)] = 3.0


class Input(NamedTuple):
    r: Annotated[float, Real("1", "reference")] = 0.0
    y: Annotated[float, Real("1", "measurement")] = 0.0


class Output(NamedTuple):
    u: Annotated[float, Real("1", "control")]


class State(NamedTuple):
    integral: Annotated[float, Real("1", "of the control")]
    u: Annotated[float, Real("1", "control")]


def update(x: State, u: Input, p: Parameters) -> State:
    error = u.r - u.y
    demand = p.k_p * error + x.integral
    control = operators.clip(demand, -p.u_max, p.u_max)
    rate: Any = operators.where(demand == control, p.k_i * error, 0.0)
    return State(integral=x.integral + T_S * rate, u=control)


BLOCK = SampledBlock(
    name="PiController",
    description="PI controller",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Output,
    start=lambda u, p: State(0.0, 0.0),
    update=update,
    output=lambda x, u, p: Output(x.u),
    sample_time=T_S,
)

FMU = Fmu(BLOCK, stop_time=10.0)
