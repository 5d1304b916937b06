"""How much of the signals goes into a page."""

from collections.abc import Sequence

import numpy as np

from .linked_figures import Columns

VALUES = 550_000
"""That a page may have, of 4 bytes each and a third more as text: 3 MB."""

MOST_ROWS = 3200
"""Of one run: more than a screen has columns, and all samples of 6 s."""


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
    columns = np.array(list(table.values()), dtype=float)
    if columns.shape[1] <= rows:
        return table
    inner = columns[:, 1:-1]
    length = -(-inner.shape[1] // ((rows - 2) // 2))
    missing = -inner.shape[1] % length
    pieces = np.pad(inner, ((0, 0), (0, missing)), mode="edge").reshape(len(columns), -1, length)
    least, most = (np.where(np.isnan(pieces), end, pieces) for end in (np.inf, -np.inf))
    places = np.sort(np.stack((least.argmin(axis=2), most.argmax(axis=2)), axis=2), axis=2)
    extreme = np.take_along_axis(pieces, places, axis=2).reshape(len(columns), -1)
    return dict(zip(table, np.hstack((columns[:, :1], extreme, columns[:, -1:])), strict=True))
