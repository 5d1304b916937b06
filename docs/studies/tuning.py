"""What a search finds for our controller, from sport to comfort, and what the others cost as they are.

Costs are over those of the gains that are computed for the car; the defaults of the others come from such searches.
"""

from collections.abc import Iterable, Sequence

import numpy as np

from driveline.harness.base.progress import progress
from driveline.harness.design.search.controller_cost import Costs
from driveline.harness.design.search.cost_evaluation import CostEvaluation
from driveline.harness.design.search.parameter_search import Evaluated, Search, best, front
from driveline.harness.design.search.search_space import Space, declared_parameters, space
from driveline.harness.design.search.tuning_runs import RUNS, Run
from driveline.harness.loop.places import COMPARATORS, PLACES
from driveline.harness.loop.settings import Settings
from driveline.harness.views.colours import BLACK, BLUE, GREEN, GREY, VERMILION
from driveline.harness.views.panels import DASHED, DOTTED, SOLID, Axis, Curve, Drawing, Panel, Points

from .study import Cell, Column, Measured, Study, Table

OURS = PLACES["controller"][0]
EVALUATIONS, SEED = 600, 1

CHARACTERS = {"sport": 0.0, "0.25": 0.25, "balanced": 0.5, "0.75": 0.75, "comfort": 1.0}
"""What a driver may choose."""

SEARCHED = tuple(name for name in COMPARATORS if name not in ("NoDamping", "TrueMotion"))
"""The others that have parameters of their own to search."""

FEW = RUNS[:4]
"""Runs of which the sentinel is."""

COSTS = tuple(Column(name, "", 3) for name in ("cost", *Costs._fields))
MARKS = {
    "sport": (VERMILION, 7.0),
    "balanced": (GREEN, 7.0),
    "comfort": (BLUE, 7.0),
    "start": (BLACK, 7.0, "square"),
}
"""Of the choices in the figure."""

CHOICES = np.linspace(0.0, 1.0, 41)
STYLES = tuple((color, dashes) for dashes in (SOLID, DASHED, DOTTED) for color in (BLUE, VERMILION, GREEN, BLACK))


def _cost(costs: Costs, character: float = 0.5) -> tuple[Cell, ...]:
    return costs.total(character), *costs


def choices_table(visited: Sequence[Evaluated], where: Space) -> Table:
    """The start and the choices: what they cost, and their parameters."""
    columns = (*COSTS, *(Column(each.name) for each in where.searched))
    rows = {"start": (*_cost(visited[0].costs), *visited[0].values)}
    for name, character in CHARACTERS.items():
        chosen = best(visited, character)
        rows[name] = (*_cost(chosen.costs, character), *chosen.values)
    return Table("character", columns, rows, f"The best of {len(visited)} candidates.")


def defaults_table(controllers: Iterable[str], runs: Sequence[Run]) -> Table:
    """What controllers cost with their defaults."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for name in controllers:
        parameters = {each.name: float(declared_parameters(name)[each.name].start) for each in space(name, {}).searched}
        with CostEvaluation(Settings(controller=name), runs=runs).opened() as costs_of:
            (found,) = costs_of([parameters])
        rows[name] = (len(parameters), *_cost(found))
    return Table("controller", (Column("parameters searched", "", 0), *COSTS), rows)


def _at(costs: Iterable[Costs]) -> tuple[np.ndarray, np.ndarray]:
    each = list(costs)
    return np.array([of.comfort for of in each]), np.array([of.response for of in each])


def _around(values: np.ndarray) -> tuple[float, float]:
    margin = 0.25 * np.ptp(values) + 0.02
    return float(values.min() - margin), float(values.max() + margin)


def front_drawing(visited: Sequence[Evaluated], where: Space) -> Drawing:
    """Comfort against response, with the front of the candidates; and the parameters along it."""
    marked = {name: best(visited, character).costs for name, character in CHARACTERS.items() if name in MARKS}
    marked["start"] = visited[0].costs
    comfort, response = _at(marked.values())
    x, y = _at(each.costs for each in front(visited))
    costs = [
        Points(*_at(each.costs for each in visited), "candidates", GREY, 2.0),
        Curve(x, y, "front", BLACK, width=0.8, held=True),
        *(Points(*_at([of]), name, *MARKS[name]) for name, of in marked.items()),
    ]
    along = [best(visited, choice).values for choice in CHOICES]
    shares = [
        Curve(CHOICES, np.array([values[k] / each.start for values in along]), each.name, color, dashes, held=True)
        for k, (each, (color, dashes)) in enumerate(zip(where.searched, STYLES, strict=False))
    ]
    left = Axis("comfort: overshoot and jerk", _around(comfort))
    right = Axis("character, from sport to comfort", (0.0, 1.0))
    rows = [
        [Panel("response: 90 % time\nand torque withheld", costs, bounds=_around(response), x=left)],
        [Panel("parameter over its start", shares, columns=4, x=right)],
    ]
    title = f"{OURS}: {len(visited)} candidates, costs over those of the computed gains"
    return Drawing(rows, right, title, size=(7.2, 2.8), same_y=False)


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
        {"front": front_drawing(visited, where)},
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
