"""Runs without and with damping, side by side, as a program asks for them."""

from collections.abc import Iterable, Mapping
from functools import partial
from os import PathLike
from typing import Unpack

from ...base.argument_kinds import BLOCKS, require_each
from ...base.errors import DrivelineError
from ...loop.places import PLANTS, NameOrFile
from ...loop.settings import Changes, Settings
from ...manoeuvres.catalogue import COMPARED, MANOEUVRES
from ...manoeuvres.manoeuvre import Manoeuvre
from ...metrics.evaluate import evaluate
from ...metrics.run_metrics import Metrics
from ...simulation.many_runs import run_many
from ...simulation.simulate import simulate
from .compare import Case, cases


def compare(
    manoeuvres: Iterable[Manoeuvre] = tuple(MANOEUVRES[name] for name in COMPARED),
    plants: Iterable[NameOrFile] = PLANTS,
    **changes: Unpack[Changes],
) -> dict[Case, Metrics]:
    """Every manoeuvre on every plant, with the damping off and on, on all cores; see also `driveline compare`.

        found = driveline.compare([driveline.MANOEUVRES["tipin15"]])
        driveline.frame(found)[["settling_time", "overshoot"]]  # a row a run: plant, manoeuvre, control

    Args:
        manoeuvres: each of a name of its own.
        plants: names of plants of the project, or paths of FMUs.
        changes: fields of the settings that are to be others, as of `simulate`, for all runs; plant and control are
            those of each run.

    Returns:
        The metrics of each run, in SI units, by (plant, manoeuvre, control): the name or path of the plant, the name of
        the manoeuvre, and whether the damping was on.

    Raises:
        DrivelineError: two plants or two manoeuvres have the same name, and what `simulate` raises.
        TypeError: there is no such field, or it is plant or control.
    """
    if own := changes.keys() & {"plant", "control"}:
        raise TypeError(f"compare sets {' and '.join(sorted(own))} itself, for each run")
    by_name: dict[str, Manoeuvre] = {}
    for manoeuvre in require_each("manoeuvres", manoeuvres, Manoeuvre, "manoeuvres, such as MANOEUVRES['tipin15']"):
        if by_name.setdefault(manoeuvre.name, manoeuvre) is not manoeuvre:
            raise DrivelineError(f"two manoeuvres are called {manoeuvre.name}; rename one")
    todo = cases([str(plant) for plant in require_each("plants", plants, str | PathLike, BLOCKS)], list(by_name))
    one = partial(_metrics, manoeuvres=by_name, settings=Settings().replace(**changes))
    return dict(zip(todo, run_many(one, todo, label="comparing"), strict=True))


def _metrics(case: Case, manoeuvres: Mapping[str, Manoeuvre], settings: Settings) -> Metrics:
    manoeuvre = manoeuvres[case.manoeuvre]
    return evaluate(simulate(manoeuvre, settings, plant=case.plant, control=case.control), manoeuvre)
