"""The report of `driveline compare`: every run without and with damping."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...manoeuvres.manoeuvre import Manoeuvre
from ...views.metrics_table import SHOWN, Row, cells, number, reasons
from ...views.page.metric_dots import metric_dots
from ...views.page.paired_runs import Pair, pair_sections
from ...views.page.report import Heading, Section, Table, of_metrics, write_report
from ...views.page.report import Row as Line

RATIO = "gear_torque_rms"
"""The metric that every run has, by which the verdict goes."""


class Both(NamedTuple):
    """The rows of a manoeuvre on a plant."""

    off: Row
    on: Row

    @property
    def name(self) -> str:
        return f"{self.on.manoeuvre} on {self.on.plant}"

    @property
    def ratio(self) -> float:
        """With damping over without."""
        return getattr(self.on.metrics, RATIO) / getattr(self.off.metrics, RATIO)


def report(
    runs: Sequence[tuple[Row, np.ndarray]],
    manoeuvres: Mapping[str, Manoeuvre],
    controllers: Iterable[str],
    provenance: Mapping[str, Any],
    path: Path,
) -> None:
    """Writes the page.

    Args:
        runs: without and with damping in turn, with their signals.
        manoeuvres: by name.
        controllers: with which the runs with damping were made, by name.
        provenance: see `harness.simulation.provenance.content`.
    """
    rows = [row for row, _ in runs]
    pairs = [Both(off, on) for off, on in zip(rows[::2], rows[1::2], strict=True)]
    signals = [results for _, results in runs]
    drawn = {
        both.name: Pair(manoeuvres[both.on.manoeuvre], off, on)
        for both, off, on in zip(pairs, signals[::2], signals[1::2], strict=True)
    }
    sections = [
        Section("All runs", "A click on a row shows that run in the figures.", _table(rows)),
        Section("The worst with damping", "Of each metric the run in which it is largest.", _worst(pairs)),
        *pair_sections(drawn),
        Section("Metrics of all runs", "Grey without, blue with damping.", figures=metric_dots(rows)),
    ]
    names = " and ".join(dict.fromkeys(controllers))
    write_report(f"Without and with {names}", verdict(pairs, names), sections, provenance, path)


def verdict(pairs: Sequence[Both], controllers: str) -> str:
    """In one sentence."""
    known = [pair for pair in pairs if np.isfinite(pair.ratio)]
    if not known:
        return "No run has an oscillation that can be compared."
    worst = max(known, key=lambda pair: pair.ratio)
    better = sum(pair.ratio < 1.0 for pair in known)
    median = float(np.median([pair.ratio for pair in known]))
    return (
        f"Damping by {controllers} lowers the oscillation of the gear torque (5-50 Hz rms) in {better} of {len(known)} "
        f"runs, to {100 * median:.0f} % in the median and to {100 * worst.ratio:.0f} % where it helps least "
        f"({worst.name})."
    )


def _table(rows: Sequence[Row]) -> Table:
    lines = [Line([row.plant, *cells(row)], f"{row.manoeuvre} on {row.plant}", muted=not row.control) for row in rows]
    return Table([*map(Heading, ("plant", "manoeuvre", "damping")), *of_metrics(SHOWN)], lines, reasons(rows))


def _worst(pairs: Sequence[Both]) -> Table:
    return Table(
        [Heading("metric"), Heading("run"), Heading("with", number=True), Heading("without", number=True)],
        list(_largest(pairs)),
    )


def _largest(pairs: Sequence[Both]) -> Iterator[Line]:
    for metric, column in SHOWN:
        known = [pair for pair in pairs if np.isfinite(metric.of(pair.on.metrics))]
        if known and metric.name != "damping_ratio":
            worst = max(known, key=lambda pair: abs(metric.of(pair.on.metrics)))
            values = [number(metric.of(row.metrics), column) for row in (worst.on, worst.off)]
            yield Line([f"{column.plain_heading}, {column.unit}", worst.name, *values], worst.name)
