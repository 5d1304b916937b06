"""The share of a record that lies in a band of frequencies."""

import numpy as np

from .declaration import Absent

DRIVE_TRAIN, TO_50_HZ = (5.0, 50.0), (0.0, 50.0)


def band_rms(x: np.ndarray, T_s: float, band: tuple[float, float] = DRIVE_TRAIN, derivative: bool = False) -> float:
    """The rms of the part of x (N samples, T_s apart) within a band in Hz, both ends included.

    Args:
        derivative: of dx/dt instead of x.

    Raises:
        Absent: x is shorter than a period of the lowest frequency of the band.
    """
    return float(np.linalg.norm(band_parts(x, T_s, band, derivative)))


def band_parts(
    x: np.ndarray, T_s: float, band: tuple[float, float] = DRIVE_TRAIN, derivative: bool = False
) -> np.ndarray:
    """What the rms in a band is the norm of: the parts at its frequencies, complex, linear in x.

    The straight line from the first to the last sample is subtracted, so that a drift does not leak
    into the band; then rms = sqrt(2 sum |X|^2)/N over the band of the discrete Fourier transform X
    (of a derivative X times 2 pi j f).

    Args:
        x: (N,) or (N, columns), see `band_rms`.

    Returns:
        (frequencies,) or (frequencies, columns).

    Raises:
        Absent: as by `band_rms`.
    """
    n = len(x)
    f = np.fft.rfftfreq(n, T_s)
    X = np.fft.rfft(x - np.linspace(x[0], x[-1], n), axis=0)
    if derivative:
        X = (X.T * (2j * np.pi * f)).T
    within = (f >= band[0]) & (f <= band[1])
    if band[0] * n * T_s < 1.0 and band[0] > 0.0:
        raise Absent(f"the run is shorter than a period of {band[0]:g} Hz")
    return np.sqrt(2.0) / n * X[within]


def decibels(answer: np.ndarray) -> np.ndarray:
    """Of an amplitude, complex or not."""
    return 20.0 * np.log10(np.abs(answer))
