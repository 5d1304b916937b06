"""The report of `driveline faults`: which cases are not clean, how near the others come, and the worst of them."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.colors import to_hex

from toolground.plain_text import printed

from ...views.colours import COLOURS
from ...views.page.figures import Figure, figure
from ...views.page.report import Heading, Row, Section, Table, write_report
from ...views.page.thinning import thinned
from ...views.panels import Axis, Curve, Panel
from .fault_campaign import Outcome, count, coverage, plan_of
from .fault_figures import SHADES, case_panels
from .fault_injection import FaultRunner
from .fault_report import HEADINGS, NOT_CLEAN, matrix_rows
from .judges import JUDGES

WORST = 6
"""Cases that are run again and drawn."""

SHARES = np.linspace(0.0, 100.0, 401)
"""In %, of the cases, at which the distributions are drawn."""


def report(outcomes: Sequence[Outcome], runner: FaultRunner, provenance: Mapping[str, Any], path: Path) -> None:
    """Writes the page.

    Args:
        runner: runs the worst cases again.
        provenance: see `harness.simulation.provenance.content`.
    """
    worst = sorted(outcomes, key=lambda outcome: -_over(outcome))[:WORST]
    sections = [
        Section(
            "Cases that are not clean",
            f"Of each kind of fault how many each judge found not clean. {coverage(outcomes)}".strip(),
            _table(outcomes),
        ),
        Section("Kinds of faults and judges", "The cases that are not clean, in % of all.", _matrix(outcomes)),
        Section("How near the limits", _READING, _judges(outcomes), [_distributions(outcomes)]),
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
    kinds = sorted(plan_of(outcomes).kinds, key=lambda kind: -count(failed, kind)[0])[:2]
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
        Row([j.name, f"{round(j.limit, 6):g}", f"{round(largest[j.name], 6):.3g}", printed(j.unit), j.question])
        for j in JUDGES
    ]
    return Table(headings, rows)


def _matrix(outcomes: Sequence[Outcome]) -> Table:
    """Each kind against each judge; a cell without cases is empty."""
    names = [judge.name for judge in JUDGES]
    rows = []
    for kind in plan_of(outcomes).kinds:
        shares = [
            failed / total if total else None for failed, total in (count(outcomes, kind, name) for name in names)
        ]
        cells = ["" if share is None else f"{100.0 * share:.0f}" for share in shares]
        shades = ["" if share is None else to_hex(SHADES(share)) for share in shares]
        rows.append(Row([kind, *cells], shades=["", *shades]))
    return Table([Heading("kind"), *(Heading(name, number=True) for name in names)], rows)


def _distributions(outcomes: Sequence[Outcome]) -> Figure:
    curves = []
    for k, name in enumerate(judge.name for judge in JUDGES if judge.limit >= 1e-6):
        ratios = np.array([_ratio(outcome, name) for outcome in outcomes])
        levels = np.quantile(ratios, SHARES / 100.0, method="inverted_cdf")
        curves.append(Curve(SHARES, levels, name, COLOURS[k % len(COLOURS)]))
    x = Axis("share of the cases that do not exceed it in %", (0.0, 100.0))
    return figure([Panel("measured over limit", curves)], x)


def _worst(worst: Sequence[Outcome]) -> Table:
    headings = [Heading("case"), Heading("most over its limit", "measured over limit", True), Heading("not clean")]
    return Table(
        headings,
        [Row([str(each.case), f"{_over(each):.2f}", ", ".join(each.failed) or "-"], _name(each)) for each in worst],
    )


def _name(outcome: Outcome) -> str:
    return f"case {outcome.case.number}: {' and '.join(outcome.kinds)}"


def _runs(worst: Sequence[Outcome], runner: FaultRunner) -> Section:
    panels = {_name(each): case_panels(each.case, runner.runs(each.case)) for each in worst}
    choices = {name: thinned(each, len(worst)) for name, each in panels.items()}
    windows = {_name(each): _window(each) for each in worst}
    return Section("Over time", figures=[Figure(choices, Axis("time in s", (0.0, 1.0)), windows, "Case")])


def _window(outcome: Outcome) -> tuple[float, float]:
    """From shortly before the first fault to a second after the last."""
    faults, duration = outcome.case.faults, outcome.case.plan.situations[outcome.case.situation].duration
    return max(min(f.begin for f in faults) - 0.2, 0.0), min(max(f.end for f in faults) + 1.0, duration)
