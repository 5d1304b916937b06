"""Figure of a recorded drive: the speed against the recorded one, the gear torque, a close-up for each controller."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..metrics.oscillation import amplitude
from .figures import BLACK, BLUE, GREY, STYLE, VERMILION, legend, save, titled

HEIGHT = 2.3
"""Of a row of axes, in inches."""


def plot_replay(
    runs: Mapping[str, np.ndarray], recorded: tuple[np.ndarray, np.ndarray], title: str, stem: Path, caption: str = ""
) -> list[Path]:
    """Draws the rides of a recorded drive.

    Args:
        runs: signals by the names of the rides, the undamped one first, with `time`, `plant.v`, `plant.T_gear` and
            `controller.T_driver`.
        recorded: time in s and speed in m/s of the recording.
        title: of the figure.
        stem: path of the files without their ending.
        caption: what was set, in small below.

    Returns:
        The files written.
    """
    undamped, *others = runs
    first = others[0]
    t, window = runs[undamped]["time"], _roughest(runs[undamped])
    with style.context(STYLE):
        size = (7.2, HEIGHT * (2 + len(others)) + 0.5)
        figure = Figure(figsize=size, layout=ConstrainedLayoutEngine(h_pad=0.11))
        speed, torque, *close = figure.subplots(2 + len(others), 1)
        titled(figure, title, caption)
        speed.plot(*recorded, color=GREY, lw=2.5, label="recorded")
        speed.plot(t, runs[first]["plant.v"], color=BLUE, label=f"simulated, {first}", rasterized=True)
        speed.set(ylabel="speed in m/s", xlim=(t[0], t[-1]))
        _torques(torque, runs, (undamped, first), (t[0], t[-1]))
        for axes, name in zip(close, others, strict=True):
            shown = _torques(axes, runs, (undamped, name), window)
            demand = runs[undamped]["controller.T_driver"]
            axes.plot(t[shown], demand[shown], color=BLACK, ls="--", lw=0.8, label="demand")
        close[-1].set_xlabel("time in s")
        for axes in (speed, torque, *close):
            legend(axes)
        return save(figure, stem)


def _torques(
    axes: Axes, runs: Mapping[str, np.ndarray], names: tuple[str, str], window: tuple[float, float]
) -> np.ndarray:
    """Draws the gear torque of two rides within a window; which samples are in it."""
    t = runs[names[0]]["time"]
    shown = (t >= window[0]) & (t <= window[1])
    for name, color in zip(names, (VERMILION, BLUE), strict=True):
        axes.plot(t[shown], runs[name]["plant.T_gear"][shown], color=color, label=name, rasterized=True)
    axes.set(ylabel="gear torque in N·m", xlim=window)
    return shown


def _roughest(run: np.ndarray, span: float = 6.0) -> tuple[float, float]:
    """The window of `span` seconds with the largest mean swing of the gear torque about the demand."""
    t = run["time"]
    T_s = float(t[1] - t[0])
    swing = amplitude(run["plant.T_gear"] - run["controller.T_driver"], T_s)
    length = min(round(span / T_s), len(swing))
    total = np.concatenate(([0.0], np.cumsum(swing)))
    first = int(np.argmax(total[length:] - total[:-length]))
    return float(t[first]), float(t[min(first + length, len(t) - 1)])
