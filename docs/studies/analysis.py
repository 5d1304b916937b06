"""The loop with our controller: margins, poles as the car changes, backlash, error of the estimate, sensitivities.

It is linear while the teeth stay on one flank, at 15 km/h where no speed is told. What `driveline analyse` finds.
"""

from collections.abc import Iterable, Mapping
from math import inf, isfinite, isnan

from driveline.harness.loop.places import PLACES, PLANTS
from driveline.harness.loop.resolved import resolve
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.estimate import EstimateMetrics
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.studies.margins.describing_function import AMPLITUDES, LimitCycle, Swing, Swinging
from driveline.harness.studies.margins.linear_figures import backlash, bode
from driveline.harness.studies.margins.loop_analysis import (
    FACTORS,
    SPEEDS,
    At,
    Part,
    Run,
    analyse,
    linear_part,
    point_of,
    run_of,
)
from driveline.harness.studies.margins.margins import Margins
from driveline.harness.studies.margins.parameter_sweeps import SWEEPS, Sweep, Swept, swept
from driveline.harness.studies.margins.sensitivity import SHOWN, Sensitivity, most_important, sensitivity, varied

from .study import Cell, Column, Measured, Study, Table, cell

OURS = PLACES["controller"][0]

MODE = (Column("drive train", "Hz", 1), Column("damping ratio", "", 2))


def _columns(record: type) -> tuple[Column, ...]:
    """Those of the metrics of a record; two frequencies are told apart by what they are of."""
    shown = [(metric, metric.column) for metric in declared(record) if metric.column]
    names = [
        metric.name.replace("_", " ") if column.plain_heading == "at" else column.plain_heading
        for metric, column in shown
    ]
    units = ("" if column.unit == "1" else column.unit for _, column in shown)
    each = zip(names, units, shown, strict=True)
    return tuple(Column(name, unit, column.decimals) for name, unit, (_, column) in each)


def _cells(record: object) -> tuple[Cell, ...]:
    """What the columns have of it."""
    shown = ((metric.of(record), metric.column) for metric in declared(type(record)) if metric.column)
    return tuple(_any(value, column.factor) for value, column in shown)


def _any(value: float, factor: float = 1.0) -> Cell:
    """A margin: any that is infinite."""
    return "any" if value == inf else cell(factor * value)


def _mode(mode: tuple[float, float]) -> tuple[Cell, ...]:
    return (None, None) if isnan(mode[0]) else tuple(mode)


def margins_table(found: Iterable[At]) -> Table:
    """The margins at some speeds."""
    rows = {f"{at.plant}, {at.speed:g} km/h": (*_mode(at.mode), *_cells(at.margins)) for at in found}
    return Table("plant, speed", (*MODE, *_columns(Margins)), rows)


SWEPT = (*MODE, Column("gain margin", "", 1), Column("delay margin", "ms", 1), Column("M_s", "", 2))


def _swept_name(plant: str, sweep: Sweep, value: float) -> str:
    return f"{plant}, {sweep.name}, {value:.3g} {sweep.unit}"


def _swept_cells(found: Swept) -> tuple[Cell, ...]:
    margins = found.margins
    if margins is None:
        return *_mode(found.mode), *("unstable",) * 3
    return *_mode(found.mode), _any(margins.gain_margin), _any(margins.delay_margin, 1e3), margins.M_s


