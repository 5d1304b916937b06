"""What no controller can beat: the best torque with full knowledge of car, state and demand, on the design model.

It answers the driver as the controller does: 90 % of the way at the same sample, no more torque withheld, settled no
later, within the same limits. The worst of four ratios to what the controller reaches is made as small as it can be;
a lower bound follows by duality, and the nonlinear design model verifies every optimum. docs/loop.md says what is
proven.

    python -m docs.studies bound                                  # all manoeuvres; each takes some minutes on a core
    python -m docs.studies bound --manoeuvre tipin15
    python -m docs.studies bound --parameters my_gains.toml --figure mine
    python -m docs.studies bound --controller SpeedWashout --json > bound.json

The car is first linear along the run of the controller, then along the best torque that was found so.
"""

import argparse
import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from driveline.fmus.building.parameter_files import read_files
from driveline.harness.design.loop_parameters import loop_parameters
from driveline.harness.loop.built_fmus import built
from driveline.harness.loop.places import BUILD, PLACES, PLANTS, T_S
from driveline.harness.loop.settings import Settings, loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.declaration import Column as metric_column
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.evaluate import at_samples, evaluate
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import simulate, start
from driveline.harness.studies.margins.linear_plant import NOISELESS
from driveline.harness.views.colours import BLACK, BLUE, GREY, VERMILION
from driveline.harness.views.figure_style import draw
from driveline.harness.views.metrics_table import values
from driveline.harness.views.panels import DASHED, Axis, Curve, Drawing, Panel
from driveline.models.controller.supervision import Parameters
from fmuloop.many_runs import run_many
from fmuloop.parameter_changes import require_constant
from fmuloop.wiring import fit

from .optimal_torque.contacts import PARTS, Contacts
from .optimal_torque.linear_car import linear_car
from .optimal_torque.linear_prediction import value
from .optimal_torque.open_loop_run import open_loop_run
from .optimal_torque.programme import Solution
from .optimal_torque.switching_search import FINE, Search
from .optimal_torque.task import BOUNDED, Task, task
from .study import Cell, Column, Measured, Study, Table
from .terminal import show

BOUNDED_MANOEUVRES = ("tipin15", "tipin50", "tipin0", "tipout", "launch")
"""Steps, and a steep ramp, in which the teeth leave their flank at most once."""

PLANT, OURS = PLANTS[0], PLACES["controller"][0]
"""The design model: tyres, ripple and differential of the other one are not linear for given contacts."""

ALONE = ("gear_torque_rms", "jerk_rms_to_50_Hz", "impact_speed")
"""Metrics that are also made as small as possible alone; overshoot alone can be avoided."""


class Optimum(NamedTuple):
    """The best torque for some metrics, and what the nonlinear design model makes of it.

    Attributes:
        contacts: of the teeth.
        solution: of the convex programme.
        results, metrics: of the run that verifies it.
        deviation: largest difference in N.m of T_gear between that run and the programme.
    """

    contacts: Contacts
    solution: Solution
    results: np.ndarray
    metrics: Metrics
    deviation: float


class Bounded(NamedTuple):
    """A manoeuvre.

    Attributes:
        jointly: the smallest worst ratio of all metrics.
        bound: no torque reference has a smaller one for contacts that were looked at.
        neighbours: how many those are.
        alone: by metric, how small it can be with the others no worse than those of the controller.
    """

    task: Task
    jointly: Optimum
    bound: float
    neighbours: int
    alone: Mapping[str, Optimum]

    def ratio(self, optimum: Optimum) -> float:
        """The worst of the metrics of a verified optimum over those that are reached."""
        return max(getattr(optimum.metrics, n) / getattr(self.task.reached, n) for n in self.task.metrics)


class Quiet(NamedTuple):
    """A loop without noise, and a manoeuvre of it.

    Attributes:
        of_car: parameters of plant and motor, `instance.name` -> value.
    """

    settings: Settings
    task: Task
    of_car: Mapping[str, float]


def quiet_run(name: str, settings: Settings) -> Quiet:
    """What is bounded of a manoeuvre for a controller.

    Raises:
        SimulationError: the run of the controller lacks a metric.
    """
    manoeuvre = MANOEUVRES[name]
    require_constant(settings.parameters, "a bound")
    quiet = settings.with_parameters({f"motor.{n}": v for n, v in NOISELESS.items()})
    blocks = fit(loop(quiet)).parameters({**start(manoeuvre), **quiet.parameters})
    limits = {name: value for name, value in blocks["controller"].items() if name in Parameters._fields}
    quiet_task = task(manoeuvre, simulate(manoeuvre, quiet), Parameters(**limits))
    of_car = {f"{place}.{name}": value for place in ("plant", "motor") for name, value in blocks[place].items()}
    return Quiet(quiet, quiet_task, of_car)


