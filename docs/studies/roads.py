"""Roads without grip, and frames of motor control that are late or wrong: gear torque over that without control.

    python -m docs.studies roads --controller LinearObserver --controller SpeedWashout

On the validation vehicle. A row of the tables is a group of runs: largest gear torque and its rms from 5 to 50 Hz
over those of the same run without control (the worst run, and the mean of all), and the longest time in fallback.
Where the frame is wrong, the torque counts from 150 ms after the error begins.
"""

import argparse
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from driveline.fmus.catalogue import SIGNAL_FAULTS
from driveline.harness.loop.built_fmus import built, made_if_missing
from driveline.harness.loop.places import BUILD, COMPARATORS, NATIVE, T_S
from driveline.harness.loop.settings import Settings, loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.signals import Signal, lines
from driveline.harness.metrics.evaluate import at_samples
from driveline.harness.metrics.spectrum import band_rms
from driveline.harness.simulation.simulate import signals, start
from driveline.harness.studies.faults.fault_injection import with_faults
from driveline.models.controller.supervision import FALLBACK
from driveline.models.signal_faults import FRAME, LATE, MOTOR_SPEED, MOTOR_TORQUE
from fmuloop.campaign import RunRequest
from fmuloop.experiment import Experiment, Source
from fmuloop.many_runs import run_many
from fmuloop.results import Results

from . import periodic_errors
from .study import Cell, Column, Measured, Study, Table
from .terminal import show

PLANT, OURS = "ValidationVehicle", "DampingController"
QUIET_PEAK, QUIET_RMS = 20.0, 1.0
"""Gear torque in N.m without control below which a ratio counts as over these."""

AFTER = 0.15
"""Time in s after the beginning of an error from which on the torque counts."""

MOST, MOST_LATE = 1.1, 1.2
"""Ratio of peak or rms that a run should not exceed; of the rms, where the frame is late or wrong."""

EASED = 5.0
"""Demand with which wheels that spin catch the road again, whatever its grip, N.m."""

HOLDING = 2400.0
"""Brakes that hold the car on a grade, N.m."""


NOTHING_TOLD: Mapping[str, Source] = {}


@dataclass(frozen=True, eq=False)
class Run:
    """A run of the loop.

    Attributes:
        group: row of the tables.
        seen_from: instant in s from which the torque counts.
        begin: of the errors of the frame in s; None: there are none.
        errors: parameters of SignalFaults, or of PeriodicErrors where they have a frequency.
        plant: parameters of the plant.
        told: further inputs, by name: what some buses tell.
    """

    group: str
    manoeuvre: Manoeuvre
    seen_from: float = 1.0
    plant: Mapping[str, float] = field(default_factory=dict)
    begin: float | None = None
    errors: Mapping[str, float] = field(default_factory=dict)
    told: Mapping[str, Source] = field(default_factory=lambda: NOTHING_TOLD)
    seed: int = 1

    def __str__(self) -> str:
        """What it is within its group."""
        begin = () if self.begin is None else (f"wrong from {self.begin:g} s on",)
        return ", ".join((self.manoeuvre.name, *(f"{name} {value:g}" for name, value in self.plant.items()), *begin))


class Ratios(NamedTuple):
    """Gear torque over that without control, and the time in fallback in s."""

    peak: float
    rms: float
    fallback: float


def pushed(begin: float, T_driver: float) -> Signal:
    """The driver pushes for half a second, and eases off as the wheels spin: they catch the road again."""
    eased = np.sign(T_driver) * EASED
    return lines((begin, 0.0), (begin + 0.1, T_driver), (begin + 0.6, T_driver), (begin + 0.8, eased))


def rolling_back(grade: float, T_driver: float, pushes: float) -> Manoeuvre:
    """The brakes are let go at 2 s; the driver pushes uphill later."""
    return Manoeuvre(
        name=f"rolls back on {grade:g}, {T_driver:g} N.m at {pushes:g} s",
        description="",
        duration=7.0,
        v_0=0.0,
        T_driver=pushed(pushes, np.sign(grade) * T_driver),
        T_brake=lines((2.0, HOLDING), (2.1, 0.0)),
        slope=lines((0.5, 0.0), (1.0, grade)),
    )


def rocking(T_driver: float, turns: float) -> Manoeuvre:
    """On the flat: pulls away with T_driver, and back at `turns` s."""
    course = lines((1.0, 0.0), (1.0, T_driver), (turns, T_driver), (turns, -T_driver))
    return Manoeuvre(f"{T_driver:+g} then {-T_driver:+g} N.m at {turns:g} s", "", 6.0, 0.0, course)


