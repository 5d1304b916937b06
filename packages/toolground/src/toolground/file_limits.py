"""What a file of anybody may take, counted before memory and time are taken: a table that the code runs by and the
documentation prints."""

from typing import NamedTuple


class Limit(NamedTuple):
    """A row of the table.

    Attributes:
        of: what is limited.
        most: as many are taken; one more is refused in a line.
        unit: of the number; empty for a count.
        reason: why so many.
    """

    of: str
    most: int
    unit: str
    reason: str


LIMITS: list[Limit] = []
"""All of them."""


def _limit(of: str, most: int, reason: str, unit: str = "") -> int:
    LIMITS.append(Limit(of, most, unit, reason))
    return most


LARGEST_TOML = _limit("TOML: file", 1_000_000, "a hundred thousand points, read in a second", "bytes")

DEEPEST_TOML = _limit(
    "TOML: parts of a key, brackets in brackets",
    10,
    "three are read; time grows with the square, and Python does not follow hundreds of brackets",
)

MOST_DIGITS = _limit("TOML: digits of a number", 300, "floating-point numbers have 309, and Python prints 4300")

LARGEST_TEXT = _limit(
    "recording as text: file", 500_000_000, "read in the time below; MDF and Parquet hold ten times as much", "bytes"
)

LONGEST_LINE = _limit("recording as text: characters of a line", 1_000_000, "loggers write some thousands")

MOST_COLUMNS = _limit("recording as text: columns", 10_000, "the names of all are looked at")

LARGEST_NOTE = _limit("recording: record beside results of ours", 1_000_000, "it tells the units", "bytes")

SMALL_TEXT = _limit(
    "recording as text: read in the process itself", 20_000_000, "none takes more than some seconds", "bytes"
)

SECONDS = _limit("recording: computing", 30, "a log of a bus with four million frames takes 20", "s")

PATIENCE = _limit("recording: reading on a busy machine or a slow disk", 10 * SECONDS, "ten times as long", "s")

MEMORY = _limit("recording: memory of what reads it", 1_500_000_000, "an hour at 1 kHz has a tenth", "bytes")

UNPACKED = _limit("FMU: what it unpacks to", 10**9, "`--unpacked-limit` says otherwise", "bytes")

MOST_ENTRIES = _limit("FMU: entries of the archive", 50_000, "a Python with its packages has some 20 000")

LARGEST_DIRECTORY = _limit("FMU: directory of the archive", 10_000_000, "200 bytes for each entry", "bytes")

LARGEST_DESCRIPTION = _limit("FMU: a description (XML)", 40_000_000, "300 000 variables", "bytes")

MOST_PARTS = _limit(
    "FMU: elements, attributes and references of a description", 3_000_000, "300 000 variables with ten each"
)

LONGEST_ATTRIBUTE = _limit(
    "FMU: characters of an attribute of a description", 10_000_000, "libxml2 takes no longer ones"
)

DEEPEST_XML = _limit("FMU: elements in elements of a description", 256, "libxml2 goes no deeper")

LARGEST_ANSWER = _limit(
    "FMU: texts that its process answers with", 10**8, "a description and its problems have a tenth", "bytes"
)
