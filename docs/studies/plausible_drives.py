"""Drives of our own that are what they say: what `driveline replay` finds odd in them, which should be nothing.

Plants, manoeuvres and damping in turn, each with a car, sensors and noise that are drawn at random (the box of
docs/results.md). What its sensors record is judged as the recording of a drive at 500 Hz and at 10 Hz, and followed
by the same plant with the car as it is declared, which nobody knows better.
"""

from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from driveline.harness.loop.built_fmus import built
from driveline.harness.loop.places import PLACES, PLANTS, T_S
from driveline.harness.loop.resolved import ResolvedLoop, resolve
from driveline.harness.manoeuvres.catalogue import USUAL_MANOEUVRES
from driveline.harness.manoeuvres.road_load import Track
from driveline.harness.metrics.evaluate import at_samples
from driveline.harness.studies.drives.replay import car_of, followed, speed_error
from driveline.harness.studies.robustness.case_runs import CaseRunner
from driveline.harness.studies.robustness.outcome import Case
from driverecords.channel_rules import excursions, spikes
from driverecords.channels import Channel
from driverecords.drive import Drive
from driverecords.file_units import FileUnit
from driverecords.findings import Finding
from driverecords.force_balance import Balance, balance, forces
from driverecords.missing_values import coded
from driverecords.plausibility import not_followed, of_drive
from driverecords.quantities import QUANTITIES
from fmuloop.many_runs import run_many

from .study import Cell, Column, Measured, Study, Table

CASES, SEED = 200, 1
STRIDES = (1, 50)
"""Samples of the controller from one of the recording to the next: 2 ms and 0.1 s."""


UNITS, STEPS = (1.0, 3.6, 30.0 / np.pi), (1.0, 0.1, 0.0625)
"""What signals of the SI are multiplied by in files, to be in km/h or rpm, and the resolutions that they have there."""


class Spiked(NamedTuple):
    """A channel: how far its loneliest sample leaves its neighbours, over their range, and what is named."""

    quantity: str
    lone: float
    named: int


class Judged(NamedTuple):
    """A drive, what was found odd in it before and after it was followed, and what the rules saw."""

    case: Case
    findings: list[Finding]
    balance: Balance
    speed_error: float
    channels: list[Spiked]


