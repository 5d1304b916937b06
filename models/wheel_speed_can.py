"""Wheel speed as it reaches the controller: coarse, late, and absent at low speed.

Every T_cyc the ABS unit takes the speeds of both driven wheels from their teeth (tooth_wheel),
rounds each to q_v and sends a message; its flag `valid` is set above v_on and cleared below v_off.
The message arrives after a random transport delay, never overtaking another, unless it is lost.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Boolean, Integer, Real
from fmublocks.block.frame import Content, Frame
from fmublocks.block.noise import uniform
from fmublocks.block.operators import branch, floor, logical_and, logical_or, maximum, minimum, where
from fmublocks.block.types import SampledBlock

from .physics import tooth_wheel
from .physics.tooth_wheel import ToothWheel
from .physics.vehicle import CAR, GearRatio, WheelRadius

T_S = 0.001
"""Sample time in s; the ABS unit works at whole multiples of it."""

SLOTS = 6
"""Messages that can be under way: the longest delay over the shortest cycle, and one."""

NEVER = 1e12
"""Arrival in s of a message that does not exist or is lost."""

LEAST_SPACING = 1e-4
"""Shortest time in s between two arrivals."""

TOOTH_L, TOOTH_R, PHASE, DELAY, LOSS = 10.0, 20.0, 30.0, 31.0, 32.0


OMEGA_MAX = 500.0
"""Largest speed of a wheel in rad/s."""


class Message(NamedTuple):
    """A message on the bus."""

    arrival: Annotated[float, Real("s", "time of its arrival")]
    speed: Annotated[float, Real("rad/s", "mean speed of the driven wheels, motor side")]
    valid: Annotated[bool, Boolean("flag")]


class Parameters(NamedTuple):
    i: GearRatio = CAR.i
    r: WheelRadius = CAR.r
    g_w2: Annotated[float, Real("1", "gain error of the speed, from the wheel radius", 0.8, 1.25)] = 1.0
    sigma_tooth: Annotated[float, Real("1", "standard deviation of the edges, in teeth", 0.0, 0.05)] = 0.005
    T_cyc: Annotated[float, Real("s", "cycle of the messages, rounded to whole milliseconds", 0.01, 0.5)] = 0.02
    q_v: Annotated[float, Real("m/s", "resolution of the speed on the bus", 0.0, 1.0)] = 0.0625 / 3.6
    v_on: Annotated[float, Real("m/s", "speed above which the message becomes valid", 0.0, 20.0)] = 5.0 / 3.6
    v_off: Annotated[float, Real("m/s", "speed below which the message becomes invalid", 0.0, 20.0)] = 3.0 / 3.6
    d_min: Annotated[float, Real("s", "shortest transport delay", 0.001, 0.05, tunable=True)] = 0.001
    d_max: Annotated[float, Real("s", "longest transport delay", 0.001, 0.05, tunable=True)] = 0.025
    loss: Annotated[float, Real("1", "probability that a message is lost", 0.0, 1.0, tunable=True)] = 0.0
    seed: Annotated[int, Integer("seed of phase, teeth, delays and losses", 0, 1_000_000)] = 1


class Input(NamedTuple):
    omega_wheel_L: Annotated[float, Real("rad/s", "speed of the left driven wheel", -OMEGA_MAX, OMEGA_MAX, 50.0)] = 0.0
    omega_wheel_R: Annotated[float, Real("rad/s", "speed of the right driven wheel", -OMEGA_MAX, OMEGA_MAX, 50.0)] = 0.0


class State(NamedTuple):
    sample: Annotated[float, Real("1", "number of the sample")]
    next_call: Annotated[float, Real("1", "sample of the next call of the ABS unit")]
    message: Annotated[float, Real("1", "number of the next message")]
    wheel_L: ToothWheel
    wheel_R: ToothWheel
    sent_valid: Annotated[bool, Boolean("flag of the message sent last")]
    last_arrival: Annotated[float, Real("s", "arrival of the last message that is not lost")]
    next_arrival: Annotated[float, Real("s", "arrival of the next message")]
    under_way: Annotated[tuple[Message, ...], Real("1", "newest first")]
    omega_2_can: Annotated[float, Real("rad/s", "speed in the message that arrived last")]
    valid: Annotated[bool, Boolean("flag of the message that arrived last")]
    counter: Annotated[int, Integer("messages that have arrived", 0)]


class Output(NamedTuple):
    omega_2_can: Annotated[float, Real("rad/s", "mean speed of the driven wheels, motor side, as received")]
    valid: Annotated[bool, Boolean("the received speed is above the minimum speed")]
    counter: Annotated[int, Integer("one more with every message that arrives", 0)]


def bus_speed(omega_L: float, omega_R: float, p: Parameters) -> float:
    """Mean speed in m/s of both wheels, each rounded to the resolution of the bus."""
    q = maximum(p.q_v, 1e-9)
    return 0.5 * q * (floor(p.r * omega_L / q + 0.5) + floor(p.r * omega_R / q + 0.5))


def cycle(p: Parameters) -> float:
    return floor(p.T_cyc / T_S + 0.5)


def start(u: Input, p: Parameters) -> State:
    """The speed known at t = 0, no message under way, the first call after a random phase."""
    v = bus_speed(abs(u.omega_wheel_L), abs(u.omega_wheel_R), p)
    omega_2 = p.g_w2 * v * p.i / p.r
    return State(
        sample=0.0,
        next_call=floor(uniform(p.seed, PHASE, 0.0) * cycle(p)),
        message=0.0,
        wheel_L=tooth_wheel.start(u.omega_wheel_L, TOOTH_L, p),
        wheel_R=tooth_wheel.start(u.omega_wheel_R, TOOTH_R, p),
        sent_valid=v > p.v_on,
        last_arrival=0.0,
        next_arrival=NEVER,
        under_way=(Message(NEVER, 0.0, False),) * SLOTS,
        omega_2_can=omega_2,
        valid=v > p.v_on,
        counter=0,
    )


def update(x: State, u: Input, p: Parameters) -> State:
    now = (x.sample + 1.0) * T_S
    turned = x._replace(
        sample=x.sample + 1.0,
        wheel_L=tooth_wheel.turn(x.wheel_L, u.omega_wheel_L, now, T_S, TOOTH_L, p),
        wheel_R=tooth_wheel.turn(x.wheel_R, u.omega_wheel_R, now, T_S, TOOTH_R, p),
    )
    sent = branch(x.sample >= x.next_call, lambda: call(turned, now, p), lambda: turned)
    return branch(sent.next_arrival <= now + 1e-9, lambda: deliver(sent, now + 1e-9), lambda: sent)


def call(x: State, now: float, p: Parameters) -> State:
    """After a call of the ABS unit, with its message on the bus."""
    wheel_L = tooth_wheel.call(x.wheel_L, now)
    wheel_R = tooth_wheel.call(x.wheel_R, now)
    v = bus_speed(wheel_L.speed, wheel_R.speed, p)
    valid = logical_or(v > p.v_on, logical_and(v >= p.v_off, x.sent_valid))
    delay = p.d_min + maximum(p.d_max - p.d_min, 0.0) * uniform(p.seed, DELAY, x.message)
    arrival = maximum(now - T_S + delay, x.last_arrival + LEAST_SPACING)
    lost = uniform(p.seed, LOSS, x.message) < p.loss
    sent = Message(where(lost, NEVER, arrival), p.g_w2 * v * p.i / p.r, valid)
    return x._replace(
        next_call=x.next_call + cycle(p),
        message=x.message + 1.0,
        wheel_L=wheel_L,
        wheel_R=wheel_R,
        sent_valid=valid,
        last_arrival=where(lost, x.last_arrival, arrival),
        next_arrival=minimum(x.next_arrival, sent.arrival),
        under_way=(sent, *x.under_way[:-1]),
    )


def deliver(x: State, now: float) -> State:
    """What has arrived by now is taken off the bus, and the newest of it is kept."""
    omega, valid, counter, following = x.omega_2_can, x.valid, x.counter, NEVER
    waiting: list[Message] = []
    for message in reversed(x.under_way):
        arrived = message.arrival <= now
        omega = where(arrived, message.speed, omega)
        valid = where(arrived, message.valid, valid)
        counter = where(arrived, counter + 1, counter)
        waiting.append(message._replace(arrival=where(arrived, NEVER, message.arrival)))
        following = minimum(following, waiting[-1].arrival)
    return x._replace(
        next_arrival=following,
        under_way=tuple(reversed(waiting)),
        omega_2_can=omega,
        valid=valid,
        counter=counter,
    )


def output(x: State, u: Input, p: Parameters) -> Output:
    return Output(omega_2_can=x.omega_2_can, valid=x.valid, counter=x.counter)


FRAME = Frame(
    identifier=0x1A0,
    name="WheelSpeed",
    meaning="what the ABS unit says of the driven wheels",
    sender="ABS",
    receiver="Controller",
    cycle=lambda p: cycle(p) * T_S,
    contents=(
        Content(
            "Wheel_Speed",
            "omega_2_can",
            "km/h",
            bits=16,
            resolution=lambda p: 0.5 * p.q_v * 3.6,  # the mean of two wheels, each rounded to q_v
            factor=lambda p: 3.6 * p.r / (p.g_w2 * p.i),
            largest=lambda p: 3.6 * p.r * OMEGA_MAX,
            meaning="mean speed of the driven wheels over ground",
        ),
        Content("Wheel_Speed_Valid", "valid", "", bits=1),
        Content("Wheel_Speed_Counter", "counter", "", bits=8),
    ),
    counter="counter",
)

BLOCK = SampledBlock(
    name="WheelSpeedCan",
    description="Wheel speed from the ABS over CAN: coarse, late, absent at low speed",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Output,
    start=start,
    output=output,
    update=update,
    sample_time=T_S,
    frames=(FRAME,),
)
