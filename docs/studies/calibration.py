"""What a change of a parameter does in a drive: of the damping law, of the car behind its back, and of its sensors.

Of the default car, means over the noise of three seeds. "not told" is a controller that takes another car for the
default one, "told" one that is designed for it.
"""

from collections.abc import Collection, Iterable, Mapping
from itertools import product
from typing import NamedTuple

from driveline.harness.design.uncertainty_box import Deviation
from driveline.harness.loop.places import PLANTS
from driveline.harness.metrics.declaration import Column as MetricColumn
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics
from fmuloop.many_runs import run_many

from .calibration_cases import (
    CAR_DRIVEN,
    DEVIATIONS,
    DRIVEN,
    FACTOR,
    LAW,
    NOISES,
    SEEDS,
    STANDSTILL,
    STIFF,
    STILL,
    SUSPECTS,
    Answer,
    Case,
    Given,
    Suspect,
    another_car,
    answered,
    at_rest,
    changed_law,
    deviation_name,
    stiff_vehicle,
)
from .study import Cell, Column, Measured, Study, Table, cell

COLUMNS: dict[str, MetricColumn] = {
    metric.name: metric.column
    for metric in declared(Metrics)
    if metric.column and metric.name not in ("damping_ratio", "stationary_torque_change")
}
"""The metrics of the tables, and how they are printed."""

METRICS = tuple(Column(of.plain_heading, of.unit, of.decimals) for of in COLUMNS.values())
CHANGES = tuple(
    Column(of.plain_heading, of.unit, of.decimals + (of.unit != "ms"), tolerance=0.1) for of in COLUMNS.values()
)
"""With a digit more than the metric."""

LEAST = 0.05
"""Share of a metric by which it changes at least where a row tells of it."""


class Effect(NamedTuple):
    """A metric of a manoeuvre."""

    metric: str
    manoeuvre: str


class Remedy(NamedTuple):
    """A parameter of the law to turn for a symptom: up or down, with what it does and what it costs."""

    symptom: str
    parameter: str
    up: bool
    does: Effect
    costs: Effect


REMEDIES = (
    Remedy("overshoot, swing", "k_d", True, Effect("overshoot", "tipin15"), Effect("response_delay", "launch")),
    Remedy("overshoot alone", "omega_w", False, Effect("overshoot", "tipin15"), Effect("withheld_time", "tipin15")),
    Remedy(
        "jerk when a tip-in lands", "T_gap", False, Effect("jerk_rms", "tipin15"), Effect("response_delay", "tipout")
    ),
    Remedy(
        "jerk when a tip-in lands",
        "landing_share",
        False,
        Effect("jerk_rms", "tipin15"),
        Effect("response_delay", "tipout"),
    ),
    Remedy(
        "a jolt after landing",
        "t_return",
        True,
        Effect("gear_torque_rms", "tipin15"),
        Effect("response_delay", "tipin15"),
    ),
    Remedy(
        "clunk in a ramp",
        "landing_share",
        False,
        Effect("impact_speed", "tipin15r"),
        Effect("gear_torque_rms", "launch"),
    ),
    Remedy("clunk in a ramp", "k_gap", False, Effect("impact_speed", "tipin15r"), Effect("gear_torque_rms", "launch")),
    Remedy(
        "clunk in creeping",
        "landing_brake",
        False,
        Effect("impact_speed", "creep"),
        Effect("gear_torque_rms", "tipin15r"),
    ),
    Remedy(
        "clunk in creeping",
        "demand_lead",
        False,
        Effect("impact_speed", "creep"),
        Effect("gear_torque_rms", "tipin15r"),
    ),
    Remedy("swing in a launch", "k_gap", True, Effect("gear_torque_rms", "launch"), Effect("impact_speed", "launch")),
    Remedy("slow to pull away", "k_d", False, Effect("response_delay", "launch"), Effect("overshoot", "launch")),
    Remedy(
        "slow after letting go", "landing_share", True, Effect("response_delay", "tipout"), Effect("jerk_rms", "tipout")
    ),
    Remedy("torque withheld", "omega_w", True, Effect("withheld_time", "tipin15"), Effect("overshoot", "tipin15")),
)


WAYS = (f"/ {FACTOR:g}", f"x {FACTOR:g}")
"""In which a parameter of the law is changed."""

