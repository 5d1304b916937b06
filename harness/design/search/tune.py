"""A search in a folder, where it is recorded and goes on if it was stopped."""

from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

from ...base.atomic_files import remove
from ...base.errors import DrivelineError
from ...base.progress import progress
from ...cosimulation.wiring import fit
from ...loop.places import PLANTS
from ...simulation.provenance import digest, require_same_run, write_record
from .controller_cost import LOST, POWER, TERMS
from .cost_evaluation import REFERENCE, CostEvaluation
from .parameter_search import Evaluated, Search
from .search_archive import Archive
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
) -> list[Evaluated]:
    """All candidates of a search, of which those that the folder has already are not run again.

    Args:
        evaluation, space: what is searched for which controller and car.
        evaluations: how many candidates.
        seed: of the search.
        folder: of the search.
        replace: whether another search in the folder may be replaced.
        inputs: files that were read, for the record.
        workers: see `harness.simulation.many_runs.run_many`.

    Raises:
        DrivelineError: there is another search in the folder; or one that cannot be read.
    """
    record, file = folder / RECORD, folder / EVALUATIONS
    run = distinguishing(evaluation, space, seed)
    try:
        require_same_run(record, run, [file])
    except DrivelineError:
        if not replace:
            raise
        remove(file)
    archive = Archive(file, [each.name for each in space.searched])
    fits = {plant: fit(evaluation.system(plant, evaluation.controller)) for plant in PLANTS}
    write_record(record, run, fits, [file], inputs)
    with evaluation.opened(workers) as costs_of, progress(evaluations, "searching") as done:
        return Search(space, costs_of, seed, archive, done).run(evaluations)


def distinguishing(evaluation: CostEvaluation, space: Space, seed: int) -> dict[str, Any]:
    """All that a candidate's costs, and which candidates are visited, depend on."""
    systems = [
        evaluation.system(plant, controller) for plant in PLANTS for controller in (REFERENCE, evaluation.controller)
    ]
    files = sorted({path for system in systems for path in system.instances.values()})
    cost = repr((TERMS, POWER, LOST, evaluation.runs))
    return {
        "controller": evaluation.controller,
        "car": dict(evaluation.car),
        "searched": {each.name: [each.low, each.start, each.high] for each in space.searched},
        "computed": dict(space.computed),
        "reference": {name: rounded(value) for name, value in evaluation.reference().items()},
        "cost": f"sha256:{sha256(cost.encode()).hexdigest()}",
        "fmus": {path.stem: digest(path) for path in files},
        "seed": seed,
    }
