"""The metrics of many runs as one table, for people (Markdown) and for tools (CSV, JSON), and what they mean."""

from collections.abc import Iterator, Mapping, Sequence
from inspect import cleandoc
from math import isnan
from pathlib import Path
from textwrap import fill
from typing import Any, NamedTuple

from toolground.atomic_files import write_text
from toolground.csv_file import write_rows

from ..metrics.declaration import Column, declared
from ..metrics.run_metrics import Metrics, RideMetrics
from .markdown import markdown_table


class Row(NamedTuple):
    """One run in the table.

    Attributes:
        damping: "off", or "on", or of several controllers the name of its own.
    """

    plant: str
    manoeuvre: str
    damping: str
    metrics: Metrics

    @property
    def control(self) -> bool:
        return self.damping != "off"

    @property
    def run(self) -> str:
        """What it is a run of, without or with damping."""
        return f"{self.manoeuvre} on {self.plant}"


DAMPINGS = "without (off) and with (on) active damping"
"""What the rows of a manoeuvre are."""

SHOWN = [(metric, metric.column) for metric in declared(Metrics) if metric.column]
"""The metrics that the table has, and how."""

RIDES_SHOWN = [(metric, metric.column) for metric in declared(RideMetrics) if metric.column]
"""Those that the table of recorded drives has."""


def cells(row: Row) -> list[str]:
    """What the table says of a run."""
    numbers = (number(metric.of(row.metrics), column) for metric, column in SHOWN)
    return [row.manoeuvre, row.damping, *numbers]


def number(value: float, column: Column) -> str:
    """A metric as a table shows it; one that has no meaning is a dash."""
    # adding zero turns a rounded -0 into 0
    return "-" if isnan(value) else f"{round(value * column.factor, column.decimals) + 0.0:.{column.decimals}f}"


def legend(record: type) -> str:
    """What the tables of a record of metrics show, for the terminal."""
    shown = [(metric.column.plain_heading, metric.description) for metric in declared(record) if metric.column]
    width = max(len(heading) for heading, _ in shown)
    return "\n".join(
        fill(meaning, 100, initial_indent=f"  {heading:{width}}  ", subsequent_indent=" " * (width + 4))
        for heading, meaning in shown
    )


def reasons(rows: Sequence[Row]) -> list[str]:
    """Why the table of these runs has dashes: a sentence for each reason, with the columns and the runs."""
    runs: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        for metric, column in SHOWN:
            if metric.name in row.metrics.absent:
                runs.setdefault((row.metrics.absent[metric.name], column.plain_heading), []).append(row)
    headings: dict[tuple[str, str], list[str]] = {}
    for (reason, heading), concerned in runs.items():
        headings.setdefault((reason, _named(concerned, rows)), []).append(heading)
    return [f"- {', '.join(columns)}: {reason} ({where})" for (reason, where), columns in headings.items()]


def _named(some: Sequence[Row], rows: Sequence[Row]) -> str:
    """Some of the runs in words: a manoeuvre alone is all runs of it."""
    names = []
    for row in some:
        whole = all(other in some for other in rows if other.manoeuvre == row.manoeuvre)
        names.append(row.manoeuvre if whole else f"{row.plant} {row.manoeuvre} {row.damping}")
    return ", ".join(dict.fromkeys(names))


def write_markdown(rows: Sequence[Row], path: Path, title: str = DAMPINGS) -> None:
    """Writes the table, with the plant as first column, and what every metric means."""
    headings = ["plant", "manoeuvre", "damping", *(column.titled for _, column in SHOWN)]
    table = markdown_table(headings, ([row.plant, *cells(row)] for row in rows), labels=3)
    meanings = [
        (metric.column.plain_heading if metric.column else "", f"`{metric.key}`", metric.description)
        for metric in declared(Metrics)
    ]
    explained = markdown_table(("column", "in `metrics.csv`", "meaning"), meanings, labels=3)
    dashes = "\n".join(reasons(rows))
    table += f"\n\n{dashes}" if dashes else ""
    above = "" if title == DAMPINGS else f"{title}\n\n"  # pages with the table have headings of their own
    write_text(f"{above}{table}\n\n{cleandoc(Metrics.__doc__ or '')}\n\n{explained}\n", path)


def ride_rows(rides: Mapping[str, RideMetrics]) -> Iterator[list[str]]:
    """A row for each ride by its name, with what it is over the first one, the undamped, in brackets."""
    undamped = next(iter(rides.values()))
    for name, ride in rides.items():
        yield [name, *(_compared(metric.of(ride), metric.of(undamped), column) for metric, column in RIDES_SHOWN)]


def _compared(value: float, other: float, column: Column) -> str:
    """A value in the unit of its column, and in brackets its ratio to another one."""
    if isnan(value):
        return "-"
    ratio = f"{value / other:.3f}" if other and not isnan(other) else "-"
    return f"{value * column.factor:.3g} ({ratio})"


def write_rides(rides: Mapping[str, RideMetrics], title: str, path: Path, notes: Sequence[str] = ()) -> None:
    """Writes the table of the rides as Markdown, and below it what there is to know of it."""
    headings = [title, *(column.titled for _, column in RIDES_SHOWN)]
    below = "".join(f"\n{note}\n" for note in notes)
    write_text(f"{markdown_table(headings, ride_rows(rides), labels=1)}\n{below}", path)


def values(metrics: Any) -> dict[str, Any]:
    """All metrics of a record by their keys, in SI units; None where one has no value, and under "absent" why."""
    every = declared(type(metrics))
    found = {metric.key: metric.of(metrics) for metric in every}
    absent = {metric.key: metrics.absent[metric.name] for metric in every if metric.name in metrics.absent}
    return {key: None if isnan(value) else value for key, value in found.items()} | {"absent": absent}


def write_metrics(runs: Sequence[dict[str, Any]], path: Path) -> None:
    """Writes CSV: one run a line, its labels and its metrics; what is None stays empty."""
    write_rows(list(runs[0]), ([_cell(value) for value in run.values()] for run in runs), path)


def _cell(value: object) -> object:
    match value:
        case None:
            return ""
        case bool():
            return int(value)
        case float():
            return f"{value:.6g}"
        case dict():
            keys = {text: [key for key in value if value[key] == text] for text in value.values()}
            return "; ".join(f"{', '.join(names)}: {text}" for text, names in keys.items())
    return value
