"""docs/design.md, what the design is worth on several cars."""

from collections.abc import Iterator, Mapping
from itertools import product
from pathlib import Path

from docs.studies.imports import ROOT
from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.design.design import design
from driveline.harness.design.design_trials import Gains, Trial, measured, own_gains
from driveline.harness.design.design_weights import records
from driveline.harness.loop.places import PLANTS
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.studies.margins.modes import swing
from driveline.harness.views.markdown import markdown_table
from driveline.harness.views.metrics_table import number

CARS = (None, *sorted((ROOT / "examples" / "cars").glob("*.toml")))
SHOWN_MANOEUVRES = ("tipin15", "tipin50", "tipin0", "tipout", "launch", "drive", "creep")
COLUMNS = ("settling_time", "overshoot", "gear_torque_rms", "jerk_rms", "response_delay", "withheld_time")
SHOWN = [(metric, metric.column) for metric in declared(Metrics) if metric.column and metric.name in COLUMNS]

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")

CAR = Path(__file__).with_name("design_page_car.md").read_text(encoding="utf-8")

Found = Mapping[Trial, Metrics]


def page(found: Found) -> str:
    """The page as Markdown."""
    return PAGE.format(cars="\n".join(_car(vehicle, found) for vehicle in CARS).rstrip())


def _car(vehicle: Path | None, found: Found) -> str:
    plant, motor, _ = records(read_vehicle(vehicle) if vehicle else {})
    alone, damped = swing(plant, motor, own_gains(vehicle))
    headings = ["plant", "manoeuvre", *(f"{column.plain_heading}, {column.unit}" for _, column in SHOWN)]
    return CAR.format(
        name=vehicle.name if vehicle else "The default car",
        frequency=alone.frequency,
        default=swing(plant, motor, design())[1].damping_ratio,
        own=f" and {damped.damping_ratio:.2f} with its own" if vehicle else "",
        table=markdown_table(headings, _rows(vehicle, found), labels=2),
    )


def _rows(vehicle: Path | None, found: Found) -> Iterator[list[str]]:
    for plant, manoeuvre in product(PLANTS, SHOWN_MANOEUVRES):
        results = [found[Trial(vehicle, plant, manoeuvre, gains)] for gains in _shown(vehicle)]
        cells = (" / ".join(number(metric.of(each), column) for each in results) for metric, column in SHOWN)
        yield [plant, manoeuvre, *cells]


def _shown(vehicle: Path | None) -> list[Gains]:
    """The default car's own gains are the default ones."""
    return [gains for gains in Gains if vehicle or gains is not Gains.OWN]


def make(folder: Path) -> None:
    trials = [
        Trial(vehicle, plant, manoeuvre, gains)
        for plant in PLANTS
        for vehicle in CARS
        for manoeuvre in SHOWN_MANOEUVRES
        for gains in _shown(vehicle)
    ]
    found = dict(zip(trials, run_many(measured, trials), strict=True))
    (folder / "design.md").write_text(page(found), encoding="utf-8")
