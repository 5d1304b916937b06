"""The report of `driveline identify`: what was found, how certain it is, and how the model fits the recording."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..recordings.measurement import Measurement
from ..views.page.figures import Figure, figure
from ..views.page.report import Heading, Row, Section, Table, write_report
from ..views.panels import Axis, within
from .car_file import MEANS, NOT_DETERMINED, Interval, found, of_car, peak
from .fit_figures import autocorrelations, distribution, innovations, simulated
from .free_runs import FreeRuns, end_of, free_runs
from .identify import Identified
from .quality import SIMULATED
from .uncertainty_figures import FREQUENCY, responses

STRETCH = 20.0
"""Of the recording, its end, in s."""

WORST = 5
"""Pieces that the table has."""


def report(identified: Identified, recording: Measurement, provenance: Mapping[str, Any], path: Path) -> None:
    """Writes the page.

    Args:
        recording: from which it was identified.
        provenance: see `harness.simulation.provenance.content`.
    """
    runs = free_runs(identified, recording, end_of(recording, STRETCH))
    pieces = _pieces(runs)
    sections = [
        Section(
            "What was found",
            f"{identified.name}, by {identified.method}: {MEANS[identified.name]}.",
            _found(identified),
        ),
        Section("How good the fit is", "On the last quarter, which was not used.", _quality(identified)),
        Section("Where it fits worst", f"Free runs of {SIMULATED:g} s; a click shows one.", _worst(pieces)),
        _over_time(recording, runs, pieces),
        _over_frequency(identified),
        _innovations(identified),
    ]
    write_report(f"The drive train of {recording.name}", verdict(identified), sections, provenance, path)


def verdict(identified: Identified) -> str:
    """In one sentence."""
    text = ", ".join(f"{row.name} {row}".replace("+-", "±") for row in found(identified))
    count = len(identified.warnings)
    return (
        f"{text} (95 %); the model fits {identified.quality.simulated:.0f} % of the motor speed over {SIMULATED:g} s, "
        + ("and nothing speaks against it." if not count else f"and {count} warning{'s' * (count > 1)} should be read.")
    )


def _found(identified: Identified) -> Table:
    headings = [
        Heading("parameter"),
        Heading("value", number=True),
        Heading("±", "half of the 95 % interval", True),
        Heading("%", "that half over the value", True),
        Heading("unit"),
    ]
    every = found(identified)
    rows = [
        Row([row.name, f"{row.value:.5g}", f"{row.half:.2g}", row.percent, row.unit])
        if row.determined
        else Row([row.name, NOT_DETERMINED, "", "", ""])
        for row in every
    ]
    if identified.tyre:
        C = Interval("C", *of_car(identified), True)
        name = "C of the car, in the vehicle file"
        rows.append(Row([name, f"{C.value:.5g}", f"{C.half:.2g}", C.percent, C.unit]))
    return Table(headings, rows, [f"Warning: {warning}" for warning in identified.warnings])


def _quality(identified: Identified) -> Table:
    quality = identified.quality
    headings = [
        Heading(
            "simulated, %",
            "share of the motor speed that free runs of 0.5 s explain: 100 (1 - rms error/deviation)",
            True,
        ),
        Heading("predicted, %", "the same, 50 ms ahead of the filter", True),
        Heading("one step, %", "the same, one sample ahead", True),
        Heading("innovations", "their size over what the noise explains: 1 if all is right", True),
        Heading("correlation", "largest autocorrelation of the innovations up to 50 ms: 0 if white", True),
        Heading("resonance, Hz", "frequency at which the car answers most on its own", True),
    ]
    fits = [f"{fit:.1f}" for fit in (quality.simulated, quality.predicted, quality.one_step)]
    return Table(headings, [Row([*fits, f"{quality.size:.2f}", f"{quality.correlation:.2f}", peak(identified)])])


def _pieces(runs: FreeRuns) -> list[tuple[float, float, float]]:
    """Beginning and end in s and rms error in rad/s of the worst free runs."""
    ends = np.flatnonzero(np.isnan(runs.time))
    found = [
        (float(runs.time[a]), float(runs.time[b - 1]), float(np.sqrt(np.mean(runs.error[a:b] ** 2))))
        for a, b in zip([0, *(ends[:-1] + 1)], ends, strict=True)
    ]
    return sorted(found, key=lambda piece: -piece[2])[:WORST]


def _name(start: float, end: float) -> str:
    return f"{start:.2f} to {end:.2f} s"


def _worst(pieces: Sequence[tuple[float, float, float]]) -> Table:
    headings = [Heading("piece"), Heading("error, rad/s", "rms of simulated less measured motor speed", True)]
    return Table(headings, [Row([_name(a, b), f"{error:.3g}"], _name(a, b)) for a, b, error in pieces])


def _over_time(recording: Measurement, runs: FreeRuns, pieces: Sequence[tuple[float, float, float]]) -> Section:
    whole = float(np.nanmin(runs.time)), float(np.nanmax(runs.time))
    windows = {"all of it": whole} | {_name(a, b): (a, b) for a, b, _ in pieces}
    panels = within(simulated(recording, runs), *whole)
    drawn = Figure(dict.fromkeys(windows, panels), Axis("time in s", whole), windows, "Piece")
    text = f"The last {whole[1] - whole[0]:.0f} s of the recording; each run starts where it fits best."
    return Section("Measured and simulated", text, figures=[drawn])


def _over_frequency(identified: Identified) -> Section:
    text = "0 dB is 1 rad/s per N·m, teeth in contact; bands: 95 % by the covariance. The recording crosses the gap."
    return Section("Frequency response", text, figures=[figure(responses(identified), FREQUENCY)])


def _innovations(identified: Identified) -> Section:
    size = innovations(identified)
    panels = [distribution(size), autocorrelations(size, identified.drive.T_s)]
    drawn = figure(panels, Axis("", (0.0, 1.0)))
    return Section("Distribution of the innovations", "What the filter did not foresee.", figures=[drawn])
