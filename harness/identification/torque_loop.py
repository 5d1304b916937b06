"""What motor control makes of the torque demand: a second-order lag (paper, eq. (1)), recorded with gain and offset.

    tau^2 d2T/dt2 + sqrt(2) tau dT/dt + T = T_ref(t - delay)        T_mot = gain T + offset

The demand is held from each sample to the next. So T is a sum of its steps, and each of them is answered by

    s(t) = 1 - exp(-y) (cos y + sin y),   y = t/(sqrt(2) tau),   t > 0

which after SETTLED is 1: the sum is the convolution of the demand with the short answer to a single sample of it.
"""

from collections.abc import Callable, Mapping
from dataclasses import astuple, dataclass, fields

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.optimize import least_squares

from driverecords.source import RecordingError
from driverecords.thresholds import Threshold

from .noise import white_noise

SQRT_2 = 2.0**0.5

SETTLED = 53.0
"""Time in tau after which the rest of an answer is 5e-17."""

START, SHORTEST, LONGEST = 0.003, 1e-4, 0.05
"""Lag in s with which the search begins, and between which it stays."""

EARLIEST, LATEST = -0.04, 0.1
"""Delays in s that are looked at: those of a demand that came late into the recording, to that of a slow gateway."""

ANSWERS = Threshold(
    0.9, "1", "share of the power of the torque that its demand explains", "0.999 in test drives of foreign loops"
)

UNKNOWN = 0.2
"""Time in s at the beginning that is not fitted: what was demanded before the recording may still act."""

OUTLYING = 3.0
"""Noise of the recorded torque beyond which a miss counts less: a demand that was logged a tick early or late misses by
half of its step, 30 times the noise."""

AROUND = 0.02
"""Time in s over which misses are averaged."""

MET = Threshold(
    1.6,
    "1",
    "rms over 20 ms of what the demand does not explain, over the noise of the torque",
    "of ten samples of noise one in 250 is beyond",
)


@dataclass(frozen=True)
class TorqueLoop:
    """From the recorded demand to the recorded torque.

    Attributes:
        tau: lag in s.
        gain: recorded over true torque.
        offset: of the recorded torque in N.m.
        delay: by which the torque comes after the demand beside the lag, in s; negative if the demand came late into
            the recording.
    """

    tau: float
    gain: float = 1.0
    offset: float = 0.0
    delay: float = 0.0

    def torque(self, T_ref: np.ndarray, T_s: float) -> np.ndarray:
        """The torque as it is recorded, without noise, from a steady start.

        Args:
            T_ref: demand in N.m, each held for T_s, shape (n,).
            T_s: between samples in s.

        Returns:
            In N.m, at each sample, shape (n,).
        """
        return self.gain * self._sum(self._answer, T_ref, T_s) + self.offset

    def derivatives(self, T_ref: np.ndarray, T_s: float) -> np.ndarray:
        """Of `torque` by tau, gain, offset and delay, shape (n, 4)."""
        T = self._sum(self._answer, T_ref, T_s)
        by_tau = self._sum(lambda t: -t / self.tau * self._rate(t), T_ref, T_s)
        by_delay = self._sum(lambda t: -self._rate(t), T_ref, T_s)
        return np.column_stack([self.gain * by_tau, T, np.ones_like(T), self.gain * by_delay])

    def _y(self, t: np.ndarray) -> np.ndarray:
        return np.maximum(t, 0.0) / (SQRT_2 * self.tau)

    def _answer(self, t: np.ndarray) -> np.ndarray:
        """s, t seconds after a step of 1."""
        y = self._y(t)
        return 1.0 - np.exp(-y) * (np.cos(y) + np.sin(y))

    def _rate(self, t: np.ndarray) -> np.ndarray:
        """ds/dt."""
        y = self._y(t)
        return SQRT_2 / self.tau * np.exp(-y) * np.sin(y)

    def _sum(self, answer: Callable[[np.ndarray], np.ndarray], T_ref: np.ndarray, T_s: float) -> np.ndarray:
        """The answers to all steps of the demand.

        Args:
            answer: to a step of 1; 0 before it, and constant a sample after SETTLED.
        """
        shift = self.delay / T_s
        first, last = int(np.floor(shift)), int(np.ceil(shift + SETTLED * self.tau / T_s)) + 1
        pulse = np.diff(answer(np.arange(first, last + 1) * T_s - self.delay))
        known = np.clip(np.arange(-last, len(T_ref) - first - 1), 0, len(T_ref) - 1)
        return np.convolve(T_ref[known], pulse, mode="valid")


