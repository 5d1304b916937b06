"""Every manoeuvre on both plants, without and with damping: the table of `driveline compare`, and the README's."""

from collections.abc import Iterable, Mapping
from itertools import product
from typing import NamedTuple

from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.catalogue import COMPARED, MANOEUVRES
from driveline.harness.metrics.evaluate import at_samples, evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import simulate
from driveline.harness.views.drive_figure import drive_drawing
from driveline.harness.views.markdown import markdown_table
from driveline.harness.views.metrics_table import SHOWN
from driveline.harness.views.signal_lines import WITHOUT
from fmuloop.many_runs import run_many

from .study import Cell, Column, Measured, Study, Table, cell, number

COLUMNS = tuple(Column(of.plain_heading, of.unit if of.unit != "1" else "", of.decimals) for _, of in SHOWN)
DRAWN = "drive"
DAMPINGS = {WITHOUT: False, "with damping": True}


class Run(NamedTuple):
    """A manoeuvre on a plant."""

    plant: str
    manoeuvre: str
    control: bool

    def __str__(self) -> str:
        return f"{self.plant}, {self.manoeuvre}, {'on' if self.control else 'off'}"


def metrics_cells(metrics: Metrics) -> tuple[Cell, ...]:
    """The metrics that tables of runs show, in the units of COLUMNS."""
    return tuple(cell(metric.of(metrics) * column.factor) for metric, column in SHOWN)


def measured(run: Run) -> tuple[Cell, ...]:
    manoeuvre = MANOEUVRES[run.manoeuvre]
    return metrics_cells(evaluate(simulate(manoeuvre, run.plant, control=run.control), manoeuvre))


def _table(runs: Iterable[Run]) -> Table:
    todo = list(runs)
    pairs = zip(map(str, todo), run_many(measured, todo, label="results"), strict=True)
    return Table("plant, manoeuvre, damping", COLUMNS, dict(pairs))


def measure() -> Measured:
    manoeuvre = MANOEUVRES[DRAWN]
    both = {name: at_samples(simulate(manoeuvre, control=control)) for name, control in DAMPINGS.items()}
    figure = drive_drawing(both, manoeuvre, PLANTS[0])
    return Measured({"runs": _table(map(Run._make, product(PLANTS, COMPARED, (False, True))))}, {DRAWN: figure})


SENTINELS = [Run(plant, "tipin15", control) for plant in PLANTS for control in (False, True)]


def again() -> dict[str, Table]:
    return {"runs": _table(SENTINELS)}


STUDY = Study(
    "every manoeuvre on both plants, without and with damping",
    measure,
    again,
    {"runs": list(map(str, SENTINELS))},
    seconds=20,
)

README = {
    "tip-in through the backlash at 15 km/h: settling": ("tipin15", "settling", 0, "ms"),
    "its overshoot": ("tipin15", "overshoot", 0, "%"),
    "launch: settling": ("launch", "settling", 0, "ms"),
    "uneven drive: gear torque, 5-50 Hz rms": ("drive", "torque rms", 1, "N·m"),
    "torque withheld from the driver in a tip-in": ("tipin15", "torque withheld", 0, "ms of the step"),
    "stationary change of the torque after it": ("tipin15", "stat. change", 2, "N·m"),
}
"""Rows of the table in the README: manoeuvre, column, decimals, unit."""


def readme_table(tables: Mapping[str, Table]) -> str:
    """The table of the README, in Markdown."""

    def shown(plant: str, row: tuple[str, str, int, str]) -> str:
        manoeuvre, name, decimals, unit = row
        off, on = (_values(tables, Run(plant, manoeuvre, control), name, decimals) for control in (False, True))
        return f"{on} {unit}" if not float(off) else f"{on} instead of {off} {unit}"

    rows = [[title, *(shown(plant, row) for plant in PLANTS)] for title, row in README.items()]
    return markdown_table(["with and without damping", *(f"`{plant}`" for plant in PLANTS)], rows, labels=3)


def _values(tables: Mapping[str, Table], run: Run, name: str, decimals: int) -> str:
    (k,) = (k for k, column in enumerate(COLUMNS) if column.name == name)
    return number(tables["runs"].rows[str(run)][k], COLUMNS[k]._replace(decimals=decimals))
