"""How much later than they happened the channels of a recording tell of things.

Each is the shift with which one channel follows best from others. Speed of motor and wheels cannot be compared as they
are: from about 1 Hz on the shaft between them matters, and at the resonance they move against each other. So the wheel
speed is fitted by what the shaft makes of the motor's, omega_2 = omega_1 - d phi/dt with phi = T_gear/C and T_gear =
T_mot - J_1 d omega_1/dt: by omega_1, dT_mot/dt and d2 omega_1/dt2 with free factors, slower than SHAFT. The load torque
is fitted likewise by T_mot and d omega_1/dt, slower than WHEEL. Nothing of the car needs to be known. What the wheels
and tyres take is part of the delay of the load.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .filters import low
from .thresholds import Threshold

SHAFT, WHEEL, MOTOR = (
    Threshold(value, "Hz", f"frequency below which {what} is compared", source)
    for value, what, source in (
        (2.0, "the wheel speed", "a quarter of a drive train's 8 Hz, above which more than the shaft decides"),
        (15.0, "the load torque", "wheels and tyres take what is faster"),
        (40.0, "the motor speed", "five times the drive train's 8 Hz"),
    )
)
EARLIEST, LATEST = (
    Threshold(value, "s", f"{which} delay that is looked at", "22 to 74 ms of wheel speeds that came over a bus")
    for value, which in ((-0.04, "smallest"), (0.1, "largest"))
)
FITS = Threshold(
    0.95,
    "1",
    "share of the power of a channel that must be explained",
    "0.989 and more in test drives of both plants",
)


@dataclass(frozen=True)
class Delay:
    """Of a channel behind others.

    Attributes:
        of, behind: quantities.
        time: in s, negative if it is early.
        deviation: its standard deviation in s, as the residual tells: what is filtered has two values a period of
            its highest frequency that do not depend on each other.
        explained: share of the power of the channel.
    """

    of: str
    behind: str
    time: float
    deviation: float
    explained: float

    def __str__(self) -> str:
        part = ", of which wheels and tyres take a part" if self.of == "T_load" else ""
        return f"{self.of} comes {1e3 * self.time:.2f} +- {1e3 * self.deviation:.2f} ms after {self.behind}{part}"


def estimated(interval: float, signals: Mapping[str, np.ndarray]) -> list[Delay]:
    """The delays that the recording tells.

    Args:
        interval: between the samples in s.
        signals: omega_1, omega_2, T_mot and perhaps T_load in SI units, motor side.
    """

    def rate(x: np.ndarray) -> np.ndarray:
        return np.gradient(x, interval)

    omega_1, T_mot = (low(signals[name], interval, MOTOR) for name in ("omega_1", "T_mot"))
    fits: list[tuple[str, str, float, list[np.ndarray]]] = [
        ("omega_2", "omega_1", SHAFT, [omega_1, rate(T_mot), rate(rate(omega_1))])
    ]
    if "T_load" in signals:
        fits.append(("T_load", "T_mot", WHEEL, [T_mot, rate(omega_1)]))
    found = [
        Delay(of, behind, *_fitted(interval, f, low(signals[of], interval, f), [low(x, interval, f) for x in others]))
        for of, behind, f, others in fits
    ]
    return [delay for delay in found if delay.explained >= FITS]


def _fitted(
    interval: float, frequency: float, y: np.ndarray, others: Sequence[np.ndarray]
) -> tuple[float, float, float]:
    """The shift in s with which y is fitted best by the others and a constant, its standard deviation, and the share
    of y that this explains; all are slower than the frequency in Hz."""
    first, last = round(EARLIEST / interval), round(LATEST / interval)
    at = np.arange(last, len(y) + first)
    if len(at) < 10 * (len(others) + 1):
        return 0.0, 0.0, 0.0
    power = float(np.sum((y[at] - y[at].mean()) ** 2))
    left = []
    for shift in range(first, last + 1):
        A = np.column_stack([*(x[at - shift] for x in others), np.ones(len(at))])
        factors = np.linalg.lstsq(A, y[at], rcond=None)[0]
        left.append(float(np.sum((y[at] - A @ factors) ** 2)))
    k = int(np.argmin(left))
    if k in (0, len(left) - 1) or power == 0.0:
        return 0.0, 0.0, 0.0  # beyond what was looked at
    before, least, after = left[k - 1 : k + 2]
    curvature = before - 2.0 * least + after
    independent = 2.0 * frequency * interval * len(at)
    deviation = interval * float(np.sqrt(2.0 * least / (independent * curvature)))
    return (first + k + 0.5 * (before - after) / curvature) * interval, deviation, 1.0 - least / power
