"""Runs without and with damping, side by side, as a program asks for them."""

from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any

from ...base.errors import DrivelineError
from ...loop.places import PLANTS, NameOrFile
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
    **settings: Any,
) -> dict[Case, Metrics]:
    """Every manoeuvre on every plant, with the damping off and on, on all cores; see also `driveline compare`.

        found = driveline.compare([driveline.MANOEUVRES["tipin15"]])
        driveline.frame(found)[["settling_time", "overshoot"]]  # a row a run: plant, manoeuvre, control

    Args:
        manoeuvres: each of a name of its own.
        plants: names of plants of the project, or paths of FMUs.
        settings: further arguments of `simulate`, for all runs.

    Returns:
        The metrics of each run, in SI units, by (plant, manoeuvre, control): the name or path of the plant, the name of
        the manoeuvre, and whether the damping was on.

    Raises:
        DrivelineError: two plants or two manoeuvres have the same name, and what `simulate` raises.
    """
    by_name: dict[str, Manoeuvre] = {}
    for manoeuvre in manoeuvres:
        if by_name.setdefault(manoeuvre.name, manoeuvre) is not manoeuvre:
            raise DrivelineError(f"two manoeuvres are called {manoeuvre.name}; rename one")
    todo = cases([str(plant) for plant in plants], list(by_name))
    one = partial(_metrics, manoeuvres=by_name, settings=settings)
    return dict(zip(todo, run_many(one, todo, label="comparing"), strict=True))


def _metrics(case: Case, manoeuvres: Mapping[str, Manoeuvre], settings: Mapping[str, Any]) -> Metrics:
    manoeuvre = manoeuvres[case.manoeuvre]
    return evaluate(simulate(manoeuvre, case.plant, control=case.control, **settings), manoeuvre)
