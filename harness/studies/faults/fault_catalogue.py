"""What can go wrong: faults of the signals that the controller gets, and what happens on ice."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import combinations
from math import exp, log

import numpy as np

MOTOR_SPEED, MOTOR_TORQUE, WHEEL_SPEED, FRAME = 1, 2, 3, 4
"""Signals, as SignalFaults numbers them."""

LATE, FROZEN, LOST, GAIN, OFFSET, NOISE, SPIKES, NO_NUMBER, FLAPPING, JUMPING = range(1, 11)
"""What can happen to them, as SignalFaults numbers it."""

SWITCHED_OFF = 11
"""What can happen to the damping beside: `enable` is not set."""

ICE = 0.1
"""Friction coefficient of ice."""

Draw = Callable[[np.random.Generator], float]


def fixed(value: float) -> Draw:
    return lambda _: value


def uniform(low: float, high: float) -> Draw:
    return lambda rng: float(rng.uniform(low, high))


def by_ratio(low: float, high: float) -> Draw:
    """Uniform in the logarithm. The functions of numpy have other last digits on other processors."""
    return lambda rng: exp(rng.uniform(log(low), log(high)))


def either_sign(draw: Draw) -> Draw:
    return lambda rng: draw(rng) * float(rng.choice((-1.0, 1.0)))


ONE = fixed(1.0)
LASTS = by_ratio(0.01, 1.0)


@dataclass(frozen=True)
class Kind:
    """One thing that can go wrong.

    Attributes:
        signal, number: which signal and what happens to it, as SignalFaults numbers them, or SWITCHED_OFF; 0 for what
            is no fault of a signal.
        size, share: of the fault, drawn anew for each case.
        meaning: of the size, with its unit.
        unit: of the size where it has one.
        lasts: how long in s; None: to the end of the run.
        tolerable: the damping has to go on.
    """

    name: str
    signal: int
    number: int
    meaning: str
    size: Draw = ONE
    share: Draw = ONE
    lasts: Draw | None = LASTS
    tolerable: bool = False
    unit: str = ""


def _of_each(signal: int, called: str, unit: str, largest: float, noise: float) -> tuple[Kind, ...]:
    """What can happen to every signal."""

    def kind(name: str, number: int, meaning: str, size: Draw = ONE, share: Draw = ONE, unit: str = "") -> Kind:
        tolerable = signal == WHEEL_SPEED
        return Kind(f"{called} {name}", signal, number, meaning, size, share, tolerable=tolerable, unit=unit)

    return (
        kind("lost", LOST, "a share of 0 to 100 % does not arrive", share=uniform(0.0, 1.0)),
        kind("late", LATE, "4 ms to 0.5 s", by_ratio(0.004, 0.5), unit="s"),
        kind("frozen", FROZEN, "the last value stays"),
        kind("zero", GAIN, "reads 0", fixed(0.0)),
        kind("offset", OFFSET, f"±5 to ±{largest:g} {unit}", either_sign(by_ratio(5.0, largest)), unit=unit),
        kind("wrong sign", GAIN, "times -1", fixed(-1.0)),
        kind("NaN", NO_NUMBER, "no number"),
        kind("noise", NOISE, f"ten times the usual, {noise:g} {unit}", fixed(noise), unit=unit),
        kind(
            "spikes",
            SPIKES,
            f"±10 to ±{3 * largest:g} {unit} in 0.5 to 20 % of the samples",
            by_ratio(10.0, 3 * largest),
            by_ratio(0.005, 0.2),
            unit,
        ),
    )


def _on_ice(name: str, meaning: str, torque: float) -> Kind:
    """A torque in N.m that the road does not hold."""
    return Kind(name, 0, 0, meaning, fixed(torque), lasts=uniform(0.2, 0.8), tolerable=True, unit="N.m")


_KINDS = (
    *_of_each(MOTOR_SPEED, "motor speed", "rad/s", 300.0, 1.5),
    Kind("motor speed gain", MOTOR_SPEED, GAIN, "times 0.3 to 2", by_ratio(0.3, 2.0)),
    *_of_each(MOTOR_TORQUE, "motor torque", "N.m", 100.0, 3.0),
    Kind(
        "motor torque ±30 %",
        MOTOR_TORQUE,
        GAIN,
        "times 0.7 to 1.3, to the end",
        uniform(0.7, 1.3),
        lasts=None,
        tolerable=True,
    ),
    *_of_each(WHEEL_SPEED, "wheel speed", "rad/s", 300.0, 1.5),
    Kind("wheel speed gain", WHEEL_SPEED, GAIN, "times 0.3 to 2", by_ratio(0.3, 2.0), tolerable=True),
    Kind(
        "wheel radius ±5 %",
        WHEEL_SPEED,
        GAIN,
        "times 0.95 to 1.05, to the end",
        uniform(0.95, 1.05),
        lasts=None,
        tolerable=True,
    ),
    Kind(
        "validity flaps",
        WHEEL_SPEED,
        FLAPPING,
        "turned over and back every 2 to 200 ms",
        by_ratio(0.002, 0.2),
        tolerable=True,
        unit="s",
    ),
    Kind(
        "counter jumps",
        WHEEL_SPEED,
        JUMPING,
        "to any number in 5 to 100 % of the samples",
        share=uniform(0.05, 1.0),
        tolerable=True,
    ),
    _on_ice("wheel lock on ice", "brakes of 4000 N.m", 4000.0),
    _on_ice("wheel spin on ice", "80 N.m more than before", 80.0),
)

LOCK, SPIN = "wheel lock on ice", "wheel spin on ice"

_OF_FRAMES = (
    Kind("frame late", FRAME, LATE, "motor speed and torque 10 to 100 ms late", by_ratio(0.01, 0.1), unit="s"),
    Kind("frame lost", FRAME, LOST, "a share of 0 to 100 % of motor speed and torque", share=uniform(0.0, 1.0)),
    Kind("frame frozen", FRAME, FROZEN, "the last values stay"),
)

NOTHING = Kind("nothing", 0, 0, "all signals are right", tolerable=True)

IN_SITUATIONS = {kind.name: kind for kind in _KINDS}
"""What goes wrong on a dry road, or makes it icy."""

ON_ROADS = {
    kind.name: kind for kind in (NOTHING, *(kind for kind in _KINDS if kind.name not in (LOCK, SPIN)), *_OF_FRAMES)
}
"""What goes wrong on roads that are slippery themselves."""

_BRIEF = by_ratio(0.002, 0.09)
"""How long in s first samples are not those of the car: until t_apart a direction is not believed for good."""

AT_STARTS = {
    kind.name: kind
    for kind in (
        Kind(
            "first speeds zero", MOTOR_SPEED, GAIN, "the motor speed reads 0 from the start on", fixed(0.0), lasts=LASTS
        ),
        Kind("first speeds negative", MOTOR_SPEED, GAIN, "times -1 from the start on", fixed(-1.0), lasts=_BRIEF),
        Kind("first speeds frozen", MOTOR_SPEED, FROZEN, "the first value stays", lasts=LASTS),
        Kind("first speeds NaN", MOTOR_SPEED, NO_NUMBER, "no number from the start on", lasts=LASTS),
        Kind("first speeds late", MOTOR_SPEED, LATE, "4 ms to 0.2 s", by_ratio(0.004, 0.2), lasts=LASTS, unit="s"),
        Kind("first torques zero", MOTOR_TORQUE, GAIN, "the motor torque reads 0", fixed(0.0), lasts=LASTS),
        Kind("first torques negative", MOTOR_TORQUE, GAIN, "times -1", fixed(-1.0), lasts=_BRIEF),
        Kind(
            "first messages zero", WHEEL_SPEED, GAIN, "the wheel speed reads 0", fixed(0.0), lasts=LASTS, tolerable=True
        ),
        Kind("no first messages", WHEEL_SPEED, LOST, "none arrives from the start on", lasts=LASTS, tolerable=True),
        Kind("enabled late", 0, SWITCHED_OFF, "the damping is switched on at speed", lasts=LASTS, tolerable=True),
    )
}
"""What first samples can be: of a host that exchanges nothing before its first step, or of a control unit that starts
while the car drives."""

KINDS = IN_SITUATIONS | ON_ROADS | AT_STARTS


def can_be_together(first: Kind, second: Kind) -> bool:
    """Of two kinds, whether they are a pair: SignalFaults delays one signal at a time, and wheels lock or spin."""
    same_slot = first.number == second.number and first.number in (0, LATE)
    return first is not second and NOTHING not in (first, second) and not same_slot


def pairs(kinds: Iterable[Kind]) -> tuple[tuple[Kind, Kind], ...]:
    """Those that can be made of kinds."""
    return tuple(pair for pair in combinations(kinds, 2) if can_be_together(*pair))
