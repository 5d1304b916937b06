"""How much of the signals goes into a page."""

from collections.abc import Sequence

import numpy as np

from .linked_figures import Columns

VALUES = 550_000
"""That a page may have, of 4 bytes each and a third more as text: 3 MB."""

MOST_ROWS = 3000
"""Of one run: more than a screen has columns."""


def stride(rows: int, of_how_many: int, columns: int) -> int:
    """Every how many-th row of a run is kept, where a page has so many runs of so many columns."""
    return max(1, -(-rows // max(100, min(MOST_ROWS, VALUES // (of_how_many * columns)))))


def thinned(tables: Sequence[Columns], runs: int) -> list[Columns]:
    """The tables of a run with as many rows as a page of so many runs has."""
    columns = sum(map(len, tables))
    return [{name: column[:: stride(len(column), runs, columns)] for name, column in table.items()} for table in tables]


def extremes(t: np.ndarray, signals: np.ndarray, pieces: int) -> tuple[np.ndarray, np.ndarray]:
    """Signals in so many pieces of equal length, each with its least and its largest value in turn.

    Args:
        t: (N,).
        signals: (N, columns).

    Returns:
        Times (2 pieces,) and values (2 pieces, columns); all of them where there are no more.
    """
    length = len(t) // pieces
    if length < 2:
        return t, signals
    cut = signals[: length * pieces].reshape(pieces, length, -1)
    values = np.stack((cut.min(axis=1), cut.max(axis=1)), axis=1).reshape(2 * pieces, -1)
    return t[: length * pieces : length].repeat(2) + np.tile((0.0, 0.5 * length * (t[1] - t[0])), pieces), values
