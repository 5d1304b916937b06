"""Roads without grip, and frames of motor control that are late or wrong: gear torque over that without control.

    python -m docs.studies.grip_and_frames
    python -m docs.studies.grip_and_frames --controller LinearObserver --controller SpeedWashout

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
from rich.table import Table

from driveline.fmus.catalogue import SIGNAL_FAULTS
from driveline.harness.base.interruption import script
from driveline.harness.cosimulation.experiment import Experiment
from driveline.harness.cosimulation.runs import run
from driveline.harness.loop.built_fmus import built, made_if_missing
from driveline.harness.loop.places import BUILD, COMPARATORS, NATIVE, T_S
from driveline.harness.loop.settings import Settings, loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.signals import Signal, lines
from driveline.harness.metrics.evaluate import at_samples
from driveline.harness.metrics.spectrum import band_rms
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.simulation.simulate import signals, start
from driveline.harness.studies.faults.fault_injection import with_faults
from driveline.harness.views.terminal import print_table
from driveline.models.controller.supervision import FALLBACK
from driveline.models.signal_faults import FRAME, LATE, MOTOR_SPEED, MOTOR_TORQUE

from . import periodic_errors

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


@dataclass(frozen=True, eq=False)
class Run:
    """A run of the loop.

    Attributes:
        group: row of the tables.
        seen_from: instant in s from which the torque counts.
        begin: of the errors of the frame in s; None: there are none.
        errors: parameters of SignalFaults, or of PeriodicErrors where they have a frequency.
        plant: parameters of the plant.
    """

    group: str
    manoeuvre: Manoeuvre
    seen_from: float = 1.0
    plant: Mapping[str, float] = field(default_factory=dict)
    begin: float | None = None
    errors: Mapping[str, float] = field(default_factory=dict)
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


def pulses(frequency: float, T_brake: float, v_0: float = 22.0) -> Manoeuvre:
    """Brakes as ABS lets them go: half of each period."""
    points = [(1.0, 0.0), (1.0, 200.0)]
    for t in np.arange(1.0, 4.0, 1.0 / frequency):
        ends = t + 0.5 / frequency
        points += [(t, 200.0), (t, 200.0 + T_brake), (ends, 200.0 + T_brake), (ends, 200.0)]
    course = lines(*points, (4.5, 0.0))
    return Manoeuvre(f"{T_brake:g} N.m at {frequency:g} Hz", "", 6.0, v_0, lines((0.0, 0.0)), course)


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


def with_wrong_frames() -> Iterator[Run]:
    for late in (0.01, 0.02, 0.03, 0.04, 0.052, 0.062, 0.08, 0.1):
        for what, signal in (("speed", MOTOR_SPEED), ("torque", MOTOR_TORQUE), ("frame", FRAME)):
            for manoeuvre, begin in product(DRIVES, (0.0, 1.1)):
                end = manoeuvre.duration
                given = {"kind_1": LATE, "signal_1": signal, "begin_1": begin, "end_1": end, "size_1": late}
                yield Run(f"{what} {1e3 * late:.0f} ms late", manoeuvre, max(1.0, begin + AFTER), {}, begin, given)
    for frequency in (2.0, 4.0, 6.0, 8.0, 10.0, 14.0):
        for what, errors in (("speed off by 7 rad/s", {"e_omega_1": 7.0}), ("torque off by 40 N.m", {"e_T_mot": 40.0})):
            for manoeuvre, begin in product(DRIVES, (0.0, 1.1)):
                given = {**errors, "begin": begin, "frequency": frequency}
                yield Run(f"{what}, {frequency:g} Hz", manoeuvre, max(1.0, begin + AFTER), {}, begin, given)


STUDIES = {"grip": on_slippery_roads, "abs": with_abs, "frames": with_wrong_frames}


INJECTORS = {False: SIGNAL_FAULTS, True: periodic_errors.FMU}
"""What makes the errors of the frame: by whether they are periodic."""


def gear_torque(each: Run, settings: Settings, injectors: Mapping[bool, Path]) -> tuple[np.ndarray, float]:
    """In N.m at the samples that count, and the time in fallback in s."""
    system = with_faults(loop(settings), injectors["frequency" in each.errors])
    parameters = start(each.manoeuvre, each.seed) | dict(settings.parameters)
    parameters |= {f"plant.{name}": value for name, value in each.plant.items()}
    parameters |= {f"faults.{name}": value for name, value in each.errors.items()}
    inputs = signals(each.manoeuvre, settings.control, settings.step_size)
    rows = at_samples(run(system, Experiment(each.manoeuvre.duration, inputs=inputs, parameters=parameters)))
    fallback = T_S * float(np.count_nonzero(rows["controller.status"] == FALLBACK))
    return rows["plant.T_gear"][rows["time"] >= each.seen_from], fallback


def ratios(each: Run, settings: Settings, injectors: Mapping[bool, Path]) -> Ratios:
    off, _ = gear_torque(each, settings.replace(control=False), injectors)
    on, fallback = gear_torque(each, settings, injectors)
    return Ratios(
        peak=float(np.abs(on).max() / max(np.abs(off).max(), QUIET_PEAK)),
        rms=band_rms(on, T_S) / max(band_rms(off, T_S), QUIET_RMS),
        fallback=fallback,
    )


def measured(
    runs: Sequence[Run], controller: str, label: str, folder: Path = BUILD, workers: int | None = None
) -> list[Ratios]:
    """The ratios of all runs with a controller, in their order, with the FMUs in `folder`."""
    injectors = {key: made_if_missing(fmu, folder, NATIVE).absolute() for key, fmu in INJECTORS.items()}
    settings = built(PLANT, controller=controller, folder=folder, build=NATIVE)
    return run_many(partial(ratios, settings=settings, injectors=injectors), runs, workers, label)


NUMBERS = ("peak, worst", "mean", "rms, worst", "mean", f"over {MOST}", "fallback, s")
NUMBERS_OF_FRAMES = (*NUMBERS[:4], f"rms over {MOST_LATE}", NUMBERS[5])


def numbers(of: Sequence[Ratios], of_frames: bool = False) -> list[str]:
    """Worst and mean of the peak and of the rms, runs beyond the limit, the longest fallback: a cell for each of
    NUMBERS, or of NUMBERS_OF_FRAMES."""
    peak, rms, fallback = (np.array(column) for column in zip(*of, strict=True))
    over = late(rms) if of_frames else int(np.count_nonzero(np.maximum(peak, rms) > MOST))
    return [*(f"{y:.2f}" for y in (peak.max(), peak.mean(), rms.max(), rms.mean())), f"{over}", f"{fallback.max():.2f}"]


def late(rms: np.ndarray) -> int:
    """Runs with a frame that is late or wrong which are beyond what they should be."""
    return int(np.count_nonzero(rms > MOST_LATE))


def by_group(runs: Sequence[Run], found: Sequence[Ratios]) -> dict[str, list[tuple[Run, Ratios]]]:
    """The runs with their ratios, by their groups, in the order of the first run of each."""
    groups: dict[str, list[tuple[Run, Ratios]]] = {}
    for each, y in zip(runs, found, strict=True):
        groups.setdefault(each.group, []).append((each, y))
    return groups


MEANINGS = """\
  peak      largest gear torque over that without control
  rms       gear torque from 5 to 50 Hz over that without control
  fallback  longest time without damping
