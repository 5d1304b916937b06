"""Results as CSV files."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from .atomic_files import complete

if TYPE_CHECKING:
    import numpy as np

ROWS_AT_ONCE = 1000


@contextmanager
def _begun(path: Path, headings: Sequence[str]) -> Iterator[TextIO]:
    """The file with its headings."""
    with complete(path) as unfinished, unfinished.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerow(headings)
        yield file


def write_rows(headings: Sequence[str], rows: Iterable[Sequence[object]], path: Path) -> None:
    """Writes one row a line."""
    with _begun(path, headings) as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def write_csv(results: np.ndarray, path: Path, headings: Sequence[str] | None = None) -> None:
    """Writes a structured array in the layout that `fmpy.util.read_csv` opens.

    One column a field; numbers are written so that reading gives the same ones, truth values as 0 and 1.

    Args:
        headings: of the columns; None: the names of the fields.
    """
    names = results.dtype.names or ()
    with _begun(path, headings or names) as file:
        for start in range(0, len(results), ROWS_AT_ONCE):  # texts take much more memory
            piece = results[start : start + ROWS_AT_ONCE]
            rows = zip(*(_texts(piece[name]) for name in names), strict=True)
            file.write("\n".join([*map(",".join, rows), ""]))  # no number has to be quoted


def _texts(column: np.ndarray) -> list[str]:
    """The numbers as Python writes them; one that stays is put into words once, which is what takes long."""
    import numpy as np

    column = np.ascontiguousarray(column.astype(int) if column.dtype == bool else column)
    bits = column.view(f"u{column.itemsize}")  # by which -0.0 is not 0.0
    begins = np.flatnonzero(np.append(True, bits[1:] != bits[:-1]))
    texts = np.array([*map(repr, column[begins].tolist())], object)
    return texts.repeat(np.diff(begins, append=len(column))).tolist()