def bounded(name: str, settings: Settings) -> Bounded:
    """The bounds of a manoeuvre for a controller.

    Args:
        name: of the manoeuvre.
        settings: of the loop with the design model, PLANT.

    Raises:
        SimulationError: the run of the controller lacks a metric.
    """
    quiet, task, of_car = quiet_run(name, settings)
    search = Search(task, linear_car(task.results, of_car, task.first), task.metrics)
    contacts = search.descend(task.contacts)
    first = _verified(search, contacts, search.solve(contacts), quiet)

    car = linear_car(first.results, of_car, task.first)
    search = Search(task, car, task.metrics)
    surroundings = search.surround(contacts)
    best = min(surroundings, key=lambda neighbour: neighbour.solution.ratio)
    jointly = _verified(search, best.contacts, best.solution, quiet)

    alone = {}
    for metric in (name for name in ALONE if name in task.metrics):
        search = Search(task, car, (metric,))
        contacts = search.descend(best.contacts)
        alone[metric] = _verified(search, contacts, search.solve(contacts, FINE), quiet)
    return Bounded(task, jointly, min(neighbour.solution.bound for neighbour in surroundings), len(surroundings), alone)


def all_bounded(names: Sequence[str], settings: Settings) -> list[Bounded]:
    """The bounds of some manoeuvres, on all cores."""
    return run_many(lambda name: bounded(name, settings), names, label="bounding")


def _verified(search: Search, contacts: Contacts, solution: Solution, settings: Settings) -> Optimum:
    task = search.task
    results = open_loop_run(task.manoeuvre, task.reference(solution.u), settings)
    expected = value(search.predictor.predict(contacts).T_gear(np.arange(len(task.times))), solution.u)
    deviation = np.abs(expected - at_samples(results)["plant.T_gear"][task.first :]).max()
    return Optimum(contacts, solution, results, evaluate(results, task.manoeuvre), float(deviation))


COLUMNS = {metric.name: metric.column for metric in declared(Metrics) if metric.column} | {
    "gear_torque_rms": metric_column("torque\nrms", "N.m", 1.0, 2),
    "jerk_rms_to_50_Hz": metric_column("jerk\nto 50 Hz", "m/s3", 1.0, 2),
    "overshoot": metric_column("over-\nshoot", "%", 1e2, 1),
}
SHOWN = (*BOUNDED, "settling_time", "response_delay", "withheld_time")

OPTIMA = (
    Column("controller / optimum", "", 3, 0.003),
    Column("at most", "", 3, 0.003),
    Column("contacts after the step", "ms"),
    Column("looked at", "", 0, 1.0),
    Column("deviation", "N.m", 4, 1.0),
)
METRICS = tuple(Column(COLUMNS[name].plain_heading, COLUMNS[name].unit, COLUMNS[name].decimals) for name in SHOWN)

AFTER = Axis("time after the step in ms", (-10.0, 250.0))


def _times(contacts: Contacts) -> str:
    """Of the changes, in ms after the step."""
    return " / ".join(f"{1e3 * T_S * (1.0 + end / PARTS):g}" for end in contacts.ends)


def _metrics(of: Metrics) -> tuple[Cell, ...]:
    return tuple(float(getattr(of, name)) * COLUMNS[name].factor for name in SHOWN)


def controller_rows(tasks: Iterable[Task]) -> dict[str, Table]:
    """What the controller does, in both tables."""
    named = {f"{task.manoeuvre.name}, controller": task for task in tasks}
    of_contacts = {name: (1.0, None, _times(task.contacts), None, None) for name, task in named.items()}
    return {
        "optima": Table("manoeuvre, torque", OPTIMA, of_contacts),
        "metrics": Table("manoeuvre, torque", METRICS, {name: _metrics(task.reached) for name, task in named.items()}),
    }


def tables(results: Sequence[Bounded]) -> dict[str, Table]:
    """What is possible in each manoeuvre, beside what the controller reaches."""
    reached = controller_rows(result.task for result in results)
    optima, metrics = (dict(reached[name].rows) for name in ("optima", "metrics"))
    for result in results:
        name, best = result.task.manoeuvre.name, result.jointly
        ratios = (1.0 / result.ratio(best), 1.0 / result.bound)
        optima[f"{name}, optimum"] = (*ratios, _times(best.contacts), result.neighbours, best.deviation)
        metrics[f"{name}, jointly"] = _metrics(best.metrics)
        for metric, optimum in result.alone.items():
            metrics[f"{name}, {COLUMNS[metric].plain_heading} alone"] = _metrics(optimum.metrics)
    rows = {"optima": optima, "metrics": metrics}
    names = [result.task.manoeuvre.name for result in results]

    def in_order(row: str) -> int:
        return names.index(row.partition(",")[0])

    return {
        of: reached[of]._replace(rows={row: rows[of][row] for row in sorted(rows[of], key=in_order)}) for of in rows
    }