"""


def show(runs: Sequence[Run], found: Sequence[Ratios], title: str) -> None:
    of_frames = runs[0].begin is not None
    headings = NUMBERS_OF_FRAMES if of_frames else NUMBERS
    table = Table("runs", "count", *headings, "the worst run", title=title, title_justify="left")
    for group, of in {**by_group(runs, found), "all": list(zip(runs, found, strict=True))}.items():
        worst, _ = max(of, key=lambda each: max(each[1].peak, each[1].rms))
        table.add_row(group, f"{len(of)}", *numbers([y for _, y in of], of_frames), str(worst))
    print_table(table)
    print(MEANINGS)


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--controller", action="append", choices=(OURS, *COMPARATORS), help="default: ours")
    parser.add_argument("--study", action="append", choices=tuple(STUDIES), help="default: all")
    parser.add_argument("--fmus", type=Path, default=BUILD, help="folder of the FMUs")
    parser.add_argument("--workers", type=int, help="processes (default: one a core)")
    options = parser.parse_args(arguments)
    for controller, study in product(options.controller or [OURS], options.study or STUDIES):
        runs = list(STUDIES[study]())
        found = measured(runs, controller, study, options.fmus, options.workers)
        show(runs, found, f"{controller}: {study}")


if __name__ == "__main__":
    script(main)
