"""Answers of the process in which FMUs that are not ours run, as plain data.

Such an FMU can write into the pipe whatever it likes, so nothing that comes out of it is run: an answer is JSON
after its length, and then as many bytes as whoever asked has expected.
"""

import json
from collections.abc import Callable, Sequence
from struct import Struct
from typing import Any, BinaryIO, NamedTuple

from toolground.errors import UserError
from toolground.file_limits import LARGEST_ANSWER
from toolground.plain_text import plain

from .errors import InstantiationError, RunEnded, SimulationError, UnpackingError, WiringError

ERRORS: dict[str, type[Exception]] = {
    error.__name__: error
    for error in (
        UserError,
        WiringError,
        SimulationError,
        UnpackingError,
        InstantiationError,
        RunEnded,
        MemoryError,
    )
}
"""What may be raised here as it was raised there; everything else becomes a SimulationError."""

LENGTH = Struct("<Q")
"""Of the JSON."""

Bytes = bytes | bytearray | memoryview


class InvalidAnswer(Exception):
    """What came is not what was asked for."""


class Answer(NamedTuple):
    """What a question was answered with: texts, bytes, or the error that was raised."""

    texts: Sequence[str] = ()
    content: Bytes = b""
    error: Exception | None = None


def send(answer: Answer, pipe: BinaryIO) -> None:
    """Writes an answer."""
    content = memoryview(answer.content)
    header: dict[str, object] = {"texts": list(answer.texts), "size": content.nbytes, "error": None}
    if answer.error is not None:
        header["error"] = type(answer.error).__name__, str(answer.error)
    line = json.dumps(header).encode()
    pipe.write(LENGTH.pack(len(line)) + line)
    pipe.write(content)
    pipe.flush()


def receive(read: Callable[[int], bytearray], expected_size: int) -> Answer:
    """Reads an answer.

    Args:
        read: gives so many bytes.
        expected_size: how many bytes are asked for; those of an error are none.

    Raises:
        InvalidAnswer: it is none.
    """
    (length,) = LENGTH.unpack(read(LENGTH.size))
    if length > LARGEST_ANSWER:
        raise InvalidAnswer
    try:
        header = json.loads(read(length))
        texts, comes, error = header["texts"], header["size"], header["error"]
    except (ValueError, KeyError, TypeError, RecursionError) as wrong:
        raise InvalidAnswer from wrong
    if not _are_texts(texts) or not (error is None or (_are_texts(error) and len(error) == 2)):
        raise InvalidAnswer
    size = 0 if error else expected_size
    if comes != size:
        raise InvalidAnswer
    return Answer(texts, read(size), error and _raised(*error))


def _are_texts(value: Any) -> bool:
    return isinstance(value, list) and {*map(type, value)} <= {str}


def _raised(name: str, text: str) -> Exception:
    if name in ERRORS:
        return ERRORS[name](plain(text))
    return SimulationError(plain(f"{name}: {text}"))
