"""Which kind of file a recording is, by its content and not by its name."""

from collections.abc import Sequence
from concurrent.futures import Future
from pathlib import Path
from threading import Thread
from typing import Any
from zipfile import BadZipFile, ZipFile

from toolground.file_limits import SECONDS

from .arrow_file import FEATHER, PARQUET, ArrowFile
from .bus_log import BusLog
from .bus_readers import LOGS, LOOKED_AT, kind_of
from .mdf_file import MARKS, MdfFile
from .source import RecordingError, Source, require_content
from .text_file import TextFile

KINDS = dict.fromkeys(MARKS, MdfFile) | {PARQUET: ArrowFile, FEATHER: ArrowFile}
"""By the bytes with which the file begins; what begins otherwise is text."""

# an Excel workbook was taken for text
FOREIGN = {
    b"\xd0\xcf\x11\xe0": "an Excel workbook or another document of Office",
    b"\x89HDF": "an HDF5 file, such as one of MATLAB 7.3",
    b"MATLAB": "a MATLAB file",
    b"\x1f\x8b": "a gzip archive",
    b"BZh": "a bzip2 archive",
    b"\xfd7zXZ": "an xz archive",
    b"7z\xbc\xaf": "a 7z archive",
    b"\x28\xb5\x2f\xfd": "a Zstandard archive",
    b"%PDF": "a PDF document",
    b"TDSm": "a TDMS file of LabVIEW",
    b"|CF,": "a file of FAMOS",
    b"DIAEXTENDED": "the head of a DIAdem file",
    b"#ROSBAG": "a bag of ROS",
    b"\x89MCAP": "an MCAP file",
    b"SQLite format 3": "an SQLite database",
    b"\x93NUMPY": "an array of NumPy",
    b"\x0a\x0d\x0d\x0a": "a capture of network packets",
    b"<?xml": "an XML document",
    b"<!DOCTYPE": "an HTML document",
    b"<html": "an HTML document",
    b"FEA1": "a Feather file of version 1",
    b"\xff\xff\xff\xff": "a stream of Arrow",
    b"{": "a JSON document",
}
"""What is not read, by the bytes with which it begins."""

ZIP = b"PK\x03\x04"


def opened(path: Path, databases: Sequence[Path] = ()) -> Source:
    """The file, ready to be read.

    Args:
        databases: of the bus, if it is a log of its frames.

    Raises:
        RecordingError: there is no such file, or it is of no kind that can be read; it is a log without a database, or
            there is one and it is none.
        MissingExtra: the package that reads this kind is not installed.
    """
    require_content(path)
    begin = _begin(path)
    kind = _kind(begin)
    if kind is BusLog:
        return BusLog(path, databases)
    if databases:
        logs = ", ".join(log.name for log in LOGS)
        raise RecordingError(f"{path} is no log of a bus ({logs}), which {databases[0]} is for")
    if named := _foreign(path, begin):
        raise RecordingError(f"{path} is {named}, which is not read; save the recording as a text file (CSV)")
    return kind(path)


def _foreign(path: Path, begin: bytes) -> str | None:
    """What the file is, if it is of a kind that is known and not read."""
    if begin.startswith(ZIP):
        try:
            with ZipFile(path) as archive:
                excel = any(name.startswith("xl/") for name in archive.namelist())
        except (BadZipFile, OSError, ValueError, NotImplementedError):
            excel = False
        return "an Excel workbook" if excel else "a ZIP archive"
    return next((name for mark, name in FOREIGN.items() if begin.startswith(mark)), None)


def is_text(path: Path) -> bool:
    """Whether a file is read as text of numbers, and by no package that unpacks it."""
    return _kind(_begin(path)) is TextFile


def _begin(path: Path) -> bytes:
    """The first bytes, for which a disk of a network that is gone lets wait for ever.

    Raises:
        RecordingError: they do not come.
    """
    begin: Future[bytes] = Future()

    def read() -> None:
        try:
            with path.open("rb") as file:
                begin.set_result(file.read(LOOKED_AT))
        except OSError as error:
            begin.set_exception(error)

    Thread(target=read, daemon=True).start()
    try:
        return begin.result(SECONDS)
    except TimeoutError:
        raise RecordingError(f"{path} takes more than {SECONDS} s to read") from None


def _kind(begin: bytes) -> Any:
    # logs first: candump, ASC and TRC are text too
    if kind_of(begin):
        return BusLog
    return next((kind for mark, kind in KINDS.items() if begin.startswith(mark)), TextFile)
