"""What an identification is worth: accuracy, intervals, the detailed vehicle, bad data."""

from collections.abc import Mapping, Sequence

import numpy as np

from docs.studies.identification_accuracy import (
    CARS,
    TRAPS,
    TRUE,
    Answer,
    Covered,
    Judged,
    accuracy,
    covered,
    from_random_starts,
    judged,
    short,
    trapped,
)
from driveline.harness.identification.estimator import Z_95
from fmuloop.many_runs import run_many

from .study import Column, Measured, Study, Table, table_of

FIRST = 201
"""Seed of the first recording; none of these was used in development."""

KNOWN_J_1, FREE_J_1, STARTS, OF_A_TRAP = 12, 6, 12, 2

LOOPS, OF_A_LOOP, FOUND = 8, 25, 12
"""Seeds of foreign loops, recordings of each, and those that are identified by the command itself."""

RIGHT = {"J_2": 0.02, "C": 0.003, "phi_B": 0.01}
"""Relative error below which a search from a wide start has found the right optimum."""

SKEW = 2e-4
"""Time in s to which a skew must be found."""


def accuracy_tables() -> dict[str, Table]:
    seeds = range(FIRST, FIRST + KNOWN_J_1)
    known = run_many(accuracy, [(seed, ()) for seed in seeds], label="accuracy")
    free = run_many(accuracy, [(seed, ("J_1",)) for seed in seeds[:FREE_J_1]], label="accuracy with J_1 free")
    starts = run_many(from_random_starts, range(FIRST, FIRST + STARTS), label="wide starts")
    right = sum(all(abs(_off(start, name)) < limit for name, limit in RIGHT.items()) for start in starts)
    count = {
        "recordings": (len(known),),
        "with J_1 free": (len(free),),
        "wide starts": (len(starts),),
        "wide starts that find the right optimum": (right,),
    }
    return {"accuracy": _accuracy(known, free), "count": Table("", (Column("count", decimals=0),), count)}


def coverage_table() -> Table:
    seeds = range(FIRST, FIRST + LOOPS)
    chunks = run_many(covered, [(seed, OF_A_LOOP, False) for seed in seeds], label="foreign loops")
    (anywhere,) = run_many(covered, [(FIRST, FOUND, True)], label="foreign loops, from anywhere")
    every = [case for chunk in chunks for case in chunk]
    table = _coverage(every)
    return table._replace(rows={**table.rows, "from anywhere, all": _coverage(anywhere).rows["all, all"]})


def short_table() -> Table:
    identified = short(FIRST)
    columns = (
        Column("J_2", "kg.m2", None, 1e-3),
        Column("C", "N.m/rad", None, 1e-4),
        Column("phi_B", "rad", None, 1e-3),
    )
    return Table("seed", columns, {str(FIRST): tuple(float(getattr(identified.p, column.name)) for column in columns)})


def vehicle_table() -> Table:
    cases = [(car, FIRST, True) for car in CARS] + [(next(iter(CARS)), FIRST, False)]
    judgements = run_many(judged, cases, label="vehicle")
    return _vehicle(dict(zip([*CARS, "default, no load torque"], judgements, strict=True)))


def traps_table() -> Table:
    cases = [(k, FIRST + n) for k in range(len(TRAPS)) for n in range(OF_A_TRAP)]
    answers = run_many(trapped, cases, label="bad data")
    traps = _traps([answers[k : k + OF_A_TRAP] for k in range(0, len(answers), OF_A_TRAP)])
    return traps._replace(note=f"{OF_A_TRAP} recordings each.")


def measure() -> Measured:
    return Measured(
        {
            **accuracy_tables(),
            "coverage": coverage_table(),
            "short": short_table(),
            "vehicle": vehicle_table(),
            "traps": traps_table(),
        }
    )


def again() -> dict[str, Table]:
    return {"short": short_table()}


def _off(answer: Answer, name: str) -> float:
    """Relative error."""
    return answer.values[name] / TRUE[name] - 1.0


def _accuracy(known: Sequence[Answer], free: Sequence[Answer]) -> Table:
    rows = []
    for case, names, every in (("", ("J_2", "C", "phi_B", "tau"), known), (", J_1 free", ("J_1", "J_2", "C"), free)):
        for name in names:
            off = np.array([100.0 * _off(answer, name) for answer in every])
            inside = np.mean([abs(answer.z(name, TRUE[name])) < Z_95 for answer in every])
            half = np.mean([100.0 * Z_95 * answer.deviations[name] / TRUE[name] for answer in every])
            worst = abs(off).max()
            rows.append(
                [name + case, f"{np.sqrt(np.mean(off**2)):.3f}", f"{worst:.3f}", f"{half:.3f}", f"{100.0 * inside:.0f}"]
            )
    headings = ["", "rms error, %", "worst, %", "95 % interval, +- %", "in the interval, %"]
    return table_of(headings, rows, labels=1)


