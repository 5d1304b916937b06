"""Periodic errors of the frame that motor control sends; all other faults of signals are those of SignalFaults.

A block between the sensors and the controller, with the interface of SignalFaults.
"""

from typing import Annotated, NamedTuple

from driveline.models.signal_faults import T_S, Begin, Input, Signals
from fmublocks.block.declaration import Real
from fmublocks.block.operators import sin, where
from fmublocks.block.types import SampledBlock
from fmublocks.fmu import Fmu

TURN = 6.283185307179586
"""A full turn in rad."""


class Parameters(NamedTuple):
    begin: Begin = 0.0
    e_omega_1: Annotated[float, Real("rad/s", "amplitude of the error of the speed", 0.0, 1000.0)] = 0.0
    e_T_mot: Annotated[float, Real("N.m", "amplitude of the error of the torque", 0.0, 1000.0)] = 0.0
    frequency: Annotated[float, Real("Hz", "of the errors", 0.0, 250.0)] = 0.0


class State(NamedTuple):
    sample: Annotated[float, Real("1", "number of the sample")]


def start(u: Input, p: Parameters) -> State:
    return State(0.0)


def update(x: State, u: Input, p: Parameters) -> State:
    return State(x.sample + 1.0)


def output(x: State, u: Input, p: Parameters) -> Signals:
    acts = (x.sample + 0.5) * T_S >= p.begin
    error = where(acts, sin(TURN * p.frequency * x.sample * T_S), 0.0)
    sent = Signals(*u)
    return sent._replace(
        omega_1_meas=sent.omega_1_meas + p.e_omega_1 * error, T_mot_est=sent.T_mot_est + p.e_T_mot * error
    )


BLOCK = SampledBlock(
    name="PeriodicErrors",
    description="Periodic errors of the frame that motor control sends",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Signals,
    start=start,
    output=output,
    update=update,
    sample_time=T_S,
)

FMU = Fmu(BLOCK, stop_time=10.0)
