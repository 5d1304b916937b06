"""The metrics of many runs as one table: on the terminal, as Markdown, as CSV."""

import csv
from collections.abc import Sequence
from dataclasses import asdict, fields
from math import isnan
from pathlib import Path
from typing import NamedTuple

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from ..metrics.evaluate import Metrics


class Shown(NamedTuple):
    """How a metric is shown: heading (in lines), unit, factor from SI and decimals."""

    metric: str
    heading: str
    unit: str
    factor: float
    decimals: int

    @property
    def plain_heading(self) -> str:
        return self.heading.replace("-\n", "").replace("\n", " ")


class Row(NamedTuple):
    """One run in the table."""

    plant: str
    manoeuvre: str
    control: bool
    metrics: Metrics


SHOWN = (
    Shown("ts", "settling", "ms", 1e3, 0),
    Shown("OS", "over-\nshoot", "%", 1e2, 0),
    Shown("zeta", "damping\nratio", "1", 1.0, 2),
    Shown("bTg", "torque\n5-50 Hz", "N.m", 1.0, 1),
    Shown("bJ", "jerk\n5-50 Hz", "m/s3", 1.0, 1),
    Shown("imp", "impact\nspeed", "rad/s", 1.0, 1),
    Shown("t90", "delay\nto 90 %", "ms", 1e3, 0),
    Shown("loss", "torque\nwithheld", "ms", 1e3, 1),
    Shown("dT_stat", "stat.\nchange", "N.m", 1.0, 2),
)
NUMBER_WIDTH = 5
"""Columns of the terminal that a number may need."""


def wide_console() -> Console:
    """Standard output; wide enough for the tables where it is no terminal with a width of its own."""
    console = Console()
    return console if console.is_terminal else Console(width=max(console.width, 120))


def cells(row: Row) -> list[str]:
    """What the table says of a run; a metric that has no meaning for it is a dash."""
    return [row.manoeuvre, "on" if row.control else "off", *(_value(row.metrics, shown) for shown in SHOWN)]


def _value(metrics: Metrics, shown: Shown) -> str:
    value = getattr(metrics, shown.metric) * shown.factor
    # adding zero turns a rounded -0 into 0
    return "-" if isnan(value) else f"{round(value, shown.decimals) + 0.0:.{shown.decimals}f}"


def terminal_table(rows: Sequence[Row]) -> Table:
    """The table for the terminal; each plant is a section, each manoeuvre a pair of rows."""
    table = Table(
        title="without (off) and with (on) active damping",
        title_justify="left",
        box=SIMPLE_HEAD,
        padding=0,
    )
    table.add_column("manoeuvre", no_wrap=True)
    table.add_column("", min_width=3)
    for shown in SHOWN:
        table.add_column(f"{shown.heading}\n{shown.unit}", justify="right", min_width=NUMBER_WIDTH, overflow="fold")
    for k, row in enumerate(rows):
        if k == 0 or row.plant != rows[k - 1].plant:
            table.add_section()
            table.add_row(f"[bold]{row.plant}[/bold]")
        table.add_row(*cells(row), style="dim" if not row.control else "")
    return table


def write_markdown(rows: Sequence[Row], path: Path) -> None:
    """The same table as Markdown, with the plant as first column."""
    heads = ["plant", "manoeuvre", "damping", *(f"{shown.plain_heading}, {shown.unit}" for shown in SHOWN)]
    lines = [heads, ["---"] * 3 + ["---:"] * len(SHOWN), *([row.plant, *cells(row)] for row in rows)]
    path.write_text("".join(f"| {' | '.join(line)} |\n" for line in lines), encoding="utf-8")


def write_metrics(rows: Sequence[Row], path: Path) -> None:
    """All metrics in SI units as CSV, one run a line; empty where one has no meaning."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("plant", "manoeuvre", "control", *(field.name for field in fields(Metrics))))
        for row in rows:
            values = ("" if isnan(x) else f"{x:.6g}" for x in asdict(row.metrics).values())
            writer.writerow((row.plant, row.manoeuvre, int(row.control), *values))
