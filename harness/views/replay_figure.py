"""Figure of a recorded drive: the speed against the recorded one, how far the gear torque swings, a close-up for each
controller; in the units of the recording."""

from collections.abc import Mapping
from itertools import cycle
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..metrics.declaration import Absent
from ..metrics.oscillation import amplitude
from ..metrics.spectrum import band_rms
from ..recordings.file_units import FileUnit
from .annotations import shade_gap
from .colours import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION
from .figure_options import PLAIN, FigureOptions
from .figure_style import STYLE, legend, save, titled
from .signal_lines import DASH_DOT, DASHED, DOTTED, SOLID, Dashes, Line, Panel, column, draw, envelope_of, interval

HEIGHT = 2.3
"""Of a row of axes, in inches."""

SI = {"v": FileUnit("m/s"), "T_mot": FileUnit("N.m")}

How = tuple[str, Dashes, float]
"""Colour, dashes and width."""

UNDAMPED: How = (ORANGE, SOLID, 1.8)
OTHERS: tuple[How, ...] = (
    (BLUE, SOLID, 0.9),
    (VERMILION, DASHED, 0.9),
    (BLACK, DASH_DOT, 0.9),
    (GREEN, DOTTED, 1.2),
    (PURPLE, (0.0, (8.0, 2.0)), 0.9),
    (GREY, (0.0, (2.0, 2.0)), 1.2),
)
"""The controllers, in turn."""


def plot_replay(
    runs: Mapping[str, np.ndarray],
    recorded: tuple[np.ndarray, np.ndarray],
    title: str,
    stem: Path,
    options: FigureOptions = PLAIN,
    file_units: Mapping[str, FileUnit] | None = None,
) -> list[Path]:
    """Draws the rides of a recorded drive.

    Args:
        runs: signals by the names of the rides, the undamped one first, with `time`, `plant.v`, `plant.T_gear` and
            `controller.T_driver`.
        recorded: time in s and speed in m/s of the recording.
        title: of the figure.
        stem: path of the files without their ending.
        file_units: of `v` and `T_mot` in the recording; None: SI units.

    Returns:
        The files written.
    """
    undamped, *others = runs
    t = runs[undamped]["time"]
    v, torque = (file_units or SI)["v"], (file_units or SI)["T_mot"]
    window = options.clipped(float(t[0]), float(t[-1]))
    closer = window if options.window else _roughest(runs[undamped])
    looks = {undamped: UNDAMPED} | dict(zip(others, cycle(OTHERS), strict=False))
    factor = 1.0 / torque.factor
    T_gear, T_driver = column("plant.T_gear", factor), column("controller.T_driver", factor)
    swings = envelope_of("plant.T_gear", factor)
    with style.context(STYLE):
        size = (7.2, HEIGHT * (2 + len(others)) + 0.5)
        figure = Figure(figsize=size, layout=ConstrainedLayoutEngine(h_pad=0.11))
        speed, swing, *close = rows = figure.subplots(2 + len(others), 1)
        titled(figure, title, options.caption)
        _speeds(speed, runs[others[0]], recorded, f"simulated, {others[0]}", v, window)
        for name, run in runs.items():
            _line(swing, Line(swings, _with_rms(name, run, torque), *looks[name]), run, window)
        swing.set(ylabel=f"gear torque, 5-50 Hz\nenvelope {torque}", xlim=window)
        swing.set_ylim(bottom=0.0)
        for axes, name in zip(close, others, strict=True):
            for each in (undamped, name):
                _line(axes, Line(T_gear, each, *looks[each]), runs[each], closer)
            _line(axes, Line(T_driver, "demand", BLACK, DOTTED, 1.1), runs[name], closer)
            shade_gap([axes], runs[name], closer, axes)
            axes.set(ylabel=f"gear torque\n{torque}", xlim=closer)
        for axes in rows:
            legend(axes, 2 if axes is swing else 5)
            for line in axes.lines:
                line.set_rasterized(True)  # of half an hour
        close[-1].set_xlabel("time in s")
        figure.align_ylabels()
        return save(figure, stem, options.kinds)


def _speeds(
    axes: Axes,
    run: np.ndarray,
    recorded: tuple[np.ndarray, np.ndarray],
    label: str,
    v: FileUnit,
    window: tuple[float, float],
) -> None:
    times, speeds = recorded
    at = (times >= window[0]) & (times <= window[1])
    axes.plot(times[at], speeds[at] / v.factor, color=GREY, lw=2.5, label="recorded")
    _line(axes, Line(column("plant.v", 1.0 / v.factor), label, BLUE), run, window)
    axes.set(ylabel=f"speed {v}", xlim=window)


def _line(axes: Axes, line: Line, run: np.ndarray, window: tuple[float, float]) -> None:
    draw(axes, Panel("", (line,)), run, window)


def _with_rms(name: str, run: np.ndarray, unit: FileUnit) -> str:
    """The name of a ride and the rms of its gear torque from 5 to 50 Hz."""
    try:
        rms = band_rms(run["plant.T_gear"], interval(run))
    except Absent:
        return name
    return f"{name}, rms {rms / unit.factor:.3g} {unit.printed}"


def _roughest(run: np.ndarray, span: float = 6.0) -> tuple[float, float]:
    """The window of `span` seconds with the largest mean swing of the gear torque about the demand."""
    t = run["time"]
    T_s = float(t[1] - t[0])
    swing = amplitude(run["plant.T_gear"] - run["controller.T_driver"], T_s)
    length = min(round(span / T_s), len(swing))
    total = np.concatenate(([0.0], np.cumsum(swing)))
    first = int(np.argmax(total[length:] - total[:-length]))
    return float(t[first]), float(t[min(first + length, len(t) - 1)])
