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

AT_ONCE = 2**16
"""Bytes that are read at once; memory is taken for those alone that have come."""


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


def receive(read: Callable[[int], bytes], expected_size: Callable[[], int]) -> Answer:
    """Reads an answer.

    Args:
        read: gives so many bytes or fewer, none at the end.
        expected_size: how many bytes are asked for when the answer comes; those of an error are none.

    Raises:
        EOFError: there are no more answers.
        InvalidAnswer: it is none.
    """
    (length,) = LENGTH.unpack(_exactly(read, LENGTH.size))
    if length > LARGEST_ANSWER:
        raise InvalidAnswer
    try:
        header = json.loads(_exactly(read, length))
        texts, comes, error = header["texts"], header["size"], header["error"]
    except (ValueError, KeyError, TypeError, RecursionError) as wrong:
        raise InvalidAnswer from wrong
    if not _are_texts(texts) or not (error is None or (_are_texts(error) and len(error) == 2)):
        raise InvalidAnswer
    size = 0 if error else expected_size()
    if comes != size:
        raise InvalidAnswer
    return Answer(texts, _exactly(read, size), error and _raised(*error))


def _exactly(read: Callable[[int], bytes], size: int) -> bytearray:
    content = bytearray()
    while len(content) < size:
        some = read(min(AT_ONCE, size - len(content)))
        if not some:
            raise EOFError
        content += some
    return content


def _are_texts(value: Any) -> bool:
    return isinstance(value, list) and {*map(type, value)} <= {str}


def _raised(name: str, text: str) -> Exception:
    if name in ERRORS:
        return ERRORS[name](plain(text))
    return SimulationError(plain(f"{name}: {text}"))
