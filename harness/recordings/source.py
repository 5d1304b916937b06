"""What every file of a recording is to its reader, whatever its format."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Protocol

from ..base.errors import DrivelineError

if TYPE_CHECKING:
    import numpy as np


class RecordingError(DrivelineError):
    """A recording that cannot be used; the message says where and why."""


class Where(NamedTuple):
    """What messages say of where a value is in its file.

    Attributes:
        pattern: of the text: {0} stands for which value it is, {1} for the number that goes with it.
        numbers: these.
    """

    pattern: str
    numbers: Sequence[int] | np.ndarray

    def __call__(self, k: int) -> str:
        """Of the value with that index."""
        return self.pattern.format(k + 1, self.numbers[k])


@dataclass(frozen=True)
class Column:
    """A column or channel of a file, before its values are read.

    Attributes:
        heading: as it stands in the file, in one line.
        name: in it.
        unit: that the file gives, None if it gives none.
    """

    heading: str
    name: str
    unit: str | None


@dataclass(frozen=True, eq=False)
class Samples:
    """The values of a column as the file has them.

    Attributes:
        values: finite.
        time: of each, in s, if the channel has its own; None if a column of the file is the time of all.
        where: of a value in the file by its index, as in "line 12".
    """

    values: np.ndarray
    time: np.ndarray | None
    where: Callable[[int], str]


class Source(Protocol):
    """A file that is open for reading.

    Attributes:
        headings: where in the file they stand, for messages, as in "drive.csv, line 1".
        own_time: whether every channel has its time, so that no column is the time of all.
    """

    path: Path
    headings: str
    own_time: bool
    columns: Sequence[Column]

    def read(self, places: Sequence[int]) -> list[Samples]:
        """The values of some of the columns.

        Raises:
            RecordingError: one is not a finite number, naming place and column.
        """
        ...


def samples(
    path: Path, column: Column, values: np.ndarray, time: np.ndarray | None, where: Callable[[int], str]
) -> Samples:
    """The values of a column that a package has read.

    Raises:
        RecordingError: one, or its time, is not a finite number.
    """
    import numpy as np

    odd = np.flatnonzero(~np.isfinite(values) | (False if time is None else ~np.isfinite(time)))
    if len(odd):
        raise not_finite(path, where(int(odd[0])), column, f"{values[odd[0]]:g}")
    return Samples(values, time, where)


def not_finite(path: Path, where: str, column: Column, value: str) -> RecordingError:
    """The message about a value that cannot be used."""
    return RecordingError(
        f"{path}, {where}, column {column.heading}: {value or 'an empty cell'} is not a finite number"
    )
