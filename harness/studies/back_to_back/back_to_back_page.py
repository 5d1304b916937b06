"""The documentation page that `driveline back-to-back` writes."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from ...views.markdown import markdown_table
from .back_to_back import STEP_SIZE, Differences

PAGE = """\
# Back to back

The same inputs go through the Python functions of a block, through its FMU built with PythonFMU and
through its native FMU. What is compared are all outputs at all communication points, {step:g} ms apart: a
difference is the largest distance from the native FMU in a signal, over the largest value of that signal, and
of all signals the largest. 0 means equal to the last bit.

## Random inputs

New independent values of all inputs at every one of {random_steps} communication points.

{random}

## Manoeuvres

The loop with damping, with native FMUs and under Jacobi. Of each block three differences: of the functions
and of the FMU built with PythonFMU, both fed with what the native FMU got in the loop, and of the
whole loop when that FMU takes the native one's place.

{loops}

Made by `driveline back-to-back`; do not edit.
"""


class LoopRow(NamedTuple):
    """One manoeuvre with one plant; differences by instance."""

    plant: str
    manoeuvre: str
    blocks: Mapping[str, Differences]


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
