"""The controller under faults of its signals: 10 000 cases, each judged beside a run without the fault and one without
control (see `driveline faults`)."""

from collections.abc import Sequence
from functools import cache

from driveline.fmus.catalogue import SIGNAL_FAULTS
from driveline.harness.loop.built_fmus import built, made_if_missing
from driveline.harness.loop.places import BUILD, NATIVE, PLANTS
from driveline.harness.loop.resolved import resolve
from driveline.harness.studies.faults.fault_campaign import Outcome, campaign, count
from driveline.harness.studies.faults.fault_cases import PLANS, case
from driveline.harness.studies.faults.fault_injection import FaultRunner
from driveline.harness.studies.faults.judges import JUDGES

from .study import Cell, Column, Measured, Study, Table, cell

CASES = {"dry": 10_000, "roads": 600, "starts": 560}
"""Of each campaign."""

SEED = 1

SENTINELS = range(1, 7)
"""Cases that are judged again."""


@cache
def _runner() -> FaultRunner:
    loops = {plant: resolve(built(plant)) for plant in PLANTS}
    return FaultRunner(made_if_missing(SIGNAL_FAULTS, BUILD, NATIVE), loops)


def outcomes_of(plan: str, numbers: Sequence[int]) -> list[Outcome]:
    """What came of cases of a campaign."""
    return campaign(_runner(), numbers, SEED, plan=PLANS[plan])


def kinds_table(outcomes: Sequence[Outcome], plan: str) -> Table:
    """For each kind of fault how many cases each judge found not clean, how many any, and how many there are."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for kind in PLANS[plan].kinds:
        failed, total = count(outcomes, kind)
        by_judge = (count(outcomes, kind, judge.name)[0] for judge in JUDGES)
        if total:
            rows[kind] = (*by_judge, failed, total)
    names = [*(judge.name for judge in JUDGES), "not clean", "cases"]
    return Table("kind", tuple(Column(name, decimals=0) for name in names), rows)


def classes_table(outcomes: Sequence[Outcome]) -> Table:
    """What is not clean: by kinds, judge, situation and plant, with the worst case."""
    classes: dict[tuple[str, ...], list[Outcome]] = {}
    for outcome in outcomes:
        for judge in outcome.failed:
            key = " + ".join(sorted(outcome.kinds)), outcome.case.situation, outcome.plant, judge
            classes.setdefault(key, []).append(outcome)
    rows: dict[str, tuple[Cell, ...]] = {}
    for key, cases in sorted(classes.items()):
        worst = max(cases, key=lambda outcome: outcome.measured[key[-1]])
        rows[", ".join(key)] = (len(cases), cell(worst.measured[key[-1]]), worst.case.number)
    columns = (Column("cases", decimals=0), Column("worst"), Column("its number", decimals=0))
    return Table("fault, begin, plant, judge", columns, rows)


def cases_table(outcomes: Sequence[Outcome]) -> Table:
    """What each judge measured."""
    columns = tuple(Column(judge.name, judge.unit if judge.unit != "1" else "") for judge in JUDGES)
    rows = {str(outcome.case): tuple(cell(outcome.measured[judge.name]) for judge in JUDGES) for outcome in outcomes}
    return Table("case", columns, rows)


def measure() -> Measured:
    tables: dict[str, Table] = {}
    rows: dict[str, tuple[Cell, ...]] = {}
    for plan, cases in CASES.items():
        outcomes = outcomes_of(plan, range(1, cases + 1))
        rows[plan] = (cases, sum(not outcome.failed for outcome in outcomes))
        for name, faults in (("single", 1), ("pair", 2)):
            its = [outcome for outcome in outcomes if len(outcome.kinds) == faults]
            if its:
                tables[f"{plan}_{name}"] = kinds_table(its, plan)
                tables[f"{plan}_{name}_classes"] = classes_table(its)
        tables[f"{plan}_cases"] = cases_table(outcomes[: len(SENTINELS)])
    count_columns = (Column("cases", decimals=0), Column("clean", decimals=0))
    return Measured({"count": Table("campaign", count_columns, rows), **tables})


def again() -> dict[str, Table]:
    return {"dry_cases": cases_table(outcomes_of("dry", SENTINELS))}


NAMES = [str(case(number, SEED, PLANTS, PLANS["dry"])) for number in SENTINELS]

STUDY = Study(
    "the controller under faults of its signals",
    measure,
    again,
    {"dry_cases": NAMES},
    (SEED,),
    seconds=600,
)
