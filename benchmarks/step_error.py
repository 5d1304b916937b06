"""How far the steps of the plants are from a tight integration of the same equations, and what they cost.

The torque of the motor in each manoeuvre of the catalogue, as the loop has it with our controller, and torque steps at
constant speeds drive a plant alone: the FMU as it is built, and one whose stretches are TIGHT long and whose ripple
never fades out. The largest distance of T_gear is the error; ALLOWED of it is what the integration was chosen for.
How sensitive a manoeuvre is shows what MORE torque of the motor makes of the tight integration: teeth that rattle
multiply any change by hundreds of impacts, and after these no two integrations agree.
"""

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.timed import Timed
from driveline.fmus.catalogue import FMUS
from driveline.harness.loop.built_fmus import warn_of_stale
from driveline.harness.loop.places import NATIVE, PLANTS
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from fmublocks.native.packaging import build_native
from fmuloop.compiled_steps import CompiledSteps
from fmuloop.experiment import Experiment, Source
from fmuloop.loading import loaded
from fmuloop.system import Scheme, System
from tests.back_to_back import STEP_SIZE, Given, drive, fed
from toolground.interruption import script

TIGHT = 5e-5
"""Stretch of the tight integration in s: at 40 m/s the ripple turns by 1.5 rad in it, of which order 8 loses 1e-7."""

ALLOWED = 1e-3
"""Error of T_gear in N.m that steps may have."""

MORE = 1e-6
"""Torque in N.m, less than any motor can tell."""

SPEEDS = (4.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0)
"""In m/s, of the torque steps."""

MICRO = 1e6


def torque_step(v: float) -> Given:
    """From 150 to -30 N.m and back within 2 s."""
    time = np.arange(0.0, 2.0, STEP_SIZE)
    return Given({"T_mot": np.where((time > 0.8) & (time < 1.4), -30.0, 150.0)}, {"v_0": v, "T_0": 150.0})


def cases(plant: str) -> Iterator[tuple[str, Given]]:
    """What drives the plant alone, by name."""
    system = loop(plant, build=NATIVE)
    warn_of_stale(system)
    known = set(FMUS[plant].block.Parameters._fields)
    for name, manoeuvre in MANOEUVRES.items():
        if set(manoeuvre.road) <= known:
            yield name, fed("plant", system, drive(system, manoeuvre), manoeuvre)
    for v in SPEEDS:
        yield f"150 N.m at {v:g} m/s", torque_step(v)


def tight(plant: str, folder: Path) -> Path:
    """The FMU that stands for the exact solution."""
    fmu = FMUS[plant]
    with patch("driveline.models.validation_vehicle.slow", lambda rate: 1.0):
        return build_native(replace(fmu, block=replace(fmu.block, step_size=TIGHT)), folder)


def driven(path: Path, given: Given) -> tuple[np.ndarray, float]:
    """Gear torque in N.m at all instants, and microseconds a step."""
    steps = len(next(iter(given.inputs.values()))) - 1
    inputs: dict[str, Source] = {f"plant.{name}": samples for name, samples in given.inputs.items()}
    parameters: Mapping[str, float] = {f"plant.{name}": value for name, value in given.parameters.items()}
    timed = Timed(CompiledSteps)
    with loaded(System({"plant": path}, own=frozenset({"plant"})), make_steps=timed) as running:
        results = running.run(
            Experiment(steps * STEP_SIZE, STEP_SIZE, inputs, parameters, Scheme.JACOBI, label="benchmark")
        )
    return results["plant.T_gear"], timed.seconds / steps * MICRO


def table(plant: str) -> Table:
    columns = ("", "error of T_gear, N.m", f"by {MORE:g} N.m more torque", "µs a step")
    result = Table(*columns, title=f"{plant} alone at 1 ms; allowed are {ALLOWED:g} N.m")
    shipped = loop(plant, build=NATIVE).instances["plant"]
    with TemporaryDirectory() as folder:
        exact = tight(plant, Path(folder))
        for name, given in cases(plant):
            T_gear, cost = driven(shipped, given)
            reference = driven(exact, given)[0]
            more = Given({**given.inputs, "T_mot": given.inputs["T_mot"] + MORE}, given.parameters)
            error, change = (float(np.max(np.abs(other - reference))) for other in (T_gear, driven(exact, more)[0]))
            result.add_row(name, f"{error:.1e}{' !' * (error > ALLOWED)}", f"{change:.1e}", f"{cost:.2f}")
    return result


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plant", choices=PLANTS, action="append", help="only this one (repeatable)")
    for plant in parser.parse_args().plant or PLANTS:
        Console().print(table(plant))


if __name__ == "__main__":
    script(main)
