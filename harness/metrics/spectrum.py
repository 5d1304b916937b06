"""The share of a record that lies in a band of frequencies."""

from functools import cached_property

import numpy as np

from .declaration import Absent

FREQUENCY = 8.0
"""At which the drive train of the default car swings, Hz: sqrt(C (1/J_1 + 1/J_2))/(2 pi)."""

DRIVE_TRAIN, TO_50_HZ = (5.0, 50.0), (0.0, 50.0)
"""Bands in Hz: what the drive train of the default car makes, and all that is felt."""


def own_band(frequency: float | None) -> tuple[float, float]:
    """The band in Hz, to a tenth, of a drive train that swings at this frequency in Hz, None: as the default car."""
    low, high = (round(edge * (frequency or FREQUENCY) / FREQUENCY, 1) for edge in DRIVE_TRAIN)
    return low, high


MOST_AT_ONCE = 2**18
"""Samples up to which one transform takes all; it takes 100 bytes a sample where their number is prime."""

BLOCK = 2**17
"""Samples of a part of a longer record."""


def band_rms(x: np.ndarray, T_s: float, band: tuple[float, float] = DRIVE_TRAIN, derivative: bool = False) -> float:
    """The rms of the part of x (N samples, T_s apart) within a band in Hz, both ends included.

    Args:
        derivative: of dx/dt instead of x.

    Raises:
        Absent: x is shorter than a period of the lowest frequency of the band.
    """
    return BandSpectrum(x, T_s).rms(band, derivative)


class BandSpectrum:
    """That of x, (N,) or (N, columns), T_s apart, for several bands.

    The straight line from the first to the last sample is subtracted, so that a drift does not leak
    into the band; then rms = sqrt(2 sum |X|^2)/N over the band of the discrete Fourier transform X
    (of a derivative X times 2 pi j f).
    """

    def __init__(self, x: np.ndarray, T_s: float) -> None:
        self._x, self._T_s = x, T_s

    @cached_property
    def _without_line(self) -> np.ndarray:
        line = np.linspace(self._x[0], self._x[-1], len(self._x))
        return np.subtract(self._x, line, out=line)

    @cached_property
    def _transform(self) -> np.ndarray:
        return np.fft.rfft(self._without_line, axis=0)

    def rms(self, band: tuple[float, float], derivative: bool = False) -> float:
        """As by `band_rms`."""
        return float(np.linalg.norm(self.parts(band, derivative)))

    def parts(self, band: tuple[float, float], derivative: bool = False) -> np.ndarray:
        """What the rms in a band is the norm of: the parts at its frequencies, complex, linear in x.

        Returns:
            (frequencies,) or (frequencies, columns).

        Raises:
            Absent: as by `band_rms`.
        """
        n = len(self._x)
        if band[0] * n * self._T_s < 1.0 and band[0] > 0.0:
            raise Absent(f"the run is shorter than a period of {band[0]:g} Hz")
        f = np.fft.rfftfreq(n, self._T_s)
        within = np.flatnonzero((f >= band[0]) & (f <= band[1]))
        X = self._transform[within] if n <= MOST_AT_ONCE else _in_blocks(self._without_line, within)
        if derivative:
            X = (X.T * (2j * np.pi * f[within])).T
        return np.sqrt(2.0) / n * X


def _in_blocks(x: np.ndarray, k: np.ndarray) -> np.ndarray:
    """X_k = sum x_l exp(-2 pi j k l/N) of x (N,) at whole numbers k that follow each other, block by block.

    Each block is a convolution, since 2 i l = i^2 + l^2 - (i - l)^2 (Bluestein).
    """
    from scipy.fft import next_fast_len  # scipy.signal takes 60 MB

    n = len(x)

    def turned(halves: np.ndarray) -> np.ndarray:
        """exp(-pi j halves/N), exact for whole numbers of any size."""
        return np.exp(-1j * np.pi / n * (halves % (2 * n)))

    i, at = k - k[0], np.arange(BLOCK)
    length = next_fast_len(len(k) + 2 * BLOCK - 2)
    chirp = np.fft.fft(turned(-(np.arange(1 - BLOCK, len(k)) ** 2)), length)
    X = np.zeros(len(k), complex)
    for first in range(0, n, BLOCK):
        part = np.resize(x[first : first + BLOCK], BLOCK) * (at < n - first)
        block = np.fft.fft(part * turned(at * at + 2 * k[0] * (first + at)), length)
        convolved = np.fft.ifft(chirp * block)[BLOCK - 1 : BLOCK - 1 + len(k)]
        X += turned(i * i + 2 * i * first) * convolved
    return X


def decibels(answer: np.ndarray) -> np.ndarray:
    """Of an amplitude, complex or not."""
    return 20.0 * np.log10(np.abs(answer))
