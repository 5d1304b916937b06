"""Margins of a loop, read from its gain L: how much of what may differ in a car it bears."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, nan, pi
from typing import Annotated

import numpy as np
from scipy.optimize import root_scalar

from ....models.controller import T_S
from ...metrics.declaration import Column, Metric
from .linear_loop import LinearLoop

NYQUIST = 0.5 / T_S
"""Highest frequency in Hz that the samples of a controller show."""

FREQUENCIES = np.geomspace(0.1, NYQUIST, 1200)
"""In Hz, at which crossings are looked for."""


@dataclass(frozen=True)
class Margins:
    """What the loop bears before it swings for ever; infinite where it bears everything, at a frequency that is NaN."""

    gain_margin: Annotated[
        float, Metric("1", "factor on what the controller adds", Column("gain\nmargin", "1", 1.0, 1))
    ]
    gain_frequency: Annotated[float, Metric("Hz", "frequency of that swing", Column("at", "Hz", 1.0, 1))]
    phase_margin: Annotated[
        float, Metric("rad", "phase that may be added or missing", Column("phase\nmargin", "deg", 180.0 / pi, 0))
    ]
    phase_frequency: Annotated[float, Metric("Hz", "frequency of that swing", Column("at", "Hz", 1.0, 1))]
    delay_margin: Annotated[
        float,
        Metric(
            "s", "dead time of the torque that may come to what the loop has", Column("delay\nmargin", "ms", 1e3, 1)
        ),
    ]
    delay_frequency: Annotated[float, Metric("Hz", "frequency of that swing", Column("at", "Hz", 1.0, 1))]
    M_s: Annotated[
        float,
        Metric("1", "largest |1/(1 + L)|: 1 over the distance of L from -1", Column("M_s", "1", 1.0, 2)),
    ]


def margins(loop: LinearLoop) -> Margins:
    """Margins of a loop that is stable.

    With growing gain it leaves stability where L first is real and below -1 over the gain, with a growing delay d
    where L exp(-2 pi i f d) first is -1.
    """

    def L(f: float) -> complex:
        return complex(loop.gain(np.array([f]))[0])

    found = loop.gain(FREQUENCIES)
    real = [*_zeros(lambda f: L(f).imag, FREQUENCIES[:-1], np.imag(found)[:-1]), NYQUIST]
    gains = [(-1.0 / L(f).real, f) for f in real if -1.0 < L(f).real < 0.0]
    unity = _zeros(lambda f: abs(L(f)) - 1.0, FREQUENCIES, np.abs(found) - 1.0)
    lags = [(float(np.angle(-L(f))) % (2.0 * pi), f) for f in unity]
    phases = [(min(lag, 2.0 * pi - lag), f) for lag, f in lags]
    delays = [(lag / (2.0 * pi * f), f) for lag, f in lags]
    never = [(inf, nan)]
    (gain, f_gain), (phase, f_phase), (delay, f_delay) = (min(each or never) for each in (gains, phases, delays))
    return Margins(gain, f_gain, phase, f_phase, delay, f_delay, float(np.abs(1.0 / (1.0 + found)).max()))


def _zeros(function: Callable[[float], float], at: np.ndarray, values: np.ndarray) -> list[float]:
    """Where a function is zero, between those of its values that differ in sign."""
    changes = np.flatnonzero(values[1:] * values[:-1] < 0.0)
    return [float(root_scalar(function, bracket=(at[k], at[k + 1]), xtol=1e-9).root) for k in changes]
