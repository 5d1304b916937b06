"""The signals of a run: a structured array that knows the unit of each column."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from importlib.metadata import entry_points
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from toolground.errors import UserError
from toolground.known_names import UnknownName, nearest

from .row_file import RESIDENT, RowFile

if TYPE_CHECKING:
    from pandas import DataFrame


class Ended(NamedTuple):
    """Which FMU asked for the end of a run, and when in s: the instant of the last row."""

    instance: str
    time: float

    def __str__(self) -> str:
        return f"{self.instance} ended the run at {self.time:g} s"


class Results(np.ndarray):
    """A row an instant, the columns `time` and `instance.variable`.

    Some of its rows or columns are Results again; a single column is an ordinary array. Those of a long run are in a
    file: a column is a copy then, which cannot be written to, and no more of the others is in memory than a piece.

    Attributes:
        units: by column; what has none is not in it.
        frequency: at which the drive train swings, Hz; None: it is not known.
        ended: by which FMU and when the run was ended before its time; None: by none.
        own_steps: in s, of the FMUs by their instances that refused those of the loop.
        file: in which the rows are; None: in memory.
    """

    units: Mapping[str, str]
    file: RowFile | None
    frequency: float | None = None
    ended: Ended | None = None
    own_steps: Mapping[str, float] = MappingProxyType({})

    def __new__(cls, table: np.ndarray, units: Mapping[str, str], file: RowFile | None = None) -> Self:
        results = table.view(cls)
        results.units, results.file = units, file
        return results

    def __array_finalize__(self, source: Any) -> None:
        self.units = getattr(source, "units", {})
        self.file = getattr(source, "file", None)
        self.frequency = getattr(source, "frequency", None)
        self.ended = getattr(source, "ended", None)
        self.own_steps = getattr(source, "own_steps", Results.own_steps)

    @property
    def remarks(self) -> dict[str, Any]:
        """What a record tells of the run: who ended it when, and the steps of FMUs that make others than the loop."""
        ended = {"ended": self.ended._asdict()} if self.ended else {}
        return ended | ({"own_steps": dict(self.own_steps)} if self.own_steps else {})

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, str) and key not in (names := self.dtype.names or ()):
            raise UnknownName(f"no column {key}; {nearest(key, names, every='there are')}")
        item = super().__getitem__(key)
        if not isinstance(key, str):
            return item
        column = np.asarray(item)
        if self.file is None:
            return column
        read = np.empty(column.shape, column.dtype)
        for rows in self.pieces():
            read[rows] = column[rows]
        read.flags.writeable = False
        return read

    def __contains__(self, key: Any) -> bool:
        """Whether there is such a column; of anything else what numpy says."""
        return key in (self.dtype.names or ()) if isinstance(key, str) else super().__contains__(key)

    def pieces(self) -> Iterator[slice]:
        """The rows, piece by piece; what has been done with a piece takes no memory at the next one."""
        count = max(1, RESIDENT // self.itemsize)
        for start in range(0, len(self), count):
            yield slice(start, start + count)
            self.passed(min(count, len(self) - start))

    def passed(self, count: int) -> None:
        """So many rows more have been read or written."""
        if self.file is not None:
            self.file.touched(count * abs(self.strides[0]))

    def __reduce__(self) -> Any:
        make, arguments, state = super().__reduce__()  # type: ignore[misc]
        return make, arguments, (state, self.units, self.frequency, self.ended, dict(self.own_steps))

    def __setstate__(self, state: Any) -> None:
        own, self.units, self.frequency, self.ended, self.own_steps = state
        super().__setstate__(own)

    def plot(self, names: Iterable[str] = (), **how: Any) -> None:
        """Shows the run in panels over time, by the installed package that draws results (entry points `fmuloop.plot`),
        which says what else it takes.

        Raises:
            UserError: none is installed.
        """
        for entry in entry_points(group="fmuloop.plot"):
            return entry.load()(self, names, **how)
        raise UserError("no package that draws results is installed; `pip install driveline-damping` brings one")

    def to_pandas(self) -> DataFrame:
        """A column a signal, over the time in s; `attrs["units"]` has the units, as of the Parquet files."""
        from pandas import DataFrame, Index  # only who asks for it waits for its import

        clock, *names = list(self.dtype.names or ())
        frame = DataFrame({name: self[name] for name in names}, index=Index(self[clock], name=clock))
        frame.attrs["units"] = {name: self.units[name] for name in (clock, *names) if name in self.units}
        return frame
