"""A recorded drive, driven by the simulated vehicle without and with damping."""

import csv
from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.lib.recfunctions import repack_fields
from rich.box import SIMPLE_HEAD
from rich.table import Table

from .cosimulation.system import BUILD
from .manoeuvres.catalogue import Manoeuvre
from .manoeuvres.recording import Recording
from .metrics.damage import damage, require_counting
from .metrics.evaluate import at_samples, evaluate
from .reports.csv_file import write_csv
from .reports.figures import plot_replay
from .simulate import simulate
from .workers import workers

KEPT = [
    "time",
    "controller.T_driver",
    "plant.T_brake",
    "plant.slope",
    "controller.T_ref",
    "plant.omega_1",
    "plant.omega_2",
    "plant.T_gear",
    "plant.v",
    "plant.a_body",
]
"""Columns that are kept of a ride; a trip of half an hour with all of them would not fit in memory."""

CSV_STRIDE = 5
"""Every so many samples of the controller go to the CSV file: 10 ms."""


@dataclass(frozen=True, eq=False)
class Ride:
    """A recorded drive that was simulated; SI units, see `harness.metrics.evaluate.Metrics`.

    Attributes:
        bTg: 5-50 Hz rms of the gear torque over the trip, N.m.
        damage: of the gear by rainflow counting, (N.m)^5, see `harness.metrics.damage`.
        bJ: 5-50 Hz rms of the jerk of the body over the trip, m/s3.
        speed_error: rms of simulated less recorded speed, m/s.
        signals: the columns KEPT at the samples of the controller.
    """

    bTg: float
    damage: float
    bJ: float
    speed_error: float
    signals: np.ndarray


def ride(
    manoeuvre: Manoeuvre,
    recording: Recording,
    plant: str,
    control: bool,
    seed: int = 1,
    fmus: Path = BUILD,
    build: str | None = None,
) -> Ride:
    """Simulates the manoeuvre of a recording and evaluates it against the recording."""
    results = simulate(manoeuvre, plant=plant, control=control, seed=seed, folder=fmus, build=build)
    signals = repack_fields(at_samples(results)[KEPT])
    metrics = evaluate(signals, manoeuvre)
    recorded = np.interp(signals["time"], recording.time - recording.time[0], recording.v)
    return Ride(
        bTg=metrics.bTg,
        damage=damage(signals["plant.T_gear"]),
        bJ=metrics.bJ,
        speed_error=float(np.sqrt(np.mean((signals["plant.v"] - recorded) ** 2))),
        signals=signals,
    )


def replay(
    manoeuvre: Manoeuvre,
    recording: Recording,
    plant: str,
    seed: int = 1,
    fmus: Path = BUILD,
    build: str | None = None,
) -> tuple[Ride, Ride]:
    """The rides without and with damping, at the same time on two cores.

    The one without damping runs in this process, where it can show its progress.

    Raises:
        MissingExtra: the package that counts load cycles is not installed.
    """
    require_counting()
    with workers(1) as pool:
        damped: Future[Ride] = pool.submit(ride, manoeuvre, recording, plant, True, seed, fmus, build)
        undamped = ride(manoeuvre, recording, plant, False, seed, fmus, build)
        return undamped, damped.result()


def rows(rides: Sequence[Ride]) -> list[tuple[str, str, float, float]]:
    """Quantity, unit, value without and value with damping."""
    off, on = rides
    return [
        ("gear torque 5-50 Hz rms", "N.m", off.bTg, on.bTg),
        ("rainflow damage, relative", "1", 1.0, on.damage / off.damage),
        ("body jerk 5-50 Hz rms", "m/s3", off.bJ, on.bJ),
        ("simulated - recorded speed, rms", "m/s", off.speed_error, on.speed_error),
    ]


def terminal_table(rides: Sequence[Ride], title: str) -> Table:
    """Both rides side by side, and their ratio."""
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD)
    table.add_column("", no_wrap=True)
    table.add_column("unit")
    for heading in ("without damping", "with damping", "with/without"):
        table.add_column(heading, justify="right")
    for quantity, unit, off, on in rows(rides):
        table.add_row(quantity, unit, f"{off:.3g}", f"{on:.3g}", f"{on / off:.3f}")
    return table


def write(rides: Sequence[Ride], recording: Recording, plant: str, folder: Path) -> list[Path]:
    """Writes metrics, signals (every 10 ms) and the figure of a replay; returns the files."""
    folder.mkdir(parents=True, exist_ok=True)
    metrics = folder / f"{recording.name}_metrics.csv"
    with metrics.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("quantity", "unit", "without damping", "with damping"))
        writer.writerows((name, unit, f"{off:.6g}", f"{on:.6g}") for name, unit, off, on in rows(rides))
    files = [metrics]
    for result, control in zip(rides, ("off", "on"), strict=True):
        files.append(folder / f"{recording.name}_{control}.csv")
        write_csv(result.signals[::CSV_STRIDE], files[-1])
    recorded = (recording.time - recording.time[0], recording.v)
    return files + plot_replay(
        [result.signals for result in rides],
        recorded,
        f"{plant} on the recorded drive {recording.name}",
        folder / recording.name,
    )
