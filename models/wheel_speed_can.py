"""Wheel speed as it reaches the controller: coarse, late, and absent at low speed.

Every T_cyc the ABS unit takes the speeds of both driven wheels from their teeth (tooth_wheel),
rounds each to q_v and sends a message; its flag `valid` is set above v_on and cleared below v_off.
The message arrives after a random transport delay, never overtaking another, unless it is lost.
"""

from typing import Annotated, Any, NamedTuple

from . import tooth_wheel
from .block import Block
from .declaration import Boolean, Integer, Real
from .noise import uniform
from .operators import floor, logical_and, logical_or, maximum, where
from .vehicle import GearRatio, WheelRadius

T_S = 0.001
"""Sample time in s; the ABS unit works at whole multiples of it."""

SLOTS = 6
"""Messages that can be under way: the longest delay over the shortest cycle, and one."""

NEVER = 1e9
"""Time to arrival in s of a message that does not exist."""

LEAST_SPACING = 1e-4
"""Shortest time in s between two arrivals."""

TOOTH_L, TOOTH_R, PHASE, DELAY, LOSS = 10.0, 20.0, 30.0, 31.0, 32.0


class Parameters(NamedTuple):
    i: GearRatio = 9.0
    r: WheelRadius = 0.29
    g_w2: Annotated[float, Real("1", "gain error of the speed, from the wheel radius", 0.8, 1.25)] = 1.0
    sigma_tooth: Annotated[float, Real("1", "standard deviation of the edges, in teeth", 0.0, 0.1)] = 0.005
    T_cyc: Annotated[float, Real("s", "cycle of the messages, rounded to whole milliseconds", 0.01, 0.5)] = 0.02
    q_v: Annotated[float, Real("m/s", "resolution of the speed on the bus", 0.0, 1.0)] = 0.0625 / 3.6
    v_on: Annotated[float, Real("m/s", "speed above which the message becomes valid", 0.0, 20.0)] = 5.0 / 3.6
    v_off: Annotated[float, Real("m/s", "speed below which the message becomes invalid", 0.0, 20.0)] = 3.0 / 3.6
    d_min: Annotated[float, Real("s", "shortest transport delay", 0.001, 0.05)] = 0.001
    d_max: Annotated[float, Real("s", "longest transport delay", 0.001, 0.05)] = 0.025
    loss: Annotated[float, Real("1", "probability that a message is lost", 0.0, 1.0)] = 0.0
    seed: Annotated[int, Integer("seed of phase, teeth, delays and losses", 0, 1_000_000)] = 1


class Input(NamedTuple):
    omega_wheel_L: Annotated[float, Real("rad/s", "speed of the left driven wheel", -500.0, 500.0, 50.0)] = 0.0
    omega_wheel_R: Annotated[float, Real("rad/s", "speed of the right driven wheel", -500.0, 500.0, 50.0)] = 0.0


class State(NamedTuple):
    tick: Annotated[float, Real("1", "samples until the next call of the ABS unit")]
    message: Annotated[float, Real("1", "number of the next message")]
    wheel_L: Annotated[tuple[float, ...], Real("1", "left ToothWheel")]
    wheel_R: Annotated[tuple[float, ...], Real("1", "right ToothWheel")]
    sent_valid: Annotated[bool, Boolean("flag of the message sent last")]
    arrival: Annotated[tuple[float, ...], Real("s", "time to arrival of the messages under way")]
    speed: Annotated[tuple[float, ...], Real("rad/s", "speeds in the messages under way")]
    flag: Annotated[tuple[float, ...], Real("1", "flags of the messages under way, 1 for valid")]
    omega_2_can: Annotated[float, Real("rad/s", "speed in the message that arrived last")]
    valid: Annotated[bool, Boolean("flag of the message that arrived last")]
    counter: Annotated[Any, Real("1", "messages that have arrived")]


class Output(NamedTuple):
    omega_2_can: Annotated[float, Real("rad/s", "mean speed of the driven wheels, motor side, as received")]
    valid: Annotated[bool, Boolean("the received speed is above the minimum speed")]
    counter: Annotated[int, Integer("one more with every message that arrives", 0)]


def bus_speed(omega_L: Any, omega_R: Any, p: Parameters) -> Any:
    """Mean speed in m/s of both wheels, each rounded to the resolution of the bus."""
    q = maximum(p.q_v, 1e-9)
    return 0.5 * q * (floor(p.r * omega_L / q + 0.5) + floor(p.r * omega_R / q + 0.5))


