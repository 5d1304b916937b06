"""Which kind of file a recording is, by its content and not by its name."""

from pathlib import Path

from .arrow_file import FEATHER, PARQUET, ArrowFile
from .mdf_file import MARKS, MdfFile
from .source import RecordingError, Source
from .text_file import TextFile

KINDS = dict.fromkeys(MARKS, MdfFile) | {PARQUET: ArrowFile, FEATHER: ArrowFile}
"""By the bytes with which the file begins; what begins otherwise is text."""


def opened(path: Path) -> Source:
    """The file, ready to be read.

    Raises:
        RecordingError: there is no such file, or it is of no kind that can be read.
        MissingExtra: the package that reads this kind is not installed.
    """
    if not path.is_file():
        raise RecordingError(f"there is no recording {path}")
    with path.open("rb") as file:
        begin = file.read(max(map(len, KINDS)))
    kind = next((kind for mark, kind in KINDS.items() if begin.startswith(mark)), TextFile)
    return kind(path)
