"""What a search finds for our controller, from sport to comfort, and what the others cost as they are.

Costs are over those of the gains that are computed for the car; the defaults of the others come from such searches.
"""

from collections.abc import Iterable, Sequence

from driveline.harness.design.search.controller_cost import Costs
from driveline.harness.design.search.cost_evaluation import CostEvaluation
from driveline.harness.design.search.parameter_search import Evaluated, Search, best
from driveline.harness.design.search.pareto_figure import front_drawing
from driveline.harness.design.search.search_space import Space, declared_parameters, space
from driveline.harness.design.search.tuning_runs import RUNS, Run
from driveline.harness.loop.places import COMPARATORS, PLACES
from driveline.harness.loop.settings import Settings
from toolground.progress import progress

from .study import Cell, Column, Measured, Study, Table

OURS = PLACES["controller"][0]
EVALUATIONS, SEED = 600, 1

CHARACTERS = {"sport": 0.0, "0.25": 0.25, "balanced": 0.5, "0.75": 0.75, "comfort": 1.0}
"""What a driver may choose."""

SEARCHED = tuple(name for name in COMPARATORS if name not in ("NoDamping", "TrueMotion"))
"""The others that have parameters of their own to search."""

MARKED = {name: CHARACTERS[name] for name in ("sport", "balanced", "comfort")}
"""Of these in the figure."""

FEW = RUNS[:4]
"""Runs of which the sentinel is."""

COSTS = tuple(Column(name, "", 3) for name in ("cost", *Costs._fields))


def _cost(costs: Costs, character: float = 0.5) -> tuple[Cell, ...]:
    return costs.total(character), *costs


def choices_table(visited: Sequence[Evaluated], where: Space) -> Table:
    """The start and the choices: what they cost, and their parameters."""
    columns = (*COSTS, *(Column(parameter.name) for parameter in where.searched))
    rows = {"start": (*_cost(visited[0].costs), *visited[0].values)}
    for name, character in CHARACTERS.items():
        chosen = best(visited, character)
        rows[name] = (*_cost(chosen.costs, character), *chosen.values)
    return Table("character", columns, rows, f"The best of {len(visited)} candidates.")


def defaults_table(controllers: Iterable[str], runs: Sequence[Run]) -> Table:
    """What controllers cost with their defaults."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for name in controllers:
        declared = declared_parameters(name)
        parameters = {p.name: float(declared[p.name].start) for p in space(name, {}).searched}
        with CostEvaluation(Settings(controller=name), runs=runs).opened() as costs_of:
            (costs,) = costs_of([parameters])
        rows[name] = (len(parameters), *_cost(costs))
    return Table("controller", (Column("parameters searched", "", 0), *COSTS), rows)


def measure() -> Measured:
    where = space(OURS, {})
    with CostEvaluation(Settings()).opened() as costs_of, progress(EVALUATIONS, "searching") as done:
        visited = Search(where, costs_of, SEED, note=done).run(EVALUATIONS)
    return Measured(
        {
            "choices": choices_table(visited, where),
            "defaults": defaults_table(SEARCHED, RUNS),
            "few_runs": defaults_table(SEARCHED[:1], FEW),
        },
        {"front": front_drawing(visited, where, MARKED, f"{OURS}, costs over those of the computed gains")},
    )


def again() -> dict[str, Table]:
    return {"few_runs": defaults_table(SEARCHED[:1], FEW)}


STUDY = Study(
    "what a search finds from sport to comfort, and what the other controllers cost",
    measure,
    again,
    {"few_runs": SEARCHED[:1]},
    (SEED,),
    seconds=500,
)