def tip_in(v_0: float, T_driver: float) -> Manoeuvre:
    course = lines((1.0, -10.0), (1.05, T_driver), (3.0, T_driver), (3.1, -10.0))
    return Manoeuvre(f"{T_driver:g} N.m at {v_0:g} m/s", "", 6.0, v_0, course)


def pulses(frequency: float, T_brake: float, v_0: float = 22.0, T_driver: float = 0.0) -> Manoeuvre:
    """Brakes as ABS lets them go: half of each period; the motor brakes too with T_driver."""
    points = [(1.0, 0.0), (1.0, 200.0)]
    for t in np.arange(1.0, 4.0, 1.0 / frequency):
        ends = t + 0.5 / frequency
        points += [(t, 200.0), (t, 200.0 + T_brake), (ends, 200.0 + T_brake), (ends, 200.0)]
    course = lines(*points, (4.5, 0.0))
    demand = lines((1.0, 0.0), (1.05, T_driver), (4.5, T_driver), (4.6, 0.0)) if T_driver else lines((0.0, 0.0))
    regenerates = f", {T_driver:g} N.m" if T_driver else ""
    return Manoeuvre(f"{T_brake:g} N.m at {frequency:g} Hz{regenerates}", "", 6.0, v_0, demand, course)


def hill_start(name: str, grade: float, T_driver: Signal) -> Manoeuvre:
    T_brake, slope = lines((1.0, HOLDING), (1.1, 0.0)), lines((0.2, 0.0), (0.7, grade))
    return Manoeuvre(f"{name} on a grade of {grade:g}", "", 6.0, 0.0, T_driver, T_brake, slope)


def on_slippery_roads() -> Iterator[Run]:
    grips = (0.05, 0.08, 0.1, 0.12, 0.15, 0.2)
    for mu, grade, pushes in product(grips, (0.12, 0.2, -0.12), (2.5, 3.0, 3.5)):
        yield Run("rolls back, then 120 N.m", rolling_back(grade, 120.0, pushes), 2.0, {"mu": mu})
    for mu, T_driver, turns in product((0.08, 0.15, 0.2), (80.0, -80.0), (2.0, 3.0)):
        yield Run("80 N.m on ice, then back", rocking(T_driver, turns), 1.0, {"mu": mu})
    for mu, T_driver in product((*grips, 0.3, 0.5, 1.0), (60.0, 120.0, 180.0)):
        yield Run("pulls away", Manoeuvre(f"{T_driver:g} N.m", "", 6.0, 0.0, pushed(1.0, T_driver)), 1.0, {"mu": mu})
    for side, grade, T_driver in product(("g_muL", "g_muR"), (0.0, 0.12), (60.0, 120.0, 180.0)):
        manoeuvre = hill_start(f"{T_driver:g} N.m", grade, pushed(1.0, T_driver))
        yield Run("pulls away on split grip", manoeuvre, 1.0, {"mu": 0.8, side: 0.125})
    for mu, v_0, T_driver in product((*grips, 0.5), (4.0, 15.0), (100.0, -60.0)):
        yield Run("tip-in and back", tip_in(v_0, T_driver), 1.0, {"mu": mu})


def with_abs() -> Iterator[Run]:
    for mu, frequency, T_brake in product((0.2, 0.5, 1.0), (4.0, 5.0, 8.0, 12.0), (500.0, 1500.0, 3300.0, 4000.0)):
        yield Run(f"ABS, mu {mu:g}", pulses(frequency, T_brake), 1.0, {"mu": mu})


DRIVES = (
    MANOEUVRES["launch"],
    hill_start("100 N.m", 0.12, lines((1.0, 0.0), (1.1, 100.0))),
    MANOEUVRES["tipin15"],
    MANOEUVRES["tipout"],
)


def with_late_signals(what: str, signal: int, late: float, told: Mapping[str, Source] = NOTHING_TOLD) -> Iterator[Run]:
    """Signals of motor control come `late` s late from the start or from 1.1 s on."""
    for manoeuvre, begin in product(DRIVES, (0.0, 1.1)):
        end = manoeuvre.duration
        errors = {"kind_1": LATE, "signal_1": signal, "begin_1": begin, "end_1": end, "size_1": late}
        yield Run(f"{what} {1e3 * late:.0f} ms late", manoeuvre, max(1.0, begin + AFTER), {}, begin, errors, told)


