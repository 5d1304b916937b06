"""The figure of the off-line test: the torque reference of the target beside that of the model."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ...metrics.evaluate import T_S
from ...views.colours import BLACK, BLUE, VERMILION
from ...views.figure_style import STYLE, legend, save, titled
from .comparison import Comparison

SHOWN = ("tipin15r", "drive", "launch_brake")
"""Manoeuvres; the teeth cross their gap in the first two, and float in it in the last."""


def plot_comparison(comparisons: Sequence[Comparison], title: str, stem: Path) -> list[Path]:
    """Draws T_ref and the difference below it for each manoeuvre of SHOWN; returns the files."""
    shown = [each for name in SHOWN for each in comparisons if each.case.name == name]
    with style.context(STYLE):
        figure = Figure(figsize=(9.6, 4.4), layout=ConstrainedLayoutEngine(h_pad=0.1))
        titled(figure, title)
        above, below = figure.subplots(2, len(shown), sharex="col", sharey="row", squeeze=False, height_ratios=(3, 2))
        for torque, difference, each in zip(above, below, shown, strict=True):
            target, model = each.traces
            t = T_S * np.arange(len(target))
            torque.plot(t, model, color=BLUE, lw=1.6, label="model, double precision")
            torque.plot(t, target, color=VERMILION, lw=0.7, ls="--", label="target, single precision")
            difference.plot(t, 1e3 * (target - model), color=BLACK, lw=0.6)
            torque.set_title(each.case.name, pad=20)
            difference.set(xlabel="time in s", xlim=(0.0, t[-1]))
        above[0].set_ylabel(r"$T_{ref}$ in N·m")
        below[0].set_ylabel("target - model\nin mN·m")
        legend(above[0])
        return save(figure, stem)
