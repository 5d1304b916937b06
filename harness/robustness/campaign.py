"""A campaign: the same draws with every controller, on all cores or on a cluster, resumed where it was stopped."""

from collections.abc import Iterable, Mapping, Sequence
from hashlib import sha256
from typing import Any

from ..analysis.box import BOX, DOUBLINGS, LOSS
from ..many import many
from ..progress import progress
from .archive import Archive
from .bench import Bench
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
    bench: Bench,
    numbers: Sequence[int],
    archive: Archive | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
) -> list[Outcome]:
    """What came of all cases, in their order; those that the archive has already are not run again.

    Args:
        numbers: of the draws.
        archive: gets every run as soon as it has been made.
        workers, scheduler: see `harness.many.many`.
    """
    every = cases(bench.loops, numbers)
    known: Mapping[Case, Outcome] = {} if archive is None else archive
    found = {case: known[case] for case in every if case in known}
    todo = [case for case in every if case not in found]
    if todo:
        with many(bench.outcome, workers, scheduler) as outcomes, progress(len(every), "robustness") as done:
            for outcome in outcomes(todo):
                found[outcome.case] = outcome
                if archive is not None:
                    archive.add(outcome)
                done(len(found))
    return [found[case] for case in every]


def distinguishing(bench: Bench) -> dict[str, Any]:
    """All that the runs depend on, beside what was set."""
    drawn = repr((dict(BOX), DOUBLINGS, LOSS, MANOEUVRES))
    files = {path.stem: digest for loop in bench.loops.values() for path, digest in loop.digests.items()}
    return {"draws": f"sha256:{sha256(drawn.encode()).hexdigest()}", "fmus": files, "seed": bench.seed}
