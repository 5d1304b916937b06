"""Faults of the signals that a controller gets: a test bench for its monitor, between the sensors and the controller.

Up to two faults act at a time, each on one signal from `begin` to `end`: the motor's speed, the torque that it
estimates, the frame with both, or the message with the wheel speed. What fails in time (late, frozen, lost) takes
the place of what comes in; what fails in value (gain, offset, noise, spikes, no number) is done to that. Without a
fault the signals pass as they are, within the same instant.

    late       what was sent `size` seconds before, at most 0.5 (of two faults that are late the first one's alone)
    frozen     what was sent last before `begin`; messages keep coming with that speed
    lost       this share of the samples or messages; the last one stays
    gain       times `size`: 0 reads zero, -1 has the wrong sign
    offset     plus `size`
    noise      plus normally distributed noise of the standard deviation `size`, new with each sample or message
    spikes     plus or minus `size` in this share of the samples or messages
    no_number  NaN
    flapping   of the message: its flag is turned over and back, `size` seconds each time
    jumping    of the message: its counter is any number in this share of the samples
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Boolean, Integer, Real
from fmublocks.block.noise import normals, uniform
from fmublocks.block.operators import (
    LARGEST,
    branch,
    clip,
    element,
    floor,
    logical_and,
    logical_not,
    logical_or,
    maximum,
    where,
)
from fmublocks.block.types import SampledBlock

from .controller import T_S

HISTORY = 250
"""Samples that are kept for the signals that come late."""

LATE, FROZEN, LOST, GAIN, OFFSET, NOISE, SPIKES, NO_NUMBER, FLAPPING, JUMPING = range(1, 11)
MOTOR_SPEED, MOTOR_TORQUE, WHEEL_SPEED, FRAME = 1, 2, 3, 4

COUNTERS = 1e6
"""A counter that jumps is below this."""

Kind = Annotated[int, Integer("what fails, numbered as above from 1; 0 for nothing", 0, 10)]
Place = Annotated[int, Integer("which signal: 1 motor speed, 2 motor torque, 3 wheel speed, 4 the first two", 1, 4)]
Begin = Annotated[float, Real("s", "instant from which the fault acts", 0.0, 1e6)]
End = Annotated[float, Real("s", "instant from which it no longer acts", 0.0, 1e6)]
Size = Annotated[float, Real("1", "how much, see above; in SI units", -1e6, 1e6)]
Share = Annotated[float, Real("1", "share of the samples or messages", 0.0, 1.0)]


class Parameters(NamedTuple):
    kind_1: Kind = 0
    signal_1: Place = 1
    begin_1: Begin = 0.0
    end_1: End = 0.0
    size_1: Size = 1.0
    share_1: Share = 1.0
    kind_2: Kind = 0
    signal_2: Place = 1
    begin_2: Begin = 0.0
    end_2: End = 0.0
    size_2: Size = 1.0
    share_2: Share = 1.0
    seed: Annotated[int, Integer("seed of noise, spikes, losses and jumps", 0, 1_000_000)] = 1


class Input(NamedTuple):
    omega_1_sent: Annotated[float, Real("rad/s", "speed of the motor as it was measured")] = 0.0
    T_mot_sent: Annotated[float, Real("N.m", "air-gap torque as motor control has estimated it")] = 0.0
    omega_2_sent: Annotated[float, Real("rad/s", "speed of the driven wheels in the message, motor side")] = 0.0
    valid_sent: Annotated[bool, Boolean("flag of the message")] = False
    counter_sent: Annotated[int, Integer("counter of the message")] = 0
    alive_sent: Annotated[int, Integer("counter of the motor's frames, 0 if they are not counted")] = 0


class Signals(NamedTuple):
    """What the controller gets."""

    omega_1_meas: Annotated[float, Real("rad/s", "measured speed of the motor")]
    T_mot_est: Annotated[float, Real("N.m", "air-gap torque as motor control estimates it")]
    omega_2_can: Annotated[float, Real("rad/s", "received speed of the driven wheels, motor side")]
    valid: Annotated[bool, Boolean("the received wheel speed is above its minimum")]
    counter: Annotated[float, Integer("one more with every message that arrives")]
    alive: Annotated[float, Integer("one more with every frame of the motor, 0 if they are not counted")]


class Fault(NamedTuple):
    """One fault; its random numbers have the numbers from `stream` on."""

    kind: float
    signal: float
    begin: float
    end: float
    size: float
    share: float
    stream: float


class Sent(NamedTuple):
    """What was sent, as far as a fault acts on it."""

    speed: Annotated[float, Real("rad/s", "of the motor; of the wheels for a fault of the message")]
    torque: Annotated[float, Real("N.m", "of the motor")]
    valid: Annotated[bool, Boolean("flag of the message")]
    counter: Annotated[int, Integer("counter of the message")]
    alive: Annotated[int, Integer("counter of the motor's frames")]


class Past(NamedTuple):
    """What was sent in the last samples, newest first."""

    speed: Annotated[tuple[float, ...], Real("rad/s", "of the motor; of the wheels for a fault of the message")]
    torque: Annotated[tuple[float, ...], Real("N.m", "of the motor")]
    valid: Annotated[tuple[bool, ...], Boolean("flag of the message")]
    counter: Annotated[tuple[int, ...], Integer("counter of the message")]
    alive: Annotated[tuple[int, ...], Integer("counter of the motor's frames")]


class State(NamedTuple):
    sample: Annotated[float, Real("1", "number of the sample")]
    past: Past
    late: Sent
    last_1: Sent
    last_2: Sent


def faults(p: Parameters) -> tuple[Fault, Fault]:
    return (
        Fault(p.kind_1, p.signal_1, p.begin_1, p.end_1, p.size_1, p.share_1, 0.0),
        Fault(p.kind_2, p.signal_2, p.begin_2, p.end_2, p.size_2, p.share_2, 10.0),
    )


def start(u: Input, p: Parameters) -> State:
    """What is sent at the start counts as what was sent before."""
    first, second = faults(p)
    sent = _sent(u, _late_one(p))
    past = Past._make((value,) * HISTORY for value in sent)
    return State(0.0, past, sent, _sent(u, first), _sent(u, second))


def update(x: State, u: Input, p: Parameters) -> State:
    late, (first, second) = _late_one(p), faults(p)
    sent, samples = _sent(u, late), clip(floor(late.size / T_S - 0.5), 0.0, HISTORY - 1.0)
    before = Sent._make(element(values, samples - 1.0) for values in x.past)
    return State(
        sample=x.sample + 1.0,
        past=Past._make((new, *old[:-1]) for new, old in zip(sent, x.past, strict=True)),
        late=_chosen(samples < 1.0, sent, before),
        last_1=_chosen(stays(first, u, x.sample, p), x.last_1, _sent(u, first)),
        last_2=_chosen(stays(second, u, x.sample, p), x.last_2, _sent(u, second)),
    )


def output(x: State, u: Input, p: Parameters) -> Signals:
    y, (first, second) = Signals(*u), faults(p)
    y = delivered(y, u, x.late, x.last_1, first, x.sample, p)
    y = delivered(y, u, x.late, x.last_2, second, x.sample, p)
    return altered(altered(y, first, x.sample, p), second, x.sample, p)


def _late_one(p: Parameters) -> Fault:
    """The fault whose signal comes late."""
    first, second = faults(p)
    return Fault(*(where(first.kind == LATE, a, b) for a, b in zip(first, second, strict=True)))


def _sent(u: Input, fault: Fault) -> Sent:
    speed = where(fault.signal == WHEEL_SPEED, u.omega_2_sent, u.omega_1_sent)
    return Sent(speed, u.T_mot_sent, u.valid_sent, u.counter_sent, u.alive_sent)


def is_of(fault: Fault, signal: int) -> bool:
    """Whether a fault acts on a signal of the motor, alone or with the frame."""
    return logical_or(fault.signal == signal, fault.signal == FRAME)


def acts(fault: Fault, sample: float) -> bool:
    """Whether a fault acts in a sample."""
    t = (sample + 0.5) * T_S
    return logical_and(t >= fault.begin, t < fault.end)


def stays(fault: Fault, u: Input, sample: float, p: Parameters) -> bool:
    """Whether what was sent last stays in the place of what is sent."""
    lost = logical_and(fault.kind == LOST, _strikes(fault, u.counter_sent, sample, p))
    return logical_and(acts(fault, sample), logical_or(fault.kind == FROZEN, lost))


def delivered(y: Signals, u: Input, late: Sent, last: Sent, fault: Fault, sample: float, p: Parameters) -> Signals:
    """The signals y after what the fault does in time: in their place is what comes late, or what was sent last."""
    is_late = logical_and(acts(fault, sample), logical_and(fault.kind == LATE, fault.signal == _late_one(p).signal))
    fails = logical_or(is_late, stays(fault, u, sample, p))
    old = _chosen(is_late, late, last)
    message = logical_and(fails, fault.signal == WHEEL_SPEED)
    whole = logical_and(message, fault.kind != FROZEN)
    return Signals(
        omega_1_meas=where(logical_and(fails, is_of(fault, MOTOR_SPEED)), old.speed, y.omega_1_meas),
        T_mot_est=where(logical_and(fails, is_of(fault, MOTOR_TORQUE)), old.torque, y.T_mot_est),
        omega_2_can=where(message, old.speed, y.omega_2_can),
        valid=where(whole, old.valid, y.valid),
        counter=where(whole, old.counter, y.counter),
        alive=where(logical_and(fails, fault.signal == FRAME), old.alive, y.alive),
    )


def altered(y: Signals, fault: Fault, sample: float, p: Parameters) -> Signals:
    """The signals y after what the fault does to their values."""
    now, strikes = acts(fault, sample), _strikes(fault, y.counter, sample, p)
    index = _index(fault, y.counter, sample)
    times = floor(((sample + 0.5) * T_S - fault.begin) / maximum(fault.size, T_S))
    turned = logical_and(fault.kind == FLAPPING, times % 2.0 == 0.0)
    jumps = logical_and(logical_and(now, fault.kind == JUMPING), strikes)

    def value(right: float, acts_on_it: bool) -> float:
        return where(logical_and(now, acts_on_it), _wrong(right, fault, strikes, index, p), right)

    return Signals(
        omega_1_meas=value(y.omega_1_meas, is_of(fault, MOTOR_SPEED)),
        T_mot_est=value(y.T_mot_est, is_of(fault, MOTOR_TORQUE)),
        omega_2_can=value(y.omega_2_can, fault.signal == WHEEL_SPEED),
        valid=where(logical_and(now, turned), logical_not(y.valid), y.valid),
        counter=where(jumps, floor(COUNTERS * uniform(p.seed, fault.stream + 4.0, sample)), y.counter),
        alive=y.alive,
    )


def _wrong(right: float, fault: Fault, strikes: bool, index: float, p: Parameters) -> float:
    """The value of a signal while the fault acts on it."""
    noise, _ = normals(p.seed, fault.stream + 1.0, index)
    sign = where(uniform(p.seed, fault.stream + 3.0, index) < 0.5, -1.0, 1.0)
    infinite = 2.0 * LARGEST * (1.0 + abs(fault.size))
    by_kind = (
        (GAIN, fault.size * right),
        (OFFSET, right + fault.size),
        (NOISE, right + fault.size * noise),
        (SPIKES, right + where(strikes, sign * fault.size, 0.0)),
        (NO_NUMBER, infinite - infinite),
    )
    value = right
    for kind, wrong in by_kind:
        value = where(fault.kind == kind, wrong, value)
    return value


def _index(fault: Fault, counter: float, sample: float) -> float:
    """Random numbers are drawn for each sample of a motor signal, and for each message."""
    return where(fault.signal == WHEEL_SPEED, 1.0 * counter, sample)


def _strikes(fault: Fault, counter: float, sample: float, p: Parameters) -> bool:
    """Whether this sample or message belongs to the share that fails."""
    index = where(fault.kind == JUMPING, sample, _index(fault, counter, sample))
    return uniform(p.seed, fault.stream, index) < fault.share


def _chosen(condition: bool, value: Sent, otherwise: Sent) -> Sent:
    return branch(condition, lambda: value, lambda: otherwise)


BLOCK = SampledBlock(
    name="SignalFaults",
    description="Faults of the signals between sensors and controller",
    module=__name__,
    Parameters=Parameters,
    Input=Input,
    State=State,
    Output=Signals,
    start=start,
    output=output,
    update=update,
    sample_time=T_S,
    gives_bad_output=True,
)
