"""docs/roads.md, every controller on roads without grip, under ABS, and behind frames that are late or wrong."""

from collections.abc import Mapping, Sequence
from functools import partial
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from docs.studies.grip_and_frames import INJECTORS, MOST, OURS, PLANT, STUDIES, Ratios, Run, ratios
from driveline.harness.loop.built_fmus import built, made_if_missing
from driveline.harness.loop.places import BUILD, COMPARATORS, NATIVE
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.views.markdown import markdown_table

CONTROLLERS = (OURS, *(name for name in COMPARATORS if name != "NoDamping"))

MOST_LATE = 1.2
"""Ratio of the rms that a frame which is late or wrong should not exceed."""

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
        groups=_groups(
            [each for name in (grip, by_abs) for each in zip(runs[name], found[Key(name, OURS)], strict=True)]
        ),
        frames=_frames(runs[frames], {name: found[Key(frames, name)] for name in CONTROLLERS}),
    )


def _numbers(of: Sequence[Ratios]) -> list[str]:
    """Worst and mean of the peak and of the rms, runs beyond MOST, the longest fallback."""
    peak, rms, fallback = (np.array(column) for column in zip(*of, strict=True))
    over = int(np.count_nonzero(np.maximum(peak, rms) > MOST))
    return [*(f"{y:.2f}" for y in (peak.max(), peak.mean(), rms.max(), rms.mean())), f"{over}", f"{fallback.max():.2f}"]


HEADS = ("peak, worst", "mean", "rms, worst", "mean", f"over {MOST}", "fallback, s")


def _controllers(studies: Sequence[str], found: Found) -> str:
    rows = [[study, f"`{name}`", *_numbers(found[Key(study, name)])] for study, name in product(studies, CONTROLLERS)]
    return markdown_table(["runs", "controller", *HEADS], rows, labels=2)


def _groups(runs: Sequence[tuple[Run, Ratios]]) -> str:
    rows = []
    for group in dict.fromkeys(each.group for each, _ in runs):
        of = [y for each, y in runs if each.group == group]
        rows.append([group, f"{len(of)}", *_numbers(of)])
    return markdown_table(["runs", "count", *HEADS], rows, labels=1)


def _frames(runs: Sequence[Run], found: Mapping[str, Sequence[Ratios]]) -> str:
    rows = []
    for group in dict.fromkeys(each.group for each in runs):
        cells = []
        for of in found.values():
            rms = np.array([y.rms for each, y in zip(runs, of, strict=True) if each.group == group])
            cells.append(f"{rms.max():.2f} / {rms.mean():.2f} / {int(np.count_nonzero(rms > MOST_LATE))}")
        rows.append([group, *cells])
    return markdown_table(["frame", *(f"`{name}`" for name in found)], rows, labels=1)


def make(folder: Path) -> None:
    injectors = {key: made_if_missing(fmu, BUILD, NATIVE).absolute() for key, fmu in INJECTORS.items()}
    runs = {study: list(made()) for study, made in STUDIES.items()}
    found = {}
    for study, controller in product(STUDIES, CONTROLLERS):
        settings = built(PLANT, controller=controller, folder=BUILD, build=NATIVE)
        measure = partial(ratios, settings=settings, injectors=injectors)
        found[Key(study, controller)] = run_many(measure, runs[study], None, f"{controller}, {study}")
    (folder / "roads.md").write_text(page(runs, found), encoding="utf-8")
