"""A campaign: the same draws with every controller, on all cores or on a cluster, resumed where it was stopped."""

from collections.abc import Callable, Iterable, MutableMapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from hashlib import sha256
from math import nan
from typing import Any

from fmuloop.many_runs import run_many

from ...design.uncertainty_box import BOX, DOUBLINGS, LOSS
from ...simulation.case_archive import Table
from .case_runs import CaseRunner
from .outcome import METRICS, ROBUSTNESS_MANOEUVRES, Case, Outcome


def cases(loops: Iterable[tuple[str, str]], numbers: Sequence[int]) -> list[Case]:
    """All draws and manoeuvres with each of the loops, which are named by plant and controller."""
    return [
        Case(plant, controller, number, manoeuvre)
        for plant, controller in loops
        for number in numbers
        for manoeuvre in ROBUSTNESS_MANOEUVRES
    ]


def campaign(
    runner: CaseRunner,
    numbers: Sequence[int],
    known: MutableMapping[Case, Outcome] | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
) -> list[Outcome]:
    """What came of all cases, in their order.

    Args:
        numbers: of the draws.
        known, workers, executor: see `harness.simulation.many_runs.run_many`.
    """
    todo = cases(runner.loops, numbers)
    found = run_many(runner.outcome, todo, workers, "robustness", executor, known, runs=runner.planned)
    return [replace(each, share=runner.share(each.case)) for each in found]


def order(runner: CaseRunner) -> Callable[[Case], tuple[int, int, int]]:
    """Where a case stands among all those of its loops."""
    loops = list(runner.loops)
    return lambda case: (
        loops.index((case.plant, case.controller)),
        case.number,
        ROBUSTNESS_MANOEUVRES.index(case.manoeuvre),
    )


def distinguishing(runner: CaseRunner) -> dict[str, Any]:
    """All that the runs depend on, beside what was set."""
    drawn = repr((dict(BOX), DOUBLINGS, LOSS, ROBUSTNESS_MANOEUVRES))
    files = {path.stem: digest for loop in runner.loops.values() for path, digest in loop.digests.items()}
    return {"draws": f"sha256:{sha256(drawn.encode()).hexdigest()}", "fmus": files, "seed": runner.seed}


def _cells(case: Case, outcome: Outcome) -> list[object]:
    values = (outcome.measured[metric.name] for metric in METRICS)
    return [*case, *("" if value != value else repr(value) for value in values), outcome.reason]


def _parsed(cells: Sequence[str]) -> tuple[Case, Outcome]:
    plant, controller, number, manoeuvre, *values, reason = cells
    case = Case(plant, controller, int(number), manoeuvre)
    measured = {m.name: float(value) if value else nan for m, value in zip(METRICS, values, strict=True)}
    return case, Outcome(case, measured, reason)


RUNS = Table([*Case._fields, *(metric.key for metric in METRICS), "reason"], _cells, _parsed)
