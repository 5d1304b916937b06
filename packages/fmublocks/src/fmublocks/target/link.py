"""The link to the program with the controller: commands go out, answers come back, over two pipes of its process.

The process is one of this machine or the emulator; link.c says what is sent. Standard library alone.
"""

import ctypes
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from toolground.child_process import Child, signal_name

EMULATOR = "qemu-system-arm"

OPTIONS = (
    *("-machine", "mps2-an386", "-nodefaults", "-display", "none", "-monitor", "none", "-serial", "none"),
    *("-semihosting-config", "enable=on,target=native"),
    # time is counted in instructions, 128 ns each: see board_mps2.c
    *("-icount", "shift=7,sleep=off"),
)

START_LIMIT, LIMIT = 10.0, 1.0
"""Longest time in s until the first answer, and until any other."""

CRASHED = 3
"""Exit code of a program that had a fault, as board_mps2.c gives it."""


class TargetError(Exception):
    """The target cannot be run, or did not answer; the message names it and says what happened."""

    def __repr__(self) -> str:
        return str(self)  # what the binary of PythonFMU logs


class Answer(NamedTuple):
    """What a command is answered with.

    Attributes:
        outputs, state: numbers in the order of the records.
        bytes: both as they came.
        count: instructions that the controller took; 0 where nothing counts them.
        stack: bytes of stack that it took; 0 likewise.
    """

    outputs: tuple[float, ...]
    state: tuple[float, ...]
    bytes: bytes
    count: int  # pyright: ignore[reportIncompatibleMethodOverride]
    stack: int


def emulated(image: Path) -> list[str]:
    """The command that runs an image on the emulated target."""
    return [EMULATOR, *OPTIONS, "-kernel", str(image)]


class Link:
    """A running program with the controller.

    Args:
        command: that starts it.
        name: what errors call it.
        real: "f" or "d", the letter of its real numbers for `struct`.

    Raises:
        TargetError: it cannot be started, or says nothing.
    """

    def __init__(self, command: Sequence[str], name: str, real: str = "f") -> None:
        self.name, self._real, self._size = name, real, struct.calcsize(real)
        self._number = ctypes.c_float if real == "f" else ctypes.c_double
        self._limit = START_LIMIT
        try:
            self._child = Child(command)
        except OSError as error:
            raise TargetError(f"{name} cannot be started: {command[0]}: {error.strerror}") from error
        sizes = struct.unpack("<4I", self._asked(b"i", 16))
        self.inputs, self.outputs, self.states, self.parameters = (size // self._size for size in sizes)
        self._limit = LIMIT

    def start(self, u: Sequence[float]) -> Answer:
        """The start with these inputs."""
        return self._answered(b"s", u, self.inputs)

    def update(self, u: Sequence[float]) -> Answer:
        """One sample with these inputs."""
        return self._answered(b"u", u, self.inputs)

    def set_state(self, x: Sequence[float]) -> Answer:
        return self._answered(b"x", x, self.states)

    def set_parameters(self, p: Sequence[float]) -> Answer:
        return self._answered(b"p", p, self.parameters)

    def read(self, address: int, count: int) -> bytes:
        """So many bytes of the memory of the target."""
        return self._asked(struct.pack("<cII", b"r", address, count), count)

    def write(self, address: int, content: bytes) -> Answer:
        """Puts bytes into the memory of the target, as a calibration tool does."""
        return self._parsed(self._asked(struct.pack("<cII", b"w", address, len(content)) + content, self._length))

    def close(self) -> None:
        """Ends the program; it may have ended before."""
        self._child.end()

    def __enter__(self) -> "Link":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _answered(self, command: bytes, numbers: Sequence[float], count: int) -> Answer:
        if len(numbers) != count:
            raise TargetError(f"{self.name}: command {command!r} takes {count} numbers, not {len(numbers)}")
        # unlike struct, ctypes makes infinities of what is too large for single precision, as C does
        return self._parsed(self._asked(command + bytes((self._number * count)(*numbers)), self._length))

    @property
    def _length(self) -> int:
        """Of an answer in bytes."""
        return (self.outputs + self.states) * self._size + 8

    def _parsed(self, raw: bytes) -> Answer:
        length = self._length - 8
        values = struct.unpack(f"<{self.outputs + self.states}{self._real}", raw[:length])
        return Answer(values[: self.outputs], values[self.outputs :], raw[:length], *struct.unpack("<2I", raw[length:]))

    def _asked(self, request: bytes, length: int) -> bytes:
        """What the program answers, so many bytes.

        Raises:
            TargetError: it does not, within the limit; it has been ended then.
        """
        if self._child.closed:
            raise TargetError(f"{self.name} was lost before")
        try:
            self._child.send(request)
            return bytes(self._child.read(length, self._limit))
        except TimeoutError:
            self.close()
            raise TargetError(f"{self.name} hangs: no answer within {self._limit:g} s") from None
        except EOFError:
            raise TargetError(self._fate()) from None

    def _fate(self) -> str:
        """How the process has ended, in words."""
        if not self._child.end(LIMIT):
            return f"{self.name} closed its link"
        code = self._child.process.returncode
        lines = self._child.errors.decode(errors="replace").strip().splitlines()
        if code < 0:
            return f"{self.name} was lost: ended by {signal_name(-code)}"
        reason = "a fault of the processor" if code == CRASHED else lines[0] if lines else f"exit code {code}"
        return f"{self.name} crashed: {reason}"
