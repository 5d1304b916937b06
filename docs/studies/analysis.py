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
    rows = zip(names, units, shown, strict=True)
    return tuple(Column(name, unit, column.decimals) for name, unit, (_, column) in rows)


def _cells(record: object) -> tuple[Cell, ...]:
    """What the columns have of it."""
    shown = ((metric.of(record), metric.column) for metric in declared(type(record)) if metric.column)
    return tuple(_any(value, column.factor) for value, column in shown)


def _any(value: float, factor: float = 1.0) -> Cell:
    """A margin: any that is infinite."""
    return "any" if value == inf else cell(factor * value)


def _mode(mode: tuple[float, float]) -> tuple[Cell, ...]:
    return (None, None) if isnan(mode[0]) else tuple(mode)


def margins_table(points: Iterable[At]) -> Table:
    """The margins at some speeds."""
    rows = {f"{at.plant}, {at.speed:g} km/h": (*_mode(at.mode), *_cells(at.margins)) for at in points}
    return Table("plant, speed", (*MODE, *_columns(Margins)), rows)


SWEPT = (*MODE, Column("gain margin", "", 1), Column("delay margin", "ms", 1), Column("M_s", "", 2))


def _swept_name(plant: str, sweep: Sweep, value: float) -> str:
    return f"{plant}, {sweep.name}, {value:.3g} {sweep.unit}"


def _swept_cells(swept: Swept) -> tuple[Cell, ...]:
    margins = swept.margins
    if margins is None:
        return *_mode(swept.mode), *("unstable",) * 3
    return *_mode(swept.mode), _any(margins.gain_margin), _any(margins.delay_margin, 1e3), margins.M_s


def poles_table(sweeps_of: Mapping[str, Mapping[str, list[Swept]]]) -> Table:
    """The least, the middle and the largest value of each sweep."""
    rows = {
        _swept_name(plant, sweep, swept.value): _swept_cells(swept)
        for plant, sweeps in sweeps_of.items()
        for sweep in SWEEPS
        for values in [sweeps[sweep.name]]
        for swept in (values[0], values[len(values) // 2], values[-1])
    }
    return Table("plant, what is another one in the car, value", SWEPT, rows)


SWINGS = (Column("N", "", 3), Column("dies away"), Column("gain margin", "", 1), Column("delay margin", "ms", 1))


def _swing_name(plant: str, amplitude: float) -> str:
    return f"{plant}, {f'{amplitude:.3g} phi_B' if isfinite(amplitude) else 'in contact'}"


def backlash_table(swings_of: Mapping[str, Iterable[Swing]]) -> Table:
    """The margins while the teeth swing."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant, swings in swings_of.items():
        for swing in swings:
            margins = (_any(swing.margins.gain_margin), _any(swing.margins.delay_margin, 1e3)) if swing.margins else ()
            row = (swing.N, "yes" if swing.stable else "no", *(margins or (None, None)))
            rows[_swing_name(plant, swing.amplitude)] = row
    return Table("plant, amplitude", SWINGS, rows)


CYCLES = (
    Column("amplitude", "phi_B", 2),
    Column("frequency", "Hz"),
    Column("N"),
    Column("lasts"),
)


def cycles_table(cycles_of: Mapping[str, Iterable[LimitCycle]]) -> Table:
    """The swings that neither grow nor die away; from those that do not last larger ones grow."""
    rows = {
        f"{plant}, {k}": (cycle.amplitude, cycle.frequency, cycle.N, "yes" if cycle.lasting else "no")
        for plant, cycles in cycles_of.items()
        for k, cycle in enumerate(cycles, 1)
    }
    return Table("plant, limit cycle", CYCLES, rows)


def estimates_table(metrics_of: Mapping[tuple[str, str], EstimateMetrics]) -> Table:
    """The error of the estimate in runs with all noise."""
    rows = {f"{plant}, {manoeuvre}": _cells(metrics) for (plant, manoeuvre), metrics in metrics_of.items()}
    return Table("plant, manoeuvre", _columns(EstimateMetrics), rows)


MOST = 12
"""Parameters that the table of sensitivities has."""


def sensitivities_table(sensitivities: Iterable[Sensitivity]) -> Table:
    """By how many % a metric changes for 1 % of a parameter."""
    headings = [m.column.plain_heading for m in declared(Metrics) if m.name in SHOWN and m.column]
    rows = {
        f"{of.parameter}, {of.plant}, {of.manoeuvre}": tuple(map(cell, of.changes.values())) for of in sensitivities
    }
    return Table("parameter, plant, manoeuvre", tuple(Column(name, "", 2, 0.05) for name in headings), rows)


def measure() -> Measured:
    analysis = analyse({plant: resolve(plant) for plant in PLANTS})
    important = most_important(analysis.sensitivities, MOST)
    ordered = [of for name in important for of in analysis.sensitivities if of.parameter == name]
    loops = {at.plant: (at.loop, at.margins) for at in analysis.at if at.speed == SPEEDS[1]}
    name = f"{OURS} at {SPEEDS[1]:g} km/h"
    return Measured(
        {
            "margins": margins_table(analysis.at),
            "poles": poles_table(analysis.swept),
            "backlash": backlash_table(analysis.swings),
            "limit_cycles": cycles_table(analysis.limit_cycles),
            "estimates": estimates_table(analysis.estimates),
            "sensitivities": sensitivities_table(ordered),
        },
        {
            "bode": bode(loops, f"{name}: loop gain"),
            "backlash": backlash(analysis.swings, f"{name}: swinging through the gap"),
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
