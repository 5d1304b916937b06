"""How much of the signals goes into a page."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..panels import Arrow, Level, Panel

Columns = Mapping[str, np.ndarray]
"""What is drawn, by name; all of the same length."""

VALUES = 300_000
"""That a page may have, of 4 bytes each and a third more as text: 1.6 MB."""

MOST_ROWS = 3200
"""Of one run: more than a screen has columns, and all samples of 6 s."""


def most_rows(runs: int, columns: int) -> int:
    """That a run has on a page of so many runs with so many columns."""
    return max(100, min(MOST_ROWS, VALUES // (runs * columns)))


def thinned(panels: Sequence[Panel], runs: int = 1) -> list[Panel]:
    """The panels of a run, whose parts have no more rows than on a page of so many runs."""
    columns: dict[bytes, dict[str, np.ndarray]] = {}  # all that has the same abscissas
    parts = {
        (k, j): part
        for k, panel in enumerate(panels)
        for j, part in enumerate(panel.parts)
        if not isinstance(part, Level | Arrow)
    }
    for (k, j), part in parts.items():
        own = columns.setdefault(part.x.tobytes(), {"x": part.x})
        own |= {f"{k} {j} {name}": getattr(part, name) for name in part.ARRAYS[1:]}
    rows = most_rows(runs, sum(map(len, columns.values())))
    seen = {key: extremes(own, rows) for key, own in columns.items()}

    def drawn(place: tuple[int, int]) -> Any:
        part, (k, j) = parts[place], place
        own = seen[part.x.tobytes()]
        return part._replace(x=own["x"], **{name: own[f"{k} {j} {name}"] for name in part.ARRAYS[1:]})

    return [
        replace(panel, parts=[drawn((k, j)) if (k, j) in parts else part for j, part in enumerate(panel.parts)])
        for k, panel in enumerate(panels)
    ]


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
