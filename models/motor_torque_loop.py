"""Torque-controlled motor: a second-order lag from demanded to air-gap torque (paper, eq. (1)).

    tau^2 d2T_mot/dt2 + sqrt(2) tau dT_mot/dt + T_mot = T_ref,   |T_ref| limited to T_max

and what motor control reports: the torque with the error of its estimate, the speed as the resolver
gives it. The noise is held for T_s; sample k of it is a pure function of the seed and k.
"""

from typing import Annotated, NamedTuple

from .block.declaration import Integer, Real
from .block.frame import Content, Frame
from .block.noise import normals
from .block.operators import clip, floor, maximum, where
from .block.types import ContinuousBlock
from .physics.vehicle import CAR, MotorLag, MotorTorque

SQRT_2 = 2.0**0.5
NOISE = 0.0


class Parameters(NamedTuple):
    tau: MotorLag = CAR.tau
    T_max: MotorTorque = CAR.T_max
    g_T: Annotated[float, Real("1", "gain of the torque estimate", 0.5, 2.0)] = 1.0
    o_T: Annotated[float, Real("N.m", "offset of the torque estimate", -50.0, 50.0)] = 0.0
    sigma_T: Annotated[float, Real("N.m", "standard deviation of the torque estimate", 0.0, 50.0)] = 0.3
    sigma_omega: Annotated[float, Real("rad/s", "standard deviation of the measured speed", 0.0, 10.0)] = 0.15
    q_omega: Annotated[float, Real("rad/s", "resolution of the measured speed, 0 for none", 0.0, 10.0)] = 0.1
    T_s: Annotated[float, Real("s", "interval for which a sample of the noise is held", 1e-4, 0.1)] = 0.002
    seed: Annotated[int, Integer("seed of the noise", 0, 1_000_000)] = 1


class Input(NamedTuple):
    T_ref: Annotated[float, Real("N.m", "demanded motor torque", -2000.0, 2000.0, 100.0)] = 0.0
    omega_1: Annotated[float, Real("rad/s", "speed of the motor", -5000.0, 5000.0, 100.0)] = 0.0


class State(NamedTuple):
    T_mot: Annotated[float, Real("N.m", "air-gap torque")]
    dT_mot: Annotated[float, Real("N.m/s", "rate of the air-gap torque")]
    sample: Annotated[float, Real("1", "time in samples of the noise")]


class Output(NamedTuple):
    T_mot: Annotated[float, Real("N.m", "air-gap torque of the motor")]
    T_mot_est: Annotated[float, Real("N.m", "air-gap torque as motor control estimates it")]
    omega_1_meas: Annotated[float, Real("rad/s", "speed of the motor as the resolver measures it")]


def start(u: Input, p: Parameters) -> State:
    """Stationary at the demanded torque."""
    return State(T_mot=clip(u.T_ref, -p.T_max, p.T_max), dT_mot=0.0, sample=0.0)


def derivative(x: State, u: Input, p: Parameters) -> State:
    T_ref = clip(u.T_ref, -p.T_max, p.T_max)
    return State(
        T_mot=x.dT_mot,
        dT_mot=(T_ref - x.T_mot - SQRT_2 * p.tau * x.dT_mot) / (p.tau * p.tau),
        sample=1.0 / p.T_s,
    )


def output(x: State, u: Input, p: Parameters) -> Output:
    k = floor(x.sample + 1e-6)
    noise_omega, noise_T = normals(p.seed, NOISE, k)
    omega_1 = u.omega_1 + p.sigma_omega * noise_omega
    steps = floor(omega_1 / maximum(p.q_omega, 1e-9) + 0.5)
    return Output(
        T_mot=x.T_mot,
        T_mot_est=p.g_T * x.T_mot + p.o_T + p.sigma_T * noise_T,
        omega_1_meas=where(p.q_omega > 0.0, steps * p.q_omega, omega_1),
    )


FRAMES = (
    Frame(
        identifier=0x1A1,
        name="MotorState",
        meaning="what motor control says of the motor",
        sender="Motor",
        receiver="Controller",
        cycle=lambda p: p.T_s,
        contents=(
            Content("Motor_Torque", "T_mot_est", "Nm", bits=32, resolution=None),
            Content("Motor_Speed", "omega_1_meas", "rad/s", bits=32, resolution=None),
        ),
    ),
    Frame(
        identifier=0x1A2,
        name="TorqueDemand",
        meaning="what motor control is to make",
        sender="Controller",
        receiver="Motor",
        cycle=lambda p: p.T_s,
        contents=(Content("Torque_Demand", "T_ref", "Nm", bits=32, resolution=None),),
    ),
)

BLOCK = ContinuousBlock(
    name="MotorTorqueLoop",
    description="Torque-controlled motor with the errors of its torque and speed signals",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Output,
    start=start,
    output=output,
    derivative=derivative,
    step_size=0.001,
    frames=FRAMES,
)
