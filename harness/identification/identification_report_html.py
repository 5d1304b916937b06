"""The report of `driveline identify`: what was found, how certain it is, and how the model fits the recording."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import norm

from ..metrics.spectrum import decibels
from ..recordings.measurement import Measurement
from ..views.colours import BLACK, BLUE, GREY, VERMILION
from ..views.html.figure_selector import chosen
from ..views.html.linked_figures import Columns, Curve, Panel, linked, source_of, stacked, window
from ..views.html.report_page import Section, write_report
from ..views.html.report_tables import Heading, Row, Table
from .car_file import MEANS, UNITS, found
from .drive_train_response import FREQUENCIES, Tyre, response
from .free_runs import FreeRuns, end_of, free_runs
from .identify import Identified
from .prediction import filtered
from .quality import SIMULATED
from .response_band import PERCENTILES, drawn_responses, recorded_response

STRETCH = 20.0
"""Of the recording, its end, in s."""

WORST = 5
"""Pieces that the table has."""

RESPONSE = np.linspace(FREQUENCIES[0], FREQUENCIES[-1], 381)
"""Frequencies in Hz."""

INNOVATIONS = np.linspace(-5.0, 5.0, 52)
"""Edges of the histogram, in standard deviations."""

SPEEDS = (
    Panel(
        "motor speed, rad/s", (Curve("omega_1_meas", "measured", GREY, width=2.4), Curve("omega_1", "simulated", BLUE))
    ),
    Panel("difference, rad/s", (Curve("error", "simulated less measured", BLUE),)),
    Panel(
        "wheel speed, rad/s", (Curve("omega_2_meas", "measured", GREY, width=2.0), Curve("omega_2", "simulated", BLUE))
    ),
    Panel(
        "torque, N·m",
        (Curve("T_mot", "motor, measured", GREY, width=2.0), Curve("T_gear", "gear, simulated", VERMILION)),
    ),
)


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
        *_innovations(identified),
    ]
    write_report(f"The drive train of {recording.name}", verdict(identified), sections, provenance, path)


def verdict(identified: Identified) -> str:
    """In one sentence."""
    text = ", ".join(
        f"{name} = {value:.4g} ± {half:.2g} {UNITS.get(name, '')}".rstrip() for name, value, half in found(identified)
    )
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
    rows = [
        Row([name, f"{value:.5g}", f"{half:.2g}", f"{100.0 * half / abs(value):.2g}", UNITS.get(name, "")])
        for name, value, half in found(identified)
    ]
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
    return Table(
        headings, [Row([*fits, *(f"{x:.2f}" for x in (quality.size, quality.correlation, identified.resonance))])]
    )


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
    columns = {name: np.asarray(getattr(runs, name)) for name in ("time", "omega_1", "omega_2", "T_gear", "error")}
    valid = np.ones(len(recording.time), bool) if recording.valid is None else recording.valid
    measured = {"omega_1_meas": recording.omega_1, "T_mot": recording.T_mot}
    if recording.omega_2 is not None:
        measured["omega_2_meas"] = np.where(valid, recording.omega_2, np.nan)
    columns |= {name: np.interp(runs.time, recording.time, signal) for name, signal in measured.items()}
    whole = float(np.nanmin(runs.time)), float(np.nanmax(runs.time))
    windows = {"all of it": whole} | {_name(a, b): (a, b) for a, b, _ in pieces}
    x_range = window(*whole)
    control, _ = chosen("Piece", dict.fromkeys(windows, ()), windows, x_range)
    figures = linked(SPEEDS, source_of(columns), x_range, "time, s")
    text = f"The last {whole[1] - whole[0]:.0f} s of the recording; each run starts where it fits best."
    return Section("Measured and simulated", text, figures=[control, stacked(figures)])


def _over_frequency(identified: Identified) -> Section:
    alone = _response(identified, identified.tyre)
    held = {f"{name}_held": column for name, column in _response(identified, None).items()} if identified.tyre else {}
    curves = {"": ("car on its own", VERMILION)} | ({"_held": ("load torque held", BLUE)} if identified.tyre else {})
    panels = [
        Panel(label, [Curve(f"{of}{end}", name, color) for end, (name, color) in curves.items()], "f")
        for of, label in (("dB", "motor speed over torque, dB"), ("degrees", "phase, degrees"))
    ]
    source = source_of({"f": RESPONSE, **alone, **held})
    figures = linked(panels, source, window(*FREQUENCIES[[0, -1]]), "frequency, Hz")
    f, recorded = recorded_response(identified)
    at = (f >= RESPONSE[0]) & (f <= RESPONSE[-1])
    dots = source_of({"f": f[at], "dB": decibels(recorded[at]), "degrees": np.degrees(np.angle(recorded[at]))})
    for figure, of in zip(figures, ("dB", "degrees"), strict=True):
        for end, (_, color) in curves.items():
            band = {"source": source, "fill_color": color, "fill_alpha": 0.25}
            figure.varea("f", f"{of}_low{end}", f"{of}_high{end}", **band)
        figure.scatter("f", of, source=dots, color=BLACK, size=3, legend_label="recording")
    text = "0 dB is 1 rad/s per N·m, teeth in contact; bands: 95 % by the covariance. The recording crosses the gap."
    return Section("Frequency response", text, figures=[stacked(figures)])


def _response(identified: Identified, behind: Tyre | None) -> Columns:
    answer, drawn = response(identified.p, RESPONSE, behind), drawn_responses(identified, RESPONSE, behind, 1)
    found: dict[str, np.ndarray] = {}
    for name, of in (("dB", decibels), ("degrees", lambda z: np.degrees(np.angle(z)))):
        found[name] = of(answer)
        found[f"{name}_low"], found[f"{name}_high"] = np.percentile(of(drawn), PERCENTILES, axis=0)
    return found


def _innovations(identified: Identified) -> Iterator[Section]:
    through = filtered(identified.drive, identified.p, identified.noise)
    size = through.size[through.settled :]
    density, _ = np.histogram(size, INNOVATIONS, density=True)
    middle = 0.5 * (INNOVATIONS[1:] + INNOVATIONS[:-1])
    source = source_of({"size": middle, "innovations": density, "normal": norm.pdf(middle)})
    curves = (Curve("innovations", "innovations", BLUE), Curve("normal", "normal", BLACK, "dashed", 1.0))
    x_range = window(*INNOVATIONS[[0, -1]])
    figures = linked([Panel("density", curves, "size")], source, x_range, "innovation over its standard deviation")
    yield Section("Distribution of the innovations", "What the filter did not foresee.", figures=[stacked(figures)])
