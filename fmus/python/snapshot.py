"""The state of an FMU as bytes: exact, the same for the same state, and refused when damaged."""

import json
import zlib
from typing import Any

from ..protocol import DAMAGED_STATE, FOREIGN_STATE
from .refusal import Refused


def pack(build: str, content: tuple[Any, ...]) -> bytes:
    """The bytes of nested tuples of numbers, for the build of that name.

    JSON keeps floats exactly (the shortest text that reads back as the same number).
    """
    body = json.dumps([build, content], separators=(",", ":")).encode()
    return b"%08x" % zlib.crc32(body) + body


def unpack(build: str, state: bytes) -> list[Any]:
    """What `pack` was given, with lists in the place of tuples.

    Raises:
        Refused: the bytes are damaged, or come from another build.
    """
    checksum, body = state[:8], state[8:]
    if checksum != b"%08x" % zlib.crc32(body):
        raise Refused(DAMAGED_STATE)
    try:
        origin, content = json.loads(body)
    except (ValueError, RecursionError) as error:
        raise Refused(DAMAGED_STATE) from error
    if origin != build:
        raise Refused(FOREIGN_STATE, origin=origin, build=build)
    return content
