"""What frames of a bus mean: databases, read by cantools."""

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from toolground.optional_packages import required
from toolground.plain_text import plain

from .source import RecordingError, require_content
from .text_file import encoding_of


class Known(NamedTuple):
    """A message, and the database that declares it."""

    message: Any
    database: Path


Messages = Mapping[tuple[int, bool], Sequence[Known]]
"""By identifier, and whether that is an extended one."""

IDENTIFIER = re.compile(r"\b(BO_|SG_|VAL_|SIG_VALTYPE_|SG_MUL_VAL_|BO_TX_BU_)(\s+)(\d+)(?=\s)")
STANDARD, EXTENDED = 0x7FF, 0x1FFF_FFFF
FLAG = 1 << 31  # of the identifier in a DBC: the frame has an extended one, as cantools expects

COMPARED = ["start", "length", "byte_order", "is_signed", "scale", "offset", "is_float", "unit", "multiplexer_ids"]
"""Of a signal that two databases declare."""


def known_messages(databases: Sequence[Path]) -> Messages:
    """All that databases declare.

    Raises:
        RecordingError: one is no database.
    """
    by_identifier: dict[tuple[int, bool], list[Known]] = {}
    for path in databases:
        for message in _messages(path):
            by_identifier.setdefault((message.frame_id, message.is_extended_frame), []).append(Known(message, path))
    return by_identifier


def the_one(path: Path, known: Sequence[Known]) -> Any:
    """The message of which these are the declarations.

    Raises:
        RecordingError: they differ; it names the databases.
    """
    first, *others = known
    # databases of body and drive train share frames; two that contradict each other went through without a word
    for other in others:
        if differs := next(_differences(first.message, other.message), None):
            raise RecordingError(
                f"{path}: {first.database} and {other.database} both know frame 0x{first.message.frame_id:X}, and "
                f"differ in {differs}; give the one that is right"
            )
    return first.message


def _differences(a: Any, b: Any) -> Iterator[str]:
    if a.length != b.length:
        yield f"its length ({a.length} and {b.length} bytes)"
    signals = [{signal.name: signal for signal in message.signals} for message in (a, b)]
    for name in sorted(signals[0].keys() ^ signals[1].keys()):
        yield f"signal {plain(name, 60)}, which only one has"
    for name in sorted(signals[0].keys() & signals[1].keys()):
        first, second = (by_name[name] for by_name in signals)
        for what in COMPARED:
            left, right = getattr(first, what), getattr(second, what)
            if left != right:
                yield f"{what.replace('_', ' ')} of {plain(name, 60)} ({plain(left, 60)} and {plain(right, 60)})"
        if _texts(first) != _texts(second):
            yield f"the named values of {plain(name, 60)}"


def _texts(signal: Any) -> dict[int, str]:
    return {number: str(text) for number, text in (signal.choices or {}).items()}


def without_value(signal: Any) -> list[float]:
    """The values of a signal that are named and stand for none: `65535 "SNA"`. Those of a state or a flag, which has no
    unit and no scale, are its values."""
    # state 0 "off" and flag 1 "on" are named values too
    if (signal.scale, signal.offset, signal.unit or "") == (1, 0, ""):
        return []
    return [number * signal.scale + signal.offset for number in signal.choices or {}]


def _messages(path: Path) -> Sequence[Any]:
    cantools = required("cantools", "decoding the frames of a bus", "driverecords[formats]")
    require_content(path, "database")
    try:
        # a DBC does not declare its encoding: `N·m` stands there in Latin-1 and in UTF-8, with and without a mark
        text = path.read_text(encoding=encoding_of(path))
        if text.lstrip().startswith("<"):  # KCD and ARXML, which name their encoding
            return cantools.database.load_file(path, strict=False).messages
        return cantools.database.load_string(IDENTIFIER.sub(_flagged, text), strict=False).messages
    except Exception as error:
        raise RecordingError(f"{path} is no database of a bus (DBC, KCD, SYM, ARXML): {plain(error, 200)}") from error


def _flagged(match: re.Match[str]) -> str:
    """The identifier of a DBC with the flag of an extended one, which some tools leave out."""
    number = int(match[3])
    return f"{match[1]}{match[2]}{number | FLAG if STANDARD < number <= EXTENDED else number}"
