"""Figures of a campaign: the matrices of single faults and of pairs, and the runs of one case."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ...views.colours import BLACK, BLUE, GREY, VERMILION
from ...views.figure_style import STYLE, legend, matrix_axes, save, titled
from .fault_campaign import Outcome, count
from .fault_cases import SITUATIONS, Case
from .fault_catalogue import KINDS
from .fault_injection import Runs
from .judges import JUDGES

SHARES = LinearSegmentedColormap.from_list("shares", ("#DDEEF8", "#E69F00", "#D55E00"))
"""From all clean to none; a cell without cases stays white."""


def plot_matrix(outcomes: Sequence[Outcome], title: str, stem: Path) -> list[Path]:
    """Single faults: each kind against the judges, and against where it begins on each plant; returns the files."""
    singles = [outcome for outcome in outcomes if len(outcome.kinds) == 1]
    plants = sorted({outcome.plant for outcome in singles})
    kinds = list(KINDS)
    panels = [("all judges", [judge.name for judge in JUDGES], _by_judge(singles))]
    panels += [(plant, list(SITUATIONS), _by_situation([o for o in singles if o.plant == plant])) for plant in plants]
    with style.context(STYLE):
        figure = Figure(figsize=(9.6, 0.235 * len(kinds) + 1.7), layout=ConstrainedLayoutEngine())
        widths = [len(columns) for _, columns, _ in panels]
        row = figure.subplots(1, len(panels), sharey=True, squeeze=False, width_ratios=widths)[0]
        for axes, (heading, columns, cells) in zip(row, panels, strict=True):
            _draw_cells(axes, heading, columns, kinds, cells)
        figure.suptitle(title, fontsize=10)
        return save(figure, stem)


def _by_judge(outcomes: Sequence[Outcome]) -> np.ndarray:
    """For each kind and judge: cases not clean, cases."""
    return np.array([[count(outcomes, kind, judge.name) for judge in JUDGES] for kind in KINDS])


def _by_situation(outcomes: Sequence[Outcome]) -> np.ndarray:
    """For each kind and situation: cases not clean, cases."""
    cells = {(kind, situation): [0, 0] for kind in KINDS for situation in SITUATIONS}
    for outcome in outcomes:
        cell = cells[outcome.kinds[0], outcome.case.situation]
        cell[0] += bool(outcome.failed)
        cell[1] += 1
    return np.array([[cells[kind, situation] for situation in SITUATIONS] for kind in KINDS])


def plot_pairs(outcomes: Sequence[Outcome], title: str, stem: Path) -> list[Path]:
    """Pairs of faults: each kind against each other; returns the files."""
    kinds = list(KINDS)
    cells = np.zeros((len(kinds), len(kinds), 2))
    for outcome in outcomes:
        if len(outcome.kinds) == 2:
            first, second = sorted(kinds.index(kind) for kind in outcome.kinds)
            cells[second, first] += (bool(outcome.failed), 1)
    with style.context(STYLE):
        figure = Figure(figsize=(9.6, 9.2), layout=ConstrainedLayoutEngine())
        _draw_cells(figure.subplots(), "", kinds, kinds, cells)
        figure.suptitle(title, fontsize=10)
        return save(figure, stem)


def _draw_cells(axes: Axes, heading: str, columns: Sequence[str], rows: Sequence[str], cells: np.ndarray) -> None:
    failed, total = cells[..., 0], cells[..., 1]
    shares = np.ma.masked_where(total == 0, failed / np.maximum(total, 1))
    axes.pcolormesh(shares, cmap=SHARES, vmin=0.0, vmax=1.0, edgecolors="white", linewidth=0.8)
    for row, column in zip(*np.nonzero(failed), strict=True):
        axes.text(column + 0.5, row + 0.5, f"{failed[row, column]:.0f}", ha="center", va="center", fontsize=6.5)
    matrix_axes(axes, columns, rows, heading)


def plot_case(case: Case, runs: Runs, verdict: str, stem: Path, caption: str = "") -> list[Path]:
    """The runs of a case: what the controller got, what it did, what came of it; returns the files."""
    faulty, healthy, undamped = runs
    t = faulty["time"]
    with style.context(STYLE):
        figure = Figure(figsize=(7.2, 8.6), layout=ConstrainedLayoutEngine(h_pad=0.11))
        speed, torque, added, status = figure.subplots(4, 1, sharex=True, height_ratios=(3, 3, 3, 1.2))
        speed.plot(t, faulty["faults.omega_2_can"], color=GREY, label="wheels, received")
        speed.plot(t, faulty["faults.omega_1_meas"], color=VERMILION, lw=0.8, label="motor, received")
        speed.plot(t, faulty["plant.omega_1"], color=BLACK, lw=0.8, label="motor, true")
        torque.plot(t, undamped["plant.T_gear"], color=GREY, label="without control")
        torque.plot(t, faulty["plant.T_gear"], color=VERMILION, label="with the fault")
        torque.plot(t, healthy["plant.T_gear"], color=BLUE, lw=0.8, label="without it")
        added.plot(t, faulty["controller.T_damp"], color=VERMILION, label="with the fault")
        added.plot(t, healthy["controller.T_damp"], color=BLUE, lw=0.8, label="without it")
        status.plot(t, faulty["controller.status"], color=VERMILION, drawstyle="steps-post")
        status.plot(t, healthy["controller.status"], color=BLUE, lw=0.8, drawstyle="steps-post")
        speed.set_ylabel("speed in rad/s")
        torque.set_ylabel("gear torque in N·m")
        added.set_ylabel("added torque in N·m")
        status.set(ylabel="status", ylim=(0.7, 4.3), xlabel="time in s", xlim=(0.8, t[-1]))
        status.set_yticks((1, 2, 3, 4), ("off", "wheel", "no wheel", "fallback"))
        for axes in (speed, torque, added):
            legend(axes)
        for fault in case.faults:
            for axes in (speed, torque, added, status):
                axes.axvspan(fault.begin, min(fault.end, t[-1]), color="0.5", alpha=0.15, lw=0.0)
        titled(figure, f"{case}\n{verdict}", caption, 8.5)
        return save(figure, stem)