def cases(count: int) -> list[tuple[Case, bool]]:
    """The drives, and whether they are damped."""
    pairs = list(product(PLANTS, (manoeuvre.name for manoeuvre in USUAL_MANOEUVRES)))
    controller = PLACES["controller"][0]
    return [
        (Case(plant, controller, k + 1, manoeuvre), bool(k // len(pairs) % 2))
        for k in range(count)
        for plant, manoeuvre in [pairs[k % len(pairs)]]
    ]


def recorded(results: np.ndarray, stride: int) -> Drive:
    """What a logger has of a run."""
    samples = at_samples(results)
    rise = np.cumsum(np.sin(samples["plant.slope"]) * samples["plant.v"]) * T_S
    kept = slice(None, None, stride)
    time = samples["time"][kept]
    columns = {"v": (samples["plant.v"], "m/s"), "elevation": (rise, "m"), "T_mot": (samples["motor.T_mot_est"], "N.m")}
    channels = {
        name: Channel(name, name, unit, time, values[kept], "sample {}".format, FileUnit(unit))
        for name, (values, unit) in columns.items()
    }
    v, elevation, T_mot = (channel.values for channel in channels.values())
    return Drive("drive", time, v, elevation, T_mot, {}, channels)


SENSORS = {
    "plant.v": "v",
    "motor.T_mot_est": "T_mot",
    "controller.T_ref": "T_ref",
    "motor.omega_1_meas": "omega_1",
    "can.omega_2_can": "omega_2",
    "plant.T_load": "T_load",
    "plant.T_rim": "T_wheel",
}
"""Signals of a run by the quantities that a logger may have of them."""


def sensed(results: np.ndarray) -> Iterator[Channel]:
    """All channels that a logger may have of a run, at three rates."""
    samples = at_samples(results)
    for signal, quantity in SENSORS.items():
        if signal in (samples.dtype.names or ()):
            unit = QUANTITIES[quantity].also or QUANTITIES[quantity].unit
            for stride in (1, 5, 50):
                time, values = samples["time"][::stride], samples[signal][::stride]
                yield Channel(quantity, quantity, unit, time, values, "sample {}".format, FileUnit(unit))


def spiked(channel: Channel) -> Spiked:
    """What the rules see in a channel."""
    lone = max((float(ratio.max(initial=0.0)) for _, ratio in excursions(channel)), default=0.0)
    written = (np.round(factor * channel.values / step) * step for factor, step in product(UNITS, STEPS))
    named = len(list(spikes(channel))) + sum(bool(coded(values).any()) for values in (channel.values, *written))
    return Spiked(channel.quantity, lone, named)


def judged(case: Case, damped: bool, loop: ResolvedLoop, follow: bool = True) -> Judged:
    """What is found odd in a drive.

    Args:
        loop: that made it, and follows it.
        follow: whether the plant follows it.
    """
    results = CaseRunner({(case.plant, case.controller): loop}, SEED).results(case, damped)
    load, T_max = car_of(loop)
    findings, error = [], 0.0
    drives = [recorded(results, stride) for stride in STRIDES]
    for drive in drives:
        findings += of_drive(drive, load, T_max)
        if follow:
            track = Track.of(drive, T_max)
            signals = followed(track, load, loop)[1]
            findings += not_followed(drive, signals["time"], signals["plant.v"])
            error = max(error, speed_error(signals, track))
    balanced = balance(forces(drives[0].time, drives[0].v, drives[0].T_mot, load))
    return Judged(case, findings, balanced, error, [spiked(channel) for channel in sensed(results)])


def all_judged(drives: Sequence[tuple[Case, bool]]) -> list[Judged]:
    """What is found odd in drives."""
    loops = {plant: resolve(built(plant)) for plant in PLANTS}
    return run_many(lambda drive: judged(drive[0], drive[1], loops[drive[0].plant]), drives, label="drives")


def plants_table(drives: Sequence[Judged]) -> Table:
    """A row for each plant."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant in PLANTS:
        its = [drive for drive in drives if drive.case.plant == plant]
        balanced = [drive.balance for drive in its if drive.balance.fits]
        signs = [drive.balance.correlation for drive in its if drive.balance.correlation]
        ratios = [balance.ratio for balance in balanced]
        counts = (len(its), sum(len(drive.findings) for drive in its), len(balanced))
        limits = (min(signs), min(ratios), max(ratios), 3.6 * max(drive.speed_error for drive in its))
        rows[plant] = (*counts, *limits)
    columns = (
        *(Column(name, decimals=0) for name in ("drives", "findings", "balanced")),
        *map(Column, ("least correlation", "least ratio", "largest ratio")),
        Column("speed error", "km/h"),
    )
    return Table("plant", columns, rows)


def findings_table(drives: Sequence[Judged]) -> Table:
    """How many findings single drives have, and how far the plant that follows is off."""
    rows = {str(drive.case): (len(drive.findings), 3.6 * drive.speed_error) for drive in drives}
    return Table("drive", (Column("findings", decimals=0), Column("speed error", "km/h", 3)), rows)


def channels_table(drives: Sequence[Judged]) -> Table:
    """A row for each quantity: how many channels, at 2 ms, 10 ms and 0.1 s, what is named in them, and how lonely the
    loneliest sample is."""
    every = [channel for drive in drives for channel in drive.channels]
    rows: dict[str, tuple[Cell, ...]] = {}
    for quantity in SENSORS.values():
        its = [channel for channel in every if channel.quantity == quantity]
        loneliest = max((channel.lone for channel in its), default=0.0)
        rows[quantity] = (len(its), sum(channel.named for channel in its), loneliest)
    return Table("quantity", (*(Column(name, decimals=0) for name in ("channels", "named")), Column("lone")), rows)


def measure() -> Measured:
    drives = all_judged(cases(CASES))
    tables = {"plants": plants_table(drives), "channels": channels_table(drives), "drives": findings_table(drives)}
    return Measured(tables)


def again() -> dict[str, Table]:
    return {"drives": findings_table(all_judged(cases(1)))}


STUDY = Study(
    "drives of our own in which nothing should be found odd",
    measure,
    again,
    {"drives": [str(cases(1)[0][0])]},
    (SEED,),
    seconds=120,
)
