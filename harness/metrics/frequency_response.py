"""How one signal of a run answers another, over frequency."""

import numpy as np

SMOOTHED = 0.5
"""Width in Hz over which the spectra are added up."""

LEAST = 1e-3
"""Share of its largest power, below which the input has nothing to answer."""


def frequency_response(u: np.ndarray, y: np.ndarray, T_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies in Hz from 0 on and the complex response of y to u (N samples, T_s apart): the cross spectrum over
    the power of u, of the differences from sample to sample, as a step has no transform; NaN where u has nothing.
    """
    U, Y = np.fft.rfft(np.diff(u)), np.fft.rfft(np.diff(y))
    f = np.fft.rfftfreq(len(u) - 1, T_s)
    width = max(1, round(SMOOTHED * (len(u) - 1) * T_s))
    power = np.convolve(np.abs(U) ** 2, np.ones(width), "same")
    answer = np.full(len(f), complex(np.nan, np.nan))
    present = power > LEAST * power.max(initial=0.0)
    np.divide(np.convolve(Y * U.conj(), np.ones(width), "same"), power, out=answer, where=present)
    return f, answer


def amplitude_spectrum(x: np.ndarray, T_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies in Hz and amplitudes of x (N samples, T_s apart) about the line from its first to its last sample."""
    X = np.fft.rfft(x - np.linspace(x[0], x[-1], len(x)))
    return np.fft.rfftfreq(len(x), T_s), 2.0 / len(x) * np.abs(X)
