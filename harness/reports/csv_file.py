"""Results as CSV files."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .files import complete

if TYPE_CHECKING:
    import numpy as np

ROWS_AT_ONCE = 1000


def write_rows(headings: Sequence[str], rows: Iterable[Sequence[object]], path: Path) -> None:
    """Writes one row a line."""
    with complete(path) as unfinished, unfinished.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headings)
        writer.writerows(rows)


def write_csv(results: np.ndarray, path: Path, headings: Sequence[str] | None = None) -> None:
    """Writes a structured array in the layout that `fmpy.util.read_csv` opens.

    One column a field; numbers are written so that reading gives the same ones, truth values as 0 and 1.

    Args:
        headings: of the columns; None: the names of the fields.
    """
    write_rows(headings or results.dtype.names or (), _rows(results), path)


def _rows(results: np.ndarray) -> Iterator[tuple[object, ...]]:
    """The rows with numbers of Python's, which take much more memory and so are made piece by piece."""
    for start in range(0, len(results), ROWS_AT_ONCE):
        piece = results[start : start + ROWS_AT_ONCE]
        columns = (piece[name] for name in results.dtype.names or ())
        yield from zip(
            *((column.astype(int) if column.dtype == bool else column).tolist() for column in columns), strict=True
        )
