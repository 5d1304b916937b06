"""The report of `driveline faults`: which cases are not clean, how near the others come, and the worst of them."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...views.colours import BLACK, BLUE, COLOURS, GREY, VERMILION
from ...views.html.figure_selector import chosen
from ...views.html.linked_figures import Columns, Curve, Panel, axes, linked, source_of, stacked, window
from ...views.html.report_page import Section, write_report
from ...views.html.report_tables import Heading, Row, Table
from ...views.html.thinning import stride
from .fault_campaign import Outcome, count
from .fault_catalogue import KINDS
from .fault_injection import FaultRunner, Runs
from .fault_page import HEADINGS, NOT_CLEAN, matrix_rows
from .judges import JUDGES

WORST = 6
"""Cases that are run again and drawn."""

SHARES = np.linspace(0.0, 100.0, 401)
"""In %, of the cases, at which the distributions are drawn."""

PALETTE = ("#DDEEF8", "#F0DFB9", "#E8C070", "#E69F00", "#DE7D00", "#D55E00")
"""From all clean to none."""

TIME = (
    Panel(
        "speed, rad/s",
        (
            Curve("wheels", "wheels, received", GREY, width=2.0),
            Curve("received", "motor, received", VERMILION),
            Curve("true", "motor, true", BLACK, width=1.0),
        ),
    ),
    Panel(
        "gear torque, N·m",
        (
            Curve("undamped", "without control", GREY, width=2.0),
            Curve("faulty", "with the fault", VERMILION),
            Curve("healthy", "without it", BLUE),
        ),
    ),
    Panel(
        "added torque, N·m",
        (Curve("added", "with the fault", VERMILION), Curve("usual", "without it", BLUE)),
    ),
    Panel("status (4: fallback)", (Curve("status", "with the fault", VERMILION), Curve("normal", "without it", BLUE))),
)


def report(outcomes: Sequence[Outcome], runner: FaultRunner, provenance: Mapping[str, Any], path: Path) -> None:
    """Writes the page.

    Args:
        runner: runs the worst cases again.
        provenance: see `harness.simulation.provenance.content`.
    """
    worst = sorted(outcomes, key=lambda outcome: -_over(outcome))[:WORST]
    sections = [
        Section(
            "Cases that are not clean", "Of each kind of fault how many each judge found not clean.", _table(outcomes)
        ),
        Section(
            "Kinds of faults and judges", "The share of the cases that are not clean.", figures=[_matrix(outcomes)]
        ),
        Section("How near the limits", _READING, _judges(outcomes), [stacked(_distributions(outcomes))]),
        Section("The worst cases", "Those that come nearest to a limit, or are furthest beyond it.", _worst(worst)),
        _runs(worst, runner),
    ]
    write_report(f"{len(outcomes)} cases of faults", verdict(outcomes), sections, provenance, path)


_READING = "What each judge measured over its limit; a case is clean where no judge measures more than 1."


def verdict(outcomes: Sequence[Outcome]) -> str:
    """In one sentence."""
    failed = [outcome for outcome in outcomes if outcome.failed]
    if not failed:
        return f"All {len(outcomes)} cases are clean."
    kinds = sorted(KINDS, key=lambda kind: -count(failed, kind)[0])[:2]
    often = " or ".join(kind for kind in kinds if count(failed, kind)[0])
    return (
        f"{len(outcomes) - len(failed)} of {len(outcomes)} cases are clean; what is not clean has most often {often}."
    )


def _over(outcome: Outcome) -> float:
    """The largest of what was measured over its limit; judges whose limit is to be nothing count only beyond it."""
    return max(_ratio(outcome, judge.name) for judge in JUDGES)


def _ratio(outcome: Outcome, name: str) -> float:
    limit = next(judge.limit for judge in JUDGES if judge.name == name)
    value = outcome.measured[name]
    if limit < 1e-6:
        return 2.0 if value > limit else 0.0
    return max(value, 0.0) / limit


def _table(outcomes: Sequence[Outcome]) -> Table:
    questions = {judge.name: judge.question for judge in JUDGES}
    headings = [Heading(text, questions.get(text, ""), k > 0) for k, text in enumerate(HEADINGS)]
    rows = [Row(row) for row in matrix_rows(outcomes) if row[NOT_CLEAN] != "0"]
    return Table(headings, rows, [] if rows else ["None."])


def _judges(outcomes: Sequence[Outcome]) -> Table:
    headings = [
        Heading("judge"),
        Heading("limit", number=True),
        Heading("largest", number=True),
        Heading("unit"),
        Heading("what it measures"),
    ]
    largest = {judge.name: max(outcome.measured[judge.name] for outcome in outcomes) for judge in JUDGES}
    rows = [
        Row([j.name, f"{round(j.limit, 6):g}", f"{round(largest[j.name], 6):.3g}", j.unit, j.question]) for j in JUDGES
    ]
    return Table(headings, rows)


def _matrix(outcomes: Sequence[Outcome]) -> Any:
    """Each kind against each judge."""
    from bokeh.models import ColumnDataSource, HoverTool
    from bokeh.transform import linear_cmap

    names = [judge.name for judge in JUDGES]
    cells = [(kind, name, *count(outcomes, kind, name)) for kind in KINDS for name in names]
    kept = [(kind, name, failed, total, failed / total) for kind, name, failed, total in cells if total]
    columns: dict[str, list[Any]] = dict(
        zip(("kind", "judge", "failed", "cases", "share"), map(list, zip(*kept, strict=True)), strict=True)
    )
    figure = axes("", 80 + 18 * len(KINDS), x_range=names, y_range=list(KINDS)[::-1], x_axis_location="above")
    fill = linear_cmap("share", list(PALETTE), 0.0, 1.0)
    cells = figure.rect(
        "judge", "kind", 0.96, 0.92, source=ColumnDataSource(data=columns), fill_color=fill, line_color=None
    )
    tips = [("", "@kind, @judge"), ("not clean", "@failed of @cases")]
    figure.add_tools(HoverTool(renderers=[cells], tooltips=tips))
    return figure


def _distributions(outcomes: Sequence[Outcome]) -> list[Any]:
    graded = [judge.name for judge in JUDGES if judge.limit >= 1e-6]
    columns: dict[str, np.ndarray] = {"share": SHARES}
    for name in graded:
        ratios = np.array([_ratio(outcome, name) for outcome in outcomes])
        columns[name] = np.quantile(ratios, SHARES / 100.0, method="inverted_cdf")
    curves = [Curve(name, name, COLOURS[k % len(COLOURS)]) for k, name in enumerate(graded)]
    panel = Panel("measured over limit", curves, "share")
    return linked([panel], source_of(columns), window(0.0, 100.0), "share of the cases that do not exceed it, %")


def _worst(worst: Sequence[Outcome]) -> Table:
    headings = [Heading("case"), Heading("most over its limit", "measured over limit", True), Heading("not clean")]
    return Table(
        headings,
        [Row([str(each.case), f"{_over(each):.2f}", ", ".join(each.failed) or "-"], _name(each)) for each in worst],
    )


def _name(outcome: Outcome) -> str:
    return f"case {outcome.case.number}: {' and '.join(outcome.kinds)}"


def _runs(worst: Sequence[Outcome], runner: FaultRunner) -> Section:
    signals = {_name(each): _signals(runner.runs(each.case)) for each in worst}
    every = stride(len(next(iter(signals.values()))["time"]), len(signals), 12)
    choices = {name: [{key: column[::every] for key, column in each.items()}] for name, each in signals.items()}
    windows = {_name(each): _window(each, signals[_name(each)]) for each in worst}
    x_range = window(*next(iter(windows.values())))
    control, (source,) = chosen("Case", choices, windows, x_range)
    return Section("Over time", "", figures=[control, stacked(linked(TIME, source, x_range, "time, s"))])


def _window(outcome: Outcome, signals: Columns) -> tuple[float, float]:
    """From shortly before the first fault to a second after the last."""
    end = float(signals["time"][-1])
    faults = outcome.case.faults
    return max(min(f.begin for f in faults) - 0.2, 0.0), min(max(min(f.end, end) for f in faults) + 1.0, end)


def _signals(runs: Runs) -> Columns:
    faulty, healthy, undamped = runs
    return {
        "time": faulty["time"],
        "wheels": faulty["faults.omega_2_can"],
        "received": faulty["faults.omega_1_meas"],
        "true": faulty["plant.omega_1"],
        "undamped": undamped["plant.T_gear"],
        "faulty": faulty["plant.T_gear"],
        "healthy": healthy["plant.T_gear"],
        "added": faulty["controller.T_damp"],
        "usual": healthy["controller.T_damp"],
        "status": faulty["controller.status"],
        "normal": healthy["controller.status"],
    }
