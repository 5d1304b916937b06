"""What an identification is worth: accuracy, intervals, the detailed vehicle, bad data, foreign loops, redesign."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from docs.studies.foreign_loop import CARS, Loop
from docs.studies.identification_accuracy import (
    DESIGN_MODEL,
    KNOWN,
    TRAPS,
    VEHICLE,
    Found,
    Judged,
    Method,
    Redesigned,
    accuracy,
    both_methods,
    foreign,
    from_random_starts,
    judged,
    redesigned,
    trapped,
)
from driveline.harness.design.design_weights import MOTOR
from driveline.harness.identification.quality import Z_95
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.studies.robustness.draws import draw

from .study import Column, Measured, Study, Table, table_of

FIRST = 101
"""Seed of the first recording; none of these was used in development."""

KNOWN_J_1, FREE_J_1, STARTS, OF_A_TRAP, VEHICLES, METHODS = 60, 20, 40, 5, 5, 3
DRAWS = {DESIGN_MODEL: 18, VEHICLE: 7}
"""How many recordings of each."""

DRAWN = 9
"""Seed of the random cars."""

LOOPS = {
    "aligned, mean of the motor torque": Loop("averaged"),
    "motor first": Loop("motor first"),
    "car first, samples of 1 ms": Loop("plant first", T_s=0.001),
    "motor speed 1 ms late": Loop("averaged", late_omega=0.001),
    "motor first, motor speed 1 ms late, samples of 2.5 ms": Loop("motor first", T_s=0.0025, late_omega=0.001),
    "car first, load held, motor speed 1.8 ms late": Loop("plant first", load_held=True, late_omega=0.0018),
    "load torque 1.5 ms late": Loop("averaged", late_T_load=0.0015),
    "motor first, both torques 2 ms late, samples of 4 ms": Loop(
        "motor first", T_s=0.004, late_T_mot=0.002, late_T_load=0.002
    ),
}
"""Loops that are not ours, of three cars each."""

TYRES = {"spring": (0, 2), "damper": (1,)}
"""Numbers of the cars by what their tyre mostly is at 8 Hz."""

OF_A_LOOP = 2
"""Recordings of each car."""

RIGHT = {"J_2": 0.004, "C": 0.001, "phi_B": 0.0035}
"""Relative error below which a search from a wide start has found the right optimum."""

TRUE = {**KNOWN._asdict(), "tau": MOTOR.tau}

WORSE = 0.05
"""By which a redesigned controller may be worse at most."""


def accuracy_tables() -> dict[str, Table]:
    seeds = range(FIRST, FIRST + KNOWN_J_1)
    known = run_many(accuracy, [(seed, ()) for seed in seeds], label="accuracy")
    free = run_many(accuracy, [(seed, ("J_1",)) for seed in seeds[:FREE_J_1]], label="accuracy with J_1 free")
    starts = run_many(from_random_starts, range(FIRST, FIRST + STARTS), label="wide starts")
    right = sum(all(abs(_off(found, name)) < limit for name, limit in RIGHT.items()) for found in starts)
    count = {
        "recordings": (len(known),),
        "with J_1 free": (len(free),),
        "wide starts": (len(starts),),
        "wide starts that find the right optimum": (right,),
    }
    return {
        "accuracy": _accuracy(known, free),
        "count": Table("", (Column("count", decimals=0),), count),
        "recordings": recordings_table(dict(zip(seeds[:5], known[:5], strict=True))),
    }


def recordings_table(found: Mapping[int, Found]) -> Table:
    """What single recordings of the design model gave, by their seeds."""
    names = {"J_2": "kg.m2", "C": "N.m/rad", "phi_B": "rad", "tau": "s"}
    columns = tuple(Column(name, unit, tolerance=0.005) for name, unit in names.items())
    return Table("seed", columns, {str(seed): tuple(of.values[name] for name in names) for seed, of in found.items()})


def vehicle_table() -> Table:
    cases = [(FIRST + n, load) for load in (True, False) for n in range(VEHICLES)]
    found = run_many(judged, cases, label="vehicle")
    return _vehicle(found[:VEHICLES], found[VEHICLES:])._replace(note=f"{VEHICLES} recordings each.")


def traps_table() -> Table:
    cases = [(k, FIRST + n) for k in range(len(TRAPS)) for n in range(OF_A_TRAP)]
    found = run_many(trapped, cases, label="bad data")
    traps = _traps([found[k : k + OF_A_TRAP] for k in range(0, len(found), OF_A_TRAP)])
    return traps._replace(note=f"{OF_A_TRAP} recordings each.")


def foreign_table() -> Table:
    cases = [(k, loop, FIRST + n) for loop in LOOPS.values() for k in range(len(CARS)) for n in range(OF_A_LOOP)]
    found = run_many(foreign, cases, label="foreign loops")
    size = len(CARS) * OF_A_LOOP
    return _foreign([list(zip(cases, found, strict=True))[k : k + size] for k in range(0, len(found), size)])


def methods_table() -> Table:
    cases = {plant: [(plant, FIRST + n) for n in range(METHODS)] for plant in DRAWS}
    found = {plant: run_many(both_methods, of, label=plant) for plant, of in cases.items()}
    return _methods(found)._replace(note=f"{METHODS} recordings each.")


def redesigned_table() -> Table:
    draws = [(plant, draw(n, DRAWN)) for plant, count in DRAWS.items() for n in range(1, count + 1)]
    cases = [(plant, drawn.number, drawn.deviation, drawn.noise) for plant, drawn in draws]
    return _redesigned(run_many(redesigned, cases, label="redesigned"))


def measure() -> Measured:
    return Measured(
        {
            **accuracy_tables(),
            "vehicle": vehicle_table(),
            "traps": traps_table(),
            "foreign": foreign_table(),
            "methods": methods_table(),
            "redesigned": redesigned_table(),
        }
    )


def again() -> dict[str, Table]:
    return {"recordings": recordings_table({FIRST: accuracy((FIRST, ()))})}


def _off(found: Found, name: str) -> float:
    """Relative error."""
    return found.values[name] / TRUE[name] - 1.0


def _accuracy(known: Sequence[Found], free: Sequence[Found]) -> Table:
    bound = {"J_2": ".084", "C": ".016", "phi_B": ".066"}
    goal = {"J_2": ".12 / .4", "C": ".025 / .1", "phi_B": ".09 / .35", "J_1": "- / .1", "tau": "- / .4"}
    rows = []
    for case, names, every in (("", ("J_2", "C", "phi_B", "tau"), known), (", J_1 free", ("J_1", "J_2", "C"), free)):
        for name in names:
            off = np.array([100.0 * _off(found, name) for found in every])
            inside = np.mean([abs(found.z(name, TRUE[name])) < Z_95 for found in every])
            rows.append(
                [
                    name + case,
                    bound.get(name, "") if not case else "",
                    f"{np.sqrt(np.mean(off**2)):.3f}",
                    f"{abs(off).max():.3f}",
                    goal.get(name, "") if name == "J_1" or not case else "",
                    f"{100.0 * inside:.0f}",
                ]
            )
    headings = ["", "bound (sd)", "rms error", "worst", "goal (rms / worst)", "in the 95 % interval, %"]
    return table_of(headings, rows, labels=1)


def _vehicle(measured: Sequence[Judged], alone: Sequence[Judged]) -> Table:
    def mean(values: Sequence[float], decimals: int = 1) -> str:
        return "-" if np.isnan(values).any() else f"{np.mean(values):.{decimals}f}"

    def spread(every: Sequence[Judged], name: str) -> str:
        values = [one.found.values[name] for one in every]
        return f"{np.mean(values):.4g} +- {100.0 * np.std(values, ddof=1) / np.mean(values):.1f} %"

    def row(text: str, goal: str, of: Callable[[Judged], float], decimals: int = 1) -> list[str]:
        return [text, goal, *(mean([of(one) for one in every], decimals) for every in (measured, alone))]

    rows = [
        *([name, goal, spread(measured, name), spread(alone, name)] for name, goal in SPREAD_GOALS.items()),
        row("simulated 0.5 s: omega_1", "92", lambda one: one.simulated[0]),
        row("simulated 0.5 s: omega_1 - omega_2", "77", lambda one: one.simulated[1]),
        row("the same below 12 Hz: omega_1", "95", lambda one: one.slow[0]),
        row("the same below 12 Hz: omega_1 - omega_2", "91", lambda one: one.slow[1]),
        row("predicted 50 ms: omega_1 (the last quarter)", "94 / 90", lambda one: one.found.quality["predicted"]),
        row("response 2 to 12 Hz with the true load, dB rms", "1", lambda one: one.response[0], 2),
        row("response 2 to 12 Hz of the car on its own, dB rms", "2", lambda one: one.response[1], 2),
        row(
            f"resonance, Hz (true: {measured[0].peak:.2f})",
            "8.0 +- .15",
            lambda one: one.found.resonance,
            2,
        ),
        row("time, s", "30", lambda one: one.found.seconds, 0),
    ]
    return table_of(["", "goal", "with load torque", "without"], rows, labels=1)


SPREAD_GOALS = {"J_2": "2.5 %", "C": "1 %", "phi_B": "0.6 %", "d": ""}
"""Standard deviation of repeated recordings, with load torque."""


def _methods(every: Mapping[str, Sequence[tuple[Method, Method]]]) -> Table:
    rows = []
    for plant, pairs in every.items():
        for k, name in enumerate(("prediction error", "output error")):
            of = [pair[k] for pair in pairs]
            values = [np.array([getattr(one.p, parameter) for one in of]) for parameter in ("J_2", "C", "phi_B", "d")]
            means = [
                f"{value.mean():.4g} +- {100.0 * value.std(ddof=1) / abs(value.mean()):.2g} %" for value in values[:3]
            ]
            fit, seconds = (np.mean([getattr(one, what) for one in of]) for what in ("simulated", "seconds"))
            rows.append([plant, name, *means, f"{values[3].mean():.3f}", f"{fit:.1f}", f"{seconds:.1f}"])
    headings = [
        *("plant", "method", "J_2, kg.m2", "C, N.m/rad", "phi_B, rad", "d, N.m.s/rad"),
        *("simulated 0.5 s: omega_1, %", "time, s"),
    ]
    return table_of(headings, rows, labels=2)


def _traps(every: Sequence[Sequence[Found]]) -> Table:
    rows = []
    for trap, found in zip(TRAPS, every, strict=True):
        true = TRUE | {name.partition(".")[2]: value for name, value in trap.parameters.items() if name == "motor.tau"}
        inside = [
            all(abs(one.z(name, true[name])) < 3.0 for name in ("J_2", "C", "phi_B", "tau")) and trap.J_1 == 1.0
            for one in found
        ]
        named = [bool(trap.cause) and any(trap.cause in warning for warning in one.warnings) for one in found]
        fine = [a or b for a, b in zip(inside, named, strict=True)]
        shares = [f"{100.0 * np.mean(share):.0f}" for share in (inside, named, fine)]
        J_2 = _rms_and_worst([100.0 * _off(one, "J_2") for one in found])
        rows.append([trap.name, shares[0], shares[1] if trap.cause else "-", shares[2], J_2])
    headings = ["", "right within 3 sd, %", "cause named, %", "either, %", "J_2 off by, % (rms / worst)"]
    return table_of(headings, rows, labels=1)


def _rms_and_worst(errors: Sequence[float]) -> str:
    return f"{np.sqrt(np.mean(np.square(errors))):.2f} / {np.abs(errors).max():.2f}"


Drives = Sequence[tuple[tuple[int, Loop, int], tuple[Found, tuple[float, float]]]]
"""Number of the car, loop, seed; what was found, and the shifts of motor and load torque in s."""


def _foreign(every: Sequence[Drives]) -> Table:
    """A row for each loop and kind of tyre, and for all loops."""
    rows = []
    together = [drive for drives in every for drive in drives]
    for name, of in (*zip(LOOPS, every, strict=True), ("all", together)):
        for tyre, numbers in TYRES.items():
            true = " / ".join(f"{1e3 * shift:.1f}" for shift in LOOPS[name].shifts) if name in LOOPS else "-"
            rows.append([name, tyre, *_of_drives([drive for drive in of if drive[0][0] in numbers], true)])
    headings = [
        *("loop and logger", "tyre", "J_2, %", "C, %", "phi_B, %", "95 % interval of J_2, +- %"),
        *("in the intervals, %", "motor / load torque late, ms", "found, off by at most, ms"),
    ]
    return table_of(headings, rows, labels=2)


def _of_drives(drives: Drives, true: str) -> list[str]:
    off = {parameter: [] for parameter in ("J_2", "C", "phi_B")}
    inside, shifts, half = [], [], []
    for (k, loop, _), (found, seen) in drives:
        half.append(100.0 * Z_95 * found.deviations["J_2"] / CARS[k].J_2)
        for parameter, errors in off.items():
            value = getattr(CARS[k], parameter)
            errors.append(100.0 * (found.values[parameter] / value - 1.0))
            inside.append(abs(found.z(parameter, value)) < Z_95)
        shifts.append(1e3 * np.subtract(seen, loop.shifts))
    worst = " / ".join(f"{shift:.2f}" for shift in np.abs(shifts).max(axis=0))
    errors = map(_rms_and_worst, off.values())
    return [*errors, f"{np.mean(half):.2f}", f"{100.0 * np.mean(inside):.0f}", true, worst]


def _redesigned(every: Sequence[Redesigned]) -> Table:
    rows = []
    for plant in DRAWS:
        cars = [car for car in every if car.plant == plant]
        designed = [car for car in cars if not car.problem]
        change = np.array([_means(car.after) / _means(car.before) for car in designed])
        points = np.array([_means(car.after)[1] - _means(car.before)[1] for car in designed])
        both = np.mean((change <= 1.0).all(axis=1) if len(change) else [0.0])
        rows.append(
            [
                plant,
                f"{len(cars)}",
                f"{len(cars) - len(designed)}",
                *(f"{np.median(change[:, k]):.2f}" for k in range(2)),
                *(f"{100.0 * np.mean(change[:, k] <= 1.0):.0f}" for k in range(2)),
                f"{100.0 * both:.0f}",
                f"{100.0 * np.mean(change[:, 0] <= 1.0 + WORSE):.0f}",
                f"{100.0 * points.max():.1f}",
            ]
        )
    headings = [
        *("plant", "cars", "no controller", "settling, over before (median)", "overshoot, over before (median)"),
        *("settling not worse, %", "overshoot not worse, %", "neither worse, %", "settling at most 5 % worse, %"),
        "overshoot at most more, points of %",
    ]
    return table_of(headings, rows, labels=1)


def _means(of: Mapping[str, tuple[float, float]]) -> np.ndarray:
    return np.mean(list(of.values()), axis=0)


STUDY = Study(
    "what an identification is worth",
    measure,
    again,
    {"recordings": [str(FIRST)]},
    range(FIRST, FIRST + KNOWN_J_1),
    seconds=3000,
)
