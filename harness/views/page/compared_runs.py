"""Runs without damping and with each controller, over time and over frequency; a control chooses which."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from ...loop import roles
from ...loop.places import T_S
from ...manoeuvres.manoeuvre import Manoeuvre
from ...metrics.evaluate import added_torque, at_samples
from ...metrics.frequency_response import amplitude_spectrum, frequency_response
from ...metrics.spectrum import TO_50_HZ
from ..annotations import shown_at_first
from ..colours import BLACK, GREEN
from ..panels import DASHED, SOLID, Axis, Curve, Dashes, Panel
from ..signal_lines import CONTROLLERS, UNDAMPED, WITHOUT, Runs, looks_of
from .figures import Figure
from .report import Section
from .thinning import thinned

TIME = Axis("time in s", (0.0, 1.0))
FREQUENCY = Axis("frequency in Hz", (0.0, 25.0))

ADDED = "controller.added"
"""What the control adds to the demand, which is computed."""


DAMPED = "with damping"
"""In the label of a curve, for the name of the controller."""


class Signal(NamedTuple):
    """One that is drawn of a run without (`off`) or with (`on`) damping.

    Attributes:
        of_each: it is drawn of every controller, as all curves of that are, instead of the first alone.
    """

    run: str
    name: str
    label: str
    color: str = BLACK
    dashes: Dashes = DASHED
    width: float = 0.7
    of_each: bool = False


def _both_of(name: str) -> list[Signal]:
    return [Signal("off", name, WITHOUT, *UNDAMPED), Signal("on", name, DAMPED, *CONTROLLERS[0], True)]


DEMAND = Signal("off", roles.DEMAND, "demand")

PANELS: Mapping[str, list[Signal]] = {
    "gear torque in N·m": [*_both_of(roles.GEAR_TORQUE), DEMAND],
    "motor torque in N·m": [
        Signal("on", roles.REFERENCE_TORQUE, f"to the motor, {DAMPED}", *CONTROLLERS[0], True),
        Signal("on", ADDED, "of it added by the control", GREEN, SOLID, 1.0),
        DEMAND,
    ],
    "motor speed in rad/s": [*_both_of(roles.MOTOR_SPEED), Signal("on", roles.WHEEL_SPEED, f"wheels, {DAMPED}")],
    "body acceleration in m/s²": _both_of(roles.BODY_ACCELERATION),
}
"""What is drawn over time, by the labels of the panels."""


class Compared(NamedTuple):
    """The runs of a manoeuvre."""

    manoeuvre: Manoeuvre
    runs: Runs


def run_sections(compared: Mapping[str, Compared]) -> Iterator[Section]:
    """The figures of runs, by their names."""
    sampled = {name: {one: at_samples(run) for one, run in each.runs.items()} for name, each in compared.items()}
    time = {name: thinned(run_panels(runs), len(compared)) for name, runs in sampled.items()}
    frequency = {name: _spectra(runs) for name, runs in sampled.items()}
    windows = {name: shown_at_first(each.manoeuvre) for name, each in compared.items()}
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


def run_panels(runs: Runs) -> list[Panel]:
    """Torques, speed and acceleration of results, at the samples of the controller; of the first controller alone what
    is no signal of every run."""
    return [Panel(label, [c for each in signals for c in _curves(each, runs)]) for label, signals in PANELS.items()]


def _curves(signal: Signal, runs: Runs) -> Iterator[Curve]:
    damped = [name for name in runs if name != WITHOUT]
    for name in [WITHOUT] if signal.run == "off" else damped if signal.of_each else damped[:1]:
        look = looks_of(runs)[name] if signal.of_each else (signal.color, signal.dashes, signal.width)
        yield Curve(runs[name]["time"], _values(signal, runs[name]), signal.label.replace(DAMPED, name), *look)


def _values(signal: Signal, run: np.ndarray) -> np.ndarray:
    if signal.name == ADDED:
        return added_torque(run[roles.DEMAND], run[roles.REFERENCE_TORQUE])
    return run[signal.name]


def _spectra(runs: Runs) -> list[Panel]:
    """Amplitudes of demand and gear torque, and the one over the other."""
    demand, looks = runs[WITHOUT][roles.DEMAND], looks_of(runs)
    f, amplitude = amplitude_spectrum(demand, T_S)
    at = f <= TO_50_HZ[1]
    f = f[at]
    amplitudes, ratios = list[Curve](), list[Curve]()
    for name, run in runs.items():
        T_gear = run[roles.GEAR_TORQUE]
        g, answer = frequency_response(demand, T_gear, T_S)
        amplitudes.append(Curve(f, amplitude_spectrum(T_gear, T_S)[1][at], name, *looks[name]))
        ratios.append(Curve(f, np.interp(f, g, np.abs(answer)), name, *looks[name]))
    amplitudes.append(Curve(f, amplitude[at], "demand", BLACK, DASHED, 0.7))
    return [Panel("gear torque in N·m", amplitudes, scale="log"), Panel("gear torque over demand", ratios, scale="log")]