def _coverage(every: Sequence[Covered]) -> Table:
    """A row for each amplitude, without and with skew, and for all."""
    rows = []
    for skewed in (False, True):
        for amplitude in sorted({case.amplitude for case in every}):
            those = [case for case in every if (case.amplitude, case.skewed) == (amplitude, skewed)]
            rows.append([f"{amplitude:g} N.m", "skewed" if skewed else "aligned", *_of_loops(those)])
    rows.append(["all", "all", *_of_loops(every)])
    headings = [
        *("amplitude", "channels", "recordings", "J_2, % (rms / worst)", "C, %", "phi_B, %", "skew, ms"),
        *("right, %", "in the intervals, %", "95 % interval of J_2, +- %", "widest over the bound"),
        "bound of J_2, +- %",
    ]
    return table_of(headings, rows, labels=2)


def _of_loops(those: Sequence[Covered]) -> list[str]:
    if not those:
        return ["0", *["-"] * 9]
    names = ("J_2", "C", "phi_B", "late_T", "late_L")
    share = {name: np.array([case.off[name] / case.true[name] for case in those]) for name in RIGHT}
    skew = 1e3 * np.array([max(abs(case.off[name]) for name in names[3:]) for case in those])
    right = np.all([abs(share[name]) < limit for name, limit in RIGHT.items()] + [skew < 1e3 * SKEW], axis=0)
    inside = [np.mean([abs(case.off[name]) < Z_95 * case.deviations[name] for case in those]) for name in names]
    half, least = (
        np.mean([100.0 * Z_95 * of["J_2"] / case.true["J_2"] for case, of in zip(those, limits, strict=True)])
        for limits in ([case.deviations for case in those], [case.bound for case in those])
    )
    wide = max(float(np.mean([case.deviations[name] / case.bound[name] for case in those])) for name in names)
    errors = [_rms_and_worst(100.0 * share[name]) for name in RIGHT]
    return [
        f"{len(those)}",
        *errors,
        _rms_and_worst(skew),
        f"{100.0 * np.mean(right):.1f}",
        " / ".join(f"{100.0 * of:.0f}" for of in inside),
        f"{half:.2f}",
        f"{wide:.2f}",
        f"{least:.2f}",
    ]


def _vehicle(cars: Mapping[str, Judged]) -> Table:
    """A row for each car."""
    rows = []
    for name, car in cars.items():
        values, quality = car.answer.values, car.answer.quality
        known = [
            100.0 * Z_95 * car.answer.deviations["phi_B"] / values["phi_B"],
            *(values[n] for n in ("J_2", "C", "d")),
        ]
        rows.append(
            [
                name,
                f"{100.0 * (car.phi_B - 1.0):+.2f} +- {known[0]:.2f}",
                f"{100.0 * (car.answer.resonance / car.peak - 1.0):+.2f}",
                *(f"{of:.3f}" for of in car.gains),
                f"{car.response:.2f}",
                *(f"{value:.4g}" for value in known[1:]),
                *("-" if np.isnan(quality[of]) else f"{quality[of]:.1f}" for of in ("omega_1", "T_load")),
                f"{car.answer.seconds:.0f}",
            ]
        )
    headings = [
        *("car", "phi_B off by, %", "resonance off by, %", "settling with its gains", "overshoot", "response, dB rms"),
        *("J_2", "C", "d", "motor speed simulated 0.5 s, %", "load torque, %", "processor, s"),
    ]
    return table_of(headings, rows, labels=1)


def _traps(every: Sequence[Sequence[Answer]]) -> Table:
    rows = []
    for trap, answers in zip(TRAPS, every, strict=True):
        true = TRUE | {name.partition(".")[2]: value for name, value in trap.parameters.items() if name == "motor.tau"}
        inside = [
            all(abs(answer.z(name, true[name])) < 3.0 for name in ("J_2", "C", "phi_B", "tau")) and trap.J_1 == 1.0
            for answer in answers
        ]
        named = [bool(trap.cause) and any(trap.cause in warning for warning in answer.warnings) for answer in answers]
        fine = [a or b for a, b in zip(inside, named, strict=True)]
        shares = [f"{100.0 * np.mean(share):.0f}" for share in (inside, named, fine)]
        J_2 = _rms_and_worst([100.0 * _off(answer, "J_2") for answer in answers])
        rows.append([trap.name, shares[0], shares[1] if trap.cause else "-", shares[2], J_2])
    headings = ["", "right within 3 sd, %", "cause named, %", "either, %", "J_2 off by, % (rms / worst)"]
    return table_of(headings, rows, labels=1)


def _rms_and_worst(errors: Sequence[float] | np.ndarray) -> str:
    return f"{np.sqrt(np.mean(np.square(errors))):.2f} / {np.abs(errors).max():.2f}"


STUDY = Study(
    "what an identification is worth",
    measure,
    again,
    {"short": [str(FIRST)]},
    range(FIRST, FIRST + KNOWN_J_1),
    seconds=700,
)
