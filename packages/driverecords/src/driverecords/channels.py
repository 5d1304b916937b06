"""The channels of a recording in SI units, with the checks that each of them has to pass alone."""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path
from typing import NamedTuple

import numpy as np

from toolground.collected_warnings import warn_once
from toolground.plain_text import plain

from .clock_times import EXAMPLES, Clock
from .column_choice import Choice, Chooser, doubled
from .file_units import FileUnit
from .format_detection import opened
from .missing_values import FILLED, coded, holes
from .quantities import QUANTITIES, aliases
from .source import Column, Kept, RecordingError, Samples, not_finite
from .time_base import (
    MOST,
    WHOLE,
    Break,
    Cut,
    break_around,
    clean_pieces,
    interval_of,
    spread_equal_times,
    time_breaks,
    time_text,
)

LEAST = 2
"""Samples that every recording has."""

LONGEST_CELL = 100
"""Characters of a cell that are shown."""


# without a limit a recording whose last third cannot be read was cut without a word
FOOTER = 20
"""Rows without a time above the first one and below the last one, that a logger may write."""

LATEST = 1.0
"""Time in s that a channel may end before the times do, without a word."""


class MissingSamples(NamedTuple):
    """Samples without a value: the number that the file has there, None if it has none, their times in s, and the place
    of the first in the file."""

    code: float | None
    times: np.ndarray
    place: str


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
        missing: samples that the file has without a value and that were left out, or filled in short holes.
    """

    quantity: str
    heading: str
    unit: str
    time: np.ndarray
    values: np.ndarray
    where: Callable[[int], str]
    file_unit: FileUnit
    clock: str = "time"
    missing: Sequence[MissingSamples] = ()

    @property
    def interval(self) -> float:
        """Median step of its times in s."""
        return interval_of(self.time)

    def at(self, kept: np.ndarray, time: np.ndarray) -> "Channel":
        """Some of its samples, by their indices, and their times."""
        return replace(self, time=time, values=self.values[kept], where=Kept(self.where, kept))


class Rows(NamedTuple):
    """Of a file in which a column is the time of all: times in s, NaN in rows without one, what the clock says at 0,
    heading of the column, and where a time cannot be read."""

    time: np.ndarray
    begin: Clock | None
    heading: str
    breaks: list[Break]


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
        cut: tuple[float | Clock | None, float | Clock | None] = WHOLE,
    ) -> None:
        """
        Args:
            columns: the headings of quantities that are not to be found by name, see `Chooser`.
            names: files of aliases beside ours.
            databases: of the bus, if the file is a log of its frames.
            cut: the part that is read.

        Raises:
            RecordingError: there is no such file; it is of no kind that can be read; a file of aliases is refused.
        """
        self.path = path
        self.names = aliases(*names)
        self._cut = Cut(*cut)
        self._source = opened(path, databases)
        self._chooser = Chooser(self._source, self.names, columns or {})

    def has(self, quantity: str) -> bool:
        """Whether there is a column for it."""
        return self._chooser.choice(quantity) is not None

    def missing(self, *quantities: str) -> list[str]:
        """Those that have no column, time among them; errors as of `read`."""
        return self._chooser.missing([*([] if self._source.own_time else ["time"]), *quantities])

    def absence(self, missing: Sequence[str]) -> RecordingError:
        """What to say of them."""
        return self._chooser.absence(missing)

    def read(self, *quantities: str, optional: Collection[str] = (), drawn: bool = False) -> dict[str, Channel]:
        """The channels of these quantities. Samples without a value are left out; those in short holes are filled.

        Args:
            optional: those of them that are left out where their columns have no number at all.
            drawn: the samples are corners of straight lines, so that two at one instant are a jump and no step of time
                is a gap.

        Raises:
            RecordingError: a column is missing, doubled or of an unknown unit; a cell cannot be read, or is larger than
                any car has; time does not increase, has a gap or steps that no recording has; there are less than two
                samples. The longest piece without all that is named.
        """
        channels, breaks = self._read(quantities, optional, drawn)
        if breaks:
            raise _refusal(channels.values(), breaks)
        return channels

    def read_pieces(
        self, *quantities: str, optional: Collection[str] = (), shortest: float
    ) -> tuple[list[dict[str, Channel]], list[Break]]:
        """The channels of each piece that lasts so long in s and can be used, and what is between the pieces; else as
        `read`."""
        channels, breaks = self._read(quantities, optional, False)
        if not breaks:
            return [channels], breaks
        long = [(begin, end) for begin, end in _clean(channels.values(), breaks) if end - begin >= shortest]
        if not long:
            raise _refusal(channels.values(), breaks)
        return [_between(channels, *piece) for piece in long], breaks

    def _read(
        self, quantities: Sequence[str], optional: Collection[str], drawn: bool
    ) -> tuple[dict[str, Channel], list[Break]]:
        """The channels, and where they cannot be used."""
        if missing := self.missing(*quantities):
            raise self.absence(missing)
        times = [] if self._source.own_time else self._chooser.times()
        choices = [self._chooser.needed(quantity) for quantity in quantities]
        first = next(iter(times), None)
        # of `Time;Velocity;Time;Motor Torque` each time holds for the columns behind it
        before = [next((time for time in reversed(times) if time.place < choice.place), first) for choice in choices]
        clocks = [time for time in times if time in before]
        samples = self._source.read([choice.place for choice in (*clocks, *choices)])
        begins = [of_clock.begin for of_clock in samples[: len(clocks)]]
        if len({begin is None for begin in begins}) > 1:  # what one calls 0 the other does not
            raise doubled(self._source, "time", [clock.column.heading for clock in clocks])
        since = next(iter(begins), None)
        rows = {time: self._rows(time, of_clock, since) for time, of_clock in zip(clocks, samples, strict=False)}
        breaks = [break_ for of in rows.values() for break_ in of.breaks]
        channels: dict[str, Channel] = {}
        for choice, clock, column_samples in zip(choices, before, samples[len(clocks) :], strict=True):
            if np.isfinite(column_samples.values).any() or choice.quantity not in optional:
                known = [channel.time for channel in channels.values()]
                channel, more = self._channel(choice, column_samples, rows[clock] if clock else None, known, drawn)
                channels[choice.quantity] = channel
                breaks += more
        for together in _by_time(channels.values()):
            # a message may stay away for long, but not in rows that it shares with a sensor
            gap = inf if drawn else min(QUANTITIES[channel.quantity].gap for channel in together)
            breaks += time_breaks(self.path, together[0].time, together[0].where, gap, jumps=drawn)
        breaks += [break_ for channel in channels.values() for break_ in _beyond_limit(self.path, channel)]
        return channels, breaks

    def _rows(self, choice: Choice, samples: Samples, since: Clock | None) -> Rows:
        """The rows; what some write below the last time is none of them.

        Args:
            since: what the clock of all says at 0.
        """
        time, column = choice.factor * samples.values, choice.column
        if samples.begin and since:
            time = time + samples.begin.after(since, 0.0)
        there = np.flatnonzero(np.isfinite(time))
        if not len(there):
            raise self._no_numbers(column, samples)
        kept = there[self._inside(time[there], since)]
        within = range(kept[0], kept[-1]) if len(kept) else ()
        odd = {k: text for k, text in samples.unreadable.items() if k in within}
        breaks = self._unreadable(column, samples.where, odd, kept, time, f", nor a time such as {EXAMPLES}")
        first, last = there[[0, -1]].tolist()
        for begin, end, rows, of_cut in (
            (-inf, float(time[first]), range(first), self._cut.begin),
            (float(time[last]), inf, range(last + 1, len(time)), self._cut.end),
        ):
            if of_cut is None and len(rows) > FOOTER:
                text = samples.unreadable.get(rows[0])
                odd_time = (
                    f"{self.path}, {samples.where(rows[0])}: {column.heading} has no value"
                    if text is None
                    else not_finite(self.path, samples.where(rows[0]), column, plain(text, LONGEST_CELL))
                )
                problem = f"{odd_time}, nor has it in the {len(rows) - 1} rows below; a footer has {FOOTER} at most"
                breaks.append(Break(begin, end, problem))
        return Rows(time, since, column.heading, breaks)

    def _inside(self, time: np.ndarray, begin: Clock | None) -> np.ndarray:
        """Which times are in the part that is read."""
        try:
            return self._cut.within(time, begin)
        except ValueError as reason:
            raise RecordingError(f"{self.path}: {reason}") from reason

    def _channel(
        self, choice: Choice, samples: Samples, rows: Rows | None, times: Sequence[np.ndarray], drawn: bool
    ) -> tuple[Channel, list[Break]]:
        """A channel, and where it cannot be used.

        Args:
            times: of the channels before, so that those that were sampled together have the same array.
        """
        declared, column = QUANTITIES[choice.quantity], choice.column
        if not np.isfinite(samples.values).any():
            raise self._no_numbers(column, samples)
        time, begin = (rows.time, rows.begin) if rows else (samples.time, samples.begin)
        assert time is not None, "a file has a column of time, or its channels have their own"
        index = np.flatnonzero(self._inside(time, begin))
        time, written = time[index], samples.values[index]
        # 255 and 65535 are values of a counter
        is_code = np.zeros(len(index), dtype=bool) if drawn or declared.unit == "1" else coded(written)
        filling = holes(
            time, np.where(is_code, np.nan, written), inf if drawn else max(FILLED, declared.hole), declared.held
        )
        places = {int(k): j for j, k in enumerate(index)} if samples.unreadable else {}
        odd = {places[k]: text for k, text in samples.unreadable.items() if k in places}
        there = np.isfinite(filling.values)
        there[list(odd)] = False
        kept = np.flatnonzero(there)
        where = Kept(samples.where, index)
        breaks = self._unreadable(column, where, odd, kept, time)
        if drawn and len(none := np.flatnonzero(np.isnan(written))):
            breaks.append(Break(-inf, inf, f"{self.path}, {where(int(none[0]))}: {column.heading} has no value"))
        breaks += [
            Break(
                float(time[a]),
                float(time[b]),
                f"{self.path}, {where(a + 1)}: {column.heading} has no value for {time[b] - time[a]:g} s "
                f"after {time_text(float(time[a]))} s; holes of {FILLED:g} s at most are filled",
            )
            for a, b in filling.long
        ]
        without_value = {code: np.flatnonzero(written == code) for code in np.unique(written[is_code]).tolist()}
        without_value |= {None: filling.filled[~is_code[filling.filled]]}
        if not drawn and len(kept) and time[-1] - time[kept[-1]] > LATEST:
            until, rest = time_text(float(time[kept[-1]])), len(time) - 1 - int(kept[-1])
            warn_once(
                f"{self.path}: {column.heading} has no value after {until} s, in {rest} samples; they are left out"
            )
        missing = [MissingSamples(code, time[at], where(at[0])) for code, at in without_value.items() if len(at)]
        time = time[kept] if drawn else spread_equal_times(time[kept])
        # some loggers write a row twice
        if not drawn and len(once := _not_twice(time, filling.values[kept])) < len(time):
            time, kept = time[once], kept[once]
        if len(kept) < LEAST:
            few = f"{self.path}: {len(kept)} samples; a drive needs at least two"
            raise RecordingError(breaks[0].problem if breaks else few)
        channel = Channel(
            choice.quantity,
            column.heading,
            choice.unit,
            next((same for same in times if np.array_equal(same, time)), time),
            choice.factor * filling.values[kept],
            Kept(samples.where, index[kept]),
            FileUnit(plain(choice.file_unit), abs(choice.factor)),
            rows.heading if rows else "time",
            missing,
        )
        return channel, breaks

    def _unreadable(
        self,
        column: Column,
        where: Callable[[int], str],
        odd: Mapping[int, str],
        kept: np.ndarray,
        time: np.ndarray,
        forms: str = "",
    ) -> list[Break]:
        """A break for each sample that cannot be read; without a time around it if there are too many.

        Args:
            odd: what stands there by index.
            kept: indices of the samples that have a value, in `time`.
        """
        breaks = []
        for k, text in list(odd.items())[: MOST + 1]:
            j = int(np.searchsorted(kept, k))
            before = float(time[kept[j - 1]]) if j else -inf
            after = float(time[kept[j]]) if j < len(kept) else inf
            few = len(odd) <= MOST
            problem = not_finite(self.path, where(k), column, plain(text, LONGEST_CELL))
            breaks.append(Break(before if few else -inf, after if few else inf, f"{problem}{forms}"))
        return breaks

    def _no_numbers(self, column: Column, samples: Samples) -> RecordingError:
        """What to say of a column without any."""
        if not len(samples.values):
            return RecordingError(f"{self.path}: 0 samples; a drive needs at least two")
        for k, text in samples.unreadable.items():
            return RecordingError(
                f"{not_finite(self.path, samples.where(k), column, plain(text, LONGEST_CELL))}, and no other is there"
            )
        return RecordingError(f"{self.path}: {column.heading} holds no numbers")


def _not_twice(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Indices of the samples that are not the one before once more."""
    return np.flatnonzero(
        np.append(np.ones(len(time[:1]), dtype=bool), (np.diff(time) != 0.0) | (np.diff(values) != 0.0))
    )


