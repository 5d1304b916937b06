"""docs/comparison.md, every controller through the same manoeuvres."""

from collections.abc import Collection, Iterator, Mapping
from itertools import product
from math import inf, isnan
from pathlib import Path
from typing import NamedTuple

from driveline.harness.design.design_trials import mean
from driveline.harness.design.search.tuning_runs import HELD_OUT_SEEDS
from driveline.harness.loop.places import COMPARATORS, PLACES, PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.declaration import Metric, declared
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.simulation.simulate import simulate
from driveline.harness.studies.robustness.outcome import SHOWN
from driveline.harness.views.markdown import markdown_table
from driveline.harness.views.metrics_table import number

OURS = PLACES["controller"][0]
MARK = "PerfectState"
"""No product: it sees the true motion."""

DRIVEN = ("tipin15", "tipin50", "tipin0", "tipout", "launch", "tipin15r", "drive", "creep", "prbs")

COMPARED = ("settling_time", "overshoot", "gear_torque_rms", "jerk_rms_to_50_Hz")
"""What the controllers are compared in."""

PRICES = (*COMPARED, "response_delay", "withheld_time", "stationary_torque_change", "impact_speed")
"""What being better in one of them may cost."""

DEARER = 1.1
"""Over ours, from when on a metric is a price."""

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")

PLANT = Path(__file__).with_name("comparison_page_plant.md").read_text(encoding="utf-8")


class Key(NamedTuple):
    """What a row and a column of a table stand for."""

    plant: str
    manoeuvre: str
    controller: str


KEYS = [
    Key(plant, manoeuvre, controller) for plant in PLANTS for manoeuvre in DRIVEN for controller in (OURS, *COMPARATORS)
]

Found = Mapping[Key, Metrics]
"""Means over the seeds."""


def measured(run: tuple[Key, int]) -> Metrics:
    """The metrics of a run with a seed."""
    (plant, name, controller), seed = run
    return evaluate(simulate(MANOEUVRES[name], plant, controller=controller, seed=seed), MANOEUVRES[name])


def page(found: Found) -> str:
    """The page as Markdown."""
    plants = "\n".join(_plant(plant, found) for plant in PLANTS).rstrip()
    return PAGE.format(seeds=", ".join(map(str, HELD_OUT_SEEDS)), mark=MARK, plants=plants)


def _plant(plant: str, found: Found) -> str:
    tables = "\n\n".join(_table(plant, metric, found) for metric in _metrics(COMPARED))
    better = "\n".join(_better(plant, found)) or "- nowhere"
    return PLANT.format(plant=plant, tables=tables, better=better)


def _table(plant: str, metric: Metric, found: Found) -> str:
    column = SHOWN[metric.name]
    headings = [f"{column.plain_heading}, {column.unit}", *(f"`{name}`" for name in (OURS, *COMPARATORS))]
    return markdown_table(headings, _rows(plant, metric, found), labels=1)


def _rows(plant: str, metric: Metric, found: Found) -> Iterator[list[str]]:
    for manoeuvre in DRIVEN:
        values = {name: abs(metric.of(found[Key(plant, manoeuvre, name)])) for name in (OURS, *COMPARATORS)}
        if isnan(values[OURS]):
            continue
        best = min(value for name, value in values.items() if name != MARK and not isnan(value))
        cells = ((name != MARK and value == best, number(value, SHOWN[metric.name])) for name, value in values.items())
        yield [manoeuvre, *(f"**{cell}**" if bold else cell for bold, cell in cells)]


def _better(plant: str, found: Found) -> Iterator[str]:
    """A line for each comparator that beats ours in a manoeuvre, with what is dearer in the same one."""
    others = [name for name in COMPARATORS if name != MARK]
    for manoeuvre, name in product(DRIVEN, others):
        ours, its = found[Key(plant, manoeuvre, OURS)], found[Key(plant, manoeuvre, name)]
        gains = list(_summary(its, ours, COMPARED, below=1.0))
        if gains:
            prices = list(_summary(its, ours, PRICES, above=DEARER))
            yield f"- {manoeuvre}, `{name}`: {', '.join(gains)}; price: {', '.join(prices) or 'none of these metrics'}"


def _summary(
    its: Metrics, ours: Metrics, names: Collection[str], below: float = 0.0, above: float = inf
) -> Iterator[str]:
    """The metrics that are less than `below` times ours, or more than `above` times, as they are shown."""
    for metric in _metrics(names):
        column = SHOWN[metric.name]
        value, other = abs(metric.of(its)), abs(metric.of(ours))
        shown, of_ours = number(value, column), number(other, column)
        if shown != of_ours and (value < below * other or value > above * other):
            yield f"{column.plain_heading} {shown} {column.unit} instead of {of_ours}"


def _metrics(names: Collection[str]) -> list[Metric]:
    return [metric for metric in declared(Metrics) if metric.name in names]


def make(folder: Path) -> None:
    runs = [(key, seed) for key in KEYS for seed in HELD_OUT_SEEDS]
    metrics = dict(zip(runs, run_many(measured, runs), strict=True))
    found = {key: mean([metrics[key, seed] for seed in HELD_OUT_SEEDS]) for key in KEYS}
    (folder / "comparison.md").write_text(page(found), encoding="utf-8")