def with_wrong_frames() -> Iterator[Run]:
    for late in (0.01, 0.02, 0.03, 0.04, 0.052, 0.062, 0.08, 0.1):
        for what, signal in (("speed", MOTOR_SPEED), ("torque", MOTOR_TORQUE), ("frame", FRAME)):
            yield from with_late_signals(what, signal, late)
    for frequency in (2.0, 4.0, 6.0, 8.0, 10.0, 14.0):
        for what, errors in (("speed off by 7 rad/s", {"e_omega_1": 7.0}), ("torque off by 40 N.m", {"e_T_mot": 40.0})):
            for manoeuvre, begin in product(DRIVES, (0.0, 1.1)):
                injected = {**errors, "begin": begin, "frequency": frequency}
                yield Run(f"{what}, {frequency:g} Hz", manoeuvre, max(1.0, begin + AFTER), {}, begin, injected)


STUDIES = {"grip": on_slippery_roads, "abs": with_abs, "frames": with_wrong_frames}


INJECTORS = {False: SIGNAL_FAULTS, True: periodic_errors.FMU}
"""What makes the errors of the frame: by whether they are periodic."""


def request(case: Run, settings: Settings, injectors: Mapping[bool, Path]) -> RunRequest:
    system = with_faults(loop(settings), injectors["frequency" in case.errors])
    parameters = start(case.manoeuvre, case.seed) | dict(settings.parameters)
    parameters |= {f"plant.{name}": value for name, value in case.plant.items()}
    parameters |= {f"faults.{name}": value for name, value in case.errors.items()}
    inputs = {**signals(case.manoeuvre, settings.control, settings.step_size), **case.told}
    return RunRequest(system, Experiment(case.manoeuvre.duration, inputs=inputs, parameters=parameters))


def gear_torque(case: Run, results: Results) -> tuple[np.ndarray, float]:
    """In N.m at the samples that count, and the time in fallback in s."""
    rows = at_samples(results)
    fallback = T_S * float(np.count_nonzero(rows["controller.status"] == FALLBACK))
    return rows["plant.T_gear"][rows["time"] >= case.seen_from], fallback


def needed(case: Run, settings: Settings, injectors: Mapping[bool, Path]) -> list[RunRequest]:
    """Without damping and with it."""
    return [request(case, its, injectors) for its in (settings.replace(control=False), settings)]


def ratios(case: Run, results: Sequence[Results]) -> Ratios:
    (off, _), (on, fallback) = (gear_torque(case, run) for run in results)
    return Ratios(
        peak=float(np.abs(on).max() / max(np.abs(off).max(), QUIET_PEAK)),
        rms=band_rms(on, T_S) / max(band_rms(off, T_S), QUIET_RMS),
        fallback=fallback,
    )


def measured(
    runs: Sequence[Run],
    controller: str,
    label: str,
    folder: Path = BUILD,
    workers: int | None = None,
    parameters: Mapping[str, float] | None = None,
) -> list[Ratios]:
    """The ratios of all runs with a controller, in their order, with the FMUs in `folder` and these parameters."""
    injectors = {key: made_if_missing(fmu, folder, NATIVE).absolute() for key, fmu in INJECTORS.items()}
    settings = built(PLANT, controller=controller, folder=folder, build=NATIVE, parameters=parameters)
    return run_many(ratios, runs, workers, label, runs=partial(needed, settings=settings, injectors=injectors))


NUMBERS = (Column("peak, worst"), Column("peak, mean"), Column("rms, worst"), Column("rms, mean"))
OVER = Column(f"over {MOST}", decimals=0), Column("fallback", "s")


def numbers(of: Sequence[Ratios]) -> tuple[Cell, ...]:
    """Worst and mean of the peak and of the rms, the runs beyond MOST, the longest fallback."""
    peak, rms, fallback = (np.array(column) for column in zip(*of, strict=True))
    over = int(np.count_nonzero(np.maximum(peak, rms) > MOST))
    return (*map(float, (peak.max(), peak.mean(), rms.max(), rms.mean())), over, float(fallback.max()))


def late(rms: np.ndarray) -> int:
    """Runs with a frame that is late or wrong which are beyond what they should be."""
    return int(np.count_nonzero(rms > MOST_LATE))


def by_group(runs: Sequence[Run], answers: Sequence[Ratios]) -> dict[str, list[tuple[Run, Ratios]]]:
    """The runs with their ratios, by their groups, in the order of the first run of each."""
    groups: dict[str, list[tuple[Run, Ratios]]] = {}
    for a_run, y in zip(runs, answers, strict=True):
        groups.setdefault(a_run.group, []).append((a_run, y))
    return groups


