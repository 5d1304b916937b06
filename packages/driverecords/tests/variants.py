"""One recording as test benches, loggers and spreadsheets write it."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

Columns = dict[str, tuple[np.ndarray, str]]
"""Name -> values and unit, in the units of the car's sensors."""


def recording(samples: int = 200, interval: float = 0.01) -> Columns:
    """A short drive; its numbers are exact in few decimals, so that every variant can hold them."""
    k = np.arange(samples)
    return {
        "Time": (k * interval, "s"),
        "Velocity": (np.round(36.0 + 3.0 * np.sin(0.05 * k), 2), "km/h"),
        "Elevation": (np.round(500.0 + 0.01 * k, 2), "m"),
        "Motor Torque": (np.round(20.0 + 30.0 * np.sin(0.3 * k), 1), "Nm"),
    }


def table(
    drive: Columns,
    separator: str = ",",
    decimal: str = ".",
    heading: Callable[[str, str], str] = lambda name, unit: f"{name} [{unit}]",
    units_row: bool = False,
    above: str = "",
    end: str = "\n",
    quoted: bool = False,
) -> str:
    """The text of a file."""

    def cell(text: str) -> str:
        return f'"{text}"' if quoted else text

    rows = [[cell(heading(name, unit)) for name, (_, unit) in drive.items()]]
    if units_row:
        rows.append([cell(unit) for _, unit in drive.values()])
    for values in zip(*(column.tolist() for column, _ in drive.values()), strict=True):
        rows.append([cell(f"{value:.10g}".replace(".", decimal)) for value in values])
    return above + end.join(separator.join(row) for row in rows) + end


def bare(name: str, unit: str) -> str:
    return name


TEXTS: dict[str, Callable[[Columns], bytes]] = {
    "logger, comma, UTF-8": lambda drive: table(drive).encode(),
    "spreadsheet in German, semicolon, decimal comma, Latin-1": lambda drive: table(
        drive, ";", ",", lambda name, unit: f"{name} [{unit.replace('Nm', 'N·m')}]", end="\r\n"
    ).encode("latin-1"),
    "spreadsheet, UTF-8 with BOM, sep= line": lambda drive: table(drive, ";", above="sep=;\n").encode("utf-8-sig"),
    "spreadsheet as Unicode text: tab, UTF-16": lambda drive: table(drive, "\t", ",", end="\r\n").encode("utf-16"),
    "UTF-16 without BOM": lambda drive: table(drive).encode("utf-16-le"),
    "UTF-32": lambda drive: table(drive).encode("utf-32"),
    "UTF-32 without BOM": lambda drive: table(drive).encode("utf-32-be"),
    "units in parentheses": lambda drive: table(drive, heading=lambda name, unit: f"{name} ({unit})").encode(),
    "units after an underscore": lambda drive: (
        table(drive, heading=lambda name, unit: f"{name}_{unit}".replace("/", "").replace(" ", "_").lower())
        .replace("_nm,", "_Nm,")
        .replace("_nm\n", "_Nm\n")
        .encode()
    ),
    "test bench: preamble, names, row of units": lambda drive: table(
        drive, "\t", heading=bare, units_row=True, above="Bench 7\tcar 12\nDate\t2026-11-22\nRate\t100\n\n"
    ).encode("latin-1"),
    "row of units in brackets, semicolon, decimal comma": lambda drive: table(
        {name: (values, f"[{unit}]") for name, (values, unit) in drive.items()}, ";", ",", bare, units_row=True
    ).encode(),
    "all cells quoted, decimal comma and comma": lambda drive: table(drive, ",", ",", quoted=True).encode(),
    "blanks after the comma, more columns than names": lambda drive: table(drive, ", ").replace("\n", ",\n").encode(),
    "other units: ms, mph, ft, kNm": lambda drive: table(
        {
            "Time": (1e3 * drive["Time"][0], "ms"),
            "Velocity": (drive["Velocity"][0] / 1.609344, "mph"),
            "Elevation": (drive["Elevation"][0] / 0.3048, "ft"),
            "Motor Torque": (1e-3 * drive["Motor Torque"][0], "kNm"),
        }
    ).encode(),
}


def write_mdf(drive: Columns, path: Path) -> None:
    """As a logger with two rates: the speed of the car in a group of its own, at every other sample."""
    from asammdf import MDF, Signal

    def signals(names: list[str], stride: int) -> list[Any]:
        time = drive["Time"][0][::stride]
        return [Signal(drive[name][0][::stride], time, unit=drive[name][1], name=name) for name in names]

    with MDF(version="4.10") as file:
        file.append(signals(["Elevation", "Motor Torque"], 1), common_timebase=True)
        file.append(signals(["Velocity"], 2), common_timebase=True)
        file.save(path, overwrite=True)


def write_arrow(drive: Columns, path: Path, units_beside: bool = False) -> None:
    """Parquet or Feather, by the ending of the file."""
    import pyarrow as pa
    from pyarrow import feather, parquet

    fields = [
        pa.field(name, pa.float64(), metadata={"unit": unit})
        if units_beside
        else pa.field(f"{name} [{unit}]", "double")
        for name, (_, unit) in drive.items()
    ]
    arrow = pa.table([values for values, _ in drive.values()], schema=pa.schema(fields))
    (parquet.write_table if path.suffix == ".parquet" else feather.write_feather)(arrow, path)
