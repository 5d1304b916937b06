"""A recorded drive, driven by the simulated vehicle without and with damping."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib.recfunctions import repack_fields

from .manoeuvres.manoeuvre import Manoeuvre
from .manoeuvres.recording import Recording
from .many import run_many
from .metrics.damage import damage, require_counting
from .metrics.declaration import given, measured
from .metrics.evaluate import at_samples, evaluate
from .metrics.record import RideMetrics
from .reports.csv_file import write_csv
from .reports.table import values, write_metrics
from .simulate import simulate

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
    """A recorded drive that was simulated; the signals are the columns KEPT at the samples of the controller."""

    control: bool
    metrics: RideMetrics
    signals: np.ndarray


def ride(manoeuvre: Manoeuvre, recording: Recording, plant: str, control: bool, **settings: Any) -> Ride:
    """Simulates the manoeuvre of a recording and evaluates it against the recording."""
    results = simulate(manoeuvre, plant=plant, control=control, **settings)
    signals = repack_fields(at_samples(results)[KEPT])
    metrics = evaluate(signals, manoeuvre)
    recorded = np.interp(signals["time"], recording.time - recording.time[0], recording.v)
    computed = {
        "gear_torque_rms": lambda: given(metrics, "gear_torque_rms"),
        "gear_damage": lambda: damage(signals["plant.T_gear"]),
        "jerk_rms": lambda: given(metrics, "jerk_rms"),
        "speed_error_rms": lambda: float(np.sqrt(np.mean((signals["plant.v"] - recorded) ** 2))),
    }
    worth = RideMetrics(**measured(computed))
    return Ride(control, worth, signals)


def replay(manoeuvre: Manoeuvre, recording: Recording, plant: str, **settings: Any) -> tuple[Ride, Ride]:
    """The rides without and with damping, at the same time on two cores.

    Args:
        settings: of both, further arguments of `harness.simulate.simulate`.

    Raises:
        MissingExtra: the package that counts load cycles is not installed.
    """
    require_counting()
    one = partial(_of_words, manoeuvre, recording, plant, **settings)
    undamped, damped = run_many(one, (WITHOUT, WITH), workers=2, label=recording.name)
    return undamped, damped


WITHOUT, WITH = "without damping", "with damping"
"""The cases, as messages name them."""


def _of_words(manoeuvre: Manoeuvre, recording: Recording, plant: str, words: str, **settings: Any) -> Ride:
    return ride(manoeuvre, recording, plant, words == WITH, **settings)


def records(rides: Sequence[Ride], recording: Recording, plant: str) -> list[dict[str, Any]]:
    """The rides for files: what they were, and all metrics by their keys."""
    return [
        {"plant": plant, "recording": recording.name, "control": result.control, **values(result.metrics)}
        for result in rides
    ]


def write(rides: Sequence[Ride], recording: Recording, plant: str, folder: Path, caption: str = "") -> list[Path]:
    """Writes metrics, signals (every 10 ms) and the figure of a replay, with its caption; returns the files."""
    from .reports.figures import plot_replay  # not for the workers, which draw nothing

    files = [folder / f"{recording.name}_metrics.csv"]
    write_metrics(records(rides, recording, plant), files[0])
    for result in rides:
        files.append(folder / f"{recording.name}_{'on' if result.control else 'off'}.csv")
        write_csv(result.signals[::CSV_STRIDE], files[-1])
    recorded = (recording.time - recording.time[0], recording.v)
    return files + plot_replay(
        [result.signals for result in rides],
        recorded,
        f"{plant} on the recorded drive {recording.name}",
        folder / recording.name,
        caption,
    )
