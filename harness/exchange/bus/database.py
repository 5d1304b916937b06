"""The database of the bus (DBC), made from the frames that the blocks declare, by cantools."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from fmublocks.block.declaration import variables
from fmublocks.block.frame import Content, Frame, layout
from fmublocks.block.types import Block
from fmuloop.errors import WiringError
from toolground.atomic_files import complete
from toolground.optional_packages import required

from ....fmus.catalogue import FMUS
from ...loop.places import CONNECTIONS, PLACES

if TYPE_CHECKING:
    from cantools.database.can import Database, Message

DIGITS = 12
"""To which numbers of the database are rounded: 0.0625/3.6*3.6 is 0.0625."""


class Signal(NamedTuple):
    """A signal of a frame, for a car.

    Attributes:
        column: of the results of a run, `instance.variable`, whose value it carries.
        factor: what that is multiplied by to be the value on the bus.
        resolution: of that value; None: single precision.
        bits: that it has.
        largest: value on the bus; None: what single precision holds.
    """

    content: Content
    meaning: str
    column: str
    factor: float
    resolution: float | None
    bits: int
    largest: float | None


class Telegram(NamedTuple):
    """A frame, for a car.

    Attributes:
        cycle: in s.
        counter: column of the results that is one more with every frame; None: they are sent at every cycle.
    """

    frame: Frame
    cycle: float
    counter: str | None
    signals: tuple[Signal, ...]


def telegrams(values: Mapping[str, Mapping[str, Any]]) -> list[Telegram]:
    """What is sent over the bus of a car.

    Args:
        values: by place of the loop, those of the parameters that are not as declared; others are ignored.

    Raises:
        WiringError: the bits of a signal do not hold its largest value in its resolution.
    """
    return [telegram for place, names in PLACES.items() for telegram in _of_place(place, FMUS[names[0]].block, values)]


def _of_place(place: str, block: Block, values: Mapping[str, Mapping[str, Any]]) -> Iterator[Telegram]:
    own = {name: value for name, value in values.get(place, {}).items() if name in block.Parameters._fields}
    p = block.Parameters(**own)
    for frame in block.frames:
        signals = tuple(_signal(place, block, content, p) for content in frame.contents)
        yield Telegram(frame, frame.cycle(p), f"{place}.{frame.counter}" if frame.counter else None, signals)


def _signal(place: str, block: Block, content: Content, p: Any) -> Signal:
    meanings = {quantity.name: quantity.declaration.description for quantity in variables(block.Output)}
    sources = {connection.target: connection.source for connection in CONNECTIONS}
    column = f"{place}.{content.quantity}"
    if content.quantity not in meanings:  # it is an input, and the results have what feeds it
        meanings |= {quantity.name: quantity.declaration.description for quantity in variables(block.Input)}
        column = sources[column]
    meaning = content.meaning or meanings[content.quantity]
    try:
        return Signal(content, meaning, column, content.factor(p), *layout(content, p))
    except ValueError as error:
        raise WiringError(str(error)) from error


def messages(sent: Iterable[Telegram]) -> list[Message]:
    """The frames as cantools has them.

    Raises:
        MissingExtra: cantools is not installed.
    """
    required("cantools", "the database of the bus", "driveline-damping[recordings]")
    from cantools.database.can import Message

    frames = []
    for telegram in sent:
        frame, signals, first = telegram.frame, [], 0
        for signal in telegram.signals:
            signals.append(_on_bus(signal, first, frame.receiver))
            first += signal.bits
        frames.append(
            Message(
                frame.identifier,
                frame.name,
                (first + 7) // 8,
                signals,
                comment=frame.meaning,
                senders=[frame.sender],
                cycle_time=max(1, round(1e3 * telegram.cycle)),
            )
        )
    return frames


def _on_bus(signal: Signal, first: int, receiver: str) -> Any:
    from cantools.database.can import Signal as DbcSignal
    from cantools.database.conversion import BaseConversion

    real = signal.resolution is None
    return DbcSignal(
        signal.content.name,
        first,
        signal.bits,
        is_signed=real,
        conversion=BaseConversion.factory(scale=_number(signal.resolution or 1.0), offset=0, is_float=real),
        minimum=None if real else 0,
        maximum=None if signal.largest is None else _number(signal.largest),
        unit=signal.content.unit or None,
        comment=signal.meaning,
        receivers=[receiver],
    )


def _number(value: float) -> float:
    """As the database has it."""
    rounded = round(value, DIGITS)
    return int(rounded) if rounded == int(rounded) else rounded


def database(messages: Iterable[Message]) -> Database:
    """The database of these messages."""
    from cantools.database.can import Database, Node

    every = list(messages)
    nodes = dict.fromkeys(name for message in every for name in (*message.senders, *message.receivers))
    return Database(messages=every, nodes=[Node(name) for name in nodes], version="")


def dbc(sent: Iterable[Telegram]) -> bytes:
    """The database as DBC, with the line ends of such files.

    Raises:
        MissingExtra: cantools is not installed.
    """
    return database(messages(sent)).as_dbc_string().encode("ascii")


def write_dbc(sent: Iterable[Telegram], path: Path) -> None:
    """Writes the database as DBC.

    Raises:
        MissingExtra: cantools is not installed.
    """
    content = dbc(sent)
    with complete(path) as unfinished:
        unfinished.write_bytes(content)