TOLD = ("not told", "told")


class Found:
    """Answers to cases, each found once; `of` finds many at once on all cores."""

    def __init__(self) -> None:
        self.answers: dict[Case, Answer] = {}

    def of(self, cases: Iterable[Case]) -> None:
        todo = [case for case in dict.fromkeys(cases) if case not in self.answers]
        self.answers |= zip(todo, run_many(answered, todo, label="calibration"), strict=True)

    def values(self, case: Case) -> dict[str, float]:
        """The metrics of a case, in the units of the tables."""
        return {name: column.factor * getattr(self.answers[case].metrics, name) for name, column in COLUMNS.items()}

    def changes(self, plant: str, manoeuvre: str, parameters: Given) -> dict[str, float]:
        """By how much they change where parameters are set."""
        usual, other = self.values(Case(plant, manoeuvre)), self.values(Case(plant, manoeuvre, parameters))
        return {name: other[name] - usual[name] for name in COLUMNS}

    def matters(self, plant: str, manoeuvre: str, name: str) -> bool:
        """Whether a parameter of the law changes some metric by more than LEAST."""
        usual = self.values(Case(plant, manoeuvre))
        effects = [self.changes(plant, manoeuvre, parameters) for parameters in changed_law(name)]
        return any(abs(changes[metric]) > LEAST * abs(usual[metric]) for changes in effects for metric in COLUMNS)


def _cells(values: Mapping[str, float]) -> tuple[Cell, ...]:
    return tuple(map(cell, values.values()))


def nominal_table(runs: Found, plant: str, manoeuvres: Iterable[str]) -> Table:
    """The default car."""
    rows = {name: _cells(runs.values(Case(plant, name))) for name in manoeuvres}
    return Table(f"{plant}, manoeuvre", METRICS, rows)


def changes_table(runs: Found, plant: str, pairs: Iterable[tuple[str, str]]) -> Table:
    """The parameters that matter, one at a time, by pairs of parameter and manoeuvre."""
    rows = {
        f"{name} {way}, {manoeuvre}": _cells(runs.changes(plant, manoeuvre, parameters))
        for name, manoeuvre in pairs
        if runs.matters(plant, manoeuvre, name)
        for way, parameters in zip(WAYS, changed_law(name), strict=True)
    }
    return Table(f"change on {plant}", CHANGES, rows)


def remedies_table(runs: Found, remedies: Iterable[Remedy]) -> Table:
    """What each remedy does and costs."""
    columns = tuple(
        column
        for what in ("does", "costs")
        for column in (Column(what), *(Column(f"{what}, {plant}", "", 2, tolerance=0.1) for plant in PLANTS))
    )

    def effected(effect: Effect, parameters: Given) -> tuple[Cell, ...]:
        column = COLUMNS[effect.metric]
        changes = (runs.changes(plant, effect.manoeuvre, parameters)[effect.metric] for plant in PLANTS)
        return f"{column.plain_heading}, {column.unit}, {effect.manoeuvre}", *map(cell, changes)

    rows = {}
    for remedy in remedies:
        parameters = changed_law(remedy.parameter)[remedy.up]
        row = f"{remedy.symptom}: {remedy.parameter} {WAYS[remedy.up]}"
        rows[row] = (*effected(remedy.does, parameters), *effected(remedy.costs, parameters))
    return Table("symptom: turn", columns, rows)


def cars_table(runs: Found, cars: Iterable[tuple[str, Deviation]]) -> Table:
    """Cars that the controller does not know, and knows, by pairs of plant and what is another one."""
    rows = {
        f"{plant}, {deviation_name(deviation)}, {manoeuvre}, {told}": _cells(
            runs.values(Case(plant, manoeuvre, parameters))
        )
        for plant, deviation in cars
        for manoeuvre in CAR_DRIVEN
        for told, parameters in zip(TOLD, another_car(plant, deviation), strict=True)
    }
    return Table("plant, car, manoeuvre", METRICS, rows)


def rest_table(runs: Found, noises: Iterable[float]) -> Table:
    """The torque that noise of the motor speed makes at standstill, rms."""
    cases = {f"{plant}, omega_still {still:g}": (plant, still) for plant, still in product(PLANTS, STILL)}
    rows = {
        f"{noise:g}": tuple(
            runs.answers[Case(plant, STANDSTILL.name, at_rest(noise, still))].metrics.added_torque_rms
            for plant, still in cases.values()
        )
        for noise in noises
    }
    return Table("noise, rad/s", tuple(Column(name, "N.m", 2, tolerance=0.1) for name in cases), rows)


