"""Response at equal jerk: any car is calm if its demand rises slowly.

The demand of a tip-in is stretched until the jerk is that which ours has in a jump; then the response is compared.
"""

from collections.abc import Sequence
from itertools import product
from math import nan

import numpy as np

from driveline.harness.design.search.tuning_runs import HELD_OUT_SEEDS
from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.catalogue import KMH, step
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.simulation.simulate import planned
from fmuloop.campaign import RunRequest
from fmuloop.many_runs import run_many
from fmuloop.results import Results

from .comparison import CONTROLLERS
from .study import Cell, Column, Measured, Study, Table, cell

RISES = (0.0, 0.04, 0.08, 0.12, 0.16, 0.2, 0.25, 0.3)
"""Times in s within which the demand rises."""

Trial = tuple[str, str, float]
"""Plant and controller by name, and the rise."""


def course(trial: Trial) -> Manoeuvre:
    return step("tip-in", "", 15 * KMH, -12.0, 100.0, trial[2])


def needed(trial: Trial) -> list[RunRequest]:
    plant, controller, _ = trial
    return [planned(course(trial), plant, controller=controller, seed=HELD_OUT_SEEDS[0])]


def measured(trial: Trial, results: Sequence[Results]) -> tuple[float, float]:
    """Rms of the jerk up to 50 Hz, m/s3, and time to 90 % in s."""
    metrics = evaluate(results[0], course(trial))
    return metrics.jerk_rms_to_50_Hz, metrics.response_delay


def at_jerk(most: float, jerk: np.ndarray, delay: np.ndarray) -> tuple[float, float]:
    """The shortest of RISES, between two of them by a straight line, with no more than this jerk, and the delay."""
    calm = np.flatnonzero(jerk <= most)
    if not len(calm):
        return nan, nan
    k = int(calm[0])
    if k == 0:
        return RISES[0], float(delay[0])
    part = (jerk[k - 1] - most) / (jerk[k - 1] - jerk[k])
    return tuple(float(of[k - 1] + part * (of[k] - of[k - 1])) for of in (np.array(RISES), delay))  # type: ignore[return-value]


def table(controllers: tuple[str, ...]) -> Table:
    trials = list(product(PLANTS, controllers, RISES))
    pairs = run_many(measured, trials, label="equal jerk", runs=needed)
    answers = np.reshape(pairs, (len(PLANTS), len(controllers), len(RISES), 2))
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant, of_plant in zip(PLANTS, answers, strict=True):
        pairs = [at_jerk(of_plant[0, 0, 0], *of_controller.T) for of_controller in of_plant]
        for what, values in zip(("rise", "time to 90 %"), zip(*pairs, strict=True), strict=True):
            rows[f"{plant}: {what}, ms"] = tuple(cell(1e3 * value) for value in values)
    return Table("tip-in at 15 km/h", tuple(Column(name, "", 0) for name in controllers), rows)


def measure() -> Measured:
    return Measured({"controllers": table(CONTROLLERS)})


STUDY = Study("response at equal jerk", measure, seeds=HELD_OUT_SEEDS[:1], seconds=10)
