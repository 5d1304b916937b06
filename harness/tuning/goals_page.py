"""Writes docs/goals.md, what the controller is to reach and what it reaches: `python -m harness.tuning.goals_page`."""

from collections.abc import Mapping
from pathlib import Path

from ..control_loop import PLANTS
from ..metrics.record import Metrics
from ..reports.files import write_text
from ..reports.markdown import markdown_table
from ..stopping import script
from .goals import GOALS, Goal, Run, all_measured, reached, title
from .runs import HELD_OUT_SEEDS

MET = 1.005
"""Share of a goal that rounds to it."""

PAGE = """\
# Goals

Made by `python -m harness.tuning.goals_page`; do not edit.

What the controller is to reach on both plants, and what it reaches with its default parameters: means over the noise
of seeds {seeds}, which no search has seen. In bold what is not reached: {missed} of {all}.
[comparison.md](comparison.md) has the other controllers, [bound.md](bound.md) what none can beat, and
[robustness.md](robustness.md) the cars that are drawn.

{table}
"""


def page(found: Mapping[Run, Metrics]) -> str:
    """The page as Markdown."""
    rows = [[title(goal), *_cells(goal, found)] for goal in GOALS]
    missed = sum(cell.startswith("**") for row in rows for cell in row)
    headings = ["goal", *(text for plant in PLANTS for text in (f"{plant}: is", "at most"))]
    return PAGE.format(
        seeds=", ".join(map(str, HELD_OUT_SEEDS)),
        missed=missed,
        all=len(GOALS) * len(PLANTS),
        table=markdown_table(headings, rows, labels=1),
    )


def _cells(goal: Goal, found: Mapping[Run, Metrics]) -> list[str]:
    cells = []
    for plant, most in zip(PLANTS, goal.values, strict=True):
        value = reached(goal, plant, found)
        shown = f"{value:.3g}"
        cells += [shown if value <= MET * most else f"**{shown}**", f"{most:g}"]
    return cells


def main() -> None:
    path = Path(__file__).parents[2] / "docs" / "goals.md"
    write_text(page(all_measured({})), path)
    print(path)


if __name__ == "__main__":
    script(main)
