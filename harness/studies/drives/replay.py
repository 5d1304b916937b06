"""A recorded drive, driven by the simulated vehicle without damping and with each of several controllers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib.recfunctions import repack_fields

from driverecords.file_units import FileUnit
from fmuloop.many_runs import run_many
from fmuloop.results import Results
from toolground.errors import UserError
from toolground.progress import part, progress

from ...loop import roles
from ...loop.resolved import ResolvedLoop
from ...manoeuvres.manoeuvre import Manoeuvre
from ...manoeuvres.road_load import RoadLoad, Track
from ...manoeuvres.speed_following import drive, lacking_force, needed_force
from ...metrics.damage import damage, require_counting
from ...metrics.declaration import given, measured
from ...metrics.evaluate import at_samples, end_of, evaluate
from ...metrics.run_metrics import RideMetrics
from ...simulation.simulate import SHORTEST, simulate
from ...views.figure_options import PLAIN, FigureOptions
from ...views.metrics_table import values, write_metrics, write_rides
from ...views.signal_lines import WITHOUT
from ...views.signals_file import write_signals

KEPT = [
    "time",
    roles.DEMAND,
    roles.BRAKE_TORQUE,
    roles.SLOPE,
    roles.REFERENCE_TORQUE,
    roles.MOTOR_SPEED,
    roles.WHEEL_SPEED,
    roles.GEAR_TORQUE,
    roles.BODY_SPEED,
    roles.BODY_ACCELERATION,
]
"""Columns that are kept of a ride; a trip of half an hour with all of them would not fit in memory."""

STRIDE = 5
"""Every so many samples of the controller go to the file of signals: 10 ms."""

CLOSE = 0.1
"""Speed error in m/s, rms, of a car without control from which on the force along the road is good enough."""

MOST_DRIVES = 6
"""Of the car without control, each with the force that the one before has lacked."""


@dataclass(frozen=True, eq=False)
class Ride:
    """A recorded drive that was simulated.

    Attributes:
        controller: its name, or "without damping".
        metrics: in SI units.
        signals: structured array with `time` and the most important columns of `Results`, a row every 2 ms.
    """

    controller: str
    metrics: RideMetrics
    signals: Results

    @property
    def control(self) -> bool:
        return self.controller != WITHOUT

    @property
    def suffix(self) -> str:
        """Of the file of its signals."""
        return self.controller if self.control else "off"


def signals_of(manoeuvre: Manoeuvre, resolved: ResolvedLoop) -> Results:
    """The columns KEPT of a run, at the samples of the controller."""
    kept: Any = repack_fields(at_samples(simulate(manoeuvre, resolved))[KEPT])
    return kept


def speed_error(signals: np.ndarray, track: Track) -> float:
    """Rms of the simulated less the recorded speed in m/s."""
    return float(np.sqrt(np.mean((signals[roles.BODY_SPEED] - np.interp(signals["time"], track.t, track.v)) ** 2)))


def ride_of(controller: str, signals: Results, manoeuvre: Manoeuvre, track: Track) -> Ride:
    """What a run of the manoeuvre of a track is worth."""
    metrics = evaluate(signals, manoeuvre)
    computed = {
        "gear_torque_rms": lambda: given(metrics, "gear_torque_rms"),
        "gear_damage": lambda: damage(signals[roles.GEAR_TORQUE]),
        "jerk_rms": lambda: given(metrics, "jerk_rms"),
        "speed_error_rms": lambda: speed_error(signals, track),
    }
    return Ride(controller, RideMetrics(**measured(computed, none_because=end_of(signals))), signals)


def followed(
    track: Track, load: RoadLoad, resolved: ResolvedLoop, held: float | None = None
) -> tuple[Manoeuvre, Results]:
    """The manoeuvre in which the car without control keeps the recorded speed, and the signals of that run."""
    F, lacking = needed_force(track, load), 0.0
    with progress(MOST_DRIVES, track.name) as done:
        for k in range(MOST_DRIVES):
            F = F + lacking
            manoeuvre = drive(track, load, F, held)
            with part(done, k):
                signals = signals_of(manoeuvre, resolved.replace(control=False))
            if signals.ended or speed_error(signals, track) <= CLOSE:
                break
            lacking = lacking_force(track, load, signals["time"], signals[roles.BODY_SPEED])
    return manoeuvre, signals


def car_of(resolved: ResolvedLoop) -> tuple[RoadLoad, float]:
    """The road load of the plant of a loop, and the largest torque of its motor in N.m."""
    return RoadLoad.of(resolved), resolved.T_max


def replay(
    track: Track, load: RoadLoad, controllers: Mapping[str, ResolvedLoop], held: float | None = None
) -> list[Ride]:
    """The ride without damping, then that with each controller, on the same road.

    Args:
        load: of the plant.
        controllers: their names, and the loop with each; the first is the one that is switched off.
        held: see `harness.manoeuvres.speed_following.drive`.

    Raises:
        UserError: the recording is shorter than a swing is looked for in.
        MissingExtra: the package that counts load cycles is not installed.
    """
    require_counting()
    if track.t[-1] < SHORTEST:
        raise UserError(f"{track.name}: the recording lasts {track.t[-1]:g} s; at least {SHORTEST:g} s are needed")
    first = next(iter(controllers.values()))
    with progress(MOST_DRIVES + len(controllers), track.name) as done:
        with part(done, 0.0, MOST_DRIVES):
            manoeuvre, undamped = followed(track, load, first, held)
        one = partial(_damped, manoeuvre, track, controllers)
        with part(done, MOST_DRIVES, len(controllers)):
            damped = run_many(one, controllers, workers=2)
    return [ride_of(WITHOUT, undamped, manoeuvre, track), *damped]


def _damped(manoeuvre: Manoeuvre, track: Track, controllers: Mapping[str, ResolvedLoop], controller: str) -> Ride:
    return ride_of(controller, signals_of(manoeuvre, controllers[controller]), manoeuvre, track)


def records(rides: Sequence[Ride], track: Track, plant: str) -> list[dict[str, Any]]:
    """The rides for files: what they were, and all metrics by their keys."""
    return [
        {
            "plant": plant,
            "recording": track.name,
            "control": ride.control,
            "controller": ride.controller,
            **values(ride.metrics),
        }
        for ride in rides
    ]


def write(
    rides: Sequence[Ride],
    track: Track,
    plant: str,
    folder: Path,
    options: FigureOptions = PLAIN,
    format: str = "csv",
    file_units: Mapping[str, FileUnit] | None = None,
    notes: Sequence[str] = (),
) -> list[Path]:
    """Writes metrics, table, signals (every 10 ms) and the figure of a replay; returns the files.

    Args:
        format: of the signals, see `harness.views.signals_file`.
        file_units: see `harness.views.replay_figure.plot_replay`.
        notes: below the table.
    """
    from ...views.replay_figure import plot_replay  # not for the workers, which draw nothing

    files = [folder / f"{track.name}{end}" for end in ("_metrics.csv", "_table.md")]
    write_metrics(records(rides, track, plant), files[0])
    write_rides({ride.controller: ride.metrics for ride in rides}, f"{track.name} on {plant}", files[1], notes)
    for ride in rides:
        stem = folder / f"{track.name}_{ride.suffix}"
        files.append(write_signals(ride.signals[::STRIDE], stem, format))
    drawn = {ride.controller: ride.signals for ride in rides}
    title = f"{plant} on the recorded drive {track.name}"
    return files + plot_replay(drawn, (track.t, track.v), title, folder / track.name, options, file_units)
