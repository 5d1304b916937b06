"""A campaign: many cases on all cores, each with its verdict."""

from collections.abc import Iterable, Mapping, MutableMapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from hashlib import sha256
from math import inf, isfinite
from pathlib import Path
from typing import Any

import numpy as np

from fmuloop.errors import RunEnded
from fmuloop.many_runs import run_many
from toolground.collected_warnings import warn_once

from ...simulation.case_archive import Table
from .evidence import Evidence
from .fault_cases import PLANS, Case, Plan, case
from .fault_catalogue import NOTHING
from .fault_injection import FaultRunner, Runs
from .judges import JUDGES


@dataclass(frozen=True)
class Outcome:
    """A case that was run, and what each judge measured."""

    case: Case
    measured: Mapping[str, float]

    @property
    def failed(self) -> tuple[str, ...]:
        """The judges that found more than their limit, but for those that the campaign excuses."""
        counting = (judge for judge in JUDGES if judge.name not in self.case.plan.excused)
        return tuple(judge.name for judge in counting if not self.measured[judge.name] <= judge.limit)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The names of what goes wrong."""
        return tuple(fault.name for fault in self.case.faults)

    @property
    def plant(self) -> str:
        return Path(self.case.plant).stem

    @property
    def record(self) -> dict[str, Any]:
        """The case for files: what it was, and what was measured."""
        given: dict[str, Any] = {
            "number": self.case.number,
            "plant": self.plant,
            "situation": self.case.situation,
            "noise": self.case.noise,
        }
        for k in range(2):
            fault = self.case.faults[k] if k < len(self.case.faults) else None
            for name in ("name", "begin", "end", "size", "share"):
                given[f"fault_{k + 1}" if name == "name" else f"{name}_{k + 1}"] = getattr(fault, name, None)
        measured = {name.replace(" ", "_"): value if isfinite(value) else None for name, value in self.measured.items()}
        return given | measured | {"clean": not self.failed}


def count(outcomes: Iterable[Outcome], kind: str, judge: str | None = None) -> tuple[int, int]:
    """How many of the cases with a kind of fault are not clean, in the eyes of one judge or of any; and how many there
    are."""
    cases = [outcome for outcome in outcomes if kind in outcome.kinds]
    return sum(judge in each.failed if judge else bool(each.failed) for each in cases), len(cases)


def plan_of(outcomes: Sequence[Outcome]) -> Plan:
    """What these cases of one campaign were drawn from."""
    return outcomes[0].case.plan if outcomes else PLANS["dry"]


MOST_NAMED = 9
"""Kinds of faults without a case that a message names."""


def coverage(outcomes: Sequence[Outcome]) -> str:
    """Which kinds of the campaign are no single fault of a case, in words, or how many; "" where all are."""
    kinds = [kind for kind in plan_of(outcomes).kinds if kind != NOTHING.name]
    alone = {outcome.kinds for outcome in outcomes}
    missing = [kind for kind in kinds if (kind,) not in alone]
    if not missing:
        return ""
    lacking = f"; without {', '.join(missing)}" if len(missing) <= MOST_NAMED else ""
    return f"Single faults are of {len(kinds) - len(missing)} of {len(kinds)} kinds{lacking}."


def campaign(
    runner: FaultRunner,
    numbers: Sequence[int],
    seed: int,
    known: MutableMapping[Case, Outcome] | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    plan: Plan = PLANS["dry"],
) -> list[Outcome]:
    """What came of the cases of these numbers, in their order.

    Args:
        seed, plan: of the campaign.
        known, workers, executor: see `harness.simulation.many_runs.run_many`.
    """
    cases = [case(number, seed, runner.plants, plan) for number in numbers]
    judge = partial(outcome, runner)
    return run_many(judge, cases, workers, "faults", executor, known, runs=runner.planned)


def outcome(runner: FaultRunner, each: Case, results: Sequence[np.ndarray]) -> Outcome:
    """What comes of a case, from the results of its runs; one that an FMU ends is clean in the eyes of no judge."""
    try:
        runs = runner.completed(each, results)
    except RunEnded as reason:
        warn_once(f"case {each}: {reason}")
        return Outcome(each, {judge.name: inf for judge in JUDGES})
    return judged(runner, each, runs)


def distinguishing(runner: FaultRunner, seed: int, plan: Plan) -> dict[str, Any]:
    """All that the outcomes depend on, beside what was set."""
    cells = 2 * len(plan.kinds) * len(plan.situations)
    first = [case(number, seed, runner.plants, plan) for number in range(1, cells + 1)]
    limits = [(judge.name, judge.limit) for judge in JUDGES]
    return {
        "cases": f"sha256:{sha256(repr((first, limits)).encode()).hexdigest()}",
        "fmus": {path.stem: digest for path, digest in runner.digests.items()},
    }


def judged(runner: FaultRunner, each: Case, runs: Runs) -> Outcome:
    """What the judges say of the runs of a case; where the controller tells no status, which of them find nothing."""
    if file := runner.without_status(each.plant):
        silent = ", ".join(judge.name for judge in JUDGES if judge.of_status)
        warn_once(f"{file} has no output status; not judged: {silent}")
    seen = Evidence(runs, each.faults, runner.limits(each.plant))
    return Outcome(each, {judge.name: judge.measure(seen) for judge in JUDGES})


def table(seed: int, plants: Sequence[str], plan: Plan = PLANS["dry"]) -> Table[Case, Outcome]:
    """Of the campaign with this seed on these plants: a line has all of a case, which must be that of its number."""

    def parsed(cells: Sequence[str]) -> tuple[Case, Outcome]:
        measured = (float(cell) for cell in cells[-1 - len(JUDGES) : -1])
        each = case(int(cells[0]), seed, plants, plan)
        outcome = Outcome(each, {judge.name: value for judge, value in zip(JUDGES, measured, strict=True)})
        if _cells(each, outcome) != list(cells):
            raise ValueError
        return each, outcome

    first = Outcome(case(1, seed, plants, plan), {judge.name: 0.0 for judge in JUDGES})
    return Table([*first.record], _cells, parsed, "the case of its number and what was measured")


def _cells(_: Case, outcome: Outcome) -> list[str]:
    """With all digits, and what is not finite too."""
    measured = {name.replace(" ", "_"): value for name, value in outcome.measured.items()}
    return [_text(value) for value in (outcome.record | measured).values()]


def _text(value: object) -> str:
    return "" if value is None else str(int(value)) if isinstance(value, bool) else str(value)
