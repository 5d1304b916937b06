"""All that the test of the controller on the target has found, and its figure."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ....fmus.target.deviations import Finding, reason
from ...loop.places import T_S
from ...views.colours import BLUE, VERMILION
from ...views.figure_style import plot
from ...views.panels import DASHED, Axis, Curve, Panel
from .comparison import Comparison
from .in_loop import InLoop
from .sample_timing import Schedule
from .size import Size

TYPICAL = "prbs"
"""The manoeuvre in which controllers are compared."""


class Part(NamedTuple):
    """What a controller takes: most instructions in a sample of one manoeuvre, and flash in bytes."""

    controller: str
    instructions: int
    flash: int


class Record(NamedTuple):
    """What the target was found to do: off-line, in the loop, under a timer, and what it takes."""

    comparisons: Sequence[Comparison]
    loops: Sequence[InLoop]
    schedule: Schedule
    size: Size
    findings: Sequence[Finding] = ()
    parts: Sequence[Part] = ()

    @property
    def passed(self) -> bool:
        """Whether no bit differs, the torque of every case that the loop gave is as near to double precision as it
        must, and every deviation from the rules has its reason."""
        near = all(each.margin <= 1.0 or each.case.drawn for each in self.comparisons)
        same = not any(each.differing for each in (*self.comparisons, *self.loops))
        explained = all(reason(each) for each in self.findings)
        kept = self.schedule.missed == 0 and all(each.finite for each in self.comparisons)
        return near and same and explained and kept


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
