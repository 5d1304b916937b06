"""What `driveline design --search` does: parameters of a controller by a search, in a folder."""

from collections.abc import Sequence
from functools import partial
from importlib.metadata import version
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

from toolground.argument_types import counted, output_folder, share
from toolground.arguments import expert, option, record
from toolground.errors import UserError
from toolground.printing import Printing

from ..loop.places import BUILD_HELP, BUILDS, PLACES, PLANTS
from ..loop.settings import Settings
from .options import FmuFolder, Replacing, controller_with_equations, file_of, seed, write_toml

if TYPE_CHECKING:
    from ..design.search.parameter_search import Evaluated
    from ..design.search.search_space import Space

DEFAULTS: dict[str, Any] = {"controller": PLACES["controller"][0], "evaluations": 600, "character": 0.5, "seed": 1}
"""Of the options that are for a search alone, which are None where they are not given."""

SHOWN = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Characters in the table."""

searching = partial(option, group="searching")


def _of_search(name: str, meaning: str, **how: Any) -> Any:
    return searching(None, f"{meaning} (default: {DEFAULTS[name]})", **how)


@record
class Search(FmuFolder, Replacing, Printing):
    """What a design can be given by a search too."""

    vehicle: Path | None = file_of("the car (default: that of all blocks)")
    output: Path | None = file_of("for the gains")
    search: Path | None = searching(None, "search, in this folder", output_folder, metavar="FOLDER")
    controller: str | None = controller_with_equations(
        None, f"whose parameters, a Python file too (default: {DEFAULTS['controller']})", "searching"
    )
    evaluations: int | None = _of_search(
        "evaluations", "how many candidates", parse=counted(1, 100_000), metavar="COUNT"
    )
    character: float | None = _of_search(
        "character", "the choice from 0, sport, to 1, comfort", parse=share, metavar="SHARE"
    )
    seed: int | None = _of_search("seed", "of the search", parse=seed, metavar="SEED")
    scheduler: str | None = expert(None, "of a Dask cluster that runs the candidates", metavar="ADDRESS")
    build: str | None = expert(None, BUILD_HELP, choices=BUILDS)


def require_search(args: Search) -> None:
    """Refuses options of a search without one.

    Raises:
        UserError: names the first.
    """
    for name in (*DEFAULTS, "scheduler", "build"):
        if name != "character" and getattr(args, name) is not None:
            raise UserError(f"--{name} is for a search: give the folder of one, --search FOLDER")


def run_search(args: Search, folder: Path) -> int:
    # here and not above: mistakes and help are answered without them
    from fmuloop.executors import dask_executor
    from toolground.tables import print_table

    from ...fmus.building.parameter_files import read_vehicle
    from ..design.search.cost_evaluation import CostEvaluation
    from ..design.search.pareto_figure import choices_table, plot_front
    from ..design.search.search_space import space
    from ..design.search.tune import EVALUATIONS, RECORD, tune

    controller, evaluations, character, number = (
        default if getattr(args, name) is None else getattr(args, name) for name, default in DEFAULTS.items()
    )
    car = read_vehicle(args.vehicle) if args.vehicle else {}
    where = space(controller, car)
    evaluation = CostEvaluation(_settings(args, controller), car)
    gains = folder / "gains.toml" if args.output is None else args.output
    with dask_executor(args.scheduler) as executor:
        visited = tune(evaluation, where, evaluations, number, folder, args.replace, [args.vehicle], executor=executor)
    name = args.vehicle.name if args.vehicle else "the default car"
    text, called = chosen(controller, where, visited, character, name, number), Path(controller).stem
    write_toml(text, gains, args.replace or args.output is None)
    figures = plot_front(visited, where, character, f"{called}, {name}: {len(visited)} candidates", folder / "front")
    if not args.silent:
        print_table(choices_table(visited, where, sorted({*SHOWN, character})))
    args.say(f"gains:      {gains} (character {character:g})")
    args.say(f"figure:     {' '.join(map(str, figures))}")
    args.say(f"candidates: {folder / EVALUATIONS}, made by {folder / RECORD}")
    return 0


def _settings(args: Search, controller: str) -> Settings:
    """Of the runs of a controller, with FMUs for both plants and for the controller that it is measured by."""
    from ..loop.built_fmus import built_together

    given = Settings(folder=args.fmus, build=args.build)
    names = dict.fromkeys((controller, DEFAULTS["controller"]))
    first, *_ = built_together(given.replace(plant=p, controller=c) for c, p in product(names, PLANTS))
    return first


def chosen(
    controller: str, where: "Space", visited: "Sequence[Evaluated]", character: float, car: str, number: int
) -> str:
    """The file of the parameters that cost least for a character.

    Args:
        car: its name.
        number: seed of the search.
    """
    from ..design.design import gains_file
    from ..design.search.parameter_search import best
    from ..design.search.search_space import declared_parameters

    found = best(visited, character)
    costs, program = found.costs, version("driveline-damping")
    comment = f"""\
Parameters of the {Path(controller).stem} for {car}, by `driveline design --search` (driveline-damping {program}).
Character {character:g} (0 sport, 1 comfort), the best of {len(visited)} candidates, seed {number}. Cost \
{costs.total(character):.3f}: swing
{costs.swing:.3f}, comfort {costs.comfort:.3f}, response {costs.response:.3f}; computed gains of the DampingController \
cost 1."""
    return gains_file(where.parameters(found.values), comment, declared_parameters(controller))
