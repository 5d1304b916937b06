"""The page of `driveline identify`: what was found and what tells it, prediction and recording, frequency response."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from driverecords.measurement import Measurement

from ..views.page.figures import figure
from ..views.page.report import Heading, Row, Section, Table, write_report
from ..views.panels import Axis, within
from .car_file import meaning, of_car, rows_of
from .fit_figures import FREQUENCY, predicted, responses
from .free_runs import SIMULATED
from .identify import Identified

STRETCH = 20.0
"""Of the recording, its end, in s."""


def report(identified: Identified, recording: Measurement, provenance: Mapping[str, Any], path: Path) -> None:
    """Writes the page.

    Args:
        recording: from which it was identified.
        provenance: see `harness.simulation.provenance.content`.
    """
    sections = [
        Section("What was found", f"{identified.name}: {meaning(identified)}.", _found(identified)),
        _over_time(identified, recording),
        _over_frequency(identified),
    ]
    write_report(f"The drive train of {recording.name}", verdict(identified), sections, provenance, path)


def verdict(identified: Identified) -> str:
    """In one sentence."""
    rows = [row for row in rows_of(identified) if row.name in ("J_2", "C", "phi_B")]
    text = ", ".join(f"{row.name} {row}".replace("+-", "±") if row.told_by else f"{row.name} not told" for row in rows)
    count = len(identified.warnings)
    return (
        f"{text} (95 %); the model predicts {identified.quality.omega_1:.0f} % of the motor speed over "
        f"{SIMULATED:g} s, "
        + ("and nothing speaks against it." if not count else f"and {count} warning{'s' * (count > 1)} should be read.")
    )


def _found(identified: Identified) -> Table:
    headings = [
        Heading("parameter"),
        Heading("meaning"),
        Heading("value", number=True),
        Heading("±", "half of the 95 % interval", True),
        Heading("%", "that half over the value", True),
        Heading("unit"),
        Heading("told by", "the channel that tells most of it"),
    ]
    rows = [
        Row(
            [
                row.name,
                row.meaning,
                f"{row.value:.5g}",
                f"{row.half:.2g}",
                row.percent,
                row.unit,
                row.told_by or "nothing: what is known of cars",
            ]
        )
        for row in rows_of(identified)
    ]
    C, half = of_car(identified)
    values = ["C", "in the vehicle file", f"{C:.5g}", f"{half:.2g}", f"{100.0 * half / C:.2g}"]
    rows.append(Row([*values, "N.m/rad", "all of these"]))
    return Table(headings, rows, [f"Warning: {warning}" for warning in identified.warnings])


def _over_time(identified: Identified, recording: Measurement) -> Section:
    end = float(recording.time[-1])
    window = max(end - STRETCH, float(recording.time[0])), end
    drawn = figure(within(predicted(identified, recording, window), *window), Axis("time in s", window))
    text = (
        f"The last {window[1] - window[0]:.0f} s of the recording; each run of {SIMULATED:g} s starts from the filter."
    )
    return Section("Prediction and recording", text, figures=[drawn])


def _over_frequency(identified: Identified) -> Section:
    text = "0 dB is 1 rad/s per N·m, teeth in contact; bands: 95 % by the covariance. The recording crosses the gap."
    return Section("Frequency response", text, figures=[figure(responses(identified), FREQUENCY)])
