"""What the controller is to reach, beside what it reaches with noise that no tuning has seen.

    python -m docs.studies goals --parameters my_gains.toml
    python -m docs.studies goals --draws 300        # the row of the Monte-Carlo too

Each figure is the mean over the seeds that are held out. Without a file it is that of the gains as they are stored.
"""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from driveline.fmus.building.parameter_files import read_parameters
from driveline.harness.design.character import factors
from driveline.harness.design.loop_parameters import loop_parameters
from driveline.harness.design.search.tuning_runs import HELD_OUT_SEEDS, SLOW_MOTOR
from driveline.harness.design.uncertainty_box import NOMINAL, Deviation, deviating
from driveline.harness.loop.places import PLACES, PLANTS
from driveline.harness.loop.resolved import as_given
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import planned
from driveline.harness.studies.robustness import summary
from driveline.harness.studies.robustness.case_runs import CaseRunner
from driveline.harness.studies.robustness.robustness_campaign import campaign
from driveline.models.controller.gains import GAINS
from fmuloop.campaign import RunRequest
from fmuloop.many_runs import run_many
from fmuloop.results import Results
from fmuloop.system import Scheme

from .study import Cell, Column, Measured, Study, Table
from .terminal import show


class Goal(NamedTuple):
    """What a metric of a manoeuvre is to be at most, in the units of the table, on each of the plants.

    Attributes:
        over_none: it is what control adds to the metric.
    """

    manoeuvre: str
    metric: str
    values: tuple[float, float]
    deviation: Deviation = NOMINAL
    over_none: bool = False


STEPS = ("tipin15", "tipin50", "tipin0", "tipout")

GOALS = (
    Goal("tipin15", "settling_time", (75, 100)),
    Goal("tipin15", "overshoot", (11, 10)),
    Goal("tipin15", "jerk_rms_to_50_Hz", (4.8, 10.5)),
    Goal("tipin15", "impact_speed", (27, 25)),
    Goal("tipin15", "crossing_time", (14, 20)),
    Goal("tipin50", "settling_time", (70, 118)),
    Goal("tipin50", "overshoot", (6, 5)),
    Goal("tipin0", "settling_time", (80, 80)),
    Goal("tipin0", "overshoot", (10, 8)),
    Goal("tipout", "settling_time", (70, 114)),
    Goal("tipout", "overshoot", (6, 6)),
    Goal("tipout", "response_delay", (66, 86)),
    Goal("launch", "settling_time", (125, 124)),
    Goal("launch", "overshoot", (9, 4.5)),
    Goal("launch", "jerk_rms_to_50_Hz", (3.8, 4.6)),
    Goal("tipin15r", "gear_torque_rms", (1.2, 1.25)),
    Goal("tipin15r", "impact_speed", (9.5, 9.5)),
    Goal("drive", "gear_torque_rms", (1.95, 1.85)),
    Goal("drive", "impact_speed", (13, 12)),
    Goal("drive", "impact_speed_90", (14.5, 13.5)),
    Goal("drive", "plateau_swing", (0.16, 0.20)),
    Goal("creep", "gear_torque_rms", (1.2, 1.3)),
    Goal("prbs", "gear_torque_rms", (5.6, 5.5)),
    Goal("prbs", "jerk_rms_to_50_Hz", (7.4, 22.5)),
    *(Goal(name, "response_delay", (18, 27), over_none=True) for name in STEPS),
    Goal("launch", "response_delay", (31, 35), over_none=True),
    *(Goal(name, "withheld_time", (12, 14)) for name in STEPS),
    *(Goal(name, "stationary_torque_change", (0.02, 0.02)) for name in STEPS),
    Goal("tipin15", "overshoot", (22, 20), SLOW_MOTOR),
)

MONTE_CARLO = ("100 %; 0.21 / 0.25 s", "100 %; 0.21 / 0.19 s")
"""What `monte_carlo` is to say of each of the plants."""

