"""The report of `driveline robustness`: shares of the draws, their distributions, the worst of them."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from fmuloop.errors import SimulationError

from ...views.page.compared_runs import Compared, run_sections
from ...views.page.figures import Figure
from ...views.page.report import Heading, Row, Section, Table, write_report
from ...views.page.thinning import thinned
from ...views.panels import Axis
from .case_runs import CaseRunner
from .draws import draw
from .outcome import METRICS, SHOWN, VERDICTS, Outcome
from .robustness_figures import both_runs, distributions
from .summary import LEVELS, Summary, cells, goal, summaries


def report(outcomes: Sequence[Outcome], runner: CaseRunner, provenance: Mapping[str, Any], path: Path) -> None:
    """Writes the page.

    Args:
        runner: runs the worst draws again.
        provenance: see `harness.simulation.provenance.content`.
    """
    found = summaries(outcomes)
    own = [summary for summary in found if summary.controller == found[0].controller and not summary.worst.reason]
    drawn = dict(_worst_runs(own, runner))
    sections = [
        Section("All runs", _reading(), _table(found)),
        _distributions(found),
        Section(
            f"The worst draws of {found[0].controller}", "Those that settle last.", _worst(own, drawn, runner.seed)
        ),
        *(run_sections(drawn) if drawn else ()),
    ]
    count = len(found[0].outcomes)
    write_report(f"{count} random cars and sensors", verdict(found), sections, provenance, path)


def verdict(found: Sequence[Summary]) -> str:
    """In one sentence."""
    controller = found[0].controller
    plants = list(dict.fromkeys(summary.plant for summary in found))
    goals = "; ".join(f"{plant}: {goal(found, plant, controller)}" for plant in plants)
    return f"Bounded and quiet with {controller}, and 95 % of its settling times of tip-in / launch: {goals}."


def _reading() -> str:
    return f"Of each metric what {' / '.join(f'{100 * level:g}' for level in LEVELS)} % of the runs do not exceed."


def _table(found: Sequence[Summary]) -> Table:
    verdicts = {"bounded and quiet, %": ("bounded", "quiet"), "good, %": ("good",)}
    meanings = {metric.name: metric.description for metric in METRICS}
    headings = [
        *map(Heading, ("plant", "manoeuvre", "controller")),
        *(Heading(text, "; ".join(VERDICTS[name] for name in names), True) for text, names in verdicts.items()),
        *(Heading(c.titled, meanings[name], True) for name, c in SHOWN.items()),
    ]
    rows = [
        Row([s.plant, s.manoeuvre, s.controller, *cells(s)], muted=s.controller != found[0].controller) for s in found
    ]
    return Table(headings, rows)


def _distributions(found: Sequence[Summary]) -> Section:
    """Of a manoeuvre on a plant the share of the runs that stays below each value, with each controller."""
    groups: dict[str, list[Summary]] = {}
    for summary in found:
        groups.setdefault(f"{summary.manoeuvre} on {summary.plant}", []).append(summary)
    panels = {name: distributions(group) for name, group in groups.items()}
    choices = {name: thinned(each, len(panels)) for name, each in panels.items()}
    text = "Which share of the draws stays below a value; a curve ends where the rest has none, as what never settles."
    return Section("Distributions", text, figures=[Figure(choices, Axis("", (0.0, 1.0)), control="Runs")])


def _worst_runs(own: Sequence[Summary], runner: CaseRunner) -> Iterator[tuple[str, Compared]]:
    for summary in own:
        case = summary.worst.case
        with suppress(SimulationError):  # a car that is not fit to be driven without damping
            yield _name(summary), Compared(runner.manoeuvre(case), both_runs(runner, case))


def _name(summary: Summary) -> str:
    return f"{summary.manoeuvre} on {summary.plant}, draw {summary.worst.case.number}"


def _worst(own: Sequence[Summary], drawn: Mapping[str, Compared], seed: int) -> Table:
    column = SHOWN["settling_time"]
    headings = [Heading("run"), Heading(column.titled, number=True), Heading("draw")]
    rows = []
    for summary in own:
        value = column.factor * summary.worst.magnitude("settling_time")
        settled = f"{value:.{column.decimals}f}" if np.isfinite(value) else "never"
        name = _name(summary)
        rows.append(Row([name, settled, str(draw(summary.worst.case.number, seed))], name if name in drawn else ""))
    return Table(headings, rows)
