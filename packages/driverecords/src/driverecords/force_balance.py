"""Balance of the forces along the road: what the motion takes,
1.09 m dv/dt + m g c_rr + c_wa v^2, follows what the motor gives, i T_mot/r. Brakes and grade blur it. So it is compared
without the parts that are faster than SMOOTHING, over all that moves for the sign, and for the size where the motor
pushes harder than FORCE, when no driver brakes. Means over EVERY are enough for that.
"""

from typing import NamedTuple, Protocol

import numpy as np

from .relations import compared
from .thresholds import Threshold
from .time_base import interval_of

RATIOS = (
    "0.84 and 0.92 in the recorded trips; 0.61 to 1.82 in 200 simulated drives of cars with half to one and a half of "
    "the mass"
)


class Car(Protocol):
    """What of the vehicle the balance of forces needs."""

    def motor_force(self, T_mot: np.ndarray) -> np.ndarray:
        """Force in N with which the motor pushes."""
        ...

    def motion(self, v: np.ndarray, interval: float) -> np.ndarray:
        """Force in N that a motion takes on a level road."""
        ...


SMOOTHING = Threshold(0.5, "s", "standard deviation of the Gaussian", "brakes and slopes are slower than 1 Hz")
FORCE = Threshold(
    300.0,
    "N",
    "force up to which the balance cannot tell a force from an error",
    "a grade of 2 % takes 284 N of 1450 kg",
)
ROLLING = Threshold(1.0, "m/s", "speed above which a car rolls", "below it friction holds it, whatever the motor does")
EVERY = Threshold(0.02, "s", "interval that is enough for the balance", "a twenty-fifth of the Gaussian")
SIGNED = Threshold(
    0.5,
    "1",
    "correlation of the forces from which on their sign means something",
    "0.91 and more in the recorded trips, 0.90 in 200 simulated drives",
)
TOGETHER = Threshold(
    0.7,
    "1",
    "the same while the motor pushes, from which on their ratio means something",
    "0.93 in the recorded trips; 0.97 but for 2 of 254 simulated drives",
)
SMALLEST, LARGEST = (
    Threshold(value, "1", f"{which} ratio of what a motion takes to what the motor gives", RATIOS)
    for value, which in ((0.5, "smallest"), (2.5, "largest"))
)
LEAST = 10
"""Samples that a balance needs."""


class Forces(NamedTuple):
    """Along the road, smoothed, in N.

    Attributes:
        time: in s.
        takes: what the motion takes.
        gives: what the motor gives.
        rolls: whether the car rolls.
    """

    time: np.ndarray
    takes: np.ndarray
    gives: np.ndarray
    rolls: np.ndarray


def forces(time: np.ndarray, v: np.ndarray, T_mot: np.ndarray, car: Car) -> Forces:
    """Those of a motion (m/s over s) and the torque of the motor (N.m)."""
    from scipy.ndimage import gaussian_filter1d

    # all samples of 6 min at 1 kHz took 1.3 s, of a torque that is too small 7.6 s; means over EVERY take 0.1 s
    count = max(1, min(int(EVERY / interval_of(time)), len(time) // LEAST))
    time, v, T_mot = (x[: len(x) // count * count].reshape(-1, count).mean(axis=1) for x in (time, v, T_mot))
    interval = interval_of(time)
    signals = (car.motion(v, interval), car.motor_force(T_mot), np.abs(v))
    takes, gives, speed = (gaussian_filter1d(x, SMOOTHING / interval, mode="nearest") for x in signals)
    return Forces(time, takes, gives, speed > ROLLING)


class Balance(NamedTuple):
    """Of the forces along the road.

    Attributes:
        worst: time in s at which they are furthest apart.
        correlation: of what the motion takes with what the motor gives, while the car rolls; 0 if too little happens.
        driven, with_motor: standard deviation in N of what the motion takes where that is positive, as brakes cannot
            give it, and its correlation with what the motor gives where that is.
        judged: whether enough happens while the motor pushes.
        together, ratio: correlation and ratio of standard deviations then.
        moved: standard deviation in N of what the motion takes then.
    """

    worst: float
    correlation: float = 0.0
    driven: float = 0.0
    with_motor: float = 0.0
    judged: bool = False
    together: float = 0.0
    ratio: float = 1.0
    moved: float = 0.0

    @property
    def fits(self) -> bool:
        return self.judged and self.together >= TOGETHER and SMALLEST <= self.ratio <= LARGEST


def balance(along: Forces, torque: float = 1.0) -> Balance:
    """How what the motion takes and what the motor gives fit together, with a factor on the torque."""
    takes, gives, rolls = along.takes, torque * along.gives, along.rolls
    pushes = rolls & (gives > FORCE)
    result = Balance(worst=float(along.time[np.argmax(np.where(rolls, np.abs(takes - gives), 0.0))]))
    if rolls.sum() >= LEAST:
        # what drives a car is its motor or a hill, never a brake: a torque that stays where it is, or is a minute late,
        # shows
        drive_force, motor_force = (np.maximum(force[rolls], 0.0) for force in (takes, gives))
        result = result._replace(driven=float(np.std(drive_force)), with_motor=compared(drive_force, motor_force)[0])
    if rolls.sum() >= LEAST and np.std(gives[rolls]) > FORCE:
        result = result._replace(correlation=compared(takes[rolls], gives[rolls])[0])
    if pushes.sum() >= LEAST and max(np.std(gives[pushes]), np.std(takes[pushes])) > FORCE:
        together, ratio = compared(takes[pushes], gives[pushes])
        result = result._replace(judged=True, together=together, ratio=ratio, moved=float(np.std(takes[pushes])))
    return result