def poles_table(found: Mapping[str, Mapping[str, list[Swept]]]) -> Table:
    """The least, the middle and the largest value of each sweep."""
    rows = {
        _swept_name(plant, sweep, each.value): _swept_cells(each)
        for plant, sweeps in found.items()
        for sweep in SWEEPS
        for values in [sweeps[sweep.name]]
        for each in (values[0], values[len(values) // 2], values[-1])
    }
    return Table("plant, what is another one in the car, value", SWEPT, rows)


SWINGS = (Column("N", "", 3), Column("dies away"), Column("gain margin", "", 1), Column("delay margin", "ms", 1))


def _swing_name(plant: str, amplitude: float) -> str:
    return f"{plant}, {f'{amplitude:.3g} phi_B' if isfinite(amplitude) else 'in contact'}"


def backlash_table(found: Mapping[str, Iterable[Swing]]) -> Table:
    """The margins while the teeth swing."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant, swings in found.items():
        for each in swings:
            margins = (_any(each.margins.gain_margin), _any(each.margins.delay_margin, 1e3)) if each.margins else ()
            row = (each.N, "yes" if each.stable else "no", *(margins or (None, None)))
            rows[_swing_name(plant, each.amplitude)] = row
    return Table("plant, amplitude", SWINGS, rows)


CYCLES = (
    Column("amplitude", "phi_B", 2),
    Column("frequency", "Hz"),
    Column("N"),
    Column("lasts"),
)


def cycles_table(found: Mapping[str, Iterable[LimitCycle]]) -> Table:
    """The swings that neither grow nor die away; from those that do not last larger ones grow."""
    rows = {
        f"{plant}, {k}": (each.amplitude, each.frequency, each.N, "yes" if each.lasting else "no")
        for plant, cycles in found.items()
        for k, each in enumerate(cycles, 1)
    }
    return Table("plant, limit cycle", CYCLES, rows)


def estimates_table(found: Mapping[tuple[str, str], EstimateMetrics]) -> Table:
    """The error of the estimate in runs with all noise."""
    rows = {f"{plant}, {manoeuvre}": _cells(metrics) for (plant, manoeuvre), metrics in found.items()}
    return Table("plant, manoeuvre", _columns(EstimateMetrics), rows)


MOST = 12
"""Parameters that the table of sensitivities has."""


def sensitivities_table(found: Iterable[Sensitivity]) -> Table:
    """By how many % a metric changes for 1 % of a parameter."""
    headings = [m.column.plain_heading for m in declared(Metrics) if m.name in SHOWN and m.column]
    rows = {
        f"{each.parameter}, {each.plant}, {each.manoeuvre}": tuple(map(cell, each.changes.values())) for each in found
    }
    return Table("parameter, plant, manoeuvre", tuple(Column(name, "", 2, 0.05) for name in headings), rows)


def measure() -> Measured:
    found = analyse({plant: resolve(plant) for plant in PLANTS})
    important = most_important(found.sensitivities, MOST)
    ordered = [each for name in important for each in found.sensitivities if each.parameter == name]
    loops = {at.plant: (at.loop, at.margins) for at in found.at if at.speed == SPEEDS[1]}
    name = f"{OURS} at {SPEEDS[1]:g} km/h"
    return Measured(
        {
            "margins": margins_table(found.at),
            "poles": poles_table(found.swept),
            "backlash": backlash_table(found.swings),
            "limit_cycles": cycles_table(found.limit_cycles),
            "estimates": estimates_table(found.estimates),
            "sensitivities": sensitivities_table(ordered),
        },
        {
            "bode": bode(loops, f"{name}: loop gain"),
            "backlash": backlash(found.swings, f"{name}: swinging through the gap"),
        },
    )


PLANT, SWEEP, AMPLITUDE = PLANTS[0], SWEEPS[1], float(AMPLITUDES[10])
SENSITIVE = "controller.k_d"


def again() -> dict[str, Table]:
    parameters = {PLANT: {}}
    point, loops = point_of(PLANT, OURS, {}), {PLANT: resolve(PLANT)}
    value = varied(PLANT, OURS, {})[SENSITIVE]
    runs = [Run(PLANT, "tipin15", SENSITIVE, factor * value) for factor in FACTORS]
    (nominal, estimate), small, large = (run_of(run, loops) for run in (Run(PLANT, "tipin15"), *runs))
    (soft,) = swept(point, SWEEP._replace(values=SWEEP.values[:1]))
    return {
        "margins": margins_table([linear_part(Part(PLANT, f"{SPEEDS[1]:g}"), OURS, parameters)]),
        "poles": Table("", SWEPT, {_swept_name(PLANT, SWEEP, soft.value): _swept_cells(soft)}),
        "backlash": backlash_table({PLANT: [Swinging(point).swing(AMPLITUDE)]}),
        "estimates": estimates_table({(PLANT, "tipin15"): estimate}),
        "sensitivities": sensitivities_table([sensitivity(PLANT, "tipin15", SENSITIVE, (small[0], nominal, large[0]))]),
    }


STUDY = Study(
    "margins, poles, backlash, error of the estimate and sensitivities of the loop",
    measure,
    again,
    {
        "margins": [f"{PLANT}, {SPEEDS[1]:g} km/h"],
        "poles": [_swept_name(PLANT, SWEEP, SWEEP.values[0])],
        "backlash": [_swing_name(PLANT, AMPLITUDE)],
        "estimates": [f"{PLANT}, tipin15"],
        "sensitivities": [f"{SENSITIVE}, {PLANT}, tipin15"],
    },
    seconds=60,
)
