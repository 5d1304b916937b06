"""The share of a record that lies in a band of frequencies."""

import numpy as np

from .declaration import Absent

DRIVE_TRAIN = (5.0, 50.0)


def band_rms(x: np.ndarray, T_s: float, band: tuple[float, float] = DRIVE_TRAIN, derivative: bool = False) -> float:
    """The rms of the part of x (N samples, T_s apart) within a band in Hz, both ends included.

    The straight line from the first to the last sample is subtracted, so that a drift does not leak
    into the band; then rms = sqrt(2 sum |X|^2)/N over the band of the discrete Fourier transform X.

    Args:
        derivative: of dx/dt instead of x (X times 2 pi j f).

    Raises:
        Absent: x is shorter than a period of the lowest frequency of the band.
    """
    n = len(x)
    f = np.fft.rfftfreq(n, T_s)
    X = np.fft.rfft(x - np.linspace(x[0], x[-1], n))
    if derivative:
        X = X * (2j * np.pi * f)
    within = (f >= band[0]) & (f <= band[1])
    if band[0] * n * T_s < 1.0 and band[0] > 0.0:
        raise Absent(f"the run is shorter than a period of {band[0]:g} Hz")
    return float(np.sqrt(2.0 * np.sum(np.abs(X[within]) ** 2)) / n)
