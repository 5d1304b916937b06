"""A search in a folder, where it is recorded and goes on if it was stopped."""

from collections.abc import Sequence
from concurrent.futures import Executor
from hashlib import sha256
from math import isfinite
from pathlib import Path
from typing import Any

from fmuloop.wiring import fit
from toolground.optional_packages import required
from toolground.progress import progress

from ...loop.places import PLANTS
from ...simulation.case_archive import Table, resumable
from .controller_cost import LOST, POWER, TERMS, Costs
from .cost_evaluation import CostEvaluation
from .parameter_search import Evaluated, Search, Values
from .search_space import Space, rounded

RECORD, EVALUATIONS = "search.json", "evaluations.csv"


def tune(
    evaluation: CostEvaluation,
    space: Space,
    evaluations: int,
    seed: int,
    folder: Path,
    replace: bool = False,
    inputs: Sequence[Path | None] = (),
    workers: int | None = None,
    executor: Executor | None = None,
) -> list[Evaluated]:
    """All candidates of a search, of which those that the folder has already are not run again.

    Args:
        evaluation, space: what is searched for which controller and car.
        evaluations: how many candidates.
        seed: of the search.
        folder: of the search.
        replace: whether another search in the folder may be replaced.
        inputs: files that were read, for the record.
        workers, executor: see `harness.simulation.many_runs.run_many`.

    Raises:
        UserError: there is another search in the folder; or one that cannot be read.
        MissingExtra: the package cma is not installed.
    """
    known = table([parameter.name for parameter in space.searched])
    fits = {plant: fit(evaluation.system(plant, evaluation.controller)) for plant in PLANTS}
    run, file, record = distinguishing(evaluation, space, seed), folder / EVALUATIONS, folder / RECORD
    with (
        resumable(file, known, record, run, fits, inputs, replace=replace) as resumed,
        evaluation.opened(workers, executor) as costs_of,
        progress(evaluations, "searching") as done,
    ):
        return Search(space, costs_of, seed, resumed.archive, done).run(evaluations)


def distinguishing(evaluation: CostEvaluation, space: Space, seed: int) -> dict[str, Any]:
    """All that a candidate's costs, and which candidates are visited, depend on."""
    cost = repr((TERMS, POWER, LOST, evaluation.runs))
    return {
        "controller": evaluation.controller,
        "car": dict(evaluation.car),
        "searched": {parameter.name: [parameter.low, parameter.start, parameter.high] for parameter in space.searched},
        "computed": dict(space.computed),
        "reference": {name: rounded(value) for name, value in evaluation.reference().items()},
        "cost": f"sha256:{sha256(cost.encode()).hexdigest()}",
        "fmus": {path.stem: digest for path, digest in sorted(evaluation.digests().items())},
        "cma": required("cma", "searching", "driveline-damping[design]").__version__,
        "seed": seed,
    }


def table(names: Sequence[str]) -> Table[Values, Costs]:
    """Of a search for the parameters of these names."""
    columns = [*names, *Costs._fields]

    def parsed(cells: Sequence[str]) -> tuple[Values, Costs]:
        numbers = [float(cell) for cell in cells]
        if not all(map(isfinite, numbers)):
            raise ValueError
        return tuple(numbers[: len(names)]), Costs(*numbers[len(names) :])

    return Table(columns, lambda values, costs: [*values, *costs], parsed, f"{len(columns)} finite numbers")
