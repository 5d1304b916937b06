"""The report of `driveline replay`: a recorded drive without damping and with each controller."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.signal import welch

from ...metrics.evaluate import T_S
from ...metrics.oscillation import amplitude
from ...metrics.run_metrics import RideMetrics
from ...metrics.spectrum import TO_50_HZ
from ...views.colours import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION
from ...views.html.figure_selector import chosen
from ...views.html.linked_figures import Columns, Curve, Panel, linked, source_of, stacked, window
from ...views.html.report_page import Section, write_report
from ...views.html.report_tables import Heading, Row, Table, of_metrics
from ...views.html.thinning import extremes
from ...views.metrics_table import RIDES_SHOWN, ride_rows

COLOURS = (GREY, BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY)
"""Of the rides, in turn."""

PIECE, PIECES = 6.0, 5
"""Length in s of the roughest pieces, and how many are shown."""

SEGMENT = 2048
"""Samples of the spectra's segments: 4 s."""

WHOLE = "the whole drive"

Rides = Mapping[str, tuple[RideMetrics, np.ndarray]]
"""By name what a ride is worth and its signals, the undamped one first."""


def report(
    rides: Rides, recorded: tuple[np.ndarray, np.ndarray], title: str, notes: Sequence[str], provenance: Any, path: Path
) -> None:
    """Writes the page.

    Args:
        recorded: time in s and speed in m/s of the recording.
        notes: why the table has dashes.
        provenance: see `harness.simulation.provenance.content`.
    """
    pieces = roughest(next(iter(list(rides.values())[1:]))[1])
    metrics = {name: worth for name, (worth, _) in rides.items()}
    headings = [Heading("ride"), *of_metrics(RIDES_SHOWN)]
    table = Table(headings, [Row(cells) for cells in ride_rows(metrics)], notes)
    sections = [
        Section("All rides", "In brackets what it is over the ride without damping.", table),
        Section(
            "The worst pieces", f"The {PIECE:g} s in which {list(rides)[1]} leaves most swing.", _worst(pieces, rides)
        ),
        *_figures(rides, recorded, [start for start, _ in pieces]),
    ]
    write_report(title, verdict(metrics), sections, provenance, path)


def verdict(rides: Mapping[str, RideMetrics]) -> str:
    """In one sentence."""
    (_, undamped), (name, damped), *_ = rides.items()
    return (
        f"{name} takes the 5-50 Hz rms of the gear torque from {undamped.gear_torque_rms:.3g} to "
        f"{damped.gear_torque_rms:.3g} N·m and that of the body jerk from {undamped.jerk_rms:.3g} to "
        f"{damped.jerk_rms:.3g} m/s³."
    )


