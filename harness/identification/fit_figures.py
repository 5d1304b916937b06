"""Figures of an identified model against its recording: free runs (paper, Fig. 5) and innovations."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from scipy.stats import norm

from ..recordings.measurement import Measurement
from ..views.colours import BLACK, BLUE, GREY
from ..views.figure_options import PLAIN, FigureOptions
from ..views.figure_style import STYLE, legend, save, titled
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
    runs = free_runs(identified, recording, window)
    drawn = [_motor_speed, _error, _wheel_speed, _torque] + [_load] * (recording.T_load is not None)
    heights = [1.0 if draw is _error else 1.6 for draw in drawn]
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 1.1 * sum(heights) + 0.7), layout=ConstrainedLayoutEngine(h_pad=0.1))
        rows = figure.subplots(len(drawn), 1, sharex=True, height_ratios=heights)
        for draw, axes in zip(drawn, rows, strict=True):
            draw(Row(axes, recording, runs, window))
            if axes.get_legend_handles_labels()[0]:
                legend(axes)
        rows[-1].set(xlabel="time in s", xlim=window)
        figure.align_ylabels()
        titled(figure, f"Measured and simulated\n{headline(identified)}", options.caption)
        return save(figure, stem, options.kinds)


def headline(identified: Identified) -> str:
    """What was identified and how, for titles."""
    return f"{identified.name}; {identified.method}"


class Row(NamedTuple):
    """Axes, and what can be drawn into them within a window (from and to when in s), in the units of the file."""

    axes: Axes
    recording: Measurement
    runs: FreeRuns
    window: tuple[float, float]

    def measured(self, y: np.ndarray, quantity: str, label: str, late: float = 0.0, **how: Any) -> None:
        t = self.recording.time - late
        shown = (t >= self.window[0]) & (t <= self.window[1])
        self.axes.plot(t[shown], y[shown] / self.recording.file_units[quantity].factor, color=GREY, label=label, **how)

    def simulated(self, y: np.ndarray, quantity: str, label: str | None, width: float = 1.0) -> None:
        t = self.runs.time
        shown = ~((t < self.window[0]) | (t > self.window[1]))  # and what is NaN between the runs
        y = y / self.recording.file_units[quantity].factor
        self.axes.plot(t[shown], y[shown], color=BLUE, lw=width, label=label)

    def named(self, name: str, quantity: str) -> None:
        """The name of what is drawn, with the unit."""
        self.axes.set_ylabel(f"{name}\n{self.recording.file_units[quantity]}")


def _motor_speed(row: Row) -> None:
    row.measured(row.recording.omega_1, "omega_1", "measured", lw=2.4)
    row.simulated(row.runs.omega_1, "omega_1", f"simulated, free runs of {SIMULATED:g} s")
    row.named("motor speed", "omega_1")


def _error(row: Row) -> None:
    row.simulated(row.runs.error, "omega_1", None, 0.6)
    row.named("difference", "omega_1")


def _wheel_speed(row: Row) -> None:
    """The recorded one as much earlier as the recording tells that it is late."""
    recording = row.recording
    omega_2 = recording.omega_2 if recording.valid is None else np.where(recording.valid, recording.omega_2, np.nan)
    late = next((delay.time for delay in recording.delays if delay.of == "omega_2"), 0.0)
    label = f"measured, drawn {1e3 * late:.0f} ms earlier" if late else "measured"
    row.measured(omega_2, "omega_2", label, late, lw=1.6, drawstyle="steps-post")
    simulated = "simulated, wheels and vehicle as one" if recording.T_load is None else "simulated"
    row.simulated(row.runs.omega_2, "omega_2", simulated)
    row.named("wheel speed", "omega_2")


def _torque(row: Row) -> None:
    row.measured(row.recording.T_mot, "T_mot", r"$T_{mot}$, measured", lw=1.6)
    row.simulated(row.runs.T_gear, "T_mot", r"$T_{gear}$, simulated")
    row.named("torque", "T_mot")


def _load(row: Row) -> None:
    if row.recording.T_load is not None:
        row.measured(-row.recording.T_load, "T_load", "measured, positive when it drives")
    row.named("load torque", "T_load")


def plot_innovations(identified: Identified, stem: Path, options: FigureOptions = PLAIN) -> list[Path]:
    """The innovations over time, their distribution and their autocorrelation.

    Args:
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    drive = identified.drive
    through = filtered(drive, identified.p, identified.noise)
    first, size = through.settled, through.size[through.settled :]
    t = drive.T_s * np.arange(first + 1, len(drive) + 1)
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 5.0), layout=ConstrainedLayoutEngine(h_pad=0.1, w_pad=0.1))
        grid = figure.subplot_mosaic("tt;hc")
        grid["t"].plot(t, size, ".", color=BLUE, ms=1.5, rasterized=True)
        grid["t"].set(xlabel="time from the start of the recording in s", xlim=(0.0, t[-1]))
        grid["t"].set_ylabel("innovation over its\nstandard deviation")
        _distribution(grid["h"], size)
        _autocorrelation(grid["c"], size, drive.T_s)
        titled(figure, f"Innovations\n{headline(identified)}", options.caption)
        return save(figure, stem, options.kinds)


def _distribution(axes: Axes, size: np.ndarray) -> None:
    largest = max(NORMAL, float(abs(size).max()))
    x = np.linspace(-largest, largest, 401)
    axes.hist(size, BARS, range=(-largest, largest), density=True, color=BLUE, alpha=0.5, label="innovations")
    axes.plot(x, norm.pdf(x), color=BLACK, label="normal")
    axes.set(xlabel="innovation over its standard deviation", ylabel="density", xlim=(-largest, largest))
    legend(axes)


def _autocorrelation(axes: Axes, size: np.ndarray, T_s: float) -> None:
    lags = np.arange(1, round(LAGS / T_s) + 1)
    white = Z_95 / np.sqrt(len(size))
    axes.axhspan(-white, white, color=GREY, alpha=0.4, lw=0, label="95 % of white noise")
    axes.vlines(lags * T_s, 0.0, [autocorrelation(size, int(lag)) for lag in lags], color=BLUE)
    axes.set(xlabel="lag in s", ylabel="autocorrelation", xlim=(0.0, LAGS))
    legend(axes)