def cycle(p: Parameters) -> Any:
    return floor(p.T_cyc / T_S + 0.5)


def start(u: Input, p: Parameters) -> State:
    """The speed known at t = 0, no message under way, the first call after a random phase."""
    v = bus_speed(abs(u.omega_wheel_L), abs(u.omega_wheel_R), p)
    return State(
        tick=floor(uniform(p.seed, PHASE, 0.0) * cycle(p)),
        message=0.0,
        wheel_L=tooth_wheel.start(u.omega_wheel_L, TOOTH_L, p),
        wheel_R=tooth_wheel.start(u.omega_wheel_R, TOOTH_R, p),
        sent_valid=v > p.v_on,
        arrival=(NEVER,) * SLOTS,
        speed=(0.0,) * SLOTS,
        flag=(0.0,) * SLOTS,
        omega_2_can=p.g_w2 * v * p.i / p.r,
        valid=v > p.v_on,
        counter=0.0,
    )


def update(x: State, u: Input, p: Parameters) -> State:
    call = x.tick <= 0.0
    turned_L = tooth_wheel.turn(tooth_wheel.ToothWheel(*x.wheel_L), u.omega_wheel_L, T_S, TOOTH_L, p)
    turned_R = tooth_wheel.turn(tooth_wheel.ToothWheel(*x.wheel_R), u.omega_wheel_R, T_S, TOOTH_R, p)
    called_L, called_R = tooth_wheel.call(turned_L), tooth_wheel.call(turned_R)

    v = bus_speed(called_L.speed, called_R.speed, p)
    valid = logical_or(v > p.v_on, logical_and(v >= p.v_off, x.sent_valid))
    return deliver(
        send(x, call, p.g_w2 * v * p.i / p.r, where(valid, 1.0, 0.0), p)._replace(
            tick=where(call, cycle(p), x.tick) - 1.0,
            message=where(call, x.message + 1.0, x.message),
            wheel_L=tuple(where(call, a, b) for a, b in zip(called_L, turned_L, strict=True)),
            wheel_R=tuple(where(call, a, b) for a, b in zip(called_R, turned_R, strict=True)),
            sent_valid=where(call, valid, x.sent_valid),
        )
    )


def send(x: State, call: Any, omega: Any, flag: Any, p: Parameters) -> State:
    """The bus with a new message on it, if there is a call; slot 0 holds the newest message."""
    delay = p.d_min + maximum(p.d_max - p.d_min, 0.0) * uniform(p.seed, DELAY, x.message)
    last = 0.0
    for arrival in x.arrival:
        last = maximum(last, where(arrival < NEVER, arrival + LEAST_SPACING, 0.0))
    lost = uniform(p.seed, LOSS, x.message) < p.loss
    arrival = where(lost, NEVER, maximum(delay, last))

    def shifted(new: Any, slots: tuple[Any, ...]) -> tuple[Any, ...]:
        return tuple(where(call, a, b) for a, b in zip((new, *slots[:-1]), slots, strict=True))

    return x._replace(
        arrival=shifted(arrival, x.arrival), speed=shifted(omega, x.speed), flag=shifted(flag, x.flag)
    )


def deliver(x: State) -> State:
    """T_S later: what has arrived by then is taken off the bus, and the newest of it is kept."""
    omega, flag, counter = x.omega_2_can, where(x.valid, 1.0, 0.0), x.counter
    left = []
    for k in reversed(range(SLOTS)):
        arrived = x.arrival[k] <= T_S + 1e-9
        omega = where(arrived, x.speed[k], omega)
        flag = where(arrived, x.flag[k], flag)
        counter = where(arrived, counter + 1.0, counter)
        left.append(where(arrived, NEVER, where(x.arrival[k] < NEVER, x.arrival[k] - T_S, NEVER)))
    return x._replace(arrival=tuple(reversed(left)), omega_2_can=omega, valid=flag > 0.5, counter=counter)


def output(x: State, u: Input, p: Parameters) -> Output:
    return Output(omega_2_can=x.omega_2_can, valid=x.valid, counter=x.counter)


BLOCK = Block(
    name="WheelSpeedCan",
    description="Wheel speed from the ABS over CAN: coarse, late, absent at low speed",
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Output,
    start=start,
    output=output,
    update=update,
    sample_time=T_S,
)