def drawing(results: Sequence[Bounded], controller: str) -> Drawing:
    """The torques, a column for each manoeuvre."""
    rows = list(zip(*(_panels(result, controller) for result in results), strict=True))
    title = f"{controller} and the best that is possible, design model"
    size = 2.2 * len(results) + 1.2, 1.9
    return Drawing(rows, AFTER, title, size=size, key=min(5, 2 * len(results)), same_y=False)


def _panels(result: Bounded, controller: str) -> list[Panel]:
    task, t_0 = result.task, result.task.manoeuvre.t_0
    runs = ((task.results, controller, BLUE), (result.jointly.results, "best possible", VERMILION))
    t = at_samples(task.results, T_S)["time"]
    demand = Curve(1e3 * (t - t_0), np.asarray(task.manoeuvre.T_driver(t), float), "demand", BLACK, DASHED, 0.8, True)
    limited = 1e3 * (task.times[: len(task.lower)] - t_0)
    limits = [Curve(limited, limit, "limits", GREY, width=0.8, held=True) for limit in (task.lower, task.upper)]

    def curves(column: str, held: bool) -> list[Curve]:
        sampled = ((at_samples(results, T_S), name, color) for results, name, color in runs)
        return [Curve(1e3 * (of["time"] - t_0), of[column], name, color, held=held) for of, name, color in sampled]

    heading = f"{task.manoeuvre.name}\n{1.0 / result.ratio(result.jointly):.2f} times the optimum"
    return [
        Panel("torque reference\nin N·m", [*limits, *curves("controller.T_ref", True), demand], heading),
        Panel("gear torque\nin N·m", [*curves("plant.T_gear", False), demand]),
    ]


def record(result: Bounded) -> dict[str, Any]:
    """All that was found for a manoeuvre, in SI units."""

    def told(contacts: Contacts, metrics: Metrics) -> dict[str, Any]:
        return {"contacts_s": [T_S * (1.0 + end / PARTS) for end in contacts.ends], **values(metrics)}

    def optimum(of: Optimum) -> dict[str, Any]:
        return {**told(of.contacts, of.metrics), "deviation_N_m": of.deviation}

    return {
        "manoeuvre": result.task.manoeuvre.name,
        "controller": told(result.task.contacts, result.task.reached),
        "jointly": {**optimum(result.jointly), "ratio": result.ratio(result.jointly), "bound": result.bound},
        "neighbours": result.neighbours,
        "alone": {name: optimum(best) for name, best in result.alone.items()},
    }


def measure() -> Measured:
    results = all_bounded(BOUNDED_MANOEUVRES, Settings())
    return Measured(tables(results), {"torques": drawing(results, OURS)})


def again() -> dict[str, Table]:
    return controller_rows(quiet_run(name, Settings()).task for name in BOUNDED_MANOEUVRES)


def explore(arguments: Sequence[str]) -> None:
    parser = argparse.ArgumentParser(
        prog="python -m docs.studies bound", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--manoeuvre", action="append", choices=BOUNDED_MANOEUVRES, help="only this one (repeatable)")
    parser.add_argument("--controller", choices=PLACES["controller"], default=OURS)
    parser.add_argument("--vehicle", type=Path, metavar="FILE.toml", help="what belongs to the car")
    parser.add_argument("--parameters", type=Path, metavar="FILE.toml", help="of the controller")
    parser.add_argument("--fmus", type=Path, default=BUILD, metavar="FOLDER", help="of the FMUs (default: %(default)s)")
    parser.add_argument("--figure", type=Path, metavar="FILE", help="draws the torques; without an ending")
    parser.add_argument("--json", action="store_true", help="all numbers, in SI units, instead of the tables")
    args = parser.parse_args(arguments)
    parameters = loop_parameters(read_files(args.vehicle, args.parameters), PLANT, args.controller)
    settings = built(PLANT, folder=args.fmus, controller=args.controller).replace(parameters=parameters)
    results = all_bounded(list(dict.fromkeys(args.manoeuvre or BOUNDED_MANOEUVRES)), settings)
    if args.figure:
        draw(drawing(results, args.controller), args.figure)
    if args.json:
        print(json.dumps([record(result) for result in results], indent=2))
    else:
        for name, table in tables(results).items():
            show(name, table)


SENTINELS = [f"{name}, controller" for name in BOUNDED_MANOEUVRES]

STUDY = Study(
    "what no controller can beat, beside what ours reaches",
    measure,
    again,
    {"optima": SENTINELS, "metrics": SENTINELS},
    explore=explore,
    seconds=1800,
)
