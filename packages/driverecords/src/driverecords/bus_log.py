"""Logs of a bus, whose frames are decoded by cantools with databases (DBC, ...)."""

from array import array
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from toolground.plain_text import plain

from .bus_database import Messages, known_messages, the_one, without_value
from .bus_readers import began, messages
from .clock_times import Clock
from .source import Column, RecordingError, Samples, Where, samples

IDENTIFIERS_SHOWN = 5


class Kind(NamedTuple):
    """Of frames: those of one identifier on one channel."""

    channel: Any
    identifier: int
    extended: bool


class Frames(NamedTuple):
    """The frames of one kind: times in s from the first frame of the log on, and their bytes."""

    # decoded frames took 390 bytes each: an hour at 1 kHz did not fit into the memory of the process that reads it
    times: "array[float]"
    data: list[bytes]


class BusLog:
    """A Source. A signal whose name several messages have is told by its message, and by its channel if need be:
    `Speed, ABS_1`, `Speed, ABS_1, channel 2`."""

    own_time = True

    def __init__(self, path: Path, databases: Sequence[Path]) -> None:
        """
        Args:
            databases: what says what the frames mean.

        Raises:
            RecordingError: there is no database; a file is damaged; none of the frames is in a database.
            MissingExtra: python-can or cantools is not installed.
        """
        self.path = path
        self.headings = str(path)
        if not databases:
            raise RecordingError(
                f"{path} holds frames of a bus", "; give the database that says what they mean, --dbc FILE"
            )
        known = known_messages(databases)
        self._frames, self._end, self._begin = _read(path, known, databases)
        declared = {kind: the_one(path, known[kind.identifier, kind.extended]) for kind in self._frames}
        self._places = [(kind, declared[kind], signal) for kind in self._frames for signal in declared[kind].signals]
        self.columns: Sequence[Column] = _columns(self._places)

    def read(self, places: Sequence[int]) -> list[Samples]:
        """See `driverecords.source.Source.read`; signals of a message have the same array of times."""
        by_place: dict[int, Samples] = {}
        for kind in dict.fromkeys(self._places[place][0] for place in places):
            by_place |= self._decoded(kind, [place for place in places if self._places[place][0] == kind])
        return [by_place[place] for place in places]

    def _decoded(self, kind: Kind, places: Sequence[int]) -> dict[int, Samples]:
        """Some signals of a message. Of what its frames hold beside them nothing is kept."""
        frames, (_, message, _) = self._frames[kind], self._places[places[0]]
        names = {place: self._places[place][2].name for place in places}
        values, there = ({place: array(code) for place in places} for code in "dq")
        for k, (moment, data) in enumerate(zip(frames.times, frames.data, strict=True)):
            try:
                content = message.decode(data, decode_choices=False)
            # a short frame in the middle of a log is damage, and was forgiven once
            except Exception as error:
                if k + 1 == len(frames.times) and moment == self._end:
                    break  # the log was cut off
                raise RecordingError(
                    f"{self.path}, frame at {moment:g} s: {data.hex(' ') or 'nothing'} is no {message.name} "
                    f"(0x{kind.identifier:X}) of {message.length} bytes: {plain(error, 200)}"
                ) from error
            for place, name in names.items():
                if name in content:  # others may be multiplexed
                    self._append(values[place], content[name], place)
                    there[place].append(k)
        time = np.array(frames.times)
        return {
            place: self._samples(
                place, np.array(values[place]), time if len(at) == len(time) else time[np.array(at, int)]
            )
            for place, at in there.items()
        }

    def _append(self, values: "array[float]", value: Any, place: int) -> None:
        try:
            values.append(value)
        except TypeError:
            raise RecordingError(f"{self.path}: {self.columns[place].heading} holds no numbers") from None

    def _samples(self, place: int, values: np.ndarray, time: np.ndarray) -> Samples:
        none = np.isin(values, without_value(self._places[place][2]))
        where = Where("frame at {1:g} s", time)
        return samples(self.path, self.columns[place], np.where(none, np.nan, values), time, where, self._begin)


def _read(path: Path, known: Messages, databases: Sequence[Path]) -> tuple[dict[Kind, Frames], float, Clock | None]:
    """The frames that are in a database, the time in s of the last frame of all, and what the clock says at the first
    one."""
    frames: dict[Kind, Frames] = {}
    others: set[int] = set()
    begin, end = None, 0.0
    with messages(path) as log:
        for message in log:
            begin = message.timestamp if begin is None else begin
            end = message.timestamp - begin
            # these have an identifier, and no bytes to decode
            if message.is_error_frame or message.is_remote_frame:
                continue
            if (message.arbitration_id, message.is_extended_id) not in known:
                others.add(message.arbitration_id)
                continue
            kind = Kind(message.channel, message.arbitration_id, message.is_extended_id)
            times, data = frames.setdefault(kind, Frames(array("d"), []))
            times.append(end)
            data.append(bytes(message.data))
    if begin is None:
        raise RecordingError(f"{path} has no frames")
    if not frames:
        shown = ", ".join(f"0x{identifier:X}" for identifier in sorted(others)[:IDENTIFIERS_SHOWN])
        raise RecordingError(f"{path}: no frame is in {', '.join(map(str, databases))}; there are {shown}, ...")
    return frames, end, began(path, begin)


def _columns(places: Sequence[tuple[Kind, Any, Any]]) -> list[Column]:
    """The signals, each by as much of name, message and channel as tells it from all others."""
    levels = [
        [signal.name, f"{signal.name}, {message.name}", f"{signal.name}, {message.name}, channel {kind.channel}"]
        for kind, message, signal in places
    ]
    often = [Counter(names) for names in zip(*levels, strict=True)]
    headings = [next((n for n, c in zip(names, often, strict=True) if c[n] == 1), names[-1]) for names in levels]
    return [
        Column(plain(heading, 60), plain(signal.name, 60), plain(signal.unit or "", 60) or None)
        for heading, (_, _, signal) in zip(headings, places, strict=True)
    ]
