"""Figures of a campaign: the matrices of single faults and of pairs, and the runs of one case."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

from ....models.controller.causes import OUTPUT
from ...loop import roles
from ...views.colours import BLACK, BLUE, GREY, ORANGE, VERMILION
from ...views.figure_options import FigureOptions
from ...views.figure_style import in_cell, matrix_axes, plot, sheet
from ...views.panels import Axis, Curve, Panel, Spans
from .fault_campaign import Outcome, count, plan_of
from .fault_cases import Case, Plan
from .fault_injection import Runs
from .judges import JUDGES

SHADES = LinearSegmentedColormap.from_list("shares", ("#DDEEF8", ORANGE, VERMILION))
"""Of a share of cases, from all clean to none; a cell without cases stays white."""

STATUS = {1.0: "off", 2.0: "wheel", 3.0: "no wheel", 4.0: "fallback"}
"""Of the controller."""

CAUSES = {number: word.replace("_", " ") for number, (word, _) in enumerate(OUTPUT.items, 1)}
"""Why it does not damp, or less."""


def plot_matrix(outcomes: Sequence[Outcome], title: str, stem: Path) -> list[Path]:
    """Single faults: each kind against the judges, and against where it begins on each plant; returns the files."""
    singles = [outcome for outcome in outcomes if len(outcome.kinds) == 1]
    plants = sorted({outcome.plant for outcome in singles})
    plan = plan_of(outcomes)
    kinds, situations = list(plan.kinds), list(plan.situations)
    panels = [("all judges", [judge.name for judge in JUDGES], _by_judge(singles, plan))]
    panels += [(plant, situations, _by_situation([o for o in singles if o.plant == plant], plan)) for plant in plants]
    with sheet(
        (2.5 + 0.32 * sum(len(columns) for _, columns, _ in panels), 0.235 * len(kinds) + 2.2),
        title,
        stem,
        pads=(0.04, 0.04),
    ) as (figure, files):
        widths = [len(columns) for _, columns, _ in panels]
        row = figure.subplots(1, len(panels), sharey=True, squeeze=False, width_ratios=widths)[0]
        for axes, (heading, columns, cells) in zip(row, panels, strict=True):
            _draw_cells(axes, heading, columns, kinds, cells)
        _legend(figure, row)
    return files


def _by_judge(outcomes: Sequence[Outcome], plan: Plan) -> np.ndarray:
    """For each kind and judge: cases not clean, cases."""
    return np.array([[count(outcomes, kind, judge.name) for judge in JUDGES] for kind in plan.kinds])


def _by_situation(outcomes: Sequence[Outcome], plan: Plan) -> np.ndarray:
    """For each kind and situation: cases not clean, cases."""
    cells = {(kind, situation): [0, 0] for kind in plan.kinds for situation in plan.situations}
    for outcome in outcomes:
        cell = cells[outcome.kinds[0], outcome.case.situation]
        cell[0] += bool(outcome.failed)
        cell[1] += 1
    return np.array([[cells[kind, situation] for situation in plan.situations] for kind in plan.kinds])


def plot_pairs(outcomes: Sequence[Outcome], title: str, stem: Path) -> list[Path]:
    """Pairs of faults: each kind against each other; returns the files."""
    kinds = list(plan_of(outcomes).kinds)
    cells = np.zeros((len(kinds), len(kinds), 2))
    for outcome in outcomes:
        if len(outcome.kinds) == 2:
            first, second = sorted(kinds.index(kind) for kind in outcome.kinds)
            cells[second, first] += (bool(outcome.failed), 1)
    with sheet((9.6, 9.7), title, stem, pads=(0.04, 0.04)) as (figure, files):
        axes = figure.subplots()
        _draw_cells(axes, "", kinds, kinds, cells)
        _legend(figure, [axes])
    return files


def _draw_cells(axes: Axes, heading: str, columns: Sequence[str], rows: Sequence[str], cells: np.ndarray) -> None:
    failed, total = cells[..., 0], cells[..., 1]
    shares = np.ma.masked_where(total == 0, failed / np.maximum(total, 1))
    axes.pcolormesh(shares, cmap=SHADES, vmin=0.0, vmax=1.0, edgecolors="white", linewidth=0.8)
    for row, column in zip(*np.nonzero(failed), strict=True):
        in_cell(axes, column, row, f"{failed[row, column]:.0f}", "black", 6.5)
    matrix_axes(axes, columns, rows, heading)


def _legend(figure: Figure, row: Sequence[Axes]) -> None:
    """What the colours mean, below."""
    colours = ScalarMappable(Normalize(0.0, 100.0), SHADES)
    label = "share of the runs of a cell that are not clean in %; numbers count these runs; white: no run"
    made = figure.colorbar(colours, ax=list(row), location="bottom", label=label, shrink=0.5, aspect=40.0)
    made.outline.set_visible(False)


def case_panels(case: Case, runs: Runs) -> list[Panel]:
    """The runs of a case: what the controller got, what it did, what came of it; shaded while a fault lasts."""
    faulty, healthy, undamped = runs
    t = faulty["time"]
    lasting = Spans.of([(fault.begin, min(fault.end, t[-1])) for fault in case.faults], color="#808080", alpha=0.15)

    def drawn(run: np.ndarray, name: str, label: str, color: str, width: float = 0.8, held: bool = False) -> Curve:
        return Curve(t, run[name], label, color, width=width, held=held)

    speeds = (
        drawn(faulty, "faults.omega_2_can", "wheels, received", GREY, 1.4),
        drawn(faulty, "faults.omega_1_meas", "motor, received", VERMILION),
        drawn(faulty, roles.MOTOR_SPEED, "motor, true", BLACK),
    )
    without = drawn(undamped, roles.GEAR_TORQUE, "without control", GREY, 1.4)
    torques, added, status = (
        (
            drawn(faulty, name, "with the fault", VERMILION, 1.0, name == roles.STATUS),
            drawn(healthy, name, "without it", BLUE, 0.8, name == roles.STATUS),
        )
        for name in (roles.GEAR_TORQUE, roles.DAMPING_TORQUE, roles.STATUS)
    )
    panels = [
        Panel("speed in rad/s", [lasting, *speeds]),
        Panel("gear torque in N·m", [lasting, without, *torques]),
        Panel("added torque in N·m", [lasting, *added]),
        Panel("status", [lasting, *status], bounds=(0.7, 4.3), ticks=STATUS, height=0.55),
    ]
    if roles.CAUSE in (faulty.dtype.names or ()):  # a controller of somebody else's need not have it
        found = {float(number): CAUSES[number] for number in np.unique(faulty[roles.CAUSE]).astype(int)}
        cause = drawn(faulty, roles.CAUSE, "with the fault", VERMILION, 1.0, held=True)
        panels.append(Panel("cause", [lasting, cause], bounds=(0.5, len(CAUSES) + 0.5), ticks=found, height=0.55))
    return panels


def plot_case(case: Case, runs: Runs, verdict: str, stem: Path, caption: str = "") -> list[Path]:
    """The panels of a case; returns the files."""
    x = Axis("time in s", (0.8, float(runs.faulty["time"][-1])))
    rows = [[panel] for panel in case_panels(case, runs)]
    return plot(rows, x, f"{case}\n{verdict}", stem, FigureOptions(caption), size=(7.2, 2.2), title_size=8.5)
