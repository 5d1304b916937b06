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
from ..panels import DASHED, SOLID, Axis, Curve, Dashes, Panel
from .figures import Figure
from .report import Section
from .thinning import thinned

STYLES = (("without damping", GREY, 1.4), ("with damping", BLUE, 1.0))
"""Label, colour and width of the two runs."""

TIME = Axis("time in s", (0.0, 1.0))
FREQUENCY = Axis("frequency in Hz", (0.0, 25.0))

ADDED = "controller.added"
"""What the control adds to the demand, which is computed."""


class Signal(NamedTuple):
    """One that is drawn of a run without (`off`) or with (`on`) damping."""

    run: str
    name: str
    label: str
    color: str = BLACK
    dashes: Dashes = DASHED
    width: float = 0.7


def _both_of(name: str) -> list[Signal]:
    runs = zip(("off", "on"), STYLES, strict=True)
    return [Signal(run, name, label, color, SOLID, width) for run, (label, color, width) in runs]


DEMAND = Signal("off", "controller.T_driver", "demand")

PANELS: Mapping[str, list[Signal]] = {
    "gear torque in N·m": [*_both_of("plant.T_gear"), DEMAND],
    "motor torque in N·m": [
        Signal("on", "controller.T_ref", "to the motor, with damping", BLUE, SOLID, 1.0),
        Signal("on", ADDED, "of it added by the control", GREEN, SOLID, 1.0),
        DEMAND,
    ],
    "motor speed in rad/s": [*_both_of("plant.omega_1"), Signal("on", "plant.omega_2", "wheels, with damping")],
    "body acceleration in m/s²": _both_of("plant.a_body"),
}
"""What is drawn over time, by the labels of the panels."""

BEFORE, AFTER = 0.1, 1.4
"""What is shown at first of a step, in s."""


class Pair(NamedTuple):
    """The signals of a manoeuvre without and with damping."""

    manoeuvre: Manoeuvre
    off: np.ndarray
    on: np.ndarray


def pair_sections(pairs: Mapping[str, Pair]) -> Iterator[Section]:
    """The figures of runs, by their names."""
    time = {name: thinned(pair_panels(pair.off, pair.on), len(pairs)) for name, pair in pairs.items()}
    frequency = {name: _spectra(pair.off, pair.on) for name, pair in pairs.items()}
    windows = {name: shown_at_first(pair.manoeuvre) for name, pair in pairs.items()}
    text = (
        "Drag to zoom, all panels together in time, double click to see all; a click on a name hides its curve. "
        "Keys: arrows, + and -, 0."
    )
    yield Section("Over time", text, figures=[Figure(time, TIME, windows, "Run")])
    text = (
        "Amplitudes of the whole run, and the ratio of the spectra of gear torque and demand; gaps where the demand has"
        " nothing at a frequency."
    )
    yield Section("Over frequency", text, figures=[Figure(frequency, FREQUENCY, control="Run")])


def shown_at_first(manoeuvre: Manoeuvre) -> tuple[float, float]:
    """From and to when in s: the step, or else the whole manoeuvre."""
    if manoeuvre.dT is None:
        return 0.0, manoeuvre.duration
    return max(manoeuvre.t_0 - BEFORE, 0.0), min(manoeuvre.t_0 + AFTER, manoeuvre.duration)


def pair_panels(off: np.ndarray, on: np.ndarray) -> list[Panel]:
    """Torques, speed and acceleration of results without and with damping, at the samples of the controller."""
    runs = {"off": at_samples(off), "on": at_samples(on)}
    t = runs["on"]["time"]

    def values(signal: Signal) -> np.ndarray:
        run = runs[signal.run]
        if signal.name == ADDED:
            return added_torque(run["controller.T_driver"], run["controller.T_ref"])
        return run[signal.name]

    return [
        Panel(label, [Curve(t, values(each), each.label, each.color, each.dashes, each.width) for each in signals])
        for label, signals in PANELS.items()
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
