"""Tables and verdicts on the terminal."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import replace
from itertools import takewhile

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.measure import Measurement
from rich.table import Column, Table
from rich.text import Text, TextType

from ..metrics.run_metrics import Metrics, RideMetrics
from .metrics_table import DAMPINGS, RIDES_SHOWN, SHOWN, Row, cells, legend, reasons, ride_rows

NUMBER_WIDTH, TEXT_WIDTH = 5, 28
"""Columns of the terminal that a number may need, and into which a text can be broken."""


def print_table(table: Table) -> None:
    """Prints a table, wide enough where stdout is not a terminal, which has a width of its own; what is wider is
    printed in parts, each with the columns of labels."""
    console = Console()
    if not console.is_terminal:
        console = Console(width=max(console.width, 120))
    for part in _parts(table, console):
        console.print(part)


def _parts(table: Table, console: Console) -> Iterator[Table]:
    """As many columns at a time as fit without a broken word."""
    if _width(table, console) <= console.width:  # at once, as each look at a width takes its time
        yield table
        return
    words = list(takewhile(lambda column: column.justify == "left", table.columns))
    labels = words if len(words) < len(table.columns) else words[:1]
    title, shown = table.title, list[Column]()
    for column in table.columns[len(labels) :]:
        if shown and _width(_of_columns(table, [*labels, *shown, column], title), console) > console.width:
            yield _of_columns(table, [*labels, *shown], title)
            title, shown = None, []
        shown.append(column)
    yield _of_columns(table, [*labels, *shown], title)


def _of_columns(table: Table, columns: Sequence[Column], title: TextType | None) -> Table:
    part = copy(table)
    part.title, part.columns = title, [replace(column, _index=k) for k, column in enumerate(columns)]
    return part


def _width(table: Table, console: Console) -> int:
    """Which it needs."""
    for column in table.columns[1:]:
        if column.justify == "left" and not column.no_wrap:
            column.max_width = TEXT_WIDTH
    return Measurement.get(console, console.options.update_width(1000), table).maximum


def plain_table(title: str, headings: Iterable[str], rows: Iterable[Sequence[str]], labels: int = 1) -> Table:
    """A table whose first columns, `labels`, tell the rows apart; the others are numbers, which stand to the right."""
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD)
    for k, heading in enumerate(headings):
        table.add_column(heading, justify="right" if k >= labels else "left", no_wrap=k < labels)
    for row in rows:
        table.add_row(*row)
    return table


MOST_PROBLEMS = 50
"""Of a rule, that are printed for people."""

SEVERITY_STYLES = {"error": "red", "warning": "yellow", "note": "cyan"}


def print_verdict(title: str, problems: Sequence[str], severity: str, rule: str, tried: bool = True) -> None:
    """Prints a rule, whether it is kept, and the first problems on lines of their own; or that it was not tried."""
    console = Console(highlight=False, soft_wrap=True)
    if problems:
        console.print(Text(f"  {severity:8}", style=SEVERITY_STYLES[severity]) + f"not: {title} [{rule}]", markup=False)
    elif tried:
        console.print(Text("  ok      ", style="green") + title)
    else:
        console.print(f"  -       not tried: {title}", markup=False)
    for problem in problems[:MOST_PROBLEMS]:
        console.print(Text(f"        - {problem}"))
    if more := len(problems[MOST_PROBLEMS:]):
        console.print(f"        ... and {more} more; `--quiet` and `--format json` have all", markup=False)


def runs_table(rows: Sequence[Row], title: str = DAMPINGS) -> Table:
    """Each plant is a section, each manoeuvre a pair of rows."""
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, padding=0)
    table.add_column("manoeuvre", no_wrap=True)
    table.add_column("", min_width=3)
    for _, column in SHOWN:
        table.add_column(
            f"{column.heading}\n{column.printed_unit}", justify="right", min_width=NUMBER_WIDTH, overflow="fold"
        )
    for k, row in enumerate(rows):
        if k == 0 or row.plant != rows[k - 1].plant:
            table.add_section()
            table.add_row(f"[bold]{row.plant}[/bold]")
        table.add_row(*cells(row), style="dim" if not row.control else "")
    return table


def print_runs(rows: Sequence[Row], title: str = DAMPINGS) -> None:
    """Prints the table of the runs, why it has dashes, and what its columns are."""
    print_table(runs_table(rows, title))
    print("\n".join([*reasons(rows), legend(Metrics), ""]))


def print_rides(rides: Mapping[str, RideMetrics], title: str, notes: Sequence[str]) -> None:
    """Prints the table of the rides, what there is to know of it, and what its columns are."""
    print_table(rides_table(rides, title))
    print("\n".join([*notes, legend(RideMetrics), ""]))


def rides_table(rides: Mapping[str, RideMetrics], title: str) -> Table:
    """A row for each ride by its name, with what it is over the first one, the undamped, in brackets."""
    headings = (f"{column.heading}\n{column.printed_unit}" for _, column in RIDES_SHOWN)
    return plain_table(title, ["", *headings], ride_rows(rides))


def rides_reasons(rides: Mapping[str, RideMetrics]) -> list[str]:
    """Why the table of the rides has dashes."""
    concerned: dict[tuple[str, ...], list[str]] = {}
    for metric, column in RIDES_SHOWN:
        for reason in dict.fromkeys(ride.absent[metric.name] for ride in rides.values() if metric.name in ride.absent):
            names = (name for name, ride in rides.items() if ride.absent.get(metric.name) == reason)
            concerned.setdefault((reason, *names), []).append(column.plain_heading)
    return [f"- {', '.join(columns)}: {reason} ({', '.join(names)})" for (reason, *names), columns in concerned.items()]