UNITS = dict.fromkeys(("settling_time", "response_delay", "withheld_time", "crossing_time"), (1e3, "ms")) | {
    "overshoot": (1e2, "%"),
    "jerk_rms_to_50_Hz": (1.0, "m/s3"),
    "impact_speed": (1.0, "rad/s"),
    "impact_speed_90": (1.0, "rad/s"),
    "gear_torque_rms": (1.0, "N.m"),
    "plateau_swing": (1.0, "N.m"),
    "stationary_torque_change": (1.0, "N.m"),
}
"""Of the table: factor and name, by metrics."""


MET = 1.005
"""Share of a goal that rounds to it."""

Reached = Mapping[tuple[Goal, str], float]
"""The magnitude of what a goal is set for on a plant, in the unit of the table."""


class Run(NamedTuple):
    """One that is measured."""

    plant: str
    manoeuvre: str
    deviation: Deviation
    control: bool
    seed: int


def runs(goals: tuple[Goal, ...] = GOALS, seeds: tuple[int, ...] = HELD_OUT_SEEDS) -> list[Run]:
    """Those that tell how far the goals are reached, each once."""
    keys = [(plant, goal.manoeuvre, goal.deviation, True) for plant in PLANTS for goal in goals]
    keys += [(plant, goal.manoeuvre, goal.deviation, False) for plant in PLANTS for goal in goals if goal.over_none]
    return [Run(*key, seed) for key in dict.fromkeys(keys) for seed in seeds]


def request(run: Run, parameters: Mapping[str, Any], settings: Settings | None = None) -> RunRequest:
    """A run with these parameters of the controller, else with the settings."""
    manoeuvre = MANOEUVRES[run.manoeuvre]
    of_loop = deviating(parameters, run.plant, PLACES["controller"][0], run.deviation)
    return planned(manoeuvre, settings, plant=run.plant, control=run.control, parameters=of_loop, seed=run.seed)


def measured(run: Run, results: Results) -> Metrics:
    """The metrics of a run."""
    return evaluate(results, MANOEUVRES[run.manoeuvre])


def all_measured(
    parameters: Mapping[str, Any], goals: tuple[Goal, ...] = GOALS, settings: Settings | None = None
) -> dict[Run, Metrics]:
    """The metrics of all runs with these parameters of the controller, else with the settings, made on all cores."""
    todo = runs(goals)
    metrics = run_many(
        lambda run, results: measured(run, results[0]),
        todo,
        label="goals",
        runs=lambda run: [request(run, parameters, settings)],
    )
    return dict(zip(todo, metrics, strict=True))


def reached(goal: Goal, plant: str, metrics_of: Mapping[Run, Metrics]) -> float:
    """The magnitude of what a goal is set for, in the unit of the table: its mean over the seeds."""

    def mean(control: bool) -> float:
        its = (plant, goal.manoeuvre, goal.deviation, control)
        those = [metrics for run, metrics in metrics_of.items() if run[:4] == its]
        return float(np.mean([abs(getattr(metrics, goal.metric)) for metrics in those]))

    value = mean(True) - mean(False) if goal.over_none else mean(True)
    return UNITS[goal.metric][0] * value


def all_reached(metrics_of: Mapping[Run, Metrics], goals: tuple[Goal, ...] = GOALS) -> dict[tuple[Goal, str], float]:
    """Of the goals on all plants."""
    return {(goal, plant): reached(goal, plant, metrics_of) for goal in goals for plant in PLANTS}


def most(goal: Goal, plant: str) -> float:
    """What is to be reached."""
    return goal.values[PLANTS.index(plant)]


def missed(values: Reached) -> list[tuple[Goal, str]]:
    """The goals that are not reached."""
    return [key for key, value in values.items() if value > MET * most(*key)]


def monte_carlo(draws: int, parameters: Mapping[str, Any], settings: Settings | None = None) -> list[str]:
    """What is bounded and quiet, and 95 % of the settling times of tip-in and launch, of so many draws on each plant.

    Args:
        parameters: of the controller.
        settings: of the runs beside plant and parameters.
    """
    controller, usual = PLACES["controller"][0], settings or Settings()
    loops = {
        (plant, controller): as_given(usual, plant=plant, parameters=loop_parameters(parameters, plant))
        for plant in PLANTS
    }
    runner = CaseRunner(loops, seed=1)
    of_loops = summary.summaries(campaign(runner, range(1, draws + 1)))
    return [summary.goal(of_loops, plant, controller) for plant in PLANTS]


