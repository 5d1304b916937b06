"""The report of `driveline compare`: every run without damping and with each controller."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...manoeuvres.manoeuvre import Manoeuvre
from ...views.metrics_table import SHOWN, Row, cells, number, reasons
from ...views.page.compared_runs import Compared, run_sections
from ...views.page.metric_dots import metric_dots
from ...views.page.report import Heading, Section, Table, of_metrics, write_report
from ...views.page.report import Row as Line
from ...views.signal_lines import WITHOUT
from .compare import Outcome, rows_of, together

RATIO = "gear_torque_rms"
"""The metric that every run has, by which the verdict goes."""


def report(
    outcomes: Sequence[Outcome], manoeuvres: Mapping[str, Manoeuvre], provenance: Mapping[str, Any], path: Path
) -> None:
    """Writes the page.

    Args:
        outcomes: of each manoeuvre on each plant, without damping and then with each controller.
        manoeuvres: by name.
        provenance: see `harness.simulation.provenance.content`.
    """
    rows, runs = rows_of(outcomes), together(outcomes)
    drawn = {
        each[0].row().run: Compared(
            manoeuvres[each[0].case.manoeuvre], {one.case.controller_name: one.results for one in each}
        )
        for each in runs
    }
    metrics = {each[0].row().run: {one.case.controller_name: one.metrics for one in each} for each in runs}
    sections = [
        Section("All runs", "A click on a row shows that run in the figures.", _table(rows)),
        Section("The worst with damping", "Of each metric the run in which it is largest.", _worst(runs)),
        *run_sections(drawn),
        Section("Metrics of all runs", "Grey without damping.", figures=metric_dots(metrics)),
    ]
    names = [each.case.controller_name for each in runs[0][1:]]
    swings = {run: {name: getattr(one, RATIO) for name, one in each.items()} for run, each in metrics.items()}
    sentences = [verdict({run: each[name] / each[WITHOUT] for run, each in swings.items()}, name) for name in names]
    write_report(f"Without and with {', '.join(names)}", " ".join(sentences), sections, provenance, path)


def verdict(ratios: Mapping[str, float], controller: str) -> str:
    """In one sentence.

    Args:
        ratios: by the names of the runs what swings with the controller over what swings without damping.
    """
    known = {run: ratio for run, ratio in ratios.items() if np.isfinite(ratio)}
    if not known:
        return f"No run with {controller} has an oscillation that can be compared."
    worst = max(known, key=known.__getitem__)
    better, median = sum(ratio < 1.0 for ratio in known.values()), float(np.median(list(known.values())))
    return (
        f"Damping by {controller} lowers the oscillation of the gear torque (rms) in {better} of {len(known)} "
        f"runs, to {100 * median:.0f} % in the median and to {100 * known[worst]:.0f} % where it helps least ({worst})."
    )


def _table(rows: Sequence[Row]) -> Table:
    lines = [Line([row.plant, *cells(row)], row.run, muted=not row.control) for row in rows]
    return Table([*map(Heading, ("plant", "manoeuvre", "damping")), *of_metrics(SHOWN)], lines, reasons(rows))


def _worst(runs: Sequence[Sequence[Outcome]]) -> Table:
    """For each controller the run in which a metric is largest, and the same run of the others."""
    names = [each.case.controller_name for each in runs[0]]
    headings = [Heading("metric"), Heading("largest in"), *(Heading(name, number=True) for name in names)]
    return Table(headings, [line for k in range(1, len(names)) for line in _largest(runs, k)])


def _largest(runs: Sequence[Sequence[Outcome]], k: int) -> Iterator[Line]:
    for metric, column in SHOWN:
        known = [each for each in runs if np.isfinite(metric.of(each[k].metrics))]
        if known and metric.name != "damping_ratio":
            worst = max(known, key=lambda each: abs(metric.of(each[k].metrics)))
            values = [number(metric.of(one.metrics), column) for one in worst]
            run, several = worst[k].row().run, len(worst) > 2
            name = f"{run}, {worst[k].case.controller_name}" if several else run
            yield Line([column.titled, name, *values], run)
