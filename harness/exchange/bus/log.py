"""The frames of a run as a log, ASC or BLF, by python-can."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from datetime import UTC, datetime
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from toolground.atomic_files import complete
from toolground.optional_packages import required

from .database import Telegram, messages

if TYPE_CHECKING:
    from cantools.database.can import Message

NO_DATE = datetime.fromtimestamp(0, UTC)
"""Of a log, so that the same run gives the same bytes."""

ROUNDING = 2e-10
"""In s, what is added to an instant because BLF cuts off what is below a nanosecond."""


def sent_at(telegram: Telegram, results: np.ndarray) -> np.ndarray:
    """The rows of a run at which a frame is on the bus: where its counter has gone on, or at every cycle."""
    if telegram.counter:
        return np.flatnonzero(np.diff(results[telegram.counter])) + 1
    interval = float(results["time"][1] - results["time"][0])
    return np.arange(0, len(results), max(1, round(telegram.cycle / interval)))


def frames(telegram: Telegram, message: Message, results: np.ndarray) -> Iterator[tuple[float, int, bytes]]:
    """Time in s, identifier and bytes of the frames of a run."""
    rows = sent_at(telegram, results)
    names = [signal.content.name for signal in telegram.signals]
    columns = []
    for signal in telegram.signals:
        values = results[signal.column][rows]
        if signal.resolution is not None and signal.content.largest is None:
            columns.append((values.astype(int) % (1 << signal.bits)).tolist())
        else:
            columns.append((values * signal.factor).tolist())
    for time, *values in zip(results["time"][rows].tolist(), *columns, strict=True):
        yield time, message.frame_id, message.encode(dict(zip(names, values, strict=True)))


def write_log(sent: Iterable[Telegram], results: np.ndarray, path: Path) -> None:
    """Writes the frames of a run in the order of their times; the ending of the file says how.

    Raises:
        MissingExtra: python-can or cantools is not installed.
    """
    can = required("can", "a log of the bus", "driveline-damping[recordings]")
    telegrams = list(sent)
    every = [
        frame
        for telegram, message in zip(telegrams, messages(telegrams), strict=True)
        for frame in frames(telegram, message, results)
    ]
    with complete(path) as unfinished, _writer(can, unfinished, path.suffix) as writer:
        for time, identifier, data in sorted(every, key=itemgetter(0)):
            message = can.Message(
                timestamp=time + ROUNDING, arbitration_id=identifier, is_extended_id=False, data=data, is_rx=True
            )
            writer.on_message_received(message)


def _writer(can: Any, path: Path, ending: str) -> Any:
    if ending == ".blf":
        return can.BLFWriter(path)

    class Undated(can.ASCWriter):
        """One whose header does not say when it was written."""

        def _format_header_datetime(self, dt: datetime) -> str:
            return super()._format_header_datetime(NO_DATE)

    return Undated(path)
