"""The state of an FMU as bytes: exact, the same for the same state, and refused when damaged."""

import json
import zlib
from typing import Any


def pack(build: str, content: tuple[Any, ...]) -> bytes:
    """The bytes of nested tuples of numbers, for the build of that name.

    JSON keeps floats exactly (the shortest text that reads back as the same number).
    """
    body = json.dumps([build, content], separators=(",", ":")).encode()
    return b"%08x" % zlib.crc32(body) + body


def unpack(build: str, state: bytes) -> tuple[Any, ...]:
    """What `pack` was given.

    Raises:
        ValueError: the bytes are damaged, or come from another build.
    """
    checksum, body = state[:8], state[8:]
    if checksum != b"%08x" % zlib.crc32(body):
        raise ValueError("its bytes are damaged")
    origin, content = json.loads(body)
    if origin != build:
        raise ValueError(f"it was saved by {origin}, this is {build}")
    return _tuples(content)


def _tuples(content: Any) -> Any:
    return tuple(_tuples(item) for item in content) if isinstance(content, list) else content
