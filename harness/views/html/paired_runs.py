"""Runs without and with damping, over time and over frequency; a control chooses which."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from ...manoeuvres.manoeuvre import Manoeuvre
from ...metrics.evaluate import T_S, added_torque, at_samples
from ...metrics.frequency_response import amplitude_spectrum, frequency_response
from ...metrics.spectrum import TO_50_HZ
from ..colours import BLACK, BLUE, GREEN, GREY
from .figure_selector import chosen
from .linked_figures import Columns, Curve, Panel, linked, stacked, window
from .report_page import Section
from .thinning import stride

OFF, ON, DEMAND = "without damping", "with damping", "demand"

TIME = (
    Panel(
        "gear torque, N·m",
        (
            Curve("T_gear_off", OFF, GREY, width=2.0),
            Curve("T_gear_on", ON, BLUE),
            Curve("T_driver", DEMAND, BLACK, "dashed", 1.0),
        ),
    ),
    Panel(
        "motor torque, N·m",
        (
            Curve("T_ref_on", "to the motor, with damping", BLUE),
            Curve("added", "of it added by the control", GREEN),
            Curve("T_driver", DEMAND, BLACK, "dashed", 1.0),
        ),
    ),
    Panel(
        "motor speed, rad/s",
        (
            Curve("omega_1_off", OFF, GREY, width=2.0),
            Curve("omega_1_on", ON, BLUE),
            Curve("omega_2_on", "wheels, with damping", BLACK, "dashed", 1.0),
        ),
    ),
    Panel("body acceleration, m/s²", (Curve("a_body_off", OFF, GREY, width=2.0), Curve("a_body_on", ON, BLUE))),
)
FREQUENCY = (
    Panel(
        "gear torque, N·m",
        (Curve("off", OFF, GREY, width=2.0), Curve("on", ON, BLUE), Curve("demand", DEMAND, BLACK, "dashed", 1.0)),
        "f",
        "log",
    ),
    Panel(
        "gear torque over demand",
        (Curve("H_off", OFF, GREY, width=2.0), Curve("H_on", ON, BLUE)),
        "f",
        "log",
    ),
)
BEFORE, AFTER = 0.1, 1.4
"""What is shown at first of a step, in s."""


class Pair(NamedTuple):
    """The signals of a manoeuvre without and with damping."""

    manoeuvre: Manoeuvre
    off: np.ndarray
    on: np.ndarray


def pair_sections(pairs: Mapping[str, Pair]) -> Iterator[Section]:
    """The figures of runs, by their names."""
    signals = {name: pair_signals(pair.off, pair.on) for name, pair in pairs.items()}
    columns = max(len(each) for each in signals.values())
    thin = {name: _thinned(each, stride(len(each["time"]), len(pairs), columns)) for name, each in signals.items()}
    windows = {name: shown_at_first(pair.manoeuvre) for name, pair in pairs.items()}
    x_range = window(*next(iter(windows.values())))
    control, (time, spectrum) = chosen(
        "Run", {name: (thin[name], _spectra(signals[name])) for name in signals}, windows, x_range
    )
    text = "Drag to zoom, all panels together in time; a click on a name in a legend hides its curve."
    yield Section("Over time", text, figures=[control, stacked(linked(TIME, time, x_range, "time, s"))])
    text = (
        "Amplitudes of the whole run, and the ratio of the spectra of gear torque and demand; gaps where the demand has"
        " nothing at a frequency."
    )
    figures = linked(FREQUENCY, spectrum, window(0.0, 25.0), "frequency, Hz")
    yield Section("Over frequency", text, figures=[stacked(figures)])


def shown_at_first(manoeuvre: Manoeuvre) -> tuple[float, float]:
    """From and to when in s: the step, or else the whole manoeuvre."""
    if manoeuvre.dT is None:
        return 0.0, manoeuvre.duration
    return max(manoeuvre.t_0 - BEFORE, 0.0), min(manoeuvre.t_0 + AFTER, manoeuvre.duration)


def pair_signals(off: np.ndarray, on: np.ndarray) -> Columns:
    """The columns of TIME, at the samples of the controller, of results without and with damping."""
    off, on = at_samples(off), at_samples(on)
    T_driver, T_ref = on["controller.T_driver"], on["controller.T_ref"]
    return {
        "time": on["time"],
        "T_driver": T_driver,
        "T_ref_on": T_ref,
        "added": added_torque(T_driver, T_ref),
        "omega_2_on": on["plant.omega_2"],
        **{
            f"{name}_{end}": run[f"plant.{name}"]
            for end, run in (("off", off), ("on", on))
            for name in ("T_gear", "omega_1", "a_body")
        },
    }


def _thinned(signals: Columns, every: int) -> Columns:
    return {name: signal[::every] for name, signal in signals.items()}


def _spectra(signals: Columns) -> Columns:
    demand = signals["T_driver"]
    f, amplitude = amplitude_spectrum(demand, T_S)
    at = f <= TO_50_HZ[1]
    found = {"f": f[at], "demand": amplitude[at]}
    for end in ("off", "on"):
        T_gear = signals[f"T_gear_{end}"]
        found[end] = amplitude_spectrum(T_gear, T_S)[1][at]
        g, answer = frequency_response(demand, T_gear, T_S)
        found[f"H_{end}"] = np.interp(found["f"], g, np.abs(answer))
    return found
