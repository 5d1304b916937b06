"""The tables of the calibration: symptoms, sensitivities, cars that are not known, rest and fallback."""

from collections.abc import Iterator, Mapping
from itertools import product
from typing import NamedTuple

from docs.studies.calibration import (
    CAR_DRIVEN,
    DEVIATIONS,
    DRIVEN,
    FACTOR,
    LAW,
    NOISES,
    STANDSTILL,
    STILL,
    SUSPECTS,
    Answer,
    Case,
    Given,
    another_car,
    at_rest,
    changed_law,
    deviation_name,
)
from driveline.harness.design.uncertainty_box import Deviation
from driveline.harness.loop.places import PLANTS
from driveline.harness.metrics.declaration import Column, declared
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.views.markdown import markdown_table
from driveline.harness.views.metrics_table import number

COLUMNS: dict[str, Column] = {
    metric.name: metric.column
    for metric in declared(Metrics)
    if metric.column and metric.name not in ("damping_ratio", "stationary_torque_change")
}
"""The metrics of the tables, and how they are printed."""

HEADINGS = [f"{column.plain_heading}, {column.unit}" for column in COLUMNS.values()]

LEAST = 0.05
"""Share of a metric by which it changes at least where a row tells of it."""

Found = Mapping[Case, Answer]


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


def value(found: Found, case: Case, metric: str) -> float:
    return getattr(found[case].metrics, metric)


def change(found: Found, plant: str, manoeuvre: str, metric: str, given: Given) -> float:
    return value(found, Case(plant, manoeuvre, given), metric) - value(found, Case(plant, manoeuvre), metric)


def signed(change: float, column: Column) -> str:
    """A change as a table shows it: with its sign, unless it rounds to nothing, and a digit more than the metric."""
    finer = column if column.unit == "ms" else column._replace(decimals=column.decimals + 1)
    text = number(change, finer)
    return f"+{text}" if float(text if text != "-" else 0.0) > 0.0 else text


def symptoms(found: Found) -> str:
    """What each remedy does and costs, measured."""

    def effected(effect: Effect, given: Given) -> str:
        column = COLUMNS[effect.metric]
        each = (signed(change(found, plant, effect.manoeuvre, effect.metric, given), column) for plant in PLANTS)
        return f"{column.plain_heading}, `{effect.manoeuvre}`: {'; '.join(each)} {column.unit}"

    rows = []
    for remedy in REMEDIES:
        given = changed_law(remedy.parameter)[remedy.up]
        turn = f"`{remedy.parameter}` {'x' if remedy.up else '/'} {FACTOR:g}"
        rows.append([remedy.symptom, turn, effected(remedy.does, given), effected(remedy.costs, given)])
    rows += [
        ["rattle at standstill", "`omega_still`, `T_still`", "[below](#rattle-at-standstill)", ""],
        ["fallback without a fault", "`tau`, `jump`, `g_radius`", "[below](#fallback-without-a-fault)", ""],
    ]
    return markdown_table(["symptom", "turn", "what it does", "what it costs"], rows, labels=4)


def nominal(found: Found, plant: str) -> Iterator[list[str]]:
    """Rows of the default car."""
    for manoeuvre in DRIVEN:
        case = Case(plant, manoeuvre)
        yield [manoeuvre, *(number(value(found, case, name), column) for name, column in COLUMNS.items())]


def changes(found: Found, plant: str) -> Iterator[list[str]]:
    """Rows of the parameters that matter."""
    for name, manoeuvre in product(LAW, DRIVEN):
        if matters(found, plant, manoeuvre, name):
            cells = (
                " / ".join(signed(change(found, plant, manoeuvre, m, given), column) for given in changed_law(name))
                for m, column in COLUMNS.items()
            )
            yield [f"`{name}`", manoeuvre, *cells]


def matters(found: Found, plant: str, manoeuvre: str, name: str) -> bool:
    """Whether a parameter changes some metric by more than LEAST."""
    return any(
        abs(change(found, plant, manoeuvre, metric, given)) > LEAST * abs(value(found, Case(plant, manoeuvre), metric))
        for metric in COLUMNS
        for given in changed_law(name)
    )


def without_effect(found: Found) -> str:
    """Which parameters have no row at all."""
    everywhere = list(product(PLANTS, DRIVEN))
    names = [f"`{name}`" for name in LAW if not any(matters(found, plant, m, name) for plant, m in everywhere)]
    return f"What has no row ({', '.join(names)}) stays as it is computed." if names else ""


def cars(found: Found) -> Iterator[list[str]]:
    """Rows of the cars that the controller does not know / knows."""
    each = [(plant, deviation) for plant in PLANTS for deviation in DEVIATIONS]
    for plant, deviation in each:
        for manoeuvre in CAR_DRIVEN:
            known = [Case(plant, manoeuvre, given) for given in another_car(plant, deviation)]
            cells = (" / ".join(number(value(found, c, m), column) for c in known) for m, column in COLUMNS.items())
            yield [plant, deviation_name(deviation), manoeuvre, *cells]


def unknown_and_known(found: Found, deviation: Deviation, metric: str) -> str:
    """A metric of `tipin15` with another car that the controller does not know / knows, on each of the plants."""
    column = COLUMNS[metric]
    pairs = [
        " / ".join(number(value(found, Case(plant, "tipin15", given), metric), column) for given in cars)
        for plant in PLANTS
        for cars in [another_car(plant, deviation)]
    ]
    return f"{'; '.join(pairs)} {column.unit}"


def rest(found: Found) -> str:
    """The torque that noise makes at standstill."""
    columns = [(plant, still) for plant in PLANTS for still in STILL]

    def torques(noise: float) -> Iterator[str]:
        for plant, still in columns:
            case = Case(plant, STANDSTILL.name, at_rest(noise, still))
            yield f"{value(found, case, 'added_torque_rms'):.2f}"

    headings = ["noise, rad/s", *(f"{plant}, `omega_still` {still:g}" for plant, still in columns)]
    return markdown_table(headings, ([f"{noise:g}", *torques(noise)] for noise in NOISES), labels=0)


def fallback(found: Found) -> str:
    """What leads to fallback, and what does not."""

    def shares(given: Given) -> list[str]:
        return [f"{found[Case(plant, 'drive', given)].fallback:.1%}".replace("%", " %") for plant in PLANTS]

    rows = ([suspect.what, suspect.helps, *shares(suspect.given)] for suspect in SUSPECTS)
    return markdown_table(["what is off", "what helps", *PLANTS], rows, labels=2)
