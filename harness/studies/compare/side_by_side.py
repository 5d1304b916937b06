"""Runs without and with damping, side by side, as a program asks for them."""

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from os import PathLike
from typing import Unpack

from fmuloop.argument_kinds import require_each
from fmuloop.many_runs import run_many
from fmuloop.results import Results
from toolground.errors import UserError

from ...loop.arguments import BLOCKS
from ...loop.mapped_names import mappings
from ...loop.places import PLACES, PLANTS, NameOrFile
from ...loop.resolved import resolve
from ...loop.settings import RunChanges, Settings
from ...loop.unit_runs import of_unit
from ...manoeuvres.catalogue import COMPARED, MANOEUVRES
from ...manoeuvres.manoeuvre import Manoeuvre
from ...metrics.evaluate import evaluate
from ...metrics.run_metrics import Metrics
from .compare import Case, Loops, cases, loops_of, needed


def compare(
    manoeuvres: Iterable[Manoeuvre] = tuple(MANOEUVRES[name] for name in COMPARED),
    plants: Iterable[NameOrFile] = PLANTS,
    controllers: Iterable[NameOrFile] = PLACES["controller"][:1],
    **changes: Unpack[RunChanges],
) -> dict[Case, Metrics]:
    """Every manoeuvre on every plant, without damping and with each controller, on all cores; see also
    `driveline compare`.

        found = driveline.compare([driveline.MANOEUVRES["tipin15"]])
        driveline.frame(found)[["settling_time", "overshoot"]]  # a row a run: plant, manoeuvre, controller

    Args:
        manoeuvres: each of a name of its own.
        plants: names of plants of the project, or paths of FMUs.
        controllers: names of controllers of the project, or paths of FMUs; the first is the one that is switched off.
        changes: fields of the settings that are to be others, as of `simulate`, for all runs; an entry of the mapping
            is for the FMUs of somebody else that have the variable.

    Returns:
        The metrics of each run, in SI units, by (plant, manoeuvre, controller): the name or path of the plant, the name
        of the manoeuvre, the name or path of the controller or "without damping". In a loop of several drive units the
        name of one follows that of the plant.

    Raises:
        UserError: two plants, manoeuvres or controllers have the same name, and what `simulate` raises.
        TypeError: there is no such field, or it is plant, controller or control.
    """
    if own := changes.keys() & {"plant", "controller", "control"}:
        raise TypeError(f"compare sets {' and '.join(sorted(own))} itself, for each run")
    by_name: dict[str, Manoeuvre] = {}
    for manoeuvre in require_each("manoeuvres", manoeuvres, Manoeuvre, "manoeuvres, such as MANOEUVRES['tipin15']"):
        if by_name.setdefault(manoeuvre.name, manoeuvre) is not manoeuvre:
            raise UserError(f"two manoeuvres are called {manoeuvre.name}; rename one")
    blocks = {"plants": plants, "controllers": controllers}
    each = [
        [str(block) for block in require_each(name, given, str | PathLike, BLOCKS)] for name, given in blocks.items()
    ]
    common, todo = Settings().replace(**changes), cases(each[0], list(by_name), each[1])
    mapped = mappings(common.mapping, each[0], each[1], common.limits)
    resolved = {(p, c): resolve(common, plant=p, controller=c, mapping=own) for (p, c), own in mapped.items()}
    loops = loops_of(resolved)
    plan = partial(needed, manoeuvres=by_name, loops=loops)
    judge = partial(_metrics, manoeuvres=by_name, loops=loops)
    answers = run_many(judge, todo, label="comparing", runs=plan)
    return {case: metrics for of_case in answers for case, metrics in of_case.items()}


def _metrics(
    case: Case, runs: Sequence[Results], manoeuvres: Mapping[str, Manoeuvre], loops: Loops
) -> dict[Case, Metrics]:
    manoeuvre, units = manoeuvres[case.manoeuvre], loops[case.plant, case.controller].settings.topology.units
    return {case._replace(plant=unit.named(case.plant)): evaluate(of_unit(runs[0], unit), manoeuvre) for unit in units}
