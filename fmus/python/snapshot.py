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


def unpack(build: str, state: bytes) -> list[Any]:
    """What `pack` was given, with lists in the place of tuples.

    Raises:
        ValueError: the bytes are damaged, or come from another build.
    """
    checksum, body = state[:8], state[8:]
    if checksum != b"%08x" % zlib.crc32(body):
        raise ValueError("its bytes are damaged")
    origin, content = json.loads(body)
    if origin != build:
        raise ValueError(f"it was saved by {origin}, this is {build}")
    return content


def shaped(content: Any, template: Any) -> Any:
    """Nested lists as the records and tuples of a template of the same structure."""
    if not isinstance(template, tuple):
        return content
    items = [shaped(item, like) for item, like in zip(content, template, strict=True)]
    return getattr(type(template), "_make", tuple)(items)
