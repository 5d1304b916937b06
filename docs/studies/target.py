"""Our controller in C on an emulated Cortex-M4F, beside the same C on this machine (`driveline target record`).

It needs `apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm cppcheck`.
"""

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from driveline.fmus.catalogue import CONTROLLERS
from driveline.harness.exchange.target.comparison import Comparison, compare, responses
from driveline.harness.exchange.target.controllers import programs
from driveline.harness.exchange.target.costs import Size, size_of
from driveline.harness.exchange.target.offline_cases import recorded
from driveline.harness.exchange.target.record import Record, numbers, record
from driveline.harness.loop.places import PLACES, T_S
from driveline.harness.loop.resolved import resolve
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.views.colours import BLACK, BLUE, VERMILION
from driveline.harness.views.panels import DASHED, Axis, Curve, Drawing, Panel
from fmublocks.native.statements import SINGLE
from fmublocks.target.sources import target_sources

from .study import Cell, Column, Measured, Study, Table
from .target_deviations import findings, reason

OURS = PLACES["controller"][0]

TYPICAL = "prbs"
"""The manoeuvre in which controllers are compared."""

LESS = ("NoDamping", "LinearObserver", "PaperObserver")
"""Controllers that have less under the same supervision: nothing, an estimator, and one that knows the gap."""

CASES = (
    Column("samples", "", 0),
    Column("with a differing bit", "", 0),
    Column("T_ref off by", "N.m", tolerance=0.5),
    Column("T_gear_hat off by", "N.m", tolerance=0.5),
    Column("of the allowed", "%", 0, tolerance=0.5),
    Column("largest T_ref", "N.m", 0),
    Column("instructions, mean", "", 0),
    Column("most", "", 0),
)
LOOPS = (
    Column("differing", "", 0),
    Column("T_ref off by", "N.m", tolerance=0.5),
    Column("T_gear off by", "N.m", tolerance=0.5),
    Column("rms of T_ref", "N.m", tolerance=0.5),
)
PARTS = (Column("instructions", "", 0), Column("flash", "B", 0))
COSTS = (Column("is", "", 0),)


def cases_table(comparisons: Iterable[Comparison]) -> Table:
    """Off-line, the same inputs on the target and here."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for of in comparisons:
        off = (of.samples, of.differing, of.T_ref, of.T_gear_hat, 1e2 * of.margin, of.largest)
        rows[of.case.name] = (*off, *of.instructions)
    return Table("case", CASES, rows)


def sizes(size: Size) -> dict[str, tuple[Cell, ...]]:
    """Rows of the table of costs: what the image holds."""
    whole = {f"{name}, B": (getattr(size, name),) for name in Size._fields if name != "library"}
    return {**whole, "of the C library": (", ".join(size.library),)}


def costs_table(target_record: Record, told: Mapping[str, Mapping[str, Any]]) -> Table:
    """What the controller takes."""
    rows: dict[str, tuple[Cell, ...]] = {
        "instructions in a drive, most": (told["costs"]["driven"],),
        "instructions of what is drawn, most": (told["costs"]["drawn"],),
        "stack that is used, B": (told["costs"]["stack_used"],),
        **sizes(target_record.size),
        **{f"under the timer: {name}": (value,) for name, value in told["schedule"].items()},
        "samples in all": (sum(comparison.samples for comparison in target_record.comparisons),),
    }
    return Table("what", COSTS, rows)


def parts_table(typical: Comparison, size: Size) -> Table:
    """What controllers take."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for name in LESS:
        with programs(CONTROLLERS[name]) as binaries:
            most = max(answer.count for answer in responses(binaries.target(), typical.case)[1:])
            rows[name] = most, size_of(binaries).flash
    rows[OURS] = typical.instructions[1], size.flash
    return Table("controller", PARTS, rows, f"Most instructions of a sample in {TYPICAL}.")


def deviations_table() -> Table:
    """The rules that are not kept, and why."""
    deviations = findings(target_sources(CONTROLLERS[OURS], SINGLE))
    counts = Counter((deviation.rule, deviation.file, reason(deviation)) for deviation in deviations)
    rows: dict[str, tuple[Cell, ...]] = {f"{rule} {file}": (n, why) for (rule, file, why), n in sorted(counts.items())}
    return Table("rule, file", (Column("found", "", 0), Column("why")), rows)


def torques(comparison: Comparison) -> Drawing:
    """The torque reference on the target and of the model, and their distance."""
    target, model = comparison.traces
    time = T_S * np.arange(len(target))
    both = [Curve(time, model, "double precision", BLACK), Curve(time, target, "target", BLUE, DASHED)]
    less = [Curve(time, target - model, "", VERMILION)]
    rows = [[Panel("T_ref in N·m", both)], [Panel("target less\nmodel in N·m", less)]]
    title = f"{comparison.case.name}: the C on the target, and the model"
    return Drawing(rows, Axis("time in s", (0.0, float(time[-1]))), title)


def measure() -> Measured:
    target_record = record(resolve())
    told = numbers(target_record)
    loops = {name: tuple(of.values()) for name, of in told["loops"].items()}
    typical = next(comparison for comparison in target_record.comparisons if comparison.case.name == TYPICAL)
    return Measured(
        {
            "cases": cases_table(target_record.comparisons),
            "loops": Table("manoeuvre", LOOPS, loops),
            "parts": parts_table(typical, target_record.size),
            "costs": costs_table(target_record, told),
            "deviations": deviations_table(),
        },
        {"torques": torques(typical)},
    )


SENTINEL = "tipin15"


def again() -> dict[str, Table]:
    resolved = resolve()
    own = resolved.fit.interfaces["controller"]
    inputs, outputs = ([v.name for v in own.of_causality(kind)] for kind in ("input", "output"))
    with programs(CONTROLLERS[OURS]) as binaries:
        compared = compare(binaries, recorded(MANOEUVRES[SENTINEL], resolved, inputs), outputs)
        size = size_of(binaries)
    return {"cases": cases_table([compared]), "costs": Table("what", COSTS, sizes(size))}


STUDY = Study(
    "our controller in C on an emulated Cortex-M4F, beside the same C on this machine",
    measure,
    again,
    {"cases": [SENTINEL], "costs": ["flash, B"]},
    seconds=60,
)
