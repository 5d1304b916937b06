"""The signals of a run: a structured array that knows the unit of each column."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Self

import numpy as np

if TYPE_CHECKING:
    from pandas import DataFrame


class Results(np.ndarray):
    """A row an instant, the columns `time` and `instance.variable`.

    Some of its rows or columns are Results again; a single column is an ordinary array.

    Attributes:
        units: by column; what has none is not in it.
    """

    units: Mapping[str, str]

    def __new__(cls, table: np.ndarray, units: Mapping[str, str]) -> Self:
        made = table.view(cls)
        made.units = units
        return made

    def __array_finalize__(self, source: Any) -> None:
        self.units = getattr(source, "units", {})

    def __getitem__(self, key: Any) -> Any:
        found = super().__getitem__(key)
        return np.asarray(found) if isinstance(key, str) else found

    def __reduce__(self) -> Any:
        make, arguments, state = super().__reduce__()  # type: ignore[misc]
        return make, arguments, (state, self.units)

    def __setstate__(self, state: Any) -> None:
        own, self.units = state
        super().__setstate__(own)

    def to_pandas(self) -> DataFrame:
        """A column a signal, over the time in s; `attrs["units"]` has the units, as of the Parquet files."""
        from pandas import DataFrame, Index  # only who asks for it waits for its import

        clock, *names = list(self.dtype.names or ())
        frame = DataFrame({name: self[name] for name in names}, index=Index(self[clock], name=clock))
        frame.attrs["units"] = {name: self.units[name] for name in (clock, *names) if name in self.units}
        return frame
