"""Tables of runs and rides on the terminal."""

from collections.abc import Mapping, Sequence

from rich.box import SIMPLE_HEAD
from rich.table import Table

from toolground.tables import plain_table, print_table

from ..metrics.run_metrics import Metrics, RideMetrics
from .metrics_table import DAMPINGS, RIDES_SHOWN, SHOWN, Row, cells, legend, reasons, ride_rows

NUMBER_WIDTH = 5
"""Columns of the terminal that a number may need."""


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
