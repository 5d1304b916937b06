"""ASAM MDF files (versions 3 and 4), read by asammdf: groups of channels, each group with its own times."""

import gc
import re
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np

from toolground.optional_packages import required
from toolground.plain_text import plain
from toolground.unit_conversion import converts, factor

from .clock_times import Clock
from .headings import split
from .source import Column, RecordingError, Samples, Where, samples

MARKS = (b"MDF     ", b"UnFinMF ")
"""With which such files begin; the second one if the logger was cut off."""

MASTER, TIME = (2, 3), 1
"""Types of channels that hold what the others of their group are sampled over, and the kind of those that hold time."""

MAPPED = re.compile("<mmap[^>]*>")
"""What asammdf says in the place of the name of a file."""


class MdfFile:
    """A Source. A channel whose name several groups have is told by its group, counted from 1: `Speed, group 2`."""

    own_time = True

    def __init__(self, path: Path) -> None:
        """
        Raises:
            RecordingError: it is damaged.
            MissingExtra: asammdf is not installed.
        """
        self.path = path
        self.headings = str(path)
        with _opened(path) as file:
            channels = list(_channels(file))
            self._master_factors = {group: _master_factor(file, group) for group, _, _ in channels}
        often = Counter(channel.name for _, _, channel in channels)
        self._places = [(group, index) for group, index, _ in channels]
        self.columns: Sequence[Column] = [
            _column(channel, f"{channel.name}, group {group + 1}" if often[channel.name] > 1 else channel.name)
            for group, _, channel in channels
        ]

    def read(self, places: Sequence[int]) -> list[Samples]:
        """See `driverecords.source.Source.read`. Samples that the logger has marked as invalid are left out;
        those for which a conversion gives a text are none; channels of a group have the same array of times."""
        times: dict[int, np.ndarray] = {}
        with _opened(self.path) as file:
            return [self._samples(file, place, times) for place in places]

    def _samples(self, file: Any, place: int, times: dict[int, np.ndarray]) -> Samples:
        (group, index), column = self._places[place], self.columns[place]
        signal = file.get(group=group, index=index)
        if signal.samples.dtype.kind == "S" and not column.unit:  # the names of states, of which numbers are meant
            signal = file.get(group=group, index=index, raw=True)
        if signal.samples.dtype.kind not in "biuf" or signal.samples.ndim != 1:
            raise RecordingError(f"{self.path}: {column.heading} holds no numbers")
        time = np.asarray(signal.timestamps, dtype=float) * self._master_factors[group]
        same = times.setdefault(group, time)
        time = same if np.array_equal(same, time) else time
        where = Where("sample {0} at {1:g} s", time)
        return samples(self.path, column, signal.samples.astype(float), time, where, _clock(file.start_time))


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """The file, while it is read; whatever asammdf meets in a damaged one is a RecordingError."""
    asammdf = required("asammdf", "reading MDF files", "driverecords[formats]")
    damage = None
    before, sys.unraisablehook = sys.unraisablehook, lambda _: None  # a file that did not open says more as it is freed
    try:
        with asammdf.MDF(path) as file:
            yield file
    except (RecordingError, MemoryError):
        raise
    except Exception as error:
        damage = plain(MAPPED.sub(path.name, str(error)), 200) or type(error).__name__
    finally:
        if damage:
            gc.collect()  # its messages come while they are still kept back
        sys.unraisablehook = before
    if damage:
        raise RecordingError(f"{path} is a damaged MDF file: {damage}")


def _master_factor(file: Any, group: int) -> float:
    """Of the times of a group to s, in which they are unless their unit says something else."""
    # times in ms occur
    unit = file.groups[group].channels[file.masters_db[group]].unit
    return factor(unit, "s") if unit and converts(unit, "s") else 1.0


def _clock(start: datetime) -> Clock | None:
    """What the clock of the logger says at 0; None of a file that does not say."""
    # where nothing was written it is 1970
    if start.year < 1990:
        return None
    return Clock(start.toordinal(), 3600.0 * start.hour + 60.0 * start.minute + start.second + 1e-6 * start.microsecond)


def _channels(file: Any) -> Iterator[tuple[int, int, Any]]:
    """Group, index and declaration of all channels that are sampled over time."""
    for number, group in enumerate(file.groups):
        master = file.masters_db.get(number)
        if master is None or getattr(group.channels[master], "sync_type", TIME) != TIME:
            continue
        for index, channel in enumerate(group.channels):
            if index != master and channel.channel_type not in MASTER:
                yield number, index, channel


def _column(channel: Any, heading: str) -> Column:
    name, unit = split(channel.name)
    # versions 2 and 3 have the unit in the conversion alone
    own = channel.unit or getattr(channel.conversion, "unit", "") or unit or ""
    return Column(plain(heading, 60), plain(name, 60), plain(own, 60) or None)
