"""What a change of one parameter alone does to the goals: which it reaches, and which are missed for it."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from driveline.harness.design.search.search_space import space
from driveline.harness.design.search.tuning_runs import HELD_OUT_SEEDS
from driveline.harness.loop.places import PLACES, PLANTS
from driveline.harness.metrics.run_metrics import Metrics
from fmuloop.campaign import RunRequest
from fmuloop.many_runs import run_many
from fmuloop.results import Results

from .goals import (
    GOALS,
    Goal,
    Reached,
    Run,
    all_measured,
    all_reached,
    measured,
    missed,
    most,
    request,
    runs,
    title,
)
from .study import Cell, Column, Measured, Study, Table

FACTORS = (0.67, 0.8, 0.9, 1.1, 1.25, 1.5)
"""By which a parameter is multiplied."""


class Change(NamedTuple):
    """Of a parameter of the controller, to a value."""

    parameter: str
    value: float

    def __str__(self) -> str:
        return f"{self.parameter} = {self.value:g}"


class Closest(NamedTuple):
    """How a goal that is missed is reached, or comes closest to it.

    Attributes:
        value: what is reached then.
        instead: goals that are missed then and were not before.
    """

    change: Change
    value: float
    instead: list[tuple[Goal, str]]


def changes() -> list[Change]:
    """Of each parameter that a search for gains may change."""
    searched = space(PLACES["controller"][0], {}).searched
    return [Change(p.name, float(f"{p.start * factor:.4g}")) for p in searched for factor in FACTORS]


def all_changed(
    metrics_of: Mapping[Run, Metrics], todo: Sequence[Change], goals: tuple[Goal, ...] = GOALS
) -> dict[Change, Reached]:
    """What changes reach, on all cores.

    Args:
        found: the runs without a change, of which those without control are taken.
    """
    without = {run: metrics for run, metrics in metrics_of.items() if not run.control}

    damped = [run for run in runs(goals) if run.control]

    def needed(change: Change) -> list[RunRequest]:
        return [request(run, {change.parameter: change.value}) for run in damped]

    def changed(_: Change, results: Sequence[Results]) -> Reached:
        return all_reached({**without, **dict(zip(damped, map(measured, damped, results), strict=True))}, goals)

    return dict(zip(todo, run_many(changed, todo, label="changes", runs=needed), strict=True))


def closest(key: tuple[Goal, str], values: Reached, changed: Mapping[Change, Reached]) -> Closest:
    """Of the changes that reach a goal the one for which the fewest others are missed; where none does, the one that
    comes closest.

    Args:
        key: of a goal that is missed.
        values: what is reached without a change.
    """
    before = set(missed(values))

    def instead(change: Change) -> list[tuple[Goal, str]]:
        return [other for other in missed(changed[change]) if other not in before]

    enough = [change for change in changed if key not in missed(changed[change])]
    if enough:
        change = min(enough, key=lambda candidate: (len(instead(candidate)), changed[candidate][key]))
    else:
        change = min(changed, key=lambda candidate: changed[candidate][key])
    return Closest(change, changed[change][key], instead(change))


def harmless(values: Reached, changed: Mapping[Change, Reached]) -> int:
    """How many of the goals that are missed one change reaches at the most without missing another one."""
    before = set(missed(values))
    after = (set(missed(goals)) for goals in changed.values())
    return max((len(before - goals) for goals in after if goals <= before), default=0)


NAMED = 3
"""Goals that are missed instead and are named; more are counted."""

STEP = tuple(goal for goal in GOALS if title(goal) in ("tipin15: settling time, ms", "tipin15: overshoot, %"))
"""Of the table that shows what each change does."""


def step_table(changed: Mapping[Change, Reached]) -> Table:
    """What each change does to a tip-in."""
    columns = tuple(Column(f"{plant}: {title(goal)}") for plant in PLANTS for goal in STEP)
    rows = {
        str(change): tuple(values[goal, plant] for plant in PLANTS for goal in STEP)
        for change, values in changed.items()
    }
    return Table("change", columns, rows)


def instead_table(values: Reached, changed: Mapping[Change, Reached]) -> Table:
    """For each goal that is missed the change that reaches it, or comes closest to it."""
    columns = (Column("change"), Column("missed instead"), Column("is"), Column("with it"), Column("at most"))
    rows: dict[str, tuple[Cell, ...]] = {}
    for key in missed(values):
        change, value, others = closest(key, values, changed)
        named = [f"{title(goal)} ({plant}): {changed[change][goal, plant]:.3g}" for goal, plant in others]
        told = f"{len(named)} goals" if len(named) > NAMED else "; ".join(named)
        row = (str(change), told, values[key], value, float(most(*key)))
        rows[f"{title(key[0])}, {key[1]}"] = row
    return Table("goal", columns, rows)


def measure() -> Measured:
    metrics_of = all_measured({})
    values, changed = all_reached(metrics_of), all_changed(metrics_of, changes())
    count = {"reached by one change without missing another": (harmless(values, changed),)}
    return Measured(
        {
            "instead": instead_table(values, changed),
            "tipin15": step_table(changed),
            "count": Table("", (Column("count", decimals=0),), count),
        }
    )


def again() -> dict[str, Table]:
    return {"tipin15": step_table(all_changed({}, SENTINELS, STEP))}


SENTINELS = changes()[2:4]

STUDY = Study(
    "what a change of one parameter alone does to the goals",
    measure,
    again,
    {"tipin15": list(map(str, SENTINELS))},
    HELD_OUT_SEEDS,
    seconds=300,
)
