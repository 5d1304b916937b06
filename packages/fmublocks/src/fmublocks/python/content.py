"""Saved states: exact as bytes, and the same for the same state. Nothing that was read from bytes is trusted; what no
instance can have come to is refused."""

import json
import math
import zlib
from typing import Any, NamedTuple

from ..block.declaration import is_tuple
from ..block.runner import runner
from ..block.types import Block, SampledBlock
from ..description.numbers import numbers
from ..description.variables import Variable, interface
from ..protocol import (
    ANY_NUMBER,
    BAD_STATE,
    DAMAGED_STATE,
    FOREIGN_STATE,
    FROM_START_ON,
    THE_START_TIME,
    WITHIN_A_SAMPLE,
    Mode,
)
from .refusal import Refused

TYPES = {"Real": (float, int), "Integer": (int,), "Boolean": (bool,)}
"""Of the values of a variable, by its type in FMI."""


class Content(NamedTuple):
    """What a saved state holds; `memory` is that of the runner, once there is one."""

    mode: Mode
    start_time: float
    stop_time: float
    time: float
    u: Any
    p: Any
    memory: tuple[Any, ...] | None


def checked(block: Block, read: Any) -> Content:
    """The content of a state of that block.

    Args:
        read: what was read from bytes.

    Raises:
        Refused: no instance can have come to it.
    """
    try:
        return _checked(block, Content._make(read))
    except (TypeError, ValueError, OverflowError) as error:
        raise Refused(DAMAGED_STATE) from error


def _checked(block: Block, content: Content) -> Content:
    mode, u, p = Mode(content.mode), block.Input._make(content.u), block.Parameters._make(content.p)
    running = mode in (Mode.STEPPING, Mode.TERMINATED)
    if mode not in tuple(Mode) or running != (content.memory is not None):
        raise Refused(DAMAGED_STATE)
    _check_times(content, running)
    values = {**u._asdict(), **p._asdict()}
    for variable in interface(block):
        if variable.causality != "output":
            _check_value(block, variable, values[variable.name])
    memory = _checked_memory(block, u, p, content.memory) if running else None
    return content._replace(mode=mode, u=u, p=p, memory=memory)


def _check_times(content: Content, running: bool) -> None:
    for name in ("start_time", "time"):
        if not math.isfinite(value := getattr(content, name)):
            raise Refused(BAD_STATE, name=name, value=value, allowed=ANY_NUMBER)
    if not running and content.time != content.start_time:
        raise Refused(BAD_STATE, name="time", value=content.time, allowed=THE_START_TIME)
    if not content.stop_time >= content.start_time:
        raise Refused(BAD_STATE, name="stop_time", value=content.stop_time, allowed=FROM_START_ON)


def _check_value(block: Block, variable: Variable, value: Any) -> None:
    """An input or a parameter is as it can be set."""
    low, high = variable.bounds()
    bounded = variable.causality == "parameter" or not block.tolerates_bad_input
    if type(value) not in TYPES[variable.fmi_type]:
        raise Refused(DAMAGED_STATE)
    if bounded and not low <= value <= high:
        raise Refused(BAD_STATE, name=variable.name, value=value, allowed=variable.allowed())


def _checked_memory(block: Block, u: Any, p: Any, read: Any) -> tuple[Any, ...]:
    """The state, of a sampled block also the coming state and the sample times to the next tick."""
    memory = shaped(read, runner(block, u, p).memory)
    for record, value in zip(("x", "coming"), memory, strict=False):
        for name, number in numbers(record, value):
            if not math.isfinite(number):
                raise Refused(BAD_STATE, name=name, value=number, allowed=ANY_NUMBER)
    if isinstance(block, SampledBlock) and not abs(memory[2]) <= 1.0:
        raise Refused(BAD_STATE, name="to_tick", value=memory[2], allowed=WITHIN_A_SAMPLE)
    return memory


def shaped(read: Any, template: Any) -> Any:
    """Nested lists of numbers as the records and tuples of a template.

    Raises:
        TypeError: a number is of another type than the template's, or no number.
        ValueError: there are more or fewer of them.
    """
    if is_tuple(template):
        items = [shaped(item, like) for item, like in zip(read, template, strict=True)]
        return getattr(type(template), "_make", tuple)(items)
    if type(read) is not type(template):
        raise TypeError(f"{read!r} is not of the type of {template!r}")
    return read


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
