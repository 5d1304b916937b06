"""What effects of motor and road that are off by default do to a tip-in of the detailed vehicle."""

from collections.abc import Iterable
from typing import NamedTuple

from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import simulate
from fmuloop.many_runs import run_many

from .results import COLUMNS, metrics_cells
from .study import Measured, Study, Table

PLANT, MANOEUVRE = PLANTS[1], MANOEUVRES["tipin15"]

LATE = {"motor.t_dead": 0.01}

EFFECTS: tuple[dict[str, float], ...] = (
    {},
    {"motor.t_dead": 0.002},
    {"motor.t_dead": 0.005},
    LATE,
    {"motor.dT_max": 2000.0},
    {"motor.dT_max": 1000.0},
    {"motor.omega_base": 60.0},
    {"plant.g_muL": 0.15},
)
"""Parameters that are set, and to what."""


class Run(NamedTuple):
    """An effect, without or with damping."""

    effect: dict[str, float]
    control: bool

    def __str__(self) -> str:
        effect = ", ".join(f"{name}={value:g}" for name, value in self.effect.items())
        return f"{effect or 'nothing'}, {'on' if self.control else 'off'}"


RUNS = [Run(effect, control) for effect in EFFECTS for control in (False, True)]
RUNS.insert(RUNS.index(Run(LATE, True)) + 1, Run({**LATE, "controller.slip_drift": 0.7}, True))


def measured(run: Run) -> Metrics:
    return evaluate(simulate(MANOEUVRE, PLANT, control=run.control, parameters=run.effect), MANOEUVRE)


def effects_table(runs: Iterable[Run]) -> Table:
    """The metrics of runs."""
    todo = list(runs)
    pairs = zip(todo, run_many(measured, todo, label="effects"), strict=True)
    return Table("set, damping", COLUMNS, {str(run): metrics_cells(metrics) for run, metrics in pairs})


def measure() -> Measured:
    return Measured({"effects": effects_table(RUNS)})


SENTINELS = RUNS[4:6]


def again() -> dict[str, Table]:
    return {"effects": effects_table(SENTINELS)}


STUDY = Study(
    "what effects that are off by default do to a tip-in of the detailed vehicle",
    measure,
    again,
    {"effects": list(map(str, SENTINELS))},
    seconds=5,
)
