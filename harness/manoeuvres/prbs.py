"""Pseudo-random binary torque, which excites a drive train at all frequencies up to that of its clock."""

from math import ceil

from .manoeuvre import Manoeuvre
from .signals import Held, lines

FEEDBACK = {
    5: (3,),
    6: (5,),
    7: (6,),
    8: (7, 6, 1),
    9: (5,),
    10: (7,),
    11: (9,),
    12: (11, 10, 4),
}
"""Stages that are added to the last one, by order: of a primitive polynomial, so that 2^order - 1 bits come before the
first ones come again (S. W. Golomb, Shift Register Sequences)."""

TEST_DRIVE = {"mean": 10.0, "amplitude": 30.0, "clock": 0.04, "order": 9, "duration": 10.0}
"""The usual demand: N.m, N.m, s, stages, s."""

TEST_SPEED = 15.0
"""Of the car in it, in km/h."""


def shift_register(length: int, order: int = 9) -> list[int]:
    """The first bits of the sequence of maximum length, from a register of ones; of order 9 that of x^9 + x^5 + 1."""
    stages = [1] * order
    bits = []
    for _ in range(length):
        bits.append(stages[-1])
        new = stages[-1]
        for stage in FEEDBACK[order]:
            new ^= stages[stage - 1]
        stages = [new, *stages[:-1]]
    return bits


def binary_torque(
    name: str, mean: float, amplitude: float, clock: float, order: int, duration: float, v_0: float, slope: float = 0.0
) -> Manoeuvre:
    """The demand jumps between mean + amplitude and mean - amplitude (N.m), or stays, every `clock` seconds.

    Args:
        order: one of FEEDBACK; the sequence begins again after (2^order - 1) clocks.
        duration: in s.
        v_0: speed at the start in m/s.
        slope: of the road in rad.
    """
    bits = shift_register(ceil(duration / clock) + 1, order)
    return Manoeuvre(
        name=name,
        description=f"pseudo-random binary torque of {amplitude:g} N.m around {mean:g} N.m at {3.6 * v_0:g} km/h",
        duration=duration,
        v_0=v_0,
        T_driver=Held(clock, [mean + amplitude * (2.0 * bit - 1.0) for bit in bits]),
        slope=lines((0.0, slope)),
    )
