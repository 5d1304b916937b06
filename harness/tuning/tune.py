"""A search in a folder, where it is recorded and goes on if it was stopped."""

from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

from ..control_loop import PLANTS
from ..cosimulation.wiring import fit
from ..errors import DrivelineError
from ..progress import progress
from ..provenance import digest, require_same_run, write_record
from ..reports.files import remove
from .archive import Archive
from .bench import REFERENCE, Bench
from .cost import LOST, POWER, TERMS
from .search import Evaluated, Search
from .space import Space, rounded

RECORD, EVALUATIONS = "search.json", "evaluations.csv"


def tune(
    bench: Bench,
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
        bench, space: what is searched for which controller and car.
        evaluations: how many candidates.
        seed: of the search.
        folder: of the search.
        replace: whether another search in the folder may be replaced.
        inputs: files that were read, for the record.
        workers: see `harness.many.run_many`.

    Raises:
        DrivelineError: there is another search in the folder; or one that cannot be read.
    """
    record, file = folder / RECORD, folder / EVALUATIONS
    run = distinguishing(bench, space, seed)
    try:
        require_same_run(record, run, [file])
    except DrivelineError:
        if not replace:
            raise
        remove(file)
    archive = Archive(file, [each.name for each in space.searched])
    fits = {plant: fit(bench.system(plant, bench.controller)) for plant in PLANTS}
    write_record(record, run, fits, [file], inputs)
    with bench.opened(workers) as costs_of, progress(evaluations, "searching") as done:
        return Search(space, costs_of, seed, archive, done).run(evaluations)


def distinguishing(bench: Bench, space: Space, seed: int) -> dict[str, Any]:
    """All that a candidate's costs, and which candidates are visited, depend on."""
    systems = [bench.system(plant, controller) for plant in PLANTS for controller in (REFERENCE, bench.controller)]
    files = sorted({path for system in systems for path in system.instances.values()})
    cost = repr((TERMS, POWER, LOST, bench.runs))
    return {
        "controller": bench.controller,
        "car": dict(bench.car),
        "searched": {each.name: [each.low, each.start, each.high] for each in space.searched},
        "computed": dict(space.computed),
        "reference": {name: rounded(value) for name, value in bench.reference().items()},
        "cost": f"sha256:{sha256(cost.encode()).hexdigest()}",
        "fmus": {path.stem: digest(path) for path in files},
        "seed": seed,
    }
