"""The channels of a recording in SI units, with the checks that each of them has to pass alone."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from pathlib import Path

import numpy as np

from ..base.plain_text import plain
from .column_choice import Choice, Chooser
from .file_units import FileUnit
from .format_detection import opened
from .missing_values import is_code
from .quantities import QUANTITIES, aliases
from .source import RecordingError, Samples

LEAST = 2
"""Samples that every recording has."""

INTERVALS = (1e-6, 1e6)
"""In s, of a recording: times in another unit than they are called are within, and filters of signals can be made."""


@dataclass(frozen=True, eq=False)
class Channel:
    """A quantity over time, in SI units.

    Attributes:
        quantity: see QUANTITIES.
        heading: of the column that it was, in one line.
        unit: of the values.
        time: in s, strictly increasing; channels that were sampled together have the same array.
        values: finite, one for each time.
        where: of a value in the file by its index, as in "line 12".
        file_unit: its unit in the file.
        clock: heading of the column of its time; "time" where a channel has its own.
    """

    quantity: str
    heading: str
    unit: str
    time: np.ndarray
    values: np.ndarray
    where: Callable[[int], str]
    file_unit: FileUnit
    clock: str = "time"


class Channels:
    """The channels of one recording, read when asked for, so that a file needs no more than a purpose asks.

    Attributes:
        path: of the file.
        names: by which quantities are found.
    """

    def __init__(
        self,
        path: Path,
        columns: Mapping[str, str] | None = None,
        names: Sequence[Path] = (),
        databases: Sequence[Path] = (),
    ) -> None:
        """
        Args:
            columns: the headings of quantities that are not to be found by name, see `Chooser`.
            names: files of aliases beside ours.
            databases: of the bus, if the file is a log of its frames.

        Raises:
            RecordingError: there is no such file; it is of no kind that can be read; a file of aliases is refused.
        """
        self.path = path
        self.names = aliases(*names)
        self._source = opened(path, databases)
        self._chooser = Chooser(self._source, self.names, columns or {})

    def has(self, quantity: str) -> bool:
        """Whether there is a column for it."""
        return self._chooser.found(quantity) is not None

    def missing(self, *quantities: str) -> list[str]:
        """Those that have no column, time among them; errors as of `read`."""
        return self._chooser.missing([*([] if self._source.own_time else ["time"]), *quantities])

    def absence(self, missing: Sequence[str]) -> str:
        """What to say of them."""
        return self._chooser.absence(missing)

    def read(self, *quantities: str, drawn: bool = False) -> dict[str, Channel]:
        """The channels of these quantities.

        Args:
            drawn: the samples are corners of straight lines, so that two at one instant are a jump and no step of time
                is a gap.

        Raises:
            RecordingError: a column is missing, doubled or of an unknown unit; a value is not a finite number, or
                larger than any car has; time does not increase, has a gap or steps that no recording has; there are
                less than two samples.
        """
        if missing := self.missing(*quantities):
            raise RecordingError(self.absence(missing))
        clock = [] if self._source.own_time else [self._chooser.needed("time")]
        choices = [*clock, *(self._chooser.needed(quantity) for quantity in quantities)]
        samples = self._source.read([choice.place for choice in choices])
        time = clock[0].factor * samples[0].values if clock else None
        channels = {
            choice.quantity: _channel(choice, one, time, *(each.column.heading for each in clock))
            for choice, one in zip(choices[len(clock) :], samples[len(clock) :], strict=True)
        }
        for together in _by_time(channels.values()):
            first = together[0]
            if len(first.time) < LEAST:
                raise RecordingError(f"{self.path}: {len(first.time)} samples; a drive needs at least two")
            gap = min(QUANTITIES[channel.quantity].gap for channel in together)
            check_time(self.path, first.time, first.where, inf if drawn else gap, jumps=drawn)
        for channel in channels.values():
            check_limit(self.path, channel)
        return channels


def _channel(choice: Choice, samples: Samples, time: np.ndarray | None, *clock: str) -> Channel:
    own = samples.time if time is None else time
    assert own is not None, "a file has a column of time, or its channels have their own"
    values = choice.factor * samples.values
    file_unit = FileUnit(plain(choice.file_unit), abs(choice.factor))
    return Channel(choice.quantity, choice.column.heading, choice.unit, own, values, samples.where, file_unit, *clock)


def _by_time(channels: Iterable[Channel]) -> Iterable[list[Channel]]:
    """Those that were sampled together."""
    groups: dict[int, list[Channel]] = {}
    for channel in channels:
        groups.setdefault(id(channel.time), []).append(channel)
    return groups.values()


def check_limit(path: Path, channel: Channel) -> None:
    """
    Raises:
        RecordingError: a value is larger than any car has.
    """
    limit = QUANTITIES[channel.quantity].limit
    beyond = np.flatnonzero(np.abs(channel.values) > limit)
    if len(beyond):
        k, unit = int(beyond[0]), channel.file_unit
        written = channel.values[k] / unit.factor
        missing = (
            f", and {written:g} is what loggers write where there is no value"
            if is_code(written)
            else f"; --column {channel.quantity}='... [UNIT]' gives another unit"
        )
        raise RecordingError(
            f"{path}, {channel.where(k)}: {channel.heading} is {channel.values[k]:g} {channel.unit}; "
            f"at most {limit:g} {channel.unit} in magnitude can be{missing}"
        )


def check_time(path: Path, time: np.ndarray, where: Callable[[int], str], gap: float, jumps: bool = False) -> None:
    """
    Args:
        path: of the recording, for messages.
        time: in s.
        where: of a sample in the file.
        gap: longest step that is still no gap, in median steps.
        jumps: whether two samples may have one time.

    Raises:
        RecordingError: it does not increase, has a gap, or steps that no recording has.
    """
    steps = np.diff(time)
    backward = np.flatnonzero((steps < 0.0) | ((steps == 0.0) & (not jumps)))
    if len(backward):
        k = int(backward[0])
        raise RecordingError(f"{path}, {where(k + 1)}: time {time[k + 1]:g} s does not come after {time[k]:g} s")
    median = float(np.median(steps))
    least, most = INTERVALS
    if not jumps and not least <= median <= most:
        raise RecordingError(
            f"{path}, {where(1)}: the sample interval is {median:g} s; {least:g} to {most:g} s are allowed"
        )
    gaps = np.flatnonzero(steps > gap * median) if isfinite(gap) else []
    if len(gaps):
        k = int(gaps[0])
        raise RecordingError(
            f"{path}, {where(k + 1)}: gap of {steps[k]:g} s after {time[k]:g} s; at most {gap * median:g} s "
            f"({gap:g} times the median step) is allowed, so cut the file there"
        )
