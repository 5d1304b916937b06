"""Odd input by the thousand: how much of it was tried, by its kind, and how much was not answered as promised?

What is tried and what is promised stands with each target of `tests.fuzz`; `make fuzz` tries hundreds of times as much.
"""

from collections.abc import Mapping

from tests.fuzz import TARGETS
from tests.fuzz.target import FAULT

from .study import Cell, Column, Measured, Study, Table

SEED = 43
"""Another one than that of the tests."""

TIMES = 3
"""As many tries as the tests make of each kind."""

SENTINEL, FEW = "campaigns", 5


def tries_table(tries: Mapping[str, int]) -> Table:
    """A row for each target, by how many tries."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for name, count in tries.items():
        target = TARGETS[name]
        answers = target.counts(SEED, count)
        rows[target.what] = (target.promise, float(count), float(answers[FAULT]))
    columns = (Column("what is promised"), Column("tries", decimals=0), Column("not as promised", decimals=0))
    return Table("input", columns, rows)


def again() -> Mapping[str, Table]:
    """That of a quick target, with the number of its tries as it is kept."""
    found = tries_table({SENTINEL: FEW})
    row = TARGETS[SENTINEL].what
    promise, _, faults = found.rows[row]
    return {"tries": found._replace(rows={row: (promise, float(TIMES * TARGETS[SENTINEL].short), faults)})}


STUDY = Study(
    "odd input and what becomes of it",
    lambda: Measured({"tries": tries_table({name: TIMES * each.short for name, each in TARGETS.items()})}),
    again,
    {"tries": [TARGETS[SENTINEL].what]},
    seeds=(SEED,),
    seconds=150,
)
