"""Every controller through the same manoeuvres, with noise that no tuning has seen."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import product
from math import inf, isnan, nan
from typing import NamedTuple

import numpy as np

from driveline.harness.design.design_trials import mean
from driveline.harness.design.search.tuning_runs import HELD_OUT_SEEDS
from driveline.harness.loop.places import COMPARATORS, PLACES, PLANTS
from driveline.harness.manoeuvres.catalogue import KMH, MANOEUVRES, step
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.simulation.simulate import simulate
from driveline.harness.studies.robustness import outcome

from .study import Cell, Column, Measured, Study, Table, cell, number

OURS = PLACES["controller"][0]
SHOWN = {metric.name: metric.column for metric in declared(Metrics) if metric.column} | outcome.SHOWN

MARK = "TrueMotion"
"""No product: it sees the true motion."""

CONTROLLERS = (OURS, *COMPARATORS)
DRIVEN = ("tipin15", "tipin50", "tipin0", "tipout", "launch", "tipin15r", "drive", "creep", "prbs")

COMPARED = ("settling_time", "overshoot", "gear_torque_rms", "jerk_rms_to_50_Hz", "crossing_time")
"""What the controllers are compared in."""

PRICES = (*COMPARED, "response_delay", "withheld_time", "stationary_torque_change", "impact_speed")
"""What being better in one of them may cost."""

RISES = (0.0, 0.04, 0.08, 0.12, 0.16, 0.2, 0.25, 0.3)
"""Times in s within which a demand rises, for the response at equal jerk."""

DEARER = 1.1
"""Over ours, from when on a metric is a price."""


class Key(NamedTuple):
    """What a row and a column of a table stand for."""

    plant: str
    manoeuvre: str
    controller: str


Found = Mapping[Key, Metrics]
"""Means over the seeds."""


def all_found(manoeuvres: Collection[str], seeds: Sequence[int] = HELD_OUT_SEEDS) -> dict[Key, Metrics]:
    """The means of all controllers on both plants."""

    def measured(run: tuple[Key, int]) -> Metrics:
        (plant, name, controller), seed = run
        return evaluate(simulate(MANOEUVRES[name], plant, controller=controller, seed=seed), MANOEUVRES[name])

    keys = [Key(*each) for each in product(PLANTS, manoeuvres, CONTROLLERS)]
    runs = list(product(keys, seeds))
    metrics = dict(zip(runs, run_many(measured, runs, label="controllers"), strict=True))
    return {key: mean([metrics[key, seed] for seed in seeds]) for key in keys}


def tables(found: Found) -> dict[str, Table]:
    """For each plant and metric a row for each manoeuvre, a column for each controller."""
    made: dict[str, Table] = {}
    for plant, metric in product(PLANTS, COMPARED):
        shown = SHOWN[metric]
        rows: dict[str, tuple[Cell, ...]] = {}
        for manoeuvre in dict.fromkeys(key.manoeuvre for key in found):
            of = [found[Key(plant, manoeuvre, controller)] for controller in CONTROLLERS]
            values = [cell(abs(getattr(each, metric)) * shown.factor) for each in of]
            if values[0] is not None:
                rows[manoeuvre] = tuple(values)
        columns = tuple(Column(name, "", shown.decimals) for name in CONTROLLERS)
        if rows:
            label = f"{plant}: {shown.plain_heading}, {shown.unit}"
            made[f"{plant}_{metric}"] = Table(label, columns, rows)
    return made


def better_table(found: Found) -> Table:
    """Where a comparator beats ours, and what is dearer there."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant, manoeuvre, name in product(PLANTS, DRIVEN, (name for name in COMPARATORS if name != MARK)):
        ours, its = found[Key(plant, manoeuvre, OURS)], found[Key(plant, manoeuvre, name)]
        gains = list(_compared(its, ours, COMPARED, below=1.0))
        if gains:
            prices = list(_compared(its, ours, PRICES, above=DEARER))
            rows[f"{plant}, {manoeuvre}, {name}"] = ("; ".join(gains), "; ".join(prices) or "none")
    return Table("plant, manoeuvre, controller", (Column("better"), Column("price")), rows)


def _compared(
    its: Metrics, ours: Metrics, names: Collection[str], below: float = 0.0, above: float = inf
) -> Iterator[str]:
    """The metrics that are less than `below` times ours, or more than `above` times, as they are shown."""
    for name in names:
        column = SHOWN[name]
        values = [abs(getattr(each, name)) * column.factor for each in (its, ours)]
        if any(map(isnan, values)):
            continue
        shown, of_ours = (number(value, Column("", "", column.decimals)) for value in values)
        if shown != of_ours and (values[0] < below * values[1] or values[0] > above * values[1]):
            yield f"{column.plain_heading} {shown} {column.unit} instead of {of_ours}"


def equal_jerk_table(seeds: Sequence[int] = HELD_OUT_SEEDS[:1]) -> Table:
    """How long the demand of a tip-in must rise for the jerk that ours has in a jump, and its response then."""

    def measured(run: tuple[str, str, float, int]) -> tuple[float, float]:
        plant, controller, rise, seed = run
        course = step("", "", 15 * KMH, -12.0, 100.0, rise)
        metrics = evaluate(simulate(course, plant, controller=controller, seed=seed), course)
        return metrics.jerk_rms_to_50_Hz, metrics.response_delay

    runs = list(product(PLANTS, CONTROLLERS, RISES, seeds))
    metrics = np.reshape(
        run_many(measured, runs, label="equal jerk"), (len(PLANTS), len(CONTROLLERS), -1, len(seeds), 2)
    )
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant, of_plant in zip(PLANTS, metrics.mean(axis=3), strict=True):
        most = of_plant[0, 0, 0]
        pairs = [_at_jerk(most, *of_controller.T) for of_controller in of_plant]
        for k, what in enumerate(("rise", "time to 90 %")):
            rows[f"{plant}: {what}, ms"] = tuple(cell(1e3 * pair[k]) for pair in pairs)
    return Table("tip-in at 15 km/h", tuple(Column(name, "", 0) for name in CONTROLLERS), rows)


def _at_jerk(most: float, jerk: np.ndarray, delay: np.ndarray) -> tuple[float, float]:
    """The shortest of RISES, between two of them by a straight line, with no more than this jerk, and the delay."""
    calm = np.flatnonzero(jerk <= most)
    if not len(calm):
        return nan, nan
    k = max(int(calm[0]), 1)
    part = float(np.clip((most - jerk[k - 1]) / (jerk[k] - jerk[k - 1]), 0.0, 1.0)) if calm[0] else 0.0
    rise, after = (float(of[k - 1] + part * (of[k] - of[k - 1])) for of in (np.array(RISES), delay))
    return rise, after


def measure() -> Measured:
    found = all_found(DRIVEN)
    return Measured({**tables(found), "equal_jerk": equal_jerk_table(), "better": better_table(found)})


def again() -> dict[str, Table]:
    return tables(all_found(["tipout"]))


STUDY = Study(
    "every controller through the same manoeuvres",
    measure,
    again,
    {f"{plant}_{metric}": ["tipout"] for plant in PLANTS for metric in COMPARED},
    HELD_OUT_SEEDS,
    seconds=60,
)
