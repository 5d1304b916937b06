"""What the design is worth: the default car and those of the examples without damping, with the gains of the default
car, and with their own.

The estimator is told the true car in either case. Means over the noise of three seeds.
"""

from collections.abc import Iterable
from itertools import product
from pathlib import Path

from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.design.design import design
from driveline.harness.loop.places import PLANTS
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.studies.margins.car_properties import swing
from fmuloop.many_runs import run_many

from .data_file import ROOT
from .design_trials import Gains, Trial, measured, own_gains
from .study import Cell, Column, Measured, Study, Table, cell

CARS = {"default": None, **{path.stem: path for path in sorted((ROOT / "examples" / "cars").glob("*.toml"))}}
MANOEUVRES = ("tipin15", "tipin50", "tipin0", "tipout", "launch", "drive", "creep")
METRICS = ("settling_time", "overshoot", "gear_torque_rms", "jerk_rms", "response_delay", "withheld_time")
SHOWN = [(metric, metric.column) for metric in declared(Metrics) if metric.column and metric.name in METRICS]

COLUMNS = tuple(Column(column.plain_heading, column.unit, column.decimals) for _, column in SHOWN)
MODES = (
    Column("drive train", "Hz", 1),
    Column("damping ratio, default gains", "", 2),
    Column("damping ratio, own gains", "", 2),
)


def modes_table(cars: Iterable[str]) -> Table:
    """The drive trains of the design model, as `driveline car` tells them."""

    def modes(vehicle: Path | None) -> tuple[Cell, ...]:
        entries = read_vehicle(vehicle) if vehicle else {}
        usual, own = (swing(PLANTS[0], entries, gains) for gains in (design(), own_gains(vehicle)))
        return own.frequency, *(train.damped.damping_ratio if train.damped else None for train in (usual, own))

    return Table("car", MODES, {name: modes(CARS[name]) for name in cars})


def runs_table(trials: Iterable[Trial]) -> Table:
    """The metrics of trials."""
    todo = list(trials)
    pairs = zip(todo, run_many(measured, todo, label="cars"), strict=True)
    rows = {named(trial): tuple(cell(m.of(metrics) * c.factor) for m, c in SHOWN) for trial, metrics in pairs}
    return Table("car, plant, manoeuvre, gains", COLUMNS, rows)


def named(trial: Trial) -> str:
    """The name of its row."""
    car = trial.vehicle.stem if trial.vehicle else "default"
    return f"{car}, {trial.plant}, {trial.manoeuvre}, {trial.gains.value}"


def all_trials() -> list[Trial]:
    """The default car's own gains are the default ones."""
    every = (Trial(*combination) for combination in product(CARS.values(), PLANTS, MANOEUVRES, Gains))
    return [trial for trial in every if trial.vehicle or trial.gains is not Gains.OWN]


def measure() -> Measured:
    return Measured({"modes": modes_table(CARS), "runs": runs_table(all_trials())})


SENTINEL = Trial(CARS["van"], PLANTS[0], "tipin15", Gains.OWN)


def again() -> dict[str, Table]:
    return {"modes": modes_table(["van"]), "runs": runs_table([SENTINEL])}


STUDY = Study(
    "what the design is worth on several cars",
    measure,
    again,
    {"modes": ["van"], "runs": [named(SENTINEL)]},
    (1, 2, 3),
    seconds=20,
)
