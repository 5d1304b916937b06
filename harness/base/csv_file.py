"""Results as CSV files."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .atomic_files import complete

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


def _rows(results: np.ndarray) -> Iterator[tuple[str, ...]]:
    """The rows as texts, which take much more memory and so are made piece by piece."""
    for start in range(0, len(results), ROWS_AT_ONCE):
        piece = results[start : start + ROWS_AT_ONCE]
        yield from zip(*(_texts(piece[name]) for name in results.dtype.names or ()), strict=True)


def _texts(column: np.ndarray) -> list[str]:
    """The numbers as Python writes them; one that stays is put into words once, which is what takes long."""
    import numpy as np

    column = np.ascontiguousarray(column.astype(int) if column.dtype == bool else column)
    bits = column.view(f"u{column.itemsize}")  # by which -0.0 is not 0.0
    begins = np.flatnonzero(np.append(True, bits[1:] != bits[:-1]))
    texts = np.array([*map(repr, column[begins].tolist())], object)
    return texts.repeat(np.diff(begins, append=len(column))).tolist()
