"""The documentation page that `python -m docs.studies back-to-back` writes."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from ...views.markdown import markdown_table
from .back_to_back import STEP_SIZE, Differences, LoopRow

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")


def page(random: Mapping[str, Differences], random_steps: int, loops: Sequence[LoopRow]) -> str:
    """The page as Markdown; `random` by block."""
    blocks = [(name, _number(d.functions), _number(d.python)) for name, d in random.items()]
    rows = [(row.plant, row.manoeuvre, *map(_numbers, row.blocks.values())) for row in loops]
    return PAGE.format(
        step=1e3 * STEP_SIZE,
        random_steps=random_steps,
        random=markdown_table(("block", "functions", "PythonFMU"), blocks, labels=1),
        loops=markdown_table(("plant", "manoeuvre", *loops[0].blocks), rows, labels=2),
    )


def _numbers(differences: Differences) -> str:
    return " / ".join(map(_number, differences))


def _number(difference: float) -> str:
    return f"{difference:.0e}" if difference else "0"
