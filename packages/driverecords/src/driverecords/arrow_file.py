"""Parquet and Feather files, read by pyarrow: tables with typed columns, whose units stand in their names or beside
them in the metadata of the column (`unit`)."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from toolground.optional_packages import required
from toolground.plain_text import plain

from .cells import decimal_of, numbers
from .clock_times import EPOCH, Clock
from .headings import split
from .source import Column, RecordingError, Samples, Where, samples

PARQUET, FEATHER = b"PAR1", b"ARROW1"
"""With which such files begin."""


class ArrowFile:
    """A Source. Rows are counted from 1; a date or a duration is in s from the first row on."""

    own_time = False

    def __init__(self, path: Path) -> None:
        """
        Raises:
            RecordingError: it is damaged.
            MissingExtra: pyarrow is not installed.
        """
        self.path = path
        self.headings = str(path)
        self._schema = self._done(lambda: _schema(path))
        self.columns: Sequence[Column] = [_column(field) for field in self._schema]

    def read(self, places: Sequence[int]) -> list[Samples]:
        """See `driverecords.source.Source.read`."""
        names = [self._schema.field(place).name for place in places]
        table = self._done(lambda: _table(self.path, names))
        return [self._samples(table.column(name), place) for name, place in zip(names, places, strict=True)]

    def _samples(self, column: Any, place: int) -> Samples:
        values, begin = column.to_numpy(), None
        if values.dtype.kind in "mM":
            first = values[~np.isnat(values)][:1]
            if len(first) and values.dtype.kind == "M":
                day = first.astype("datetime64[D]")
                begin = Clock(int(day[0].astype(int)) + EPOCH, float((first - day)[0] / np.timedelta64(1, "s")))
            values = (values - first) / np.timedelta64(1, "s") if len(first) else np.full(len(values), np.nan)
        elif values.dtype.kind not in "biuf":
            try:
                values = column.cast("double").to_numpy()  # decimals, flags, texts of numbers
            except Exception:  # pyarrow has many
                # a column of texts has a decimal and marks between thousands of its own, as a text file has
                texts = [str(cell) for cell in column.to_pylist()]
                values, unreadable = numbers(texts, decimal_of(texts))
                return Samples(values, None, Where("row {0}", range(len(values))), unreadable)
        rows = Where("row {0}", range(len(values)))
        return samples(self.path, self.columns[place], values.astype(float), None, rows, begin)

    def _done(self, work: Any) -> Any:
        try:
            return work()
        except (OSError, ValueError, KeyError, NotImplementedError) as error:  # all that pyarrow raises of a file
            raise RecordingError(f"{self.path} is a damaged Parquet or Feather file: {plain(error, 200)}") from error


def _is_parquet(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(len(PARQUET)) == PARQUET


def _schema(path: Path) -> Any:
    if _is_parquet(path):
        return required("pyarrow.parquet", "reading Parquet files", "driverecords[formats]").read_schema(path)
    with required("pyarrow", "reading Feather files", "driverecords[formats]").ipc.open_file(path) as file:
        return file.schema


def _table(path: Path, names: Sequence[str]) -> Any:
    if _is_parquet(path):
        return required("pyarrow.parquet", "reading Parquet files", "driverecords[formats]").read_table(
            path, columns=list(names)
        )
    return required("pyarrow.feather", "reading Feather files", "driverecords[formats]").read_table(
        path, columns=list(names)
    )


def _column(field: Any) -> Column:
    name, unit = split(field.name)
    beside = (field.metadata or {}).get(b"unit", b"").decode(errors="replace")
    dated = "s" if str(field.type).startswith(("timestamp", "duration")) else None
    return Column(plain(field.name, 60), plain(name, 60), unit or plain(beside, 60) or dated)