PARAMETERS = tuple(field.name for field in fields(TorqueLoop))


@dataclass(frozen=True)
class FittedLoop:
    """A torque loop as a recording shows it.

    Attributes:
        loop: with which the recorded torque is met best.
        deviations: standard deviation of each of its parameters, in its unit.
        lag: standard deviation in s of its whole lag, delay + sqrt(2) tau, of which less is known of either.
        noise: of the recorded torque, rms, in N.m.
        explained: share of the power of the recorded torque.
        torque: of the loop at each sample in N.m, as it is recorded, without noise.
        met: samples at which that is the recorded one, less noise.
    """

    loop: TorqueLoop
    deviations: Mapping[str, float]
    noise: float
    explained: float
    torque: np.ndarray
    met: np.ndarray
    lag: float = 0.0

    @property
    def answers(self) -> bool:
        """Whether the recorded torque is that of the demand."""
        return self.explained >= ANSWERS


def fitted(T_ref: np.ndarray, T_mot: np.ndarray, T_s: float) -> FittedLoop:
    """The torque loop by least squares, its delay between EARLIEST and LATEST.

    Args:
        T_ref: recorded demand in N.m, each held until the next, shape (n,).
        T_mot: recorded torque in N.m, with white noise, shape (n,).
        T_s: between samples in s.

    Raises:
        RecordingError: the demand does not change.
    """
    at = slice(round(UNKNOWN / T_s), len(T_ref) + round(EARLIEST / T_s))
    T = T_mot[at]
    if not np.ptp(T_ref[at]) > 0.0:
        raise RecordingError("the torque demand does not change, so that nothing can be said of motor control")

    def misses(x: np.ndarray) -> np.ndarray:
        return TorqueLoop(*x).torque(T_ref, T_s)[at] - T

    def derivatives(x: np.ndarray) -> np.ndarray:
        return TorqueLoop(*x).derivatives(T_ref, T_s)[at]

    lower, upper = (SHORTEST, -np.inf, -np.inf, EARLIEST), (LONGEST, np.inf, np.inf, LATEST)
    start = TorqueLoop(START, delay=_nearest_delay(T_ref, T_mot, T_s, at))
    noise = max(white_noise(T_mot), 1e-6 * float(np.ptp(T)))
    fit = least_squares(
        misses,
        astuple(start),
        derivatives,  # pyright: ignore[reportArgumentType]
        (lower, upper),
        x_scale="jac",
        loss="soft_l1",
        f_scale=OUTLYING * noise,
    )
    loop = TorqueLoop(*map(float, fit.x))
    torque = loop.torque(T_ref, T_s)
    off = (T_mot - torque) ** 2
    met = uniform_filter1d(off, max(round(AROUND / T_s), 3)) < (MET * noise) ** 2
    met[: at.start] = False
    rms = float(np.sqrt(off[at][met[at]].mean() if met[at].any() else off[at].mean()))
    inverse = rms * np.linalg.pinv(loop.derivatives(T_ref, T_s)[at])
    deviations = dict(zip(PARAMETERS, map(float, np.linalg.norm(inverse, axis=1)), strict=True))
    lag = float(np.linalg.norm(SQRT_2 * inverse[PARAMETERS.index("tau")] + inverse[PARAMETERS.index("delay")]))
    return FittedLoop(loop, deviations, rms, 1.0 - float(off[at].mean() / np.var(T)), torque, met, lag)


def _nearest_delay(T_ref: np.ndarray, T_mot: np.ndarray, T_s: float, at: slice) -> float:
    """The whole number of samples, in s, with which the torque goes best with that of a usual lag."""
    T = TorqueLoop(START).torque(T_ref, T_s)
    delays = range(round(EARLIEST / T_s), round(LATEST / T_s) + 1)
    along = [float(np.corrcoef(np.roll(T, k)[at], T_mot[at])[0, 1]) for k in delays]
    return delays[int(np.argmax(along))] * T_s
