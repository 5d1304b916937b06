"""What a change of one parameter alone does to the goals: which it reaches, and which are missed for it."""

from collections.abc import Mapping
from typing import NamedTuple

from docs.studies.goals import Goal, Reached, Run, all_reached, measured, missed, runs
from driveline.harness.design.search.search_space import space
from driveline.harness.loop.places import PLACES
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.many_runs import run_many

FACTORS = (0.67, 0.8, 0.9, 1.1, 1.25, 1.5)
"""By which a parameter is multiplied."""


class Change(NamedTuple):
    """Of a parameter of the controller, to a value."""

    parameter: str
    value: float


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
    return [Change(each.name, float(f"{each.start * factor:.4g}")) for each in searched for factor in FACTORS]


def all_changed(found: Mapping[Run, Metrics]) -> dict[Change, Reached]:
    """What every change reaches, on all cores.

    Args:
        found: the runs without a change, of which those without control are taken.
    """
    without = {run: metrics for run, metrics in found.items() if not run.control}

    def changed(change: Change) -> Reached:
        made = {run: measured(run, {change.parameter: change.value}) for run in runs() if run.control}
        return all_reached({**without, **made})

    todo = changes()
    return dict(zip(todo, run_many(changed, todo), strict=True))


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
        change = min(enough, key=lambda each: (len(instead(each)), changed[each][key]))
    else:
        change = min(changed, key=lambda each: changed[each][key])
    return Closest(change, changed[change][key], instead(change))


def harmless(values: Reached, changed: Mapping[Change, Reached]) -> int:
    """How many of the goals that are missed one change reaches at the most without missing another one."""
    before = set(missed(values))
    after = (set(missed(each)) for each in changed.values())
    return max((len(before - each) for each in after if each <= before), default=0)
