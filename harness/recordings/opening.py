"""Which kind of file a recording is, by its content and not by its name."""

from pathlib import Path

from .source import RecordingError, Source
from .text_file import TextFile


def opened(path: Path) -> Source:
    """The file, ready to be read.

    Raises:
        RecordingError: there is no such file, or it is of no kind that can be read.
    """
    if not path.is_file():
        raise RecordingError(f"there is no recording {path}")
    return TextFile(path)