def roughest(signals: np.ndarray) -> list[tuple[float, float]]:
    """Beginnings in s of the pieces with the largest mean swing of the gear torque about the demand, and that swing in
    N.m; the pieces do not overlap."""
    swing = amplitude(signals["plant.T_gear"] - signals["controller.T_driver"], T_S)
    length = min(round(PIECE / T_S), len(swing))
    means = swing[: len(swing) // length * length].reshape(-1, length).mean(axis=1)
    order = np.argsort(-means, kind="stable")[:PIECES]
    return [(float(signals["time"][k * length]), float(means[k])) for k in order]


def _worst(pieces: Sequence[tuple[float, float]], rides: Rides) -> Table:
    undamped = next(iter(rides.values()))[1]
    swing = amplitude(undamped["plant.T_gear"] - undamped["controller.T_driver"], T_S)
    rows = []
    for start, mean in pieces:
        at = slice(round(start / T_S), round((start + PIECE) / T_S))
        rows.append(Row([_name(start), f"{mean:.2f}", f"{swing[at].mean():.2f}"], _name(start)))
    meaning = "mean over the piece of half the peak to peak within 0.2 s, of gear torque less demand"
    return Table(
        [Heading("piece"), Heading("swing, N.m", meaning, True), Heading("without damping", number=True)], rows
    )


def _name(start: float) -> str:
    return f"{start:g} to {start + PIECE:g} s"


def _figures(rides: Rides, recorded: tuple[np.ndarray, np.ndarray], starts: Sequence[float]) -> Iterator[Section]:
    curves = list(zip(rides, COLOURS * len(rides), strict=False))
    widths = [2.0, *[1.4] * len(rides)]
    signals = _signals(rides, recorded)
    time = np.asarray(signals["time"])
    choices, windows = {WHOLE: [_overview(signals)]}, {WHOLE: (float(time[0]), float(time[-1]))}
    for start in starts:
        at = (time >= start) & (time <= start + PIECE)
        choices[_name(start)] = [{name: signal[at] for name, signal in signals.items()}]
        windows[_name(start)] = (start, min(start + PIECE, float(time[-1])))
    x_range = window(*windows[WHOLE])
    control, (source,) = chosen("Piece", choices, windows, x_range)

    def of(quantity: str) -> list[Curve]:
        return [Curve(f"{quantity} {name}", name, c, width=w) for (name, c), w in zip(curves, widths, strict=False)]

    demand = Curve("T_driver", "demand", BLACK, "dashed", 1.0)
    speed = [Curve("recorded", "recorded", GREY, width=2.5), Curve("v", "simulated", BLUE)]
    panels = [
        Panel("gear torque, N·m", [*of("T_gear"), demand]),
        Panel("body acceleration, m/s²", of("a_body")),
        Panel("speed, m/s", speed),
    ]
    text = "The whole drive as the least and the largest value of each piece of it; a worst piece with every sample."
    yield Section("Over time", text, figures=[control, stacked(linked(panels, source, x_range, "time, s"))])
    density = [Panel("gear torque, N·m/√Hz", of("T_gear"), "f", "log")]
    figures = linked(density, source_of(_densities(rides)), window(0.0, 25.0), "frequency, Hz")
    yield Section("Over frequency", "Root of the power density of the gear torque.", figures=[stacked(figures)])
    share = [Panel("share of the time, %", of("T_gear"), "swing", "log")]
    exceeded = _exceeded(rides)
    figures = linked(
        share, source_of(exceeded), window(0.0, float(exceeded["swing"][-1])), "swing of the gear torque, N·m"
    )
    yield Section(
        "How often it swings how much", "Share of the time in which a swing is exceeded.", figures=[stacked(figures)]
    )


def _signals(rides: Rides, recorded: tuple[np.ndarray, np.ndarray]) -> Columns:
    first = list(rides.values())[1][1]
    return {
        "time": first["time"],
        "T_driver": first["controller.T_driver"],
        "v": first["plant.v"],
        "recorded": np.interp(first["time"], *recorded),
        **{
            f"{quantity} {name}": signals[f"plant.{quantity}"]
            for name, (_, signals) in rides.items()
            for quantity in ("T_gear", "a_body")
        },
    }


def _overview(signals: Columns) -> Columns:
    others = [name for name in signals if name != "time"]
    t, values = extremes(signals["time"], np.column_stack([signals[name] for name in others]), 1500)
    return {"time": t, **dict(zip(others, values.T, strict=True))}


def _densities(rides: Rides) -> Columns:
    found: dict[str, np.ndarray] = {}
    for name, (_, signals) in rides.items():
        T_gear = signals["plant.T_gear"]
        f, power = welch(T_gear, 1.0 / T_S, nperseg=min(SEGMENT, len(T_gear)), detrend="linear")
        at = (f > 0.0) & (f <= TO_50_HZ[1])
        found |= {"f": f[at], f"T_gear {name}": np.sqrt(power[at])}
    return found


def _exceeded(rides: Rides) -> Columns:
    swings = {name: amplitude(signals["plant.T_gear"], T_S) for name, (_, signals) in rides.items()}
    levels = np.linspace(0.0, max(float(swing.max()) for swing in swings.values()), 400)
    shares = {
        f"T_gear {name}": 100.0 * (1.0 - np.searchsorted(np.sort(swing), levels, "right") / len(swing))
        for name, swing in swings.items()
    }
    return {"swing": levels, **{name: np.where(share > 0.0, share, np.nan) for name, share in shares.items()}}
