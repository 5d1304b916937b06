"""Tables on the terminal."""

from collections.abc import Iterable, Iterator, Sequence
from copy import copy
from dataclasses import replace
from itertools import takewhile

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.measure import Measurement
from rich.table import Column, Table
from rich.text import TextType

TEXT_WIDTH = 28
"""Columns of the terminal into which a text can be broken."""


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
