"""What the coupling of the FMUs costs, against the loop solved as one system: errors, dead time, order, metrics.

The error of each signal at the communication step of the loop is over 0.6 s of a tip-in with damping and without
noise; dead times are those of a sine round the open loop, negative where a signal comes too early; the metrics are
those of every manoeuvre with noise.
"""

from collections.abc import Iterable, Mapping
from itertools import product

from driveline.harness.loop.places import STEP_SIZE
from fmuloop.many_runs import run_many
from fmuloop.system import Scheme

from .coupling_error import COUPLING_MANOEUVRES, PLANTS, SIGNALS, STEPS, Comparison, compare
from .dead_time import SECTIONS, dead_times
from .step_dependence import CASES, Case, deviations_of
from .study import Cell, Column, Measured, Study, Table, cell

ERRORS = tuple(Column(name, "%", tolerance=0.05) for name in SIGNALS)
ORDERS = (*(Column(f"{1e3 * step:g} ms", "%", tolerance=0.05) for step in STEPS), Column("order", "", 1))
DEAD_TIMES = tuple(Column(section.name, "ms", 2) for section in SECTIONS)
METRICS = tuple(
    column
    for damping in ("without damping", "with damping")
    for column in (Column(damping, "%", tolerance=0.2), Column(f"worst {damping}"))
)

Coupling = tuple[Scheme, float]
"""Scheme and communication step in s."""


def errors_table(comparisons: Iterable[Comparison]) -> Table:
    """The largest errors at the communication step of the loop."""
    rows = {str(c): tuple(1e2 * c.deviations[STEP_SIZE][name].largest for name in SIGNALS) for c in comparisons}
    return Table("plant, tip-in, scheme", ERRORS, rows, "The largest distance, over the range of the signal.")


def orders_table(comparisons: Iterable[Comparison]) -> Table:
    """How the error of the gear torque falls with the communication step."""
    rows = {
        str(c): (*(1e2 * of["plant.T_gear"].rms for of in c.deviations.values()), c.order("plant.T_gear"))
        for c in comparisons
    }
    return Table("plant, tip-in, scheme", ORDERS, rows, "Rms of the error of T_gear, over its range.")


def dead_times_table(couplings: Iterable[Coupling]) -> Table:
    """What is added to each connection, and around the loop."""
    todo = list(couplings)
    times = run_many(lambda pair: dead_times(*pair), todo, label="dead times")
    rows = {
        f"{scheme.value}, {1e3 * step:g} ms": tuple(1e3 * late[column.name] for column in DEAD_TIMES)
        for (scheme, step), late in zip(todo, times, strict=True)
    }
    return Table("scheme, communication step", DEAD_TIMES, rows)


def metrics_table(cases: Iterable[Case]) -> Table:
    """Of all metrics that a run has, the one that depends on the communication step most."""
    todo = list(cases)
    deviations = dict(zip(todo, run_many(deviations_of, todo, label="communication steps"), strict=True))
    rows = {
        f"{case.plant}, {case.manoeuvre}": (*_worst(deviations[case]), *_worst(deviations[case._replace(control=True)]))
        for case in todo
        if not case.control
    }
    return Table("plant, manoeuvre", METRICS, rows)


def _worst(deviations: Mapping[str, float]) -> tuple[Cell, Cell]:
    name = max(deviations, key=deviations.__getitem__)
    return cell(1e2 * deviations[name]), name.replace("_", " ")


def measure() -> Measured:
    cases = list(product(PLANTS, COUPLING_MANOEUVRES, Scheme))
    comparisons = run_many(lambda case: compare(*case), cases, label="coupling errors")
    return Measured(
        {
            "dead_times": dead_times_table(product(Scheme, (STEP_SIZE, 0.5 * STEP_SIZE))),
            "errors": errors_table(comparisons),
            "orders": orders_table(comparisons),
            "metrics": metrics_table(CASES),
        }
    )


def again() -> dict[str, Table]:
    plant = next(iter(PLANTS))
    comparisons = [compare(plant, COUPLING_MANOEUVRES[0], Scheme.PROPAGATED)]
    return {
        "dead_times": dead_times_table([(Scheme.JACOBI, STEP_SIZE)]),
        "errors": errors_table(comparisons),
        "orders": orders_table(comparisons),
        "metrics": metrics_table(Case(plant, "tipin15", control) for control in (False, True)),
    }


PROPAGATED = ("TwoMassDriveline, in contact, propagated",)

STUDY = Study(
    "what co-simulation does to the loop: its errors, its dead time, its metrics",
    measure,
    again,
    {
        "dead_times": ("jacobi, 1 ms",),
        "errors": PROPAGATED,
        "orders": PROPAGATED,
        "metrics": ("TwoMassDriveline, tipin15",),
    },
    seconds=20,
)
