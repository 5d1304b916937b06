"""Every controller through the same manoeuvres, with noise that no tuning has seen."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import product
from math import inf, isnan
from typing import NamedTuple

from driveline.harness.design.search.tuning_runs import HELD_OUT_SEEDS
from driveline.harness.loop.places import COMPARATORS, PLACES, PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import planned
from driveline.harness.studies.robustness.outcome import SHOWN
from fmuloop.campaign import RunRequest
from fmuloop.many_runs import run_many
from fmuloop.results import Results

from .design_trials import mean
from .study import Cell, Column, Measured, Study, Table, cell, number

OURS = PLACES["controller"][0]
MARK = "TrueMotion"
"""No product: it sees the true motion."""

CONTROLLERS = (OURS, *COMPARATORS)
DRIVEN = ("tipin15", "tipin50", "tipin0", "tipout", "launch", "tipin15r", "drive", "creep", "prbs")

COMPARED = ("settling_time", "overshoot", "gear_torque_rms", "jerk_rms_to_50_Hz")
"""What the controllers are compared in."""

PRICES = (*COMPARED, "response_delay", "withheld_time", "stationary_torque_change", "impact_speed")
"""What being better in one of them may cost."""

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

    def needed(run: tuple[Key, int]) -> list[RunRequest]:
        (plant, name, controller), seed = run
        return [planned(MANOEUVRES[name], plant, controller=controller, seed=seed)]

    def measured(run: tuple[Key, int], results: Sequence[Results]) -> Metrics:
        return evaluate(results[0], MANOEUVRES[run[0].manoeuvre])

    keys = [Key(*combination) for combination in product(PLANTS, manoeuvres, CONTROLLERS)]
    runs = list(product(keys, seeds))
    metrics = dict(zip(runs, run_many(measured, runs, label="controllers", runs=needed), strict=True))
    return {key: mean([metrics[key, seed] for seed in seeds]) for key in keys}


def tables(metrics_of: Found) -> dict[str, Table]:
    """For each plant and metric a row for each manoeuvre, a column for each controller."""
    by_name: dict[str, Table] = {}
    for plant, metric in product(PLANTS, COMPARED):
        shown = SHOWN[metric]
        rows: dict[str, tuple[Cell, ...]] = {}
        for manoeuvre in dict.fromkeys(key.manoeuvre for key in metrics_of):
            of = [metrics_of[Key(plant, manoeuvre, controller)] for controller in CONTROLLERS]
            values = [cell(abs(getattr(metrics, metric)) * shown.factor) for metrics in of]
            if values[0] is not None:
                rows[manoeuvre] = tuple(values)
        columns = tuple(Column(name, "", shown.decimals) for name in CONTROLLERS)
        if rows:
            label = f"{plant}: {shown.plain_heading}, {shown.unit}"
            by_name[f"{plant}_{metric}"] = Table(label, columns, rows)
    return by_name


def better_table(metrics_of: Found) -> Table:
    """Where a comparator beats ours, and what is dearer there."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant, manoeuvre, name in product(PLANTS, DRIVEN, (name for name in COMPARATORS if name != MARK)):
        ours, its = metrics_of[Key(plant, manoeuvre, OURS)], metrics_of[Key(plant, manoeuvre, name)]
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
        values = [abs(getattr(metrics, name)) * column.factor for metrics in (its, ours)]
        if any(map(isnan, values)):
            continue
        shown, of_ours = (number(value, Column("", "", column.decimals)) for value in values)
        if shown != of_ours and (values[0] < below * values[1] or values[0] > above * values[1]):
            yield f"{column.plain_heading} {shown} {column.unit} instead of {of_ours}"


def measure() -> Measured:
    metrics_of = all_found(DRIVEN)
    return Measured({**tables(metrics_of), "better": better_table(metrics_of)})


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
