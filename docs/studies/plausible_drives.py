"""Drives of our own that are what they say: what `driveline replay` finds odd in them, which should be nothing.

    python -m docs.studies.plausible_drives [--cases N]

Plants, manoeuvres and damping in turn, each with a car, sensors and noise that are drawn at random (the box of
docs/robustness.md). What its sensors record is judged as the recording of a drive at 500 Hz and at 10 Hz, and followed
by the same plant with the car as it is declared, which nobody knows better.
"""

import argparse
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.table import Table

from driveline.harness.base.interruption import script
from driveline.harness.loop.built_fmus import built
from driveline.harness.loop.places import BUILD, PLACES, PLANTS, T_S
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import USUAL_MANOEUVRES
from driveline.harness.manoeuvres.road_load import Track
from driveline.harness.metrics.evaluate import at_samples
from driveline.harness.recordings.channels import Channel
from driveline.harness.recordings.drive import Drive
from driveline.harness.recordings.file_units import FileUnit
from driveline.harness.recordings.force_balance import Balance, balance, forces
from driveline.harness.recordings.plausibility import Finding, not_followed, of_drive
from driveline.harness.simulation.many_runs import run_many
from driveline.harness.studies.drives.replay import car_of, followed, speed_error
from driveline.harness.studies.robustness.case_runs import CaseRunner
from driveline.harness.studies.robustness.outcome import Case
from driveline.harness.views.terminal import print_table

CASES, SEED = 200, 1
STRIDES = (1, 50)
"""Samples of the controller from one of the recording to the next: 2 ms and 0.1 s."""


class Judged(NamedTuple):
    """A drive, what was found odd in it before and after it was followed, and what the rules saw."""

    case: Case
    findings: list[Finding]
    balance: Balance
    speed_error: float


def cases(count: int) -> list[tuple[Case, bool]]:
    """The drives, and whether they are damped."""
    pairs = list(product(PLANTS, (manoeuvre.name for manoeuvre in USUAL_MANOEUVRES)))
    controller = PLACES["controller"][0]
    return [
        (Case(plant, controller, k + 1, manoeuvre), bool(k // len(pairs) % 2))
        for k in range(count)
        for plant, manoeuvre in [pairs[k % len(pairs)]]
    ]


def recorded(results: np.ndarray, stride: int) -> Drive:
    """What a logger has of a run."""
    samples = at_samples(results)
    rise = np.cumsum(np.sin(samples["plant.slope"]) * samples["plant.v"]) * T_S
    kept = slice(None, None, stride)
    time = samples["time"][kept]
    columns = {"v": (samples["plant.v"], "m/s"), "elevation": (rise, "m"), "T_mot": (samples["motor.T_mot_est"], "N.m")}
    channels = {
        name: Channel(name, name, unit, time, values[kept], "sample {}".format, FileUnit(unit))
        for name, (values, unit) in columns.items()
    }
    v, elevation, T_mot = (channel.values for channel in channels.values())
    return Drive("drive", time, v, elevation, T_mot, {}, channels)


def judged(case: Case, damped: bool, settings: Settings, follow: bool = True) -> Judged:
    """What is found odd in a drive.

    Args:
        settings: of the loop that made it, and follows it.
        follow: whether the plant follows it.
    """
    results = CaseRunner({(case.plant, case.controller): settings}, SEED).results(case, damped)
    load, T_max = car_of(settings)
    findings, error = [], 0.0
    drives = [recorded(results, stride) for stride in STRIDES]
    for drive in drives:
        findings += of_drive(drive, load, T_max)
        if follow:
            track = Track.of(drive, T_max)
            signals = followed(track, load, settings)[1]
            findings += not_followed(drive, signals["time"], signals["plant.v"])
            error = max(error, speed_error(signals, track))
    return Judged(case, findings, balance(forces(drives[0].time, drives[0].v, drives[0].T_mot, load)), error)


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=CASES, help="default: %(default)s")
    parser.add_argument("--fmus", type=Path, default=BUILD, help="default: %(default)s")
    args = parser.parse_args(arguments)
    settings = {plant: built(plant, folder=args.fmus) for plant in PLANTS}
    found = run_many(lambda one: judged(*one, settings[one[0].plant]), cases(args.cases), label="drives")
    table = Table(
        "plant", "drives", "findings", "balanced", "correlation", "ratio", "speed error, m/s", title_justify="left"
    )
    for plant in PLANTS:
        of_plant = [one for one in found if one.case.plant == plant]
        balanced = [one.balance for one in of_plant if one.balance.fits]
        signs = [one.balance.correlation for one in of_plant if one.balance.correlation]
        table.add_row(
            plant,
            str(len(of_plant)),
            str(sum(len(one.findings) for one in of_plant)),
            str(len(balanced)),
            f"{min(signs):.2f} to {max(signs):.2f}",
            f"{min(b.ratio for b in balanced):.2f} to {max(b.ratio for b in balanced):.2f}",
            f"to {max(one.speed_error for one in of_plant):.2f}",
        )
    print_table(table)
    for one in found:
        for finding in one.findings:
            print(f"{one.case}: {finding}")


if __name__ == "__main__":
    script(main)
