"""docs/goals.md, what the controller is to reach and what it reaches."""

from collections.abc import Mapping
from pathlib import Path

from docs.studies.goals import GOALS, Goal, Reached, all_measured, all_reached, missed, most, title
from docs.studies.one_at_a_time import FACTORS, Change, all_changed, closest, harmless
from driveline.harness.design.search.tuning_runs import HELD_OUT_SEEDS
from driveline.harness.loop.places import PLANTS
from driveline.harness.views.markdown import markdown_table

NAMED = 3
"""Goals that are missed instead and are named; more are counted."""

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")


def page(values: Reached, changed: Mapping[Change, Reached]) -> str:
    """The page as Markdown.

    Args:
        values: what is reached.
        changed: the same with one parameter changed.
    """
    bold = missed(values)
    headings = ["goal", *(text for plant in PLANTS for text in (f"{plant}: is", "at most"))]
    return PAGE.format(
        seeds=", ".join(map(str, HELD_OUT_SEEDS)),
        missed=len(bold),
        all=len(values),
        table=markdown_table(headings, [[title(goal), *_cells(goal, values)] for goal in GOALS], labels=1),
        factors=", ".join(f"{factor:g}" for factor in FACTORS),
        harmless=harmless(values, changed),
        changes=markdown_table(
            ["goal", "plant", "change", "missed instead", "is", "with it", "at most"],
            [_closest(key, values, changed) for key in bold],
            labels=4,
        ),
    )


def _cells(goal: Goal, values: Reached) -> list[str]:
    cells = []
    for plant in PLANTS:
        shown = f"{values[goal, plant]:.3g}"
        cells += [f"**{shown}**" if (goal, plant) in missed(values) else shown, f"{most(goal, plant):g}"]
    return cells


def _closest(key: tuple[Goal, str], values: Reached, changed: Mapping[Change, Reached]) -> list[str]:
    goal, plant = key
    change, value, others = closest(key, values, changed)
    shown = f"{value:.3g}"
    return [
        title(goal),
        plant,
        f"`{change.parameter}` = {change.value:g}",
        _instead(others, changed[change]),
        f"{values[key]:.3g}",
        f"**{shown}**" if key in missed(changed[change]) else shown,
        f"{most(*key):g}",
    ]


def _instead(others: list[tuple[Goal, str]], changed: Reached) -> str:
    if not others:
        return "-"
    if len(others) > NAMED:
        return f"{len(others)} goals"
    return "; ".join(
        f"{title(goal)} ({plant}): {changed[goal, plant]:.3g} for {most(goal, plant):g}" for goal, plant in others
    )


def make(folder: Path) -> None:
    found = all_measured({})
    (folder / "goals.md").write_text(page(all_reached(found), all_changed(found)), encoding="utf-8")
