"""Odd input by the thousand: how much of it was tried, by its kind, and how much was not answered as promised?

What is tried and what is promised stands with each target of `tests.fuzz`; `make fuzz` tries hundreds of times as much.
"""

from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor

from tests.fuzz import TARGETS
from tests.fuzz.target import FAULT

from .study import Cell, Column, Measured, Study, Table

SEED = 43
"""Another one than that of the tests."""

TIMES, MORE = 3, {"caches": 30, "campaigns": 30, "parameter_files": 30, "calls": 30, "states": 10, "swollen": 10}
"""As many tries as the tests make of each kind, and of those that take few minutes then."""

SENTINEL, FEW = "campaigns", 5


def tries_table(tries: Mapping[str, int]) -> Table:
    """A row for each target, by how many tries."""
    rows: dict[str, tuple[Cell, ...]] = {}
    with ProcessPoolExecutor() as pool:
        every = pool.map(faults, tries, tries.values())
        for (name, count), odd in zip(tries.items(), every, strict=True):
            rows[TARGETS[name].what] = (TARGETS[name].promise, float(count), float(odd))
    columns = (Column("what is promised"), Column("tries", decimals=0), Column("not as promised", decimals=0))
    return Table("input", columns, rows)


def faults(name: str, tries: int) -> int:
    """Of so many tries of a target."""
    return TARGETS[name].counts(SEED, tries)[FAULT]


def tries_of(name: str) -> int:
    return MORE.get(name, TIMES) * TARGETS[name].short


def again() -> Mapping[str, Table]:
    """That of a quick target, with the number of its tries as it is kept."""
    table = tries_table({SENTINEL: FEW})
    row = TARGETS[SENTINEL].what
    promise, _, answers = table.rows[row]
    return {"tries": table._replace(rows={row: (promise, float(tries_of(SENTINEL)), answers)})}


STUDY = Study(
    "odd input and what becomes of it",
    lambda: Measured({"tries": tries_table({name: tries_of(name) for name in TARGETS})}),
    again,
    {"tries": [TARGETS[SENTINEL].what]},
    seeds=(SEED,),
    seconds=300,
)
