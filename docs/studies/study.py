"""A study: what measures the project itself, and the tables and figures that come of it.

A study is measured by a function that gives tables: columns with unit and tolerance, rows with a name. Its numbers are
kept in docs/studies/data; pages and figures are rendered from there. Its sentinels are rows that take a second or two:
`make test` computes them again and compares.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from math import isclose, isnan
from types import MappingProxyType
from typing import NamedTuple

from driveline.harness.views.panels import Drawing

Cell = float | str | None
"""A number, a word, or nothing where a number would make no sense."""


class Column(NamedTuple):
    """What a column of a table has.

    Attributes:
        unit: of its numbers; empty for words and counts.
        decimals: that are shown; None: three significant digits.
        tolerance: by which a number may be another one when it is measured again, over its magnitude. Half of the last
            decimal that is shown is always allowed.
    """

    name: str
    unit: str = ""
    decimals: int | None = None
    tolerance: float = 0.02

    @property
    def least(self) -> float:
        """What is allowed in any case, in the unit."""
        return 0.0 if self.decimals is None else 0.5 * 10.0**-self.decimals

    def within(self, was: Cell, now: Cell) -> bool:
        """Whether a cell that was measured again says the same."""
        if isinstance(was, str) or isinstance(now, str) or was is None or now is None:
            return was == now
        return isclose(now, was, rel_tol=self.tolerance, abs_tol=self.least)


class Table(NamedTuple):
    """Rows by their names, each with a cell for each column.

    Attributes:
        label: heading of the names of the rows.
        note: a sentence below it.
    """

    label: str
    columns: tuple[Column, ...]
    rows: Mapping[str, tuple[Cell, ...]]
    note: str = ""


class Measured(NamedTuple):
    """What a study finds."""

    tables: Mapping[str, Table]
    figures: Mapping[str, Drawing] = {}


Rows = Mapping[str, Collection[str]]
"""Names of rows by the tables that have them."""


class Study(NamedTuple):
    """How one is measured.

    Attributes:
        purpose: in half a sentence.
        measure: gives all tables and figures.
        again: gives tables that have the sentinels, in a second or two. Other rows in them are compared too. None:
            there are none, as of times.
        sentinels: the rows that `again` gives at least.
        seeds: of what is drawn.
        explore: with arguments of its own, for who wants to know more; it prints, and keeps nothing.
        seconds: about how long `measure` takes on two cores.
    """

    purpose: str
    measure: Callable[[], Measured]
    again: Callable[[], Mapping[str, Table]] | None = None
    sentinels: Rows = MappingProxyType({})
    seeds: Sequence[int] = (1,)
    explore: Callable[[Sequence[str]], None] | None = None
    seconds: float = 60.0


STUDIES = (
    "results",
    "goals",
    "learned_gap",
    "one_at_a_time",
    "tutorial",
    "comparison",
    "equal_jerk",
    "roads",
    "told",
    "faults",
    "robustness",
    "healthy_hours",
    "false_alarms",
    "undetectable_faults",
    "plausible_drives",
    "replay",
    "identification",
    "one_step",
    "design",
    "authority",
    "calibration",
    "vehicle_model",
    "one_car",
    "unseen_cars",
    "tuning",
    "analysis",
    "coupling",
    "target",
    "bound",
    "speed",
    "reliability",
)
"""Modules of this folder that have a STUDY; those that decide come first."""


def study(name: str) -> Study:
    """That of a name."""
    return import_module(f"{__package__}.{name}").STUDY


def number(value: Cell, column: Column) -> str:
    """A cell as it is shown."""
    if value is None or isinstance(value, str):
        return value or "-"
    if column.decimals is None:
        return f"{value:.3g}" if abs(value) < 1e3 else f"{value:.0f}"
    # adding zero turns a rounded -0 into 0
    return f"{round(value, column.decimals) + 0.0:.{column.decimals}f}"


def cell(value: float) -> float | None:
    """A number that has come out; None where there is none."""
    return None if isnan(value) else float(value)


def table_of(headings: Sequence[str], rows: Iterable[Sequence[str]], labels: int) -> Table:
    """A table from cells as they are shown: the first ones name a row, others are numbers where they can be."""
    named = {", ".join(row[:labels]): tuple(map(_parsed, row[labels:])) for row in rows}
    return Table(", ".join(filter(None, headings[:labels])), tuple(map(Column, headings[labels:])), named)


def _parsed(text: str) -> Cell:
    try:
        return None if text == "-" else float(text)
    except ValueError:
        return text


class Difference(NamedTuple):
    """A cell that is another one than it was; it may be that the row or the column is not there any more."""

    table: str
    row: str
    column: str
    was: str
    now: str
    allowed: str

    def __str__(self) -> str:
        return f"{self.table}, {self.row}, {self.column}: was {self.was}, is {self.now}, tolerance {self.allowed}"


def differences(was: Mapping[str, Table], now: Mapping[str, Table]) -> Iterator[Difference]:
    """The cells of tables that were measured again which are beyond their tolerances.

    Args:
        was: as they are kept.
        now: those that are compared; they may have less rows.
    """
    for name, table in now.items():
        before = was.get(name)
        if before is None or [column.name for column in before.columns] != [column.name for column in table.columns]:
            had, has = (", ".join(column.name for column in of.columns) if of else "none" for of in (before, table))
            yield Difference(name, "all", "columns", had, has, "none")
            continue
        for row, cells in table.rows.items():
            for k, column in enumerate(table.columns):
                old = before.rows[row][k] if row in before.rows else "no such row"
                if not column.within(old, cells[k]):
                    then, now_is = number(old, column), number(cells[k], column)
                    allowed = f"{1e2 * column.tolerance:g} %, at least {column.least:g} {column.unit}".strip()
                    yield Difference(name, row, column.name, then, now_is, allowed)