def title(goal: Goal) -> str:
    """The goal in words."""
    slow = f", tau x{goal.deviation.tau:g}" if goal.deviation.tau != 1.0 else ""
    over = " over none" if goal.over_none else ""
    return f"{goal.manoeuvre}{slow}: {goal.metric.replace('_', ' ')}{over}, {UNITS[goal.metric][1]}"


COLUMNS = tuple(Column(name) for plant in PLANTS for name in (plant, f"{plant}: at most"))


def reached_table(values: Reached) -> Table:
    """What is reached, beside what is to be."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for goal in dict.fromkeys(goal for goal, _ in values):
        pairs = ((values[goal, plant], float(most(goal, plant))) for plant in PLANTS)
        rows[title(goal)] = tuple(number for pair in pairs for number in pair)
    return Table("goal", COLUMNS, rows, f"{len(missed(values))} of {len(values)} are not reached.")


CHARACTERS = {"sport": 0.0, "as designed": 0.5, "comfort": 1.0}
"""Choices of `driveline design --character`."""


def of_character(character: float) -> dict[str, float]:
    """The stored gains that are others with a character, by name."""
    return {name: factor * GAINS[name] for name, factor in factors(character).items() if factor != 1.0}


def trade_table(of_characters: Mapping[str, Reached]) -> Table:
    """What each character reaches of the goals that are missed as designed, and how many goals each misses."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for key in missed(of_characters["as designed"]):
        cells = (values[key] for values in of_characters.values())
        rows[f"{title(key[0])}, {key[1]}"] = (*cells, float(most(*key)))
    rows["goals missed"] = (*(len(missed(values)) for values in of_characters.values()), 0)
    return Table("goal", tuple(map(Column, (*of_characters, "at most"))), rows)


def measure() -> Measured:
    all_of = {name: all_reached(all_measured(of_character(value))) for name, value in CHARACTERS.items()}
    values, late = all_of["as designed"], all_reached(all_measured({}, settings=LATE))
    count = {"goals": len(values), "missed": len(missed(values)), "missed late": len(missed(late))}
    return Measured(
        {
            "reached": reached_table(values),
            "late": reached_table(late),
            "trade": trade_table(all_of),
            "count": Table("", (Column("count", decimals=0),), {name: (n,) for name, n in count.items()}),
        }
    )


LATE = Settings(scheme=Scheme.JACOBI)
"""Each signal reaches the block that it feeds one step late, as in hosts that step all FMUs side by side."""

SENTINELS = tuple(goal for goal in GOALS if goal.manoeuvre == "tipin15" and goal.deviation == NOMINAL)


def again() -> dict[str, Table]:
    return {"reached": reached_table(all_reached(all_measured({}, SENTINELS), SENTINELS))}


def explore(arguments: Sequence[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m docs.studies goals", description=__doc__)
    parser.add_argument("--parameters", type=Path, help="of the controller")
    parser.add_argument("--draws", type=int, default=0, help="of the Monte-Carlo (default: none)")
    args = parser.parse_args(arguments)
    parameters = read_parameters(args.parameters) if args.parameters else {}
    show("reached", reached_table(all_reached(all_measured(parameters))))
    if args.draws > 0:
        pairs = zip(PLANTS, monte_carlo(args.draws, parameters), MONTE_CARLO, strict=True)
        rows = {plant: (shares, goal) for plant, shares, goal in pairs}
        what = f"{args.draws} draws: bounded and quiet; 95 % of settling of tip-in / launch"
        show("Monte-Carlo", Table("plant", (Column(what), Column("goal")), rows))


STUDY = Study(
    "what the controller is to reach on both plants, and what it reaches",
    measure,
    again,
    {"reached": [title(goal) for goal in SENTINELS]},
    HELD_OUT_SEEDS,
    explore,
    seconds=60,
)
