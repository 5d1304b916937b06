"""The rows of a long run in a temporary file: in memory are those alone at which somebody is at work."""

import mmap
import os
import platform
from ctypes import CDLL
from pathlib import Path
from tempfile import TemporaryFile

import numpy as np

MOST_IN_MEMORY = 2**26
"""Bytes of rows from which on they are in a file: 5 minutes of the loop at 1 ms."""

RESIDENT = 2**22
"""Bytes of the file that are in memory at a time."""

ON_DISK = Path("/var/tmp")
"""Where systems keep temporary files on a disk; /tmp is memory on many."""

LARGE = 2**20
"""Bytes of an array."""

M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3
"""Of malloc.h."""

MOST_KEPT = 2**25
"""Bytes of an array that the GNU C library can keep."""


class RowFile:
    """A file of zeros as memory. It has no name and is gone when nobody uses its memory any more.

    Attributes:
        memory: what is written there, the file has.

    Raises:
        MemoryError: there is no room for it.
    """

    def __init__(self, size: int) -> None:
        _give_back()
        folder = os.environ.get("TMPDIR", ON_DISK if os.access(ON_DISK, os.W_OK) else None)
        try:
            with TemporaryFile(dir=folder) as file:
                _allocate(file.fileno(), size)
                self.memory = mmap.mmap(file.fileno(), size)
        except OSError as refusal:
            text = f"a run with {size / 1e9:.3g} GB of results: {refusal.strerror} in {folder}; TMPDIR names another"
            raise MemoryError(text) from refusal
        self._touched = 0

    def touched(self, size: int) -> None:
        """So many bytes more were read or written; now and then all are given back to the system, which has the
        file."""
        self._touched += size
        if self._touched >= RESIDENT and hasattr(self.memory, "madvise"):
            self.memory.madvise(mmap.MADV_DONTNEED)
            self._touched = 0


def _give_back() -> None:
    """From now on the C library gives memory of LARGE and more back to the system when it is free. That of GNU keeps
    holes as long as columns of an hour otherwise."""
    _set_malloc(M_MMAP_THRESHOLD, LARGE)


def keep_freed() -> None:
    """From now on the C library keeps memory that is free, for the next table: getting it from the system again takes a
    tenth of a run in lanes."""
    _set_malloc(M_MMAP_THRESHOLD, MOST_KEPT)
    _set_malloc(M_TRIM_THRESHOLD, MOST_IN_MEMORY)


def _set_malloc(parameter: int, value: int) -> None:
    if platform.libc_ver()[0] == "glibc":
        CDLL(None).mallopt(parameter, value)


def _allocate(file: int, size: int) -> None:
    """Room on the disk: writing to memory for which there is none would end the process."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file, 0, size)
    else:
        os.truncate(file, size)


def zeros(length: int, dtype: np.dtype) -> tuple[np.ndarray, RowFile | None]:
    """A table of so many rows, and the file that it is in, if it is long."""
    size = length * dtype.itemsize
    if size <= MOST_IN_MEMORY:
        return np.zeros(length, dtype), None
    file = RowFile(size)
    return np.frombuffer(file.memory, dtype), file
