"""Torque-controlled motor: a second-order lag from demanded to air-gap torque (paper, eq. (1)).

    tau^2 d2T_mot/dt2 + sqrt(2) tau dT_mot/dt + T_mot = T_ref,   |T_ref| limited to T_max

Three more effects are off until their parameters are set: the demand acts t_dead later (physics.dead_time); above
omega_base the power is constant, and T_max falls with omega_base/|omega_1| (field weakening); the torque follows
the rate dT_mot/dt of the lag within +-dT_max.

Motor control reports the torque with the error of its estimate, and the speed as the resolver gives it.
The noise is held for T_s; sample k of it is a pure function of the seed and k.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Integer, Real
from fmublocks.block.frame import Content, Frame
from fmublocks.block.noise import normals
from fmublocks.block.operators import clip, cos, exp, floor, logical_and, logical_or, maximum, sin, where
from fmublocks.block.types import ContinuousBlock

from .physics import dead_time
from .physics.dead_time import Line
from .physics.vehicle import CAR, MotorLag, MotorTorque

SQRT_2 = 2.0**0.5
NOISE = 0.0

OMEGA_MAX = 5000.0
"""Largest speed of the motor in rad/s."""


class Parameters(NamedTuple):
    tau: MotorLag = CAR.tau
    T_max: MotorTorque = CAR.T_max
    g_T: Annotated[float, Real("1", "gain of the torque estimate", 0.5, 2.0, tunable=True)] = 1.0
    o_T: Annotated[float, Real("N.m", "offset of the torque estimate", -50.0, 50.0, tunable=True)] = 0.0
    sigma_T: Annotated[float, Real("N.m", "standard deviation of the torque estimate", 0.0, 50.0, tunable=True)] = 0.3
    sigma_omega: Annotated[
        float, Real("rad/s", "standard deviation of the measured speed", 0.0, 10.0, tunable=True)
    ] = 0.15
    q_omega: Annotated[float, Real("rad/s", "resolution of the measured speed, 0 for none", 0.0, 10.0)] = 0.1
    T_s: Annotated[float, Real("s", "interval for which a sample of the noise is held", 1e-4, 0.1)] = 0.002
    seed: Annotated[int, Integer("seed of the noise", 0, 1_000_000)] = 1
    t_dead: Annotated[float, Real("s", "dead time of the demand; below 0.1 ms none", 0.0, 0.01)] = 0.0
    dT_max: Annotated[float, Real("N.m/s", "largest rate of the torque; 1e7 limits none", 10.0, 1e8, tunable=True)] = (
        1e7
    )
    omega_base: Annotated[
        float, Real("rad/s", "speed above which the power is constant; 5000 is never reached", 10.0, 1e4, tunable=True)
    ] = OMEGA_MAX


class Input(NamedTuple):
    T_ref: Annotated[float, Real("N.m", "demanded motor torque", -2000.0, 2000.0, 100.0)] = 0.0
    omega_1: Annotated[float, Real("rad/s", "speed of the motor", -OMEGA_MAX, OMEGA_MAX, 100.0)] = 0.0


class State(NamedTuple):
    T_mot: Annotated[float, Real("N.m", "air-gap torque")]
    dT_mot: Annotated[float, Real("N.m/s", "rate of the air-gap torque, before its limit", nominal=1e4)]
    sample: Annotated[float, Real("1", "time in samples of the noise")]
    d_0: Annotated[float, Real("N.m", "demand in the dead time, filtered")]
    d_1: Annotated[float, Real("N.m", "first derivative of d_0 times t_dead")]
    d_2: Annotated[float, Real("N.m", "second derivative of d_0 times t_dead^2")]
    d_3: Annotated[float, Real("N.m", "third derivative of d_0 times t_dead^3")]


class Output(NamedTuple):
    T_mot: Annotated[float, Real("N.m", "air-gap torque of the motor")]
    T_mot_est: Annotated[float, Real("N.m", "air-gap torque as motor control estimates it")]
    omega_1_meas: Annotated[float, Real("rad/s", "speed of the motor as the resolver measures it")]


def largest(omega_1: float, p: Parameters) -> float:
    """The largest torque in N.m that the motor has at a speed (rad/s)."""
    return p.T_max * (p.omega_base / maximum(abs(omega_1), p.omega_base))


def limited(T: float, omega_1: float, p: Parameters) -> float:
    """A torque in N.m, limited to what the motor has at a speed (rad/s)."""
    T_max = largest(omega_1, p)
    return clip(T, -T_max, T_max)


def start(u: Input, p: Parameters) -> State:
    """Stationary at the demanded torque."""
    T_mot = limited(u.T_ref, u.omega_1, p)
    return State(T_mot=T_mot, dT_mot=0.0, sample=0.0, d_0=u.T_ref, d_1=0.0, d_2=0.0, d_3=0.0)


def line(x: State) -> Line:
    return Line(x.d_0, x.d_1, x.d_2, x.d_3)


def delayed_demand(x: State, u: Input, p: Parameters) -> float:
    """T_ref as it was t_dead ago, in N.m."""
    return dead_time.delayed(line(x), u.T_ref, p.t_dead)


def derivative(x: State, u: Input, p: Parameters) -> State:
    T_ref = limited(delayed_demand(x, u, p), u.omega_1, p)
    d_0, d_1, d_2, d_3 = dead_time.rates(line(x), u.T_ref, p.t_dead)
    return State(
        T_mot=clip(x.dT_mot, -p.dT_max, p.dT_max),
        dT_mot=(T_ref - x.T_mot - SQRT_2 * p.tau * x.dT_mot) / (p.tau * p.tau),
        sample=1.0 / p.T_s,
        d_0=d_0,
        d_1=d_1,
        d_2=d_2,
        d_3=d_3,
    )


def solution(x: State, u: Input, du: Input, p: Parameters, h: float) -> tuple[bool, State]:
    """The lag in closed form: about the response r(t) to a demand that moves along a line,

        T_mot = r + E (e cos at + (e + de/a) sin at),   E = exp(-at),   a = 1/(sqrt(2) tau)
        dT_mot = dr + E (de cos at - (de + 2 a e) sin at),   r = T_ref + dT_ref (t - sqrt(2) tau)

    e and de are the distances from r and dr at the beginning. It holds without dead time, as long as the demand stays
    within the largest torque or is held beyond it, and what the rate comes to at most is less than dT_max.
    """
    a, late = 1.0 / (SQRT_2 * p.tau), SQRT_2 * p.tau
    end, omega_1 = u.T_ref + du.T_ref * h, maximum(abs(u.omega_1), abs(u.omega_1 + du.omega_1 * h))
    T_max = largest(omega_1, p)
    within = maximum(abs(u.T_ref), abs(end)) <= T_max
    held = logical_and(du.T_ref == 0.0, logical_or(du.omega_1 == 0.0, omega_1 <= p.omega_base))
    T_ref = clip(u.T_ref, -T_max, T_max)

    e, de = x.T_mot - (T_ref - du.T_ref * late), x.dT_mot - du.T_ref
    free = abs(du.T_ref) + 2.0 * (abs(de) + a * abs(e)) < p.dT_max
    E, c, s = exp(-(a * h)), cos(a * h), sin(a * h)
    return logical_and(logical_and(p.t_dead < dead_time.LEAST, free), logical_or(within, held)), x._replace(
        T_mot=T_ref + du.T_ref * (h - late) + E * (e * c + (e + late * de) * s),
        dT_mot=du.T_ref + E * (de * c - (de + 2.0 * a * e) * s),
        sample=x.sample + 1.0 / p.T_s * h,
    )


def noise_sample(x: State) -> float:
    """The number of the sample of the noise that is held."""
    return floor(x.sample + 1e-6)


def output(x: State, u: Input, p: Parameters) -> Output:
    k = noise_sample(x)
    noise_omega, noise_T = normals(p.seed, NOISE, k)
    omega_1 = u.omega_1 + p.sigma_omega * noise_omega
    steps = floor(omega_1 / maximum(p.q_omega, 1e-9) + 0.5)
    return Output(
        T_mot=x.T_mot,
        T_mot_est=p.g_T * x.T_mot + p.o_T + p.sigma_T * noise_T,
        omega_1_meas=where(p.q_omega > 0.0, steps * p.q_omega, omega_1),
    )


def event_indicators(x: State, u: Input, p: Parameters) -> tuple[float, ...]:
    """The torque changes at its largest rate, the delayed demand reaches the largest torque, the speed omega_base."""
    T_max = largest(u.omega_1, p)
    T_ref = delayed_demand(x, u, p)
    return (x.dT_mot - p.dT_max, x.dT_mot + p.dT_max, T_ref - T_max, T_ref + T_max, abs(u.omega_1) - p.omega_base)


def next_event(x: State, u: Input, p: Parameters) -> float:
    """Time in s to the next sample of the noise."""
    return (noise_sample(x) + 1.0 - x.sample) * p.T_s


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
    event_indicators=event_indicators,
    solution=solution,
    next_event=next_event,
    step_size=0.001,
    frames=FRAMES,
)
