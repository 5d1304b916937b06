"""How much of the signals goes into a page."""

from collections.abc import Sequence

import numpy as np

from .linked_figures import Columns

VALUES = 550_000
"""That a page may have, of 4 bytes each and a third more as text: 3 MB."""

MOST_ROWS = 3000
"""Of one run: more than a screen has columns."""


def most_rows(runs: int, columns: int) -> int:
    """That a run has on a page of so many runs with so many columns."""
    return max(100, min(MOST_ROWS, VALUES // (runs * columns)))


def thinned(tables: Sequence[Columns], runs: int = 1) -> list[Columns]:
    """The tables of a run with no more rows than on a page of so many runs."""
    rows = most_rows(runs, sum(map(len, tables)))
    return [extremes(table, rows) for table in tables]


def extremes(table: Columns, rows: int) -> Columns:
    """A table in no more than so many rows.

    The first and the last row stay. Between them are pieces of equal length, of each of which every column has its
    least and its largest value, in the order in which they come. Of the abscissa these are its ends, so that an extreme
    is moved by less than the length of a piece. NaN are left out where a piece has anything else.
    """
    length = len(next(iter(table.values())))
    if length <= rows:
        return table
    return {name: np.concatenate(_pieces(column, (rows - 2) // 2)) for name, column in table.items()}


def _pieces(column: np.ndarray, count: int) -> list[np.ndarray]:
    found = [column[:1]]
    for piece in np.array_split(column[1:-1], count):
        known = np.flatnonzero(~np.isnan(piece))
        known = known if len(known) else np.arange(len(piece))
        ends = {known[piece[known].argmin()], known[piece[known].argmax()]}
        found.append(piece[[min(ends), max(ends)]])
    return [*found, column[-1:]]
