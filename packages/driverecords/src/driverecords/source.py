"""What every file of a recording is to its reader, whatever its format."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Protocol

from toolground.errors import UserError

if TYPE_CHECKING:
    import numpy as np

    from .clock_times import Clock


class RecordingError(UserError):
    """A recording that cannot be used; the message says where and why.

    Attributes:
        problem: without what is advised.
    """

    def __init__(self, problem: str, advice: str = "") -> None:
        """
        Args:
            advice: options that mend it, for commands that have them; with the mark before it.
        """
        super().__init__(problem + advice)
        self.problem = problem


def require_content(path: Path, what: str = "recording") -> None:
    """Refuses what is no regular file with content.

    A pipe that nobody writes never ends, nor does /proc/kmsg: a regular file of no size that waits for the next line.
    """
    if not path.is_file():
        kind = "a folder" if path.is_dir() else "no file" if path.exists() else ""
        raise RecordingError(f"{path} is {kind}; a file is needed" if kind else f"there is no {what} {path}")
    if not path.stat().st_size:
        raise RecordingError(f"{path} is empty")


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


class Kept(NamedTuple):
    """The same of values of which only some were kept, by their indices."""

    where: Callable[[int], str]
    index: np.ndarray

    def __call__(self, k: int) -> str:
        """Of the value with that index among those kept."""
        return self.where(int(self.index[k]))


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
        values: finite, or NaN where there is none.
        time: of each, in s, if the channel has its own; None if a column of the file is the time of all.
        where: of a value in the file by its index, as in "line 12".
        unreadable: what stands in the place of some values that are NaN, by their indices.
        begin: what the clock says at the time 0, None if that is not known.
    """

    values: np.ndarray
    time: np.ndarray | None
    where: Callable[[int], str]
    unreadable: Mapping[int, str] = field(default_factory=dict)
    begin: Clock | None = None


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
            RecordingError: one of them holds no numbers.
        """
        ...


def samples(
    path: Path,
    column: Column,
    values: np.ndarray,
    time: np.ndarray | None,
    where: Callable[[int], str],
    begin: Clock | None = None,
) -> Samples:
    """The values of a column that a package has read.

    Raises:
        RecordingError: one of their times is not a finite number.
    """
    import numpy as np

    if time is not None and len(odd := np.flatnonzero(~np.isfinite(time))):
        raise not_finite(path, where(int(odd[0])), column, f"its time, {time[odd[0]]:g},")
    infinite = np.isinf(values)
    unreadable = {int(k): f"{values[k]:g}" for k in np.flatnonzero(infinite)}
    return Samples(np.where(infinite, np.nan, values), time, where, unreadable, begin)


def not_finite(path: Path, where: str, column: Column, value: str) -> RecordingError:
    """The message about a value that cannot be used."""
    return RecordingError(f"{path}, {where}, column {column.heading}: {value} is not a finite number")
