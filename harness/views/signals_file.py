"""The signals of a run as a file, with the unit of each: CSV, Parquet or ASAM MDF 4.

The same signals give the same bytes; a simulated run has no date, so that of an MDF file is the first one there is. All
are read again by `driverecords`, and numbers and times are then the same.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from driverecords.headings import split
from toolground.atomic_files import complete
from toolground.csv_file import write_csv
from toolground.optional_packages import required

if TYPE_CHECKING:
    import numpy as np

MDF_VERSION = "4.10"
"""That all tools of the last ten years read."""

TRANSPOSED_DEFLATE = 2

NO_DATE = datetime.fromtimestamp(0, UTC)

HISTORY = """\
<FHcomment><TX>signals of a run</TX><tool_id>driveline-damping</tool_id><tool_vendor>driveline-damping</tool_vendor>\
<tool_version>{}</tool_version></FHcomment>"""


def _csv_with_units(results: np.ndarray, path: Path) -> None:
    """Units in brackets behind the names."""
    write_csv(results, path, [f"{name} [{unit}]" if unit else name for _, name, unit in _columns(results)])


def _parquet(results: np.ndarray, path: Path) -> None:
    """The unit of a column stands in its metadata as `unit`, and where pandas reads `DataFrame.attrs` from."""
    arrow = required("pyarrow", "writing Parquet files", "driveline-damping[recordings]")
    parquet = required("pyarrow.parquet", "writing Parquet files", "driveline-damping[recordings]")
    fields, attributes = [], {}
    for column, name, unit in _columns(results):
        kind = arrow.from_numpy_dtype(results.dtype[column])
        fields.append(arrow.field(name, kind, metadata={"unit": unit} if unit else None))
        attributes |= {name: unit} if unit else {}
    schema = arrow.schema(fields, metadata={"PANDAS_ATTRS": json.dumps({"units": attributes})})
    with (
        complete(path) as unfinished,
        unfinished.open("wb") as file,
        parquet.ParquetWriter(file, schema, use_dictionary=False) as writer,  # numbers hardly come twice
    ):
        for piece in _pieces(results):
            columns = [
                arrow.Array.from_buffers(field.type, len(piece), [None, arrow.py_buffer(_packed(piece[name]))])
                for field, name in zip(schema, piece.dtype.names or (), strict=True)
            ]
            writer.write_table(arrow.table(columns, schema=schema))


def _packed(column: np.ndarray) -> np.ndarray:
    """Its values as they are in the memory of Arrow, which would load pandas to bring them there."""
    import numpy as np

    return np.packbits(column, bitorder="little") if column.dtype == bool else np.ascontiguousarray(column)


def _pieces(results: np.ndarray) -> Iterator[np.ndarray]:
    """The rows, of which no more are copied at a time."""
    for start in range(0, len(results), ROWS_AT_ONCE):
        yield results[start : start + ROWS_AT_ONCE]


def _mdf(results: np.ndarray, path: Path) -> None:
    """One group of channels, whose master is the first column, the time."""
    asammdf = required("asammdf", "writing MDF files", "driveline-damping[recordings]")
    from importlib.metadata import version

    from asammdf.blocks.v4_blocks import FileHistory

    history = FileHistory()
    history.time_stamp = NO_DATE
    history.comment = HISTORY.format(version("driveline-damping"))
    with asammdf.MDF(version=MDF_VERSION) as made:
        made.start_time = NO_DATE
        for piece in _pieces(results):
            signals = _signals(piece, asammdf.Signal)
            if made.groups:
                samples = signals[0].timestamps, *(signal.samples for signal in signals)
                made.extend(0, [(values, None) for values in samples])
            else:
                made.append(signals, common_timebase=True)
        made.file_history.append(history)
        with complete(path) as unfinished, unfinished.open("wb+") as file:
            made.save(file, compression=TRANSPOSED_DEFLATE, add_history_block=False)


def _signals(piece: np.ndarray, make: Callable[..., Any]) -> list[Any]:
    """Of asammdf."""
    (clock, *_), *others = _columns(piece)
    signals = []
    for column, name, unit in others:
        samples = piece[column].astype("u1") if piece.dtype[column].kind == "b" else piece[column].copy()
        signals.append(make(samples, piece[clock].copy(), name=name, unit=unit or ""))
    return signals


def _columns(results: np.ndarray) -> Iterator[tuple[str, str, str | None]]:
    """Each column, its name and its unit: that in the name itself, in brackets, or that of Results."""
    from fmuloop.results import Results

    units = results.units if isinstance(results, Results) else {}
    for column in results.dtype.names or ():
        name, unit = split(column)
        yield column, name, unit or units.get(column)


ROWS_AT_ONCE = 2**13
"""That are copied at a time to be written."""


class Format(NamedTuple):
    """How signals are written.

    Attributes:
        package: that must be there.
    """

    ending: str
    write: Callable[[np.ndarray, Path], None]
    meaning: str
    package: str | None = None


FORMATS: Mapping[str, Format] = {
    "csv": Format(".csv", write_csv, "names alone in the headings, units in the JSON file beside it"),
    "csv-units": Format(".csv", _csv_with_units, "units in the headings"),
    "parquet": Format(".parquet", _parquet, "units in the metadata of the columns", "pyarrow"),
    "mf4": Format(".mf4", _mdf, "ASAM MDF 4.10", "asammdf"),
}


def require_format(name: str) -> None:
    """
    Raises:
        MissingExtra: the package that writes it is not installed.
    """
    package = FORMATS[name].package
    if package and not find_spec(package):  # it is loaded when it is needed
        required(package, f"writing {FORMATS[name].ending.removeprefix('.')} files", "driveline-damping[recordings]")


def signals_path(stem: Path, format: str) -> Path:
    """The file of signals in a format, of its path without ending."""
    return stem.with_name(f"{stem.name}{FORMATS[format].ending}")


def write_signals(results: np.ndarray, stem: Path, format: str = "csv") -> Path:
    """Writes a structured array, its first column the time in s, with the units that it knows; returns the file.

    Args:
        stem: path of the file without its ending.
        format: "csv", "csv-units" (with the units in the headings), "parquet" or "mf4".

    Raises:
        MissingExtra: the package that writes the format is not installed.
    """
    path = signals_path(stem, format)
    FORMATS[format].write(results, path)
    return path
