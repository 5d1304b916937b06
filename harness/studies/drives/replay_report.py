"""The report of `driveline replay`: a recorded drive without damping and with each controller."""

from collections.abc import Iterator, Mapping, Sequence
from math import isnan
from pathlib import Path
from typing import Any

import numpy as np
from scipy.signal import welch

from ...loop import roles
from ...loop.places import T_S
from ...metrics.oscillation import amplitude
from ...metrics.run_metrics import RideMetrics
from ...metrics.spectrum import TO_50_HZ
from ...views.metrics_table import RIDES_SHOWN, ride_rows
from ...views.page.figures import Figure, figure
from ...views.page.report import Heading, Row, Section, Table, of_metrics, write_report
from ...views.page.thinning import thinned
from ...views.panels import Axis, Curve, Panel, within
from ...views.replay_figure import PIECE, USUAL_UNITS, roughest, speeds, swinging, swings, torques
from ...views.signal_lines import Line, Look, Runs, column, looks_of

SEGMENT = 2048
"""Samples of the spectra's segments: 4 s."""

WHOLE = "the whole drive"

Rides = Mapping[str, tuple[RideMetrics, np.ndarray]]
"""By name what a ride is worth and its signals, the undamped one first."""


def report(
    rides: Rides,
    recorded: tuple[np.ndarray, np.ndarray],
    title: str,
    notes: Sequence[str],
    odd: Sequence[str],
    provenance: Any,
    path: Path,
) -> None:
    """Writes the page.

    Args:
        recorded: time in s and speed in m/s of the recording.
        notes: why the table has dashes.
        odd: what makes the recording implausible.
        provenance: see `harness.simulation.provenance.content`.
    """
    pieces = roughest(next(iter(list(rides.values())[1:]))[1])
    metrics = {name: worth for name, (worth, _) in rides.items()}
    headings = [Heading("ride"), *of_metrics(RIDES_SHOWN)]
    table = Table(headings, [Row(cells) for cells in ride_rows(metrics)], notes)
    doubt = [
        Section("Is the recording plausible?", "", Table([Heading("what is odd in it")], [Row([text]) for text in odd]))
    ]
    sections = [
        *(doubt if odd else []),
        Section("All rides", "In brackets what it is over the ride without damping.", table),
        Section(
            "The worst pieces", f"The {PIECE:g} s in which {list(rides)[1]} leaves most swing.", _worst(pieces, rides)
        ),
        *_figures(rides, recorded, [start for start, _ in pieces]),
    ]
    write_report(title, verdict(metrics, odd), sections, provenance, path)


def verdict(rides: Mapping[str, RideMetrics], odd: Sequence[str]) -> str:
    """In one sentence."""
    (_, undamped), (name, damped), *_ = rides.items()
    if isnan(undamped.gear_torque_rms + damped.gear_torque_rms):
        return f"Without damping and with {name} there is nothing to compare: see the table of the rides."
    doubt = f"The recording is not plausible ({len(odd)} {'finding' if len(odd) == 1 else 'findings'}); if it is true, "
    return (
        f"{doubt if odd else ''}{name} takes the rms of the gear torque from {undamped.gear_torque_rms:.3g} to "
        f"{damped.gear_torque_rms:.3g} N·m and that of the body jerk from {undamped.jerk_rms:.3g} to "
        f"{damped.jerk_rms:.3g} m/s³."
    )


def _worst(pieces: Sequence[tuple[float, float]], rides: Rides) -> Table:
    undamped = next(iter(rides.values()))[1]
    without = swinging(undamped)
    rows = []
    for start, mean in pieces:
        at = slice(round(start / T_S), round((start + PIECE) / T_S))
        rows.append(Row([_name(start), f"{mean:.2f}", f"{without[at].mean():.2f}"], _name(start)))
    meaning = "mean over the piece of half the peak to peak within 0.2 s, of gear torque less demand"
    return Table(
        [Heading("piece"), Heading("swing, N·m", meaning, True), Heading("without damping", number=True)], rows
    )


def _name(start: float) -> str:
    return f"{start:g} to {start + PIECE:g} s"


def _figures(rides: Rides, recorded: tuple[np.ndarray, np.ndarray], starts: Sequence[float]) -> Iterator[Section]:
    runs = {name: signals for name, (_, signals) in rides.items()}
    looks = looks_of(runs)
    damped = list(runs)[1]
    panels = [
        torques(runs, looks, USUAL_UNITS["T_mot"]),
        swings(runs, looks, USUAL_UNITS["T_mot"]),
        Panel("body acceleration in m/s²", [c for name in runs for c in _acceleration(name, looks).of(runs[name])]),
        speeds(runs[damped], recorded, f"simulated, {damped}", USUAL_UNITS["v"]),
    ]
    time = runs[damped]["time"]
    windows = {WHOLE: (float(time[0]), float(time[-1]))}
    windows |= {_name(start): (start, min(start + PIECE, float(time[-1]))) for start in starts}
    choices = {name: within(panels, *window) for name, window in windows.items()}
    choices[WHOLE] = thinned(panels)
    x = Axis("time in s", windows[WHOLE])
    text = "The whole drive as the least and the largest value of each piece of it; a worst piece with every sample."
    yield Section("Over time", text, figures=[Figure(choices, x, windows, "Piece")])
    densities = figure([_densities(runs, looks)], Axis("frequency in Hz", (0.0, 25.0)))
    yield Section("Over frequency", "Root of the power density of the gear torque.", figures=[densities])
    exceeded, largest = _exceeded(runs, looks)
    shares = figure([exceeded], Axis("swing of the gear torque in N·m", (0.0, largest)))
    yield Section("How often it swings how much", "Share of the time in which a swing is exceeded.", figures=[shares])


def _acceleration(name: str, looks: Mapping[str, Look]) -> Line:
    return Line(column(roles.BODY_ACCELERATION), name, *looks[name])


def _densities(runs: Runs, looks: Mapping[str, Look]) -> Panel:
    curves = []
    for name, signals in runs.items():
        T_gear = signals[roles.GEAR_TORQUE]
        f, power = welch(T_gear, 1.0 / T_S, nperseg=min(SEGMENT, len(T_gear)), detrend="linear")
        at = (f > 0.0) & (f <= TO_50_HZ[1])
        curves.append(Curve(f[at], np.sqrt(power[at]), name, *looks[name]))
    return Panel("gear torque in N·m/√Hz", curves, scale="log")


def _exceeded(runs: Runs, looks: Mapping[str, Look]) -> tuple[Panel, float]:
    """Over the swing the share of the time in which it is exceeded; and the largest swing."""
    swings = {name: np.sort(amplitude(signals[roles.GEAR_TORQUE], T_S)) for name, signals in runs.items()}
    levels = np.linspace(0.0, max(float(swing[-1]) for swing in swings.values()), 400)
    curves = []
    for name, swing in swings.items():
        share = 100.0 * (1.0 - np.searchsorted(swing, levels, "right") / len(swing))
        curves.append(Curve(levels, np.where(share > 0.0, share, np.nan), name, *looks[name]))
    return Panel("share of the time in %", curves, scale="log"), float(levels[-1])
