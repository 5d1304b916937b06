"""Runs without and with damping, over time and over frequency; a control chooses which."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from ...loop.places import T_S
from ...manoeuvres.manoeuvre import Manoeuvre
from ...metrics.evaluate import added_torque, at_samples
from ...metrics.frequency_response import amplitude_spectrum, frequency_response
from ...metrics.spectrum import TO_50_HZ
from ..colours import BLACK, BLUE, GREEN, GREY
from ..panels import DASHED, Axis, Curve, Panel
from .figure_selector import chosen
from .linked_figures import linked, shown, stacked, tables
from .report_page import Section
from .thinning import thinned

STYLES = (("without damping", GREY, 1.4), ("with damping", BLUE, 1.0))
"""Label, colour and width of the two runs."""

TIME = Axis("time in s", (0.0, 1.0))
FREQUENCY = Axis("frequency in Hz", (0.0, 25.0))

NEEDED = [
    "time",
    *(f"controller.{name}" for name in ("T_driver", "T_ref")),
    *(f"plant.{name}" for name in ("T_gear", "omega_1", "omega_2", "a_body")),
]
"""The columns of results that are drawn."""

BEFORE, AFTER = 0.1, 1.4
"""What is shown at first of a step, in s."""


class Pair(NamedTuple):
    """The signals of a manoeuvre without and with damping."""

    manoeuvre: Manoeuvre
    off: np.ndarray
    on: np.ndarray


def pair_sections(pairs: Mapping[str, Pair]) -> Iterator[Section]:
    """The figures of runs, by their names."""
    time = {name: pair_panels(pair.off, pair.on) for name, pair in pairs.items()}
    frequency = {name: _spectra(pair.off, pair.on) for name, pair in pairs.items()}
    choices = {name: [*thinned(tables(time[name]), len(pairs)), *tables(frequency[name])] for name in pairs}
    windows = {name: shown_at_first(pair.manoeuvre) for name, pair in pairs.items()}
    first = next(iter(pairs))
    x_range = shown(TIME._replace(window=windows[first]))
    control, (of_time, *of_frequency) = chosen("Run", choices, windows, x_range)
    text = "Drag to zoom, all panels together in time; a click on a name in a legend hides its curve."
    figures = linked(time[first], TIME, x_range, [of_time])
    yield Section("Over time", text, figures=[control, stacked(figures)])
    text = (
        "Amplitudes of the whole run, and the ratio of the spectra of gear torque and demand; gaps where the demand has"
        " nothing at a frequency."
    )
    figures = linked(frequency[first], FREQUENCY, sources=of_frequency)
    yield Section("Over frequency", text, figures=[stacked(figures)])


def shown_at_first(manoeuvre: Manoeuvre) -> tuple[float, float]:
    """From and to when in s: the step, or else the whole manoeuvre."""
    if manoeuvre.dT is None:
        return 0.0, manoeuvre.duration
    return max(manoeuvre.t_0 - BEFORE, 0.0), min(manoeuvre.t_0 + AFTER, manoeuvre.duration)


def pair_panels(off: np.ndarray, on: np.ndarray) -> list[Panel]:
    """Torques, speed and acceleration of results without and with damping, at the samples of the controller."""
    off, on = at_samples(off), at_samples(on)
    t, T_driver, T_ref = on["time"], on["controller.T_driver"], on["controller.T_ref"]
    demand = Curve(t, T_driver, "demand", BLACK, DASHED, 0.7)

    def both(name: str) -> list[Curve]:
        return _both(t, off[f"plant.{name}"], on[f"plant.{name}"])

    to_motor = Curve(t, T_ref, "to the motor, with damping", BLUE)
    added = Curve(t, added_torque(T_driver, T_ref), "of it added by the control", GREEN)
    wheels = Curve(t, on["plant.omega_2"], "wheels, with damping", BLACK, DASHED, 0.7)
    return [
        Panel("gear torque in N·m", [*both("T_gear"), demand]),
        Panel("motor torque in N·m", [to_motor, added, demand]),
        Panel("motor speed in rad/s", [*both("omega_1"), wheels]),
        Panel("body acceleration in m/s²", both("a_body")),
    ]


def _both(x: np.ndarray, *signals: np.ndarray) -> list[Curve]:
    """Without and with damping."""
    styled = zip(signals, STYLES, strict=True)
    return [Curve(x, signal, label, color, width=width) for signal, (label, color, width) in styled]


def _spectra(off: np.ndarray, on: np.ndarray) -> list[Panel]:
    """Amplitudes of demand and gear torque, and the one over the other."""
    off, on = at_samples(off), at_samples(on)
    demand = on["controller.T_driver"]
    f, amplitude = amplitude_spectrum(demand, T_S)
    at = f <= TO_50_HZ[1]
    f = f[at]
    demanded = Curve(f, amplitude[at], "demand", BLACK, DASHED, 0.7)
    torques = [run["plant.T_gear"] for run in (off, on)]
    answers = [frequency_response(demand, T_gear, T_S) for T_gear in torques]
    amplitudes = _both(f, *(amplitude_spectrum(T_gear, T_S)[1][at] for T_gear in torques))
    ratios = _both(f, *(np.interp(f, g, np.abs(answer)) for g, answer in answers))
    return [
        Panel("gear torque in N·m", [*amplitudes, demanded], scale="log"),
        Panel("gear torque over demand", ratios, scale="log"),
    ]
