"""The table of docs/vehicle_model.md, what each effect does to a tip-in, between its marks."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from docs.studies.generated_sections import filled
from docs.studies.imports import ROOT
from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.simulation.simulate import simulate
from driveline.harness.views.markdown import markdown_table
from driveline.harness.views.metrics_table import SHOWN, number

PAGE = ROOT / "docs" / "vehicle_model.md"

PLANT, MANOEUVRE = PLANTS[1], MANOEUVRES["tipin15"]

EFFECTS = (
    None,
    ("motor.t_dead", 0.002),
    ("motor.t_dead", 0.005),
    ("motor.t_dead", 0.01),
    ("motor.dT_max", 2000.0),
    ("motor.dT_max", 1000.0),
    ("motor.omega_base", 60.0),
    ("plant.g_muL", 0.15),
)
"""A parameter that is set, and to what."""

COLUMNS = [
    (metric, column)
    for metric, column in SHOWN
    if metric.name not in ("damping_ratio", "withheld_time", "stationary_torque_change")
]


class Run(NamedTuple):
    """An effect, without or with damping."""

    effect: tuple[str, float] | None
    control: bool


RUNS = [Run(effect, control) for effect in EFFECTS for control in (False, True)]


def measured(run: Run) -> Metrics:
    parameters = dict([run.effect] if run.effect else [])
    return evaluate(simulate(MANOEUVRE, PLANT, control=run.control, parameters=parameters), MANOEUVRE)


def table(found: Mapping[Run, Metrics]) -> str:
    """A row for each effect: the metrics without / with damping."""
    headings = ["set", *(f"{column.plain_heading}, {column.unit}" for _, column in COLUMNS)]
    return markdown_table(headings, [_row(effect, found) for effect in EFFECTS], labels=1)


def _row(effect: tuple[str, float] | None, found: Mapping[Run, Metrics]) -> list[str]:
    off, on = (found[Run(effect, control)] for control in (False, True))
    cells = (f"{number(metric.of(off), column)} / {number(metric.of(on), column)}" for metric, column in COLUMNS)
    return ["`{}={:g}`".format(*effect) if effect else "nothing", *cells]


def make(folder: Path) -> None:
    found = dict(zip(RUNS, run_many(measured, RUNS), strict=True))
    page = filled(PAGE.read_text(encoding="utf-8"), {"effects": table(found)})
    (folder / PAGE.name).write_text(page, encoding="utf-8")
