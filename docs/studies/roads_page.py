"""docs/roads.md, every controller on roads without grip, under ABS, and behind frames that are late or wrong."""

from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from docs.studies.grip_and_frames import (
    MOST,
    MOST_LATE,
    NUMBERS,
    OURS,
    STUDIES,
    Ratios,
    Run,
    by_group,
    late,
    measured,
    numbers,
)
from driveline.harness.loop.places import COMPARATORS
from driveline.harness.views.markdown import markdown_table

CONTROLLERS = (OURS, *(name for name in COMPARATORS if name != "NoDamping"))

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")


class Key(NamedTuple):
    """Runs of a study with a controller."""

    study: str
    controller: str


Found = Mapping[Key, Sequence[Ratios]]
"""For each run of the study, in their order."""


def page(runs: Mapping[str, Sequence[Run]], found: Found) -> str:
    """The page as Markdown."""
    grip, by_abs, frames = STUDIES
    return PAGE.format(
        count=len(runs[grip]),
        abs_count=len(runs[by_abs]),
        most=MOST,
        most_late=MOST_LATE,
        controllers=_controllers((grip, by_abs), found),
        groups=_groups([*runs[grip], *runs[by_abs]], [*found[Key(grip, OURS)], *found[Key(by_abs, OURS)]]),
        frames=_frames(runs[frames], {name: found[Key(frames, name)] for name in CONTROLLERS}),
    )


def _controllers(studies: Sequence[str], found: Found) -> str:
    rows = [[study, f"`{name}`", *numbers(found[Key(study, name)])] for study, name in product(studies, CONTROLLERS)]
    return markdown_table(["runs", "controller", *NUMBERS], rows, labels=2)


def _groups(runs: Sequence[Run], found: Sequence[Ratios]) -> str:
    rows = [[group, f"{len(of)}", *numbers([y for _, y in of])] for group, of in by_group(runs, found).items()]
    return markdown_table(["runs", "count", *NUMBERS], rows, labels=1)


def _frames(runs: Sequence[Run], found: Mapping[str, Sequence[Ratios]]) -> str:
    tables = [by_group(runs, of) for of in found.values()]
    rows = [[group, *(_rms([y.rms for _, y in table[group]]) for table in tables)] for group in tables[0]]
    return markdown_table(["frame", *(f"`{name}`" for name in found)], rows, labels=1)


def _rms(of: Sequence[float]) -> str:
    """The worst, the mean, and how many are beyond MOST_LATE."""
    return f"{max(of):.2f} / {np.mean(of):.2f} / {late(np.array(of))}"


def make(folder: Path) -> None:
    runs = {study: list(made()) for study, made in STUDIES.items()}
    found = {
        Key(study, controller): measured(runs[study], controller, f"{controller}, {study}")
        for study, controller in product(STUDIES, CONTROLLERS)
    }
    (folder / "roads.md").write_text(page(runs, found), encoding="utf-8")