def _by_time(channels: Iterable[Channel]) -> Iterable[list[Channel]]:
    """Those that were sampled together."""
    groups: dict[int, list[Channel]] = {}
    for channel in channels:
        groups.setdefault(id(channel.time), []).append(channel)
    return groups.values()


def _beyond_limit(path: Path, channel: Channel) -> list[Break]:
    """Where a value is larger than any car has."""
    limit = QUANTITIES[channel.quantity].limit
    beyond = np.flatnonzero(np.abs(channel.values) > limit)
    # with a wrong unit all samples are beyond
    few, breaks = len(beyond) <= MOST, []
    for k in beyond[:MOST].tolist():
        problem = (
            f"{path}, {channel.where(k)}: {channel.heading} is {channel.values[k]:g} {channel.unit}; at most {limit:g} "
            f"{channel.unit} in magnitude can be"
        )
        advice = f"; --column {channel.quantity}='... [UNIT]' gives another unit"
        breaks.append(
            (break_around(channel.time, k, k, problem) if few else Break(-inf, inf, problem))._replace(advice=advice)
        )
    return breaks


def _clean(channels: Collection[Channel], breaks: Iterable[Break]) -> list[tuple[float, float]]:
    begin, end = max(channel.time.min() for channel in channels), min(channel.time.max() for channel in channels)
    return clean_pieces(float(begin), float(end), breaks)


def _between(channels: Mapping[str, Channel], begin: float, end: float) -> dict[str, Channel]:
    """What was sampled together still is."""
    times = {id(channel.time): channel.time for channel in channels.values()}
    kept = {k: np.flatnonzero((time >= begin) & (time <= end)) for k, time in times.items()}
    cut = {k: time[kept[k]] for k, time in times.items()}
    return {name: of.at(kept[id(of.time)], cut[id(of.time)]) for name, of in channels.items()}


def _refusal(channels: Collection[Channel], breaks: Sequence[Break]) -> RecordingError:
    """What to say of breaks: the first, and the longest piece without any."""
    problem, advice = breaks[0].problem, breaks[0].advice
    if pieces := _clean(channels, breaks):
        begin, end = max(pieces, key=lambda piece: piece[1] - piece[0])
        advice += f"; the longest piece without is --from {time_text(begin)} --to {time_text(end)}"
    return RecordingError(problem, advice)
