"""What `driveline design --search` does: parameters of a controller by a search, in a folder."""

import argparse
from collections.abc import Sequence
from importlib.metadata import version
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...fmus.building.options import output_folder
from ..base.errors import DrivelineError
from ..base.plain_text import quoted
from ..base.written_numbers import real
from ..loop.built_fmus import built_together
from ..loop.places import BUILD_HELP, BUILDS, PLACES, PLANTS
from ..loop.settings import Settings
from .options import add_fmus, count, experts, seed
from .printing import Printer

if TYPE_CHECKING:
    from ..design.search.parameter_search import Evaluated
    from ..design.search.search_space import Space

COMMENT = """\
Parameters of the {controller} for {car}, by `driveline design --search` (driveline-damping {version}).
Character {character:g} (0 sport, 1 comfort), the best of {count} candidates, seed {seed}. Cost {total:.3f}: swing
{costs.swing:.3f}, comfort {costs.comfort:.3f}, response {costs.response:.3f}; computed gains of the DampingController \
cost 1."""

DEFAULTS: dict[str, Any] = {"controller": PLACES["controller"][0], "evaluations": 600, "character": 0.5, "seed": 1}
"""Of the options that are for a search alone."""

METAVARS = {"controller": "NAME", "evaluations": "COUNT", "character": "SHARE", "seed": "SEED"}
MOST_EVALUATIONS = 100_000
SHOWN = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Characters in the table."""


def add_search(parser: argparse.ArgumentParser) -> None:
    """--search and the options that are for it alone; `None` where they are not given."""
    group = parser.add_argument_group("searching")
    group.add_argument("--search", type=output_folder, metavar="FOLDER", help="search, in this folder")
    options: dict[str, tuple[str, dict[str, Any]]] = {
        "controller": ("whose parameters", {"choices": PLACES["controller"]}),
        "evaluations": ("how many candidates", {"type": _evaluations}),
        "character": ("the choice from 0, sport, to 1, comfort", {"type": share}),
        "seed": ("of the search", {"type": seed}),
    }
    for name, (meaning, how) in options.items():
        group.add_argument(f"--{name}", metavar=METAVARS[name], help=f"{meaning} (default: {DEFAULTS[name]})", **how)
    group.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster that runs the candidates")
    experts(parser).add_argument("--build", choices=BUILDS, help=BUILD_HELP)
    add_fmus(parser)


def _evaluations(text: str) -> int:
    return count(text, 1, MOST_EVALUATIONS)


def share(text: str) -> float:
    """A number from 0 to 1."""
    number = real(text)
    if number is None or not 0.0 <= number <= 1.0:
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a number from 0 to 1")
    return number


def require_search(args: argparse.Namespace) -> None:
    """Refuses options of a search without one.

    Raises:
        DrivelineError: names the first.
    """
    for name in (*DEFAULTS, "scheduler", "build"):
        if getattr(args, name) is not None:
            raise DrivelineError(f"--{name} is for a search: give the folder of one, --search FOLDER")


def run_search(args: argparse.Namespace) -> int:
    # here and not above: mistakes and help are answered without them
    from ...fmus.building.parameter_files import read_vehicle
    from ..design.search.cost_evaluation import CostEvaluation
    from ..design.search.pareto_figure import choices_table, plot_front
    from ..design.search.search_space import space
    from ..design.search.tune import EVALUATIONS, RECORD, tune
    from ..views.terminal import print_table

    controller, evaluations, character, number = (
        default if getattr(args, name) is None else getattr(args, name) for name, default in DEFAULTS.items()
    )
    car = read_vehicle(args.vehicle) if args.vehicle else {}
    where = space(controller, car)
    evaluation = CostEvaluation(_settings(args, controller), car)
    gains = args.search / "gains.toml" if args.output is None else args.output
    visited = tune(
        evaluation, where, evaluations, number, args.search, args.replace, [args.vehicle], scheduler=args.scheduler
    )
    name = args.vehicle.name if args.vehicle else "the default car"
    text = chosen(controller, where, visited, character, name, number)
    write_toml(text, gains, args.replace or args.output is None)
    title = f"{controller}, {name}: {len(visited)} candidates"
    figures = plot_front(visited, where, character, title, args.search / "front")
    out = Printer(args)
    if not out.silent:
        print_table(choices_table(visited, where, sorted({*SHOWN, character})))
    out.say(f"gains:      {gains} (character {character:g})")
    out.say(f"figure:     {' '.join(map(str, figures))}")
    out.say(f"candidates: {args.search / EVALUATIONS}, made by {args.search / RECORD}")
    return 0


def _settings(args: argparse.Namespace, controller: str) -> Settings:
    """Of the runs of a controller, with FMUs for both plants and for the controller that it is measured by."""
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
    comment = COMMENT.format(
        controller=controller,
        car=car,
        version=version("driveline-damping"),
        character=character,
        count=len(visited),
        seed=number,
        total=found.costs.total(character),
        costs=found.costs,
    )
    return gains_file(where.parameters(found.values), comment, declared_parameters(controller))


def write_toml(text: str, path: Path, replace: bool) -> None:
    """Writes a vehicle file or one of gains; one with another content only if it may be replaced."""
    from ..base.atomic_files import write_text
    from ..simulation.provenance import require_same_text

    if not replace:
        require_same_text(text, path)
    write_text(text, path)
