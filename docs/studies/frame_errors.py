"""Errors of the frame that motor control sends: late as a whole or in part, or with a periodic error.

A block between the sensors and the controller, with the interface of SignalFaults, which delays one signal alone.
"""

from typing import Annotated, NamedTuple

from driveline.fmus.fmu import Fmu
from driveline.models.block.declaration import Real
from driveline.models.block.operators import interpolate, sin, where
from driveline.models.block.types import SampledBlock
from driveline.models.signal_faults import T_S, Input, Signals

HISTORY = 60
"""Samples that are kept."""

TURN = 6.283185307179586
"""A full turn in rad."""

Delay = Annotated[float, Real("s", "by which the signal is late", 0.0, (HISTORY - 1) * T_S)]


class Parameters(NamedTuple):
    begin: Annotated[float, Real("s", "instant from which the errors act", 0.0, 1e6)] = 0.0
    late_omega_1: Delay = 0.0
    late_T_mot: Delay = 0.0
    e_omega_1: Annotated[float, Real("rad/s", "amplitude of the periodic error of the speed", 0.0, 1000.0)] = 0.0
    e_T_mot: Annotated[float, Real("N.m", "amplitude of the periodic error of the torque", 0.0, 1000.0)] = 0.0
    frequency: Annotated[float, Real("Hz", "of the periodic errors", 0.0, 250.0)] = 0.0


class State(NamedTuple):
    sample: Annotated[float, Real("1", "number of the sample")]
    omega_1: Annotated[tuple[float, ...], Real("rad/s", "speeds that were sent, newest first")]
    T_mot: Annotated[tuple[float, ...], Real("N.m", "torques that were sent, newest first")]


def start(u: Input, p: Parameters) -> State:
    return State(0.0, (u.omega_1_sent,) * HISTORY, (u.T_mot_sent,) * HISTORY)


def update(x: State, u: Input, p: Parameters) -> State:
    return State(x.sample + 1.0, (u.omega_1_sent, *x.omega_1[:-1]), (u.T_mot_sent, *x.T_mot[:-1]))


def output(x: State, u: Input, p: Parameters) -> Signals:
    acts = (x.sample + 0.5) * T_S >= p.begin
    error = where(acts, sin(TURN * p.frequency * x.sample * T_S), 0.0)
    omega_1 = interpolate((u.omega_1_sent, *x.omega_1), where(acts, p.late_omega_1, 0.0) / T_S)
    T_mot = interpolate((u.T_mot_sent, *x.T_mot), where(acts, p.late_T_mot, 0.0) / T_S)
    return Signals(
        omega_1_meas=omega_1 + p.e_omega_1 * error,
        T_mot_est=T_mot + p.e_T_mot * error,
        omega_2_can=u.omega_2_sent,
        valid=u.valid_sent,
        counter=u.counter_sent,
    )


BLOCK = SampledBlock(
    name="FrameErrors",
    description="Errors of the frame that motor control sends",
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
