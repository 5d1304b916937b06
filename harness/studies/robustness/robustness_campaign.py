"""A campaign: the same draws with every controller, on all cores or on a cluster, resumed where it was stopped."""

from collections.abc import Iterable, Mapping, Sequence
from hashlib import sha256
from typing import Any

from ...base.progress import progress
from ...design.uncertainty_box import BOX, DOUBLINGS, LOSS
from ...simulation.many_runs import many
from .campaign_archive import Archive
from .case_runs import CaseRunner
from .outcome import MANOEUVRES, Case, Outcome


def cases(loops: Iterable[tuple[str, str]], numbers: Sequence[int]) -> list[Case]:
    """All draws and manoeuvres with each of the loops, which are named by plant and controller."""
    return [
        Case(plant, controller, number, manoeuvre)
        for plant, controller in loops
        for number in numbers
        for manoeuvre in MANOEUVRES
    ]


def campaign(
    runner: CaseRunner,
    numbers: Sequence[int],
    archive: Archive | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
) -> list[Outcome]:
    """What came of all cases, in their order; those that the archive has already are not run again.

    Args:
        numbers: of the draws.
        archive: gets every run as soon as it has been made.
        workers, scheduler: see `harness.simulation.many_runs.many`.
    """
    every = cases(runner.loops, numbers)
    known: Mapping[Case, Outcome] = {} if archive is None else archive
    found = {case: known[case] for case in every if case in known}
    todo = [case for case in every if case not in found]
    if todo:
        with many(runner.outcome, workers, scheduler) as outcomes, progress(len(every), "robustness") as done:
            for outcome in outcomes(todo):
                found[outcome.case] = outcome
                if archive is not None:
                    archive.add(outcome)
                done(len(found))
    return [found[case] for case in every]


def distinguishing(runner: CaseRunner) -> dict[str, Any]:
    """All that the runs depend on, beside what was set."""
    drawn = repr((dict(BOX), DOUBLINGS, LOSS, MANOEUVRES))
    files = {path.stem: digest for loop in runner.loops.values() for path, digest in loop.digests.items()}
    return {"draws": f"sha256:{sha256(drawn.encode()).hexdigest()}", "fmus": files, "seed": runner.seed}
