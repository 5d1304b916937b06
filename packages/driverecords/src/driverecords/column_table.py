"""What was found in a recorded drive, for people and tools: its columns as they were read, and what is odd."""

from collections.abc import Iterator, Sequence
from os import PathLike
from typing import Any

from toolground.printing import Printing

from .channels import Channel
from .drive import Drive
from .findings import Finding, tell

HEADINGS = ("quantity", "column", "read as", "samples", "every, s", "from, s", "to, s", "least", "largest")


def columns(drive: Drive) -> list[dict[str, Any]]:
    """Of each column what was found: for tools, in the units of the file."""
    return [_column(channel) for channel in drive.channels.values()]


def column_rows(drive: Drive) -> Iterator[list[str]]:
    """The same for people; `read as` has the unit of the file and that of the SI."""
    for one in columns(drive):
        unit = one["unit"] if one["unit"] == one["si_unit"] else f"{one['unit']} -> {one['si_unit']}"
        numbers = (one[name] for name in ("interval_s", "begin_s", "end_s", "least", "largest"))
        yield [one["quantity"], one["column"], unit, str(one["samples"]), *(f"{value:.6g}" for value in numbers)]


def _column(channel: Channel) -> dict[str, Any]:
    written = channel.values / channel.file_unit.factor
    return {
        "quantity": channel.quantity,
        "column": channel.heading,
        "unit": channel.file_unit.unit,
        "si_unit": channel.unit,
        "samples": len(channel.time),
        "interval_s": channel.interval,
        "begin_s": float(channel.time[0]),
        "end_s": float(channel.time[-1]),
        "least": float(written.min()),
        "largest": float(written.max()),
    }


def show(
    printing: Printing, recording: PathLike[str] | str, drive: Drive, odd: Sequence[Finding], strict: bool = False
) -> None:
    """Prints the columns of a recording as a table, and tells what is odd in it.

    Raises:
        RecordingError: something is odd, and it is strict.
    """
    from rich.markup import escape

    from toolground.tables import plain_table, print_table

    if not printing.silent:
        rows = (map(escape, row) for row in column_rows(drive))
        print_table(plain_table(escape(str(recording)), HEADINGS, map(list, rows)))
    tell(odd, recording, strict)
    printing.say("" if odd else "nothing is odd")


def document(drive: Drive, odd: Sequence[Finding]) -> dict[str, Any]:
    """The same for tools."""
    return {"columns": columns(drive), "findings": [finding.document() for finding in odd]}
