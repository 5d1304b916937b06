"""The figure of the off-line test: the torque reference of the target beside that of the model."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...loop.places import T_S
from ...views.colours import BLUE, VERMILION
from ...views.figure_style import plot
from ...views.panels import DASHED, Axis, Curve, Panel
from .comparison import Comparison

SHOWN = ("tipin15r", "drive", "launch_brake")
"""Manoeuvres; the teeth cross their gap in the first two, and float in it in the last."""


def plot_comparison(comparisons: Sequence[Comparison], title: str, stem: Path) -> list[Path]:
    """Draws T_ref and the difference below it for each manoeuvre of SHOWN; returns the files."""
    shown = [each for name in SHOWN for each in comparisons if each.case.name == name]
    rows = list(zip(*map(_panels, shown), strict=True))
    return plot(rows, Axis("", (0.0, 1.0)), title, stem, size=(9.6, 2.2))


def _panels(found: Comparison) -> list[Panel]:
    target, model = found.traces
    t = T_S * np.arange(len(target))
    x = Axis("time in s", (0.0, float(t[-1])))
    torques = [
        Curve(t, model, "model, double precision", BLUE, width=1.6),
        Curve(t, target, "target, single precision", VERMILION, DASHED, 0.7),
    ]
    difference = Curve(t, 1e3 * (target - model), width=0.6)
    return [
        Panel(r"$T_{ref}$ in N·m", torques, found.case.name, x=x),
        Panel("target - model\nin mN·m", [difference], height=0.67, x=x),
    ]
