"""Results as CSV files."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .files import complete

if TYPE_CHECKING:
    import numpy as np


def write_rows(headings: Sequence[str], rows: Iterable[Sequence[object]], path: Path) -> None:
    """Writes one row a line."""
    with complete(path) as unfinished, unfinished.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headings)
        writer.writerows(rows)


def write_csv(results: np.ndarray, path: Path) -> None:
    """Writes a structured array in the layout that `fmpy.util.read_csv` opens.

    One column a field; numbers are written so that reading gives the same ones, truth values as 0 and 1.
    """
    names = results.dtype.names or ()
    columns = [(results[name].astype(int) if results[name].dtype == bool else results[name]).tolist() for name in names]
    write_rows(names, zip(*columns, strict=True), path)
