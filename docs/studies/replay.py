"""Recorded drives with every controller that damps, over those without damping (see `driveline replay`).

The trips of a real car are in a folder beside the checkout; where they are absent, only the town drive is measured.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

from driveline.harness.loop.built_fmus import built_together
from driveline.harness.loop.places import PLACES, PLANTS
from driveline.harness.loop.resolved import resolve
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import TOWN_DRIVE
from driveline.harness.manoeuvres.road_load import Track
from driveline.harness.metrics.run_metrics import RideMetrics
from driveline.harness.studies.drives.replay import car_of, replay
from driveline.harness.views.metrics_table import RIDES_SHOWN
from driveline.harness.views.signal_lines import WITHOUT
from driverecords.drive import read_drive

from .data_file import ROOT
from .study import Cell, Column, Measured, Study, Table, cell

TRIPS = ROOT.parent / "shared" / "data"

CONTROLLERS = tuple(name for name in PLACES["controller"] if name != "NoDamping")

COLUMNS = (
    *(Column(column.plain_heading, column.unit, None) for _, column in RIDES_SHOWN),
    *(Column(f"{column.plain_heading}, over undamped") for _, column in RIDES_SHOWN[:3]),
)


def recordings() -> Iterator[Path]:
    """Those that are there."""
    yield TOWN_DRIVE
    yield from sorted(TRIPS.glob("bmw_i3_trip_*.csv"))


def rides_table(path: Path, plant: str, controllers: Sequence[str] = CONTROLLERS) -> Table:
    """A row for each controller."""
    settings = built_together(Settings(plant, name) for name in controllers)
    loops = [resolve(each) for each in settings]
    load, T_max = car_of(loops[0])
    rides = replay(Track.of(read_drive(path), T_max), load, dict(zip(controllers, loops, strict=True)))
    metrics_of = {ride.controller: ride.metrics for ride in rides}
    rows = {name: _cells(metrics, metrics_of[WITHOUT]) for name, metrics in metrics_of.items()}
    return Table(f"{path.stem} on {plant}", COLUMNS, rows)


def _cells(metrics: RideMetrics, undamped: RideMetrics) -> tuple[Cell, ...]:
    values = [metric.of(metrics) * column.factor for metric, column in RIDES_SHOWN]
    ratios = [metric.of(metrics) / metric.of(undamped) for metric, _ in RIDES_SHOWN[:3]]
    return tuple(map(cell, (*values, *ratios)))


def measure() -> Measured:
    return Measured({f"{path.stem}_{plant}": rides_table(path, plant) for path in recordings() for plant in PLANTS})


SENTINEL = f"{TOWN_DRIVE.stem}_{PLANTS[0]}"


def again() -> dict[str, Table]:
    return {SENTINEL: rides_table(TOWN_DRIVE, PLANTS[0], CONTROLLERS[:1])}


STUDY = Study(
    "recorded drives with every controller",
    measure,
    again,
    {SENTINEL: [WITHOUT, CONTROLLERS[0]]},
    seconds=300,
)