DRIFTS = (0.55, 0.7)
"""Values of `slip_drift` above the default, at which a motor that is late is not taken for slip."""

CONTROLLERS = (OURS, *(name for name in COMPARATORS if name != "NoDamping"))


def controllers_table(answers: Mapping[tuple[str, str], Sequence[Ratios]]) -> Table:
    """Every controller on roads without grip and under ABS."""
    rows = {f"{study}, {name}": numbers(of) for (study, name), of in answers.items() if study != "frames"}
    return Table("runs, controller", (*NUMBERS, *OVER), rows)


def groups_table(runs: Sequence[Run], answers: Sequence[Ratios]) -> Table:
    """A row for each group of runs with ours."""
    rows = {group: (len(of), *numbers([y for _, y in of])) for group, of in by_group(runs, answers).items()}
    return Table("runs", (Column("count", decimals=0), *NUMBERS, *OVER), rows)


def frames_table(runs: Sequence[Run], answers: Mapping[str, Sequence[Ratios]]) -> Table:
    """For frames that are late or wrong the rms of each controller: worst, mean, and how many are beyond MOST_LATE."""
    rows: dict[str, tuple[Cell, ...]] = {}
    grouped = [by_group(runs, of) for of in answers.values()]
    for group in grouped[0]:
        rms_of = (np.array([y.rms for _, y in of[group]]) for of in grouped)
        rows[group] = tuple(f"{rms.max():.2f} / {rms.mean():.2f} / {late(rms)}" for rms in rms_of)
    return Table("frame", tuple(map(Column, answers)), rows)


def runs_table(runs: Sequence[Run], answers: Sequence[Ratios]) -> Table:
    """Single runs with ours."""
    rows = {f"{run.group}: {run}": tuple(map(float, y)) for run, y in zip(runs, answers, strict=True)}
    return Table("run", (Column("peak"), Column("rms"), Column("fallback", "s")), rows)


def sentinels() -> list[Run]:
    """One run of each kind."""
    return [next(iter(runs_of())) for runs_of in STUDIES.values()]


def measure() -> Measured:
    runs = {study: list(runs_of()) for study, runs_of in STUDIES.items()}
    answers = {
        (study, controller): measured(runs[study], controller, f"{controller}, {study}")
        for study, controller in product(STUDIES, CONTROLLERS)
    }
    drifts = {
        f"slip_drift {value:g}": numbers(
            measured(runs["grip"], OURS, f"slip_drift {value:g}", parameters={"controller.slip_drift": value})
        )
        for value in DRIFTS
    }
    slippery = [*runs["grip"], *runs["abs"]]
    return Measured(
        {
            "controllers": controllers_table(answers),
            "drifts": Table("grip", (*NUMBERS, *OVER), drifts),
            "groups": groups_table(slippery, [*answers["grip", OURS], *answers["abs", OURS]]),
            "frames": frames_table(runs["frames"], {name: answers["frames", name] for name in CONTROLLERS}),
            "runs": runs_table(slippery, [*answers["grip", OURS], *answers["abs", OURS]])._replace(note="With ours."),
            "late": runs_table(sentinels()[2:], measured(sentinels()[2:], OURS, "frames")),
        }
    )


def again() -> dict[str, Table]:
    runs = sentinels()
    answers = measured(runs, OURS, "roads")
    return {"runs": runs_table(runs[:2], answers[:2]), "late": runs_table(runs[2:], answers[2:])}


def explore(arguments: Sequence[str]) -> None:
    parser = argparse.ArgumentParser(
        prog="python -m docs.studies roads",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--controller", action="append", choices=(OURS, *COMPARATORS), help="default: ours")
    parser.add_argument("--study", action="append", choices=tuple(STUDIES), help="default: all")
    options = parser.parse_args(arguments)
    for controller, study in product(options.controller or [OURS], options.study or STUDIES):
        runs = list(STUDIES[study]())
        show(f"{controller}: {study}", groups_table(runs, measured(runs, controller, study)))


NAMES = [f"{run.group}: {run}" for run in sentinels()]

STUDY = Study(
    "roads without grip, ABS, and frames that are late or wrong",
    measure,
    again,
    {
        "runs": [f"{run.group}: {run}" for run in sentinels()[:2]],
        "late": [f"{r.group}: {r}" for r in sentinels()[2:]],
    },
    explore=explore,
    seconds=120,
)
