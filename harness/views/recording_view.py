"""A recorded drive as it was read: its columns as a table, and a small figure of them with what is odd."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from driverecords.channels import Channel
from driverecords.drive import Drive
from driverecords.findings import Finding

from .colours import BLUE, VERMILION
from .figure_options import PLAIN, FigureOptions
from .figure_style import plot
from .panels import Axis, Curve, Panel, Part, Points


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
