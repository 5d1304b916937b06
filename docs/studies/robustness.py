"""Cars and sensors that are drawn at random, with every controller (see `driveline robustness`)."""

from collections.abc import Sequence
from dataclasses import replace
from math import inf, isinf

from driveline.harness.loop.built_fmus import built_together
from driveline.harness.loop.places import COMPARATORS, PLACES, PLANTS
from driveline.harness.loop.resolved import resolve
from driveline.harness.loop.settings import settings
from driveline.harness.studies.robustness.case_runs import CaseRunner
from driveline.harness.studies.robustness.outcome import SHOWN, Outcome
from driveline.harness.studies.robustness.robustness_campaign import campaign
from driveline.harness.studies.robustness.robustness_figures import distributions
from driveline.harness.studies.robustness.summary import LEVELS, Summary, summaries
from driveline.harness.views.panels import Axis, Curve, Drawing, Panel

from .study import Cell, Column, Measured, Study, Table

DRAWS, SEED = 300, 1

DRAWN = "tipin15"
"""The manoeuvre of the figure."""

OURS = PLACES["controller"][0]
CONTROLLERS = (OURS, *COMPARATORS)

LISTED = {name: of for name, of in SHOWN.items() if name not in ("response_delay", "stationary_torque_change")}
"""In the columns of a table; draws are compared in all."""

COLUMNS = (
    *(Column(name, "%", 1) for name in ("bounded and quiet", "good")),
    *(
        Column(f"{column.plain_heading}, {100 * level:g} %", column.unit, column.decimals)
        for column in LISTED.values()
        for level in LEVELS
    ),
)


def runner(controllers: Sequence[str]) -> CaseRunner:
    """Of these controllers on both plants."""
    pairs = [(plant, controller) for plant in PLANTS for controller in controllers]
    loops = map(resolve, built_together(settings(plant, controller=controller) for plant, controller in pairs))
    return CaseRunner(dict(zip(pairs, loops, strict=True)), SEED)


def summary_table(summaries: Sequence[Summary]) -> Table:
    """A row for each controller: shares of the runs, and what half and 95 % of them do not exceed."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for summary in summaries:
        levels = ((summary.level(name, level) * of.factor) for name, of in LISTED.items() for level in LEVELS)
        shares = (100.0 * summary.share(verdict) for verdict in ("stable", "good"))
        rows[summary.controller] = (*shares, *(None if isinf(value) else value for value in levels))
    return Table("controller", COLUMNS, rows)


def draws_table(outcomes: Sequence[Outcome]) -> Table:
    """Single draws."""
    columns = tuple(Column(of.plain_heading, of.unit, of.decimals) for of in SHOWN.values())
    rows: dict[str, tuple[Cell, ...]] = {}
    for outcome in outcomes:
        values = (outcome.magnitude(name) * of.factor for name, of in SHOWN.items())
        rows[str(outcome.case)] = tuple(None if value == inf else value for value in values)
    return Table("draw", columns, rows)


def distribution(summaries: Sequence[Summary]) -> Drawing:
    """Which share of the draws of a tip-in stays below a value, for each controller; a column for each plant."""
    columns = [
        [_thinner(panel) for panel in distributions(of, plant)]
        for plant in PLANTS
        if (of := [summary for summary in summaries if (summary.plant, summary.manoeuvre) == (plant, DRAWN)])
    ]
    title = f"{DRAWN}: share of {DRAWS} draws that stay below a value"
    return Drawing(list(zip(*columns, strict=True)), Axis("", (0.0, 1.0)), title, (7.2, 1.95), key=4)


def _thinner(panel: Panel) -> Panel:
    """With every third draw."""
    parts = [part._replace(x=part.x[::3], y=part.y[::3]) if isinstance(part, Curve) else part for part in panel.parts]
    return replace(panel, parts=parts)


def measure() -> Measured:
    outcomes = campaign(runner(CONTROLLERS), range(1, DRAWS + 1))
    of_loops = summaries(outcomes)
    tables = {
        f"{plant}_{manoeuvre}": summary_table([s for s in of_loops if (s.plant, s.manoeuvre) == (plant, manoeuvre)])
        for plant, manoeuvre in dict.fromkeys((s.plant, s.manoeuvre) for s in of_loops)
    }
    first = [outcome for outcome in outcomes if outcome.case.number == 1 and outcome.case.controller == OURS]
    return Measured({**tables, "draws": draws_table(first)}, {"distribution": distribution(of_loops)})


def again() -> dict[str, Table]:
    return {"draws": draws_table(campaign(runner([OURS]), [1]))}


STUDY = Study(
    "cars and sensors that are drawn at random, with every controller",
    measure,
    again,
    {"draws": [f"1, tipin15 on {plant} with {OURS}" for plant in PLANTS]},
    (SEED,),
    seconds=300,
)
