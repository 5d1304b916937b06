"""Saved states with a right checksum and wrong content, of both builds."""

import json
import struct
import zlib
from itertools import takewhile

from fmus.native.records import paths, records_of
from models.block.types import Block

HEAD = 48
"""Of a state of a native build, in bytes: checksum and GUID; all that follows are numbers of 8 bytes."""

FROM_THE_END = {"start_time": 8, "stop_time": 7, "time": 6, "ticks": 5, "mode": 4}
"""Places in a native state, in numbers; before them lie the records."""

IN_C = (("input", "u"), ("output", "y"), ("parameter", "p"), ("rate", "u"), ("state", "x"), ("coming", "x"))
"""Places from the head on, and the letters of the records that lie there."""

IN_JSON = {"mode": (0,), "start_time": (1,), "stop_time": (2,), "time": (3,), "ticks": (6, 3)}


FIRST_IN_JSON = {"input": (4, 0), "parameter": (5, 0), "state": (6, 1), "coming": (6, 2)}
"""Places of records; of a state, which may hold others, the first number in it is meant."""


def forged(saved: bytes, place: str, value: float, block: Block) -> bytes:
    """A saved state of the block with another value in the named place.

    Args:
        place: see FROM_THE_END, or the first number of "input", "parameter", "state", "coming" (the state that is on
            its way), and in C "output" and "rate" (that of an input).
    """
    return (_forged_in_python if saved[8:9] == b"[" else _forged_in_c)(saved, place, value, block)


def _forged_in_c(saved: bytes, place: str, value: float, block: Block) -> bytes:
    if place in FROM_THE_END:
        offset = len(saved) - 8 * FROM_THE_END[place]
    else:
        numbers = {letter: len([*paths("", record)]) for letter, record in records_of(block).items()}
        before = takewhile(lambda item: item[0] != place, IN_C)
        offset = HEAD + 8 * sum(numbers[letter] for _, letter in before)
    new = struct.pack("=q" if place == "mode" else "=d", value)
    body = saved[4:offset] + new + saved[offset + 8 :]
    return zlib.crc32(body).to_bytes(4, "little") + body


def _forged_in_python(saved: bytes, place: str, value: float, _block: Block) -> bytes:
    build, content = json.loads(saved[8:])
    *way, last = FIRST_IN_JSON.get(place) or IN_JSON[place]
    where = content
    for step in way:
        where = where[step]
    if place in ("state", "coming"):
        where, last = where[last], 0
        while isinstance(where[last], list):
            where = where[last]
    where[last] = value
    return with_checksum(json.dumps([build, content], separators=(",", ":")).encode())


def with_checksum(body: bytes) -> bytes:
    """A state of a Python build."""
    return b"%08x" % zlib.crc32(body) + body
