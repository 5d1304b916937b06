"""Figures of an identified model against its recording: free runs (paper, Fig. 5) and innovations."""

from pathlib import Path

import numpy as np
from scipy.stats import norm

from ..recordings.measurement import Measurement
from ..views.colours import BLUE, GREY
from ..views.figure_options import PLAIN, FigureOptions
from ..views.figure_style import plot
from ..views.panels import Axis, Band, Bars, Curve, Panel, Points
from .free_runs import FreeRuns, end_of, free_runs
from .identify import Identified
from .prediction import filtered
from .quality import SIMULATED, Z_95, autocorrelation

STRETCH = 3.0
"""Of the recording, its end, in s."""

LAGS = 0.2
"""Lag in s up to which the autocorrelation is drawn."""

BARS = 51
"""Of the histogram."""

NORMAL = 4.0
"""Size up to which the normal density is drawn at least."""


def plot_simulation(
    identified: Identified, recording: Measurement, stem: Path, options: FigureOptions = PLAIN
) -> list[Path]:
    """Measured and simulated speeds and torques in the units of the file, over a window or the last STRETCH, as in
    Fig. 5 of the paper.

    Args:
        recording: from which it was identified.
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    begin, end = float(recording.time[0]), float(recording.time[-1])
    window = options.clipped(begin, end) if options.window else end_of(recording, STRETCH)
    rows = [[panel] for panel in simulated(recording, free_runs(identified, recording, window))]
    title = f"Measured and simulated\n{headline(identified)}"
    return plot(rows, Axis("time in s", window), title, stem, options, size=(7.2, 1.75))


def headline(identified: Identified) -> str:
    """What was identified and how, for titles."""
    return f"{identified.name}; {identified.method}"


def simulated(recording: Measurement, runs: FreeRuns) -> list[Panel]:
    """Speeds and torques, measured and of free runs, in the units of the file; the recorded wheel speed as much earlier
    as the recording tells that it is late."""
    file_units, t = recording.file_units, recording.time
    omega_2 = recording.omega_2 if recording.valid is None else np.where(recording.valid, recording.omega_2, np.nan)
    late = next((delay.time for delay in recording.delays if delay.of == "omega_2"), 0.0)
    alone = "simulated, wheels and vehicle as one" if recording.T_load is None else "simulated"
    label = f"measured, drawn {1e3 * late:.0f} ms earlier" if late else "measured"

    def measured(y: np.ndarray, quantity: str, label: str = "measured", width: float = 1.6) -> Curve:
        return Curve(t, y / file_units[quantity].factor, label, GREY, width=width)

    def model(y: np.ndarray, quantity: str, label: str = "", width: float = 1.0) -> Curve:
        return Curve(runs.time, y / file_units[quantity].factor, label, BLUE, width=width)

    motor = measured(recording.omega_1, "omega_1", width=2.4)
    wheels = measured(omega_2, "omega_2", label)._replace(x=t - late, held=True)
    torque = measured(recording.T_mot, "T_mot", "motor, measured")
    panels = [
        Panel(
            f"motor speed\n{file_units['omega_1']}",
            [motor, model(runs.omega_1, "omega_1", f"simulated, free runs of {SIMULATED:g} s")],
        ),
        Panel(f"difference\n{file_units['omega_1']}", [model(runs.error, "omega_1", width=0.6)], height=0.62),
        Panel(f"wheel speed\n{file_units['omega_2']}", [wheels, model(runs.omega_2, "omega_2", alone)]),
        Panel(f"torque\n{file_units['T_mot']}", [torque, model(runs.T_gear, "T_mot", "gear, simulated")]),
    ]
    if recording.T_load is not None:
        load = measured(-recording.T_load, "T_load", "measured, positive when it drives", 1.0)
        panels.append(Panel(f"load torque\n{file_units['T_load']}", [load]))
    return panels


def plot_innovations(identified: Identified, stem: Path, options: FigureOptions = PLAIN) -> list[Path]:
    """The innovations over time, their distribution and their autocorrelation.

    Args:
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    size, T_s = innovations(identified), identified.drive.T_s
    t = T_s * (len(identified.drive) + np.arange(1 - len(size), 1))
    over_time = Panel("innovation over its\nstandard deviation", [Points(t, size, color=BLUE, size=1.7)])
    x, title = Axis("time from the start of the recording in s", (0.0, t[-1])), f"Innovations\n{headline(identified)}"
    rows = [[over_time], [distribution(size), autocorrelations(size, T_s)]]
    return plot(rows, x, title, stem, options, size=(7.2, 2.1), same_y=False)


def innovations(identified: Identified) -> np.ndarray:
    """What the filter did not foresee, over its standard deviation, once it has settled."""
    through = filtered(identified.drive, identified.p, identified.noise)
    return through.size[through.counted]


def distribution(size: np.ndarray) -> Panel:
    """Of the innovations, beside the normal one."""
    largest = max(NORMAL, float(abs(size).max()))
    density, edges = np.histogram(size, BARS, (-largest, largest), density=True)
    x = np.linspace(-largest, largest, 401)
    bars = Bars(0.5 * (edges[1:] + edges[:-1]), density, edges[1] - edges[0], "innovations", BLUE, 0.5)
    normal = Curve(x, norm.pdf(x), "normal")
    return Panel("density", [bars, normal], x=Axis("innovation over its standard deviation", (-largest, largest)))


def autocorrelations(size: np.ndarray, T_s: float) -> Panel:
    """Of the innovations, with what white noise has."""
    lags = np.arange(1, round(LAGS / T_s) + 1)
    white = np.full(2, Z_95 / np.sqrt(len(size)))
    band = Band(np.array([0.0, LAGS]), -white, white, "95 % of white noise", GREY, 0.4)
    bars = Bars(lags * T_s, np.array([autocorrelation(size, int(lag)) for lag in lags]), 0.5 * T_s)
    return Panel("autocorrelation", [band, bars], x=Axis("lag in s", (0.0, LAGS)))
