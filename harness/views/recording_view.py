"""A recorded drive as it was read: its columns as a table, and a small figure of them with what is odd."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from driverecords.channels import Channel
from driverecords.drive import Drive
from driverecords.findings import Finding

from .colours import BLUE, VERMILION
from .figure_options import PLAIN, FigureOptions
from .figure_style import plot
from .panels import Axis, Curve, Panel, Part, Points

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


def plot_recording(drive: Drive, findings: Sequence[Finding], stem: Path, options: FigureOptions = PLAIN) -> list[Path]:
    """Draws the columns of a recording in their units, with a dot at each sample that is odd; returns the files."""
    panels = [
        Panel(f"{channel.quantity} {channel.file_unit}", list(_parts(channel, findings)))
        for channel in drive.channels.values()
    ]
    window = options.clipped(float(drive.time[0]), float(drive.time[-1]))
    return plot([[panel] for panel in panels], Axis("time in s", window), drive.name, stem, options, size=(7.2, 1.3))


def _parts(channel: Channel, findings: Sequence[Finding]) -> Iterator[Part]:
    written = channel.values / channel.file_unit.factor
    yield Curve(channel.time, written, color=BLUE)
    of_channel = (finding for finding in findings if finding.column == channel.heading)
    times = np.array([time for finding in of_channel for time in finding.samples or (finding.time,)])
    if len(times):
        yield Points(times, np.interp(times, channel.time, written), "odd", VERMILION)
