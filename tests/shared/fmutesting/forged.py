"""Saved states with a right checksum and wrong content, of both builds."""

import json
import struct
import zlib

HEAD = 48
"""Of a state of a native build, in bytes: checksum and GUID; all that follows are numbers of 8 bytes."""

FROM_THE_END = {"start_time": 7, "stop_time": 6, "time": 5, "to_tick": 4, "mode": 3}
"""Places in a native state, in numbers; before them lie the two states of a block."""

IN_JSON = {"mode": (0,), "start_time": (1,), "stop_time": (2,), "time": (3,), "to_tick": (6, 2)}


def forged(saved: bytes, place: str, value: float, states: int = 0, coming: bool = False) -> bytes:
    """A saved state with another value in the named place.

    Args:
        place: see FROM_THE_END; "input" for the first one, "state" for the first of the state.
        states: numbers in a state of the block.
        coming: for the state that is on its way.
    """
    if saved[8:9] == b"[":
        return _forged_in_python(saved, place, value, coming)
    return _forged_in_c(saved, place, value, states * (1 if coming else 2))


def _forged_in_c(saved: bytes, place: str, value: float, back: int) -> bytes:
    if place == "input":
        offset = HEAD
    elif place == "state":
        offset = len(saved) - 8 * (7 + back)
    else:
        offset = len(saved) - 8 * FROM_THE_END[place]
    new = struct.pack("=q" if place == "mode" else "=d", value)
    return with_number(saved, offset, new)


def with_number(saved: bytes, offset: int, number: bytes) -> bytes:
    """A state of a native build with other 8 bytes at the offset, and its checksum."""
    return sealed(saved[4:offset] + number + saved[offset + 8 :])


def sealed(body: bytes) -> bytes:
    """A state of a native build."""
    return zlib.crc32(body).to_bytes(4, "little") + body


def _forged_in_python(saved: bytes, place: str, value: float, coming: bool) -> bytes:
    build, content = json.loads(saved[8:])
    path = {"input": (4, 0), "state": (6, int(coming))}.get(place) or IN_JSON[place]
    *way, last = path
    where = content
    for step in way:
        where = where[step]
    if place == "state":
        where, last = where[last], 0
        while isinstance(where[last], list):
            where = where[last]
    where[last] = value
    return with_checksum(json.dumps([build, content], separators=(",", ":")).encode())


def with_checksum(body: bytes) -> bytes:
    """A state of a Python build."""
    return b"%08x" % zlib.crc32(body) + body
