"""The goals beside what is reached: what misses its goal is bold and counted."""

from harness.control_loop import PLANTS
from harness.metrics.declaration import declared
from harness.metrics.record import Metrics
from harness.tuning.goals import GOALS, UNITS, Goal, runs, title
from harness.tuning.goals_page import MET, page

TWICE = Goal("tipout", "response_delay", (66, 86))
"""Of this metric another goal is set over none, which asks for less time."""


def reaching(share: float) -> str:
    """The page of a controller that reaches this share of every goal, but for what is counted over none."""
    found = {}
    for run in runs():
        values = {metric.name: 0.0 for metric in declared(Metrics)}
        for goal in GOALS:
            if run[1:3] == (goal.manoeuvre, goal.deviation) and run.control:
                values[goal.metric] = share * goal.values[PLANTS.index(run.plant)] / UNITS[goal.metric][0]
        found[run] = Metrics(**values)  # type: ignore[arg-type]
    return page(found)


def test_a_goal_is_missed_by_what_does_not_round_to_it() -> None:
    number, met = len(GOALS) * len(PLANTS), len(PLANTS)
    assert TWICE in GOALS
    assert f"not reached: 0 of {number}." in reaching(0.999 * MET)
    assert f"not reached: {number - met} of {number}." in reaching(1.001 * MET)


def test_every_goal_has_its_row() -> None:
    text = reaching(2.0)
    assert all((f"| {title(goal)} | **" in text) == (goal != TWICE) for goal in GOALS)
    assert "| tipin15: settling time, ms | **150** | 75 | **200** | 100 |" in text
