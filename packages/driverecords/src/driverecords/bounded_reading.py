"""Files that unpack to more than they are, and packages that crash, hang or swell over damaged ones: they are read by a
process of its own, with limits of time and memory.

What a file says of its size would be quicker to check, but is written by whoever wrote the file; and no package lets
itself be told how much it may unpack. A limit of the operating system holds for all of them, known faults and others.
"""

from collections.abc import Callable
from functools import wraps
from importlib import import_module
from pathlib import Path
from typing import Any, TypeVar, cast

from toolground.errors import UserError
from toolground.file_limits import MEMORY, PATIENCE, SECONDS, SMALL_TEXT
from toolground.interpreter import ChildError, Limits, call
from toolground.plain_text import plain, words

from .format_detection import is_text
from .source import RecordingError, require_content

FEW_THREADS = {"ARROW_DEFAULT_MEMORY_POOL": "system", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
"""Environment in which packages reserve no memory for threads and data that there may never be."""


Read = TypeVar("Read", bound=Callable[..., Any])


def bounded(read: Read) -> Read:
    """The function, which reads the recording at its first argument, with limits.

    Raises:
        RecordingError: the file takes more than recordings do, or ends the process that reads it.
    """

    @wraps(read)
    def limited(path: Path, *arguments: Any, **named: Any) -> Any:
        path = Path(path)
        require_content(path)
        if is_text(path) and path.stat().st_size <= SMALL_TEXT:
            return read(path, *arguments, **named)
        answer = _alone(path, read.__module__, read.__name__, (path, *arguments), named)
        if isinstance(answer, UserError):
            raise answer
        return answer

    return cast(Read, limited)


def _alone(path: Path, *question: Any) -> Any:
    """The outcome in a process of its own."""
    try:
        return call(outcome, *question, limits=Limits(PATIENCE, SECONDS, MEMORY), environment=FEW_THREADS)
    except TimeoutError as late:
        raise RecordingError(f"{path} {late} to read") from late
    except ChildError as end:
        raise RecordingError(f"{path} ended the process that read it: {plain(end, 200)}") from end


def outcome(module: str, name: str, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
    """What the function, by its module and name, reads from the file; or the error that says why it cannot."""
    path = arguments[0]
    try:
        return getattr(import_module(module), name).__wrapped__(*arguments, **named)
    except UserError as refusal:
        return refusal
    except MemoryError:
        return RecordingError(f"{path} takes more than {MEMORY / 1e6:.0f} MB of memory to read")
    except Exception as fault:
        return RecordingError(f"{path} cannot be read: {plain(words(fault), 200)}")
