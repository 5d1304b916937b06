"""Results as files."""

import csv
import os
from pathlib import Path

import numpy as np


def write_csv(results: np.ndarray, path: Path) -> None:
    """Writes a structured array in the layout that `fmpy.util.read_csv` opens.

    One column a field; numbers are written so that reading gives the same ones, truth values as 0 and
    1. The file appears complete or not at all.

    Args:
        path: of the file; its folder is made if absent.
    """
    names = results.dtype.names or ()
    columns = [
        (results[name].astype(int) if results[name].dtype == np.bool_ else results[name]).tolist() for name in names
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        with unfinished.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(names)
            writer.writerows(zip(*columns, strict=True))
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)
