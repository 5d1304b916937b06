"""What the channels of one car must have to do with each other: a wrong sign, a wrong unit or two exchanged channels
show there, whatever the car is.

- The wheels turn as fast as the motor, over i.
- What the torque of the motor does within a few hundredths of a second, it does to the motor: the faster parts of
  T_mot and d omega_1/dt go together, those of any other torque and speed do not (paper, eq. (2): J_1 d omega_1/dt =
  T_mot - T_gear, and T_gear is slower).
- In the long run the load opposes the motor, with about its size, and the motor makes what is demanded.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.signal import butter, sosfiltfilt

from .source import RecordingError
from .thresholds import Threshold

RATIO = Threshold(
    0.1,
    "1",
    "part by which motor speed over wheel speed times i may differ from 1",
    "0.004 to 0.008 in test drives of both plants",
)
STANDSTILL = Threshold(
    1.0,
    "rad/s",
    "speed, rms, motor side, below which the ratio of two speeds tells nothing",
    "four steps of the bus, of 0.27 rad/s",
)
FAST = (20.0, 60.0)
"""Band in Hz in which torques and rates of speeds are compared."""

LINK = Threshold(
    0.5,
    "1",
    "correlation there from which on T_mot certainly belongs to the rate of omega_1",
    "0.52 to 0.98, and always the largest, in test drives of both plants with 15 and 30 N.m, at 15 and 50 km/h; 0.35 "
    "at least of 60 random cars",
)
OTHERS = Threshold(
    0.7,
    "1",
    "the same of another torque and speed",
    "0.48 at most in those test drives; 0.63 of 60 random cars: in a wide gap wheels and motor feel the teeth alike",
)
SLOW = Threshold(
    2.0,
    "Hz",
    "frequency below which load and demand are compared with the motor torque",
    "a quarter of the 8 Hz of a drive train",
)
OPPOSED = Threshold(
    0.5,
    "1",
    "correlation there from which on one certainly goes with it or against it",
    "0.995 and more in test drives",
)
SIZE = Threshold(
    3.0, "1", "factor by which it may be larger or smaller", "0.73 to 1.00 in test drives; gear ratios are larger"
)

ORDER = 4


def low(x: np.ndarray, interval: float, frequency: float) -> np.ndarray:
    """What of a signal, `interval` s apart, is slower than a frequency in Hz (Butterworth, forwards and backwards)."""
    return sosfiltfilt(butter(ORDER, _below_nyquist(frequency, interval), fs=1.0 / interval, output="sos"), x)


def band(x: np.ndarray, interval: float, frequencies: tuple[float, float]) -> np.ndarray:
    """What of it lies between two frequencies in Hz."""
    between = [_below_nyquist(frequency, interval) for frequency in frequencies]
    return sosfiltfilt(butter(ORDER, between, btype="band", fs=1.0 / interval, output="sos"), x)


def _below_nyquist(frequency: float, interval: float) -> float:
    return min(frequency, 0.45 / interval)


TURNS = "--column QUANTITY='-HEADING' turns it"
SAYS = "--column QUANTITY='HEADING [UNIT]' says what a column is"


def check_relations(
    path: Path, headings: Mapping[str, str], interval: float, signals: Mapping[str, np.ndarray]
) -> None:
    """
    Args:
        path: of the recording, for messages.
        headings: of the columns, by quantity: omega_1, omega_2, T_mot and, if they were recorded, T_load and
            T_ref.
        interval: between the samples in s.
        signals: in SI units, motor side, by quantity.

    Raises:
        RecordingError: a channel has the wrong sign or unit, or is exchanged with another.
    """
    _check_links(path, headings, interval, signals)
    _check_speeds(path, headings, signals)
    for torque in SLOW_TORQUES:
        if torque.name in signals:
            _check_torque(path, headings, interval, signals, torque)


def links(interval: float, signals: Mapping[str, np.ndarray]) -> dict[tuple[str, str], float]:
    """Correlation of each torque with the rate of each speed, in the band FAST. The demand is left out: that of a fast
    motor is its torque, without noise."""
    torques = {name: band(x, interval, FAST) for name, x in signals.items() if name in ("T_mot", "T_load")}
    rates = {
        name: band(np.gradient(x, interval), interval, FAST) for name, x in signals.items() if name.startswith("omega_")
    }
    return {(T, omega): compared(torques[T], rates[omega])[0] for T in torques for omega in rates}


def _check_links(path: Path, headings: Mapping[str, str], interval: float, signals: Mapping[str, np.ndarray]) -> None:
    correlations = links(interval, signals)
    T, omega = max(correlations, key=lambda pair: abs(correlations[pair]))
    link = correlations[T, omega]
    expected = (T, omega) == ("T_mot", "omega_1")
    # a car with a wide gap was refused for channels that were not exchanged
    if abs(link) < (LINK if expected else OTHERS):
        return  # too little excitation to tell
    finding = f"{headings[omega]} follows {headings[T]} (correlation {link:.2f} from {FAST[0]:g} to {FAST[1]:g} Hz)"
    if not expected:
        exchanged = [
            f"{headings[of_motor]} and {headings[name]}"
            for of_motor, name in (("T_mot", T), ("omega_1", omega))
            if of_motor != name
        ]
        raise RecordingError(f"{path}: {finding}: are {', and '.join(exchanged)} exchanged? {SAYS}")
    if link < 0.0:
        raise RecordingError(f"{path}: {finding}: one of them has the wrong sign; {TURNS}")


def _check_speeds(path: Path, headings: Mapping[str, str], signals: Mapping[str, np.ndarray]) -> None:
    omega_1, omega_2 = signals["omega_1"], signals["omega_2"]
    if np.sqrt(np.mean(omega_2**2)) < STANDSTILL:
        return
    ratio = float(omega_1 @ omega_2 / (omega_2 @ omega_2))
    if ratio < 0.0:
        raise RecordingError(
            f"{path}: {headings['omega_1']} and {headings['omega_2']} turn against each other: one has the wrong sign; "
            f"{TURNS}"
        )
    if abs(ratio - 1.0) > RATIO:
        raise RecordingError(
            f"{path}: {headings['omega_1']} is {ratio:.4g} times what {headings['omega_2']} says of the motor: "
            f"the unit of one, the gear ratio or the tyre radius is not what it is said to be "
            f"(rpm for rad/s makes 9.549, km/h for m/s 3.6); {SAYS}"
        )


class SlowTorque(NamedTuple):
    """A torque that goes with that of the motor in the long run, or against it.

    Attributes:
        sign: 1 or -1.
        contrary: what it does if its sign is wrong, between both headings.
        so: what that means.
    """

    name: str
    sign: float
    contrary: str
    so: str


SLOW_TORQUES = (
    SlowTorque(
        "T_load",
        -1.0,
        "acts with",
        "its sign is wrong; a load that brakes is negative, the torque of wheels that drive positive",
    ),
    SlowTorque("T_ref", 1.0, "asks for the opposite of", "one of them has the wrong sign"),
)


def _check_torque(
    path: Path, headings: Mapping[str, str], interval: float, signals: Mapping[str, np.ndarray], torque: SlowTorque
) -> None:
    heading, of_motor = headings[torque.name], headings["T_mot"]
    slow = (low(signals[name], interval, SLOW) for name in (torque.name, "T_mot"))
    correlation, size = compared(*slow)
    if torque.sign * correlation < -OPPOSED:
        raise RecordingError(
            f"{path}: {heading} {torque.contrary} {of_motor} (correlation {correlation:.2f} below {SLOW:g} Hz): "
            f"{torque.so}; {TURNS}"
        )
    if torque.sign * correlation > OPPOSED and not 1.0 / SIZE <= size <= SIZE:
        raise RecordingError(
            f"{path}: {heading} is {size:.3g} times as large as {of_motor}, motor side: the unit of one or the gear "
            f"ratio is not what it is said to be, or it is not on the side that its name says; {SAYS}"
        )


def compared(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    """Correlation of two signals, and the standard deviation of the first over that of the second; 0 of one that does
    not vary, and infinity over it."""
    size = float(np.std(x) * np.std(y))
    correlation = float(np.mean((x - x.mean()) * (y - y.mean()))) / size if size > 0.0 else 0.0
    return correlation, float(np.std(x) / np.std(y)) if np.std(y) > 0.0 else np.inf
