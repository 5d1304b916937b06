"""Figures of an identified model against its recording: free runs (paper, Fig. 5) and innovations."""

from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from scipy.stats import norm

from ..recordings.measurement import Measurement
from ..reports.figures import BLACK, BLUE, GREY, STYLE, VERMILION, legend, save, titled
from .free_runs import FreeRuns, free_runs
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


def plot_simulation(identified: Identified, recording: Measurement, stem: Path, caption: str = "") -> list[Path]:
    """Measured and simulated speeds and torques over the last STRETCH, as in Fig. 5 of the paper.

    Args:
        recording: from which it was identified.
        stem: path of the files without their ending.
        caption: what was set, in small below.

    Returns:
        The files written.
    """
    runs = free_runs(identified, recording, STRETCH)
    drawn = [_motor_speed, _error, _wheel_speed, _torque] + [_load] * (recording.T_load is not None)
    heights = [1.0 if draw is _error else 1.6 for draw in drawn]
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 1.1 * sum(heights) + 0.7), layout=ConstrainedLayoutEngine(h_pad=0.1))
        rows = figure.subplots(len(drawn), 1, sharex=True, height_ratios=heights)
        for draw, axes in zip(drawn, rows, strict=True):
            draw(axes, recording, runs)
            if axes.get_legend_handles_labels()[0]:
                legend(axes)
        rows[-1].set(xlabel="time in s", xlim=(np.nanmin(runs.time), np.nanmax(runs.time)))
        figure.align_ylabels()
        titled(figure, f"Measured and simulated\n{said(identified)}", caption)
        return save(figure, stem)


def said(identified: Identified) -> str:
    """What was identified and how, for titles."""
    return f"{identified.name}; {identified.method}"


def _motor_speed(axes: Axes, recording: Measurement, runs: FreeRuns) -> None:
    _measured(axes, recording, runs, recording.omega_1, "measured", lw=2.4)
    axes.plot(runs.time, runs.omega_1, color=BLUE, label=f"simulated, free runs of {SIMULATED:g} s")
    axes.set_ylabel("motor speed\n" r"$\omega_1$ in rad/s")


def _error(axes: Axes, recording: Measurement, runs: FreeRuns) -> None:
    axes.plot(runs.time, runs.error, color=BLUE, lw=0.6)
    axes.set_ylabel("difference\nin rad/s")


def _wheel_speed(axes: Axes, recording: Measurement, runs: FreeRuns) -> None:
    """The recorded one as much earlier as the recording tells that it is late."""
    omega_2 = recording.omega_2 if recording.valid is None else np.where(recording.valid, recording.omega_2, np.nan)
    late = next((delay.time for delay in recording.delays if delay.of == "omega_2"), 0.0)
    label = f"measured, drawn {1e3 * late:.0f} ms earlier" if late else "measured"
    _measured(axes, recording, runs, omega_2, label, late, lw=1.6, drawstyle="steps-post")
    simulated = "simulated, wheels and vehicle as one" if recording.T_load is None else "simulated"
    axes.plot(runs.time, runs.omega_2, color=BLUE, label=simulated)
    axes.set_ylabel("wheel speed\n" r"$\omega_2$ in rad/s")


def _torque(axes: Axes, recording: Measurement, runs: FreeRuns) -> None:
    _measured(axes, recording, runs, recording.T_mot, r"$T_{mot}$, measured")
    axes.plot(runs.time, runs.T_gear, color=VERMILION, label=r"$T_{gear}$, simulated")
    axes.set_ylabel("torque\nin N·m")


def _load(axes: Axes, recording: Measurement, runs: FreeRuns) -> None:
    if recording.T_load is not None:
        _measured(axes, recording, runs, -recording.T_load, r"$-T_{load}$, measured")
    axes.set_ylabel("load torque\nin N·m")


def _measured(
    axes: Axes, recording: Measurement, runs: FreeRuns, y: np.ndarray, label: str, late: float = 0.0, **how
) -> None:
    """A recorded signal while there are runs."""
    t = recording.time - late
    shown = (t >= np.nanmin(runs.time)) & (t <= np.nanmax(runs.time))
    axes.plot(t[shown], y[shown], color=GREY, label=label, **how)


def plot_innovations(identified: Identified, stem: Path, caption: str = "") -> list[Path]:
    """The innovations over time, their distribution and their autocorrelation.

    Args:
        stem: path of the files without their ending.
        caption: what was set, in small below.

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
        titled(figure, f"Innovations\n{said(identified)}", caption)
        return save(figure, stem)


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