def fallback_table(runs: Found, suspects: Iterable[Suspect]) -> Table:
    """The share of a drive in fallback, where something is off that is no fault."""
    rows = {
        suspect.what: (
            suspect.helps,
            *(1e2 * runs.answers[Case(plant, "drive", suspect.parameters)].fallback for plant in PLANTS),
        )
        for suspect in suspects
    }
    return Table("what is off", (Column("what helps"), *(Column(plant, "%", 1) for plant in PLANTS)), rows)


def cases(
    law: Collection[tuple[str, str]],
    cars: Collection[tuple[str, Deviation]],
    noises: Collection[float],
    suspects: Collection[Suspect],
    plants: Collection[str] = PLANTS,
) -> list[Case]:
    """Those of the tables."""
    usual = [Case(plant, manoeuvre) for plant in plants for _, manoeuvre in law]
    changed = [Case(plant, manoeuvre, told) for plant in plants for p, manoeuvre in law for told in changed_law(p)]
    others = [Case(plant, name, told) for plant, d in cars for told in another_car(plant, d) for name in CAR_DRIVEN]
    off = [Case(plant, "drive", suspect.parameters) for plant in PLANTS for suspect in suspects]
    still = [Case(plant, STANDSTILL.name, at_rest(*pair)) for plant in PLANTS for pair in product(noises, STILL)]
    return [*usual, *changed, *others, *off, *still]


ALL_LAW = tuple(product(LAW, DRIVEN))
ALL_CARS = tuple(product(PLANTS, DEVIATIONS))


def measure() -> Measured:
    runs = Found()
    stiff = stiff_vehicle()
    runs.of([*cases(ALL_LAW, ALL_CARS, NOISES, SUSPECTS), stiff])
    cars = cars_table(runs, ALL_CARS)
    more = f"{stiff.plant}, {deviation_name(STIFF)}, {stiff.manoeuvre}, told, k_d x {FACTOR:g}"
    tables = {
        "remedies": remedies_table(runs, REMEDIES),
        "cars": cars._replace(rows={**cars.rows, more: _cells(runs.values(stiff))}),
        "rest": rest_table(runs, NOISES),
        "fallback": fallback_table(runs, SUSPECTS),
    }
    for plant in PLANTS:
        tables[f"nominal_{plant}"] = nominal_table(runs, plant, DRIVEN)
        tables[f"changes_{plant}"] = changes_table(runs, plant, ALL_LAW)
    return Measured(tables)


SOFT = (PLANTS[0], Deviation(C=0.5))
REMEDY = REMEDIES[1]


def again() -> dict[str, Table]:
    runs, law = Found(), [("k_d", "tipin15")]
    runs.of(cases([*law, (REMEDY.parameter, "tipin15")], [SOFT], NOISES[:1], SUSPECTS[:1]))
    tables = {
        "remedies": remedies_table(runs, [REMEDY]),
        "cars": cars_table(runs, [SOFT]),
        "rest": rest_table(runs, NOISES[:1]),
        "fallback": fallback_table(runs, SUSPECTS[:1]),
    }
    for plant in PLANTS:
        tables[f"nominal_{plant}"] = nominal_table(runs, plant, ["tipin15"])
        tables[f"changes_{plant}"] = changes_table(runs, plant, law)
    return tables


STUDY = Study(
    "what to turn in a car: symptoms, sensitivities of the law, cars that are not known, rest and fallback",
    measure,
    again,
    {
        "remedies": [f"{REMEDY.symptom}: {REMEDY.parameter} {WAYS[REMEDY.up]}"],
        "cars": [f"{SOFT[0]}, {deviation_name(SOFT[1])}, tipin15, {told}" for told in TOLD],
        "rest": [f"{NOISES[0]:g}"],
        "fallback": [SUSPECTS[0].what],
        **{f"nominal_{plant}": ["tipin15"] for plant in PLANTS},
        **{f"changes_{plant}": [f"k_d {way}, tipin15" for way in WAYS] for plant in PLANTS},
    },
    SEEDS,
    seconds=30,
)
