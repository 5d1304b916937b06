"""How far model exchange is from co-simulation: T_gear of the plants in the manoeuvres, T_mot of the motor.

The loop makes a manoeuvre. What then enters plant or motor is given to it alone, with straight lines between the
samples: in co-simulation with steps of 0.1 ms and input derivatives, in model exchange with CVode as FMPy has it, by
FMI 2.0 and by FMI 3.0. The difference over the largest torque is shown, that between the two FMIs, the number of
derivatives that CVode took, and of its restarts at events; and how far co-simulation moves if the inertia of the motor
is larger by 1e-8 of it: without feedback the motor swings undamped in the backlash, and some manoeuvres amplify what is
small. The motor, which restarts with every sample of its noise, is run in the first manoeuvre alone.
"""

import argparse
from collections.abc import Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple
from unittest.mock import patch

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave
from fmpy.sundials import CVodeSolver

from driveline.harness.loop.places import BUILD, NATIVE, PLACES, PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate, start
from driveline.models.physics.vehicle import CAR
from fmublocks.builds import FMI3_FOLDER
from toolground.interruption import script

MOTOR = PLACES["motor"][0]

STEP_SIZE, SAMPLE_TIME = 1e-4, 1e-3

INWARDS = 1.0 - 1e-12
"""So that no input is beyond its bounds by rounding at the end of a line."""

EXAMPLES = """\
examples:
  python -m benchmarks.model_exchange
  python -m benchmarks.model_exchange --manoeuvres tipin15,abs --tolerance 1e-11
"""


class OpenLoop(NamedTuple):
    """A run of one FMU without feedback.

    Attributes:
        start: parameters.
        times: in s, SAMPLE_TIME apart; of the samples of the inputs, by name.
        output: that is compared.
    """

    name: str
    start: Mapping[str, float]
    times: np.ndarray
    inputs: Mapping[str, np.ndarray]
    output: str


class Taken(NamedTuple):
    """An output of a run in model exchange at the times of the samples, and what the solver took."""

    output: np.ndarray
    derivatives: int
    restarts: int


class Solver(CVodeSolver):
    """CVode of FMPy with the inputs of each instant: FMPy 0.3.32 computes derivatives with those of the last step."""

    derivatives = restarts = 0

    def __init__(self, **arguments: Any) -> None:
        super().__init__(**arguments, maxNumSteps=100_000)

    def f(self, t: float, y: Any, ydot: Any, user_data: Any) -> int:
        Solver.derivatives += 1
        self.input.apply(t)
        return super().f(t, y, ydot, user_data)

    def reset(self, time: float) -> None:
        Solver.restarts += 1
        super().reset(time)


def recorded(manoeuvre: str, plant: str, folder: Path = BUILD) -> tuple[OpenLoop, OpenLoop]:
    """The runs of plant and motor in a manoeuvre, as the loop makes it with the FMUs in a folder."""
    made = MANOEUVRES[manoeuvre]
    results = simulate(made, plant, build="native", step_size=SAMPLE_TIME, folder=folder)
    times = SAMPLE_TIME * np.arange(len(results))
    given = {name.removeprefix("plant."): value for name, value in start(made).items() if name.startswith("plant.")}
    of_plant = {"T_mot": "motor.T_mot", "T_brake": "plant.T_brake", "slope": "plant.slope"}
    of_motor = {"T_ref": "controller.T_ref", "omega_1": "plant.omega_1"}
    inputs = [{name: results[column] for name, column in columns.items()} for columns in (of_plant, of_motor)]
    inputs[0]["T_load_rec"] = np.zeros(len(times))
    return OpenLoop(plant, given, times, inputs[0], "T_gear"), OpenLoop(MOTOR, {}, times, inputs[1], "T_mot")


@contextmanager
def _unpacked(path: Path):
    with TemporaryDirectory() as folder:
        fmpy.extract(str(path), folder)
        yield folder


def stepped(run: OpenLoop, path: Path, step_size: float = STEP_SIZE) -> np.ndarray:
    """The output in co-simulation, at the times of the samples."""
    described = fmpy.read_model_description(str(path))
    references = {v.name: v.valueReference for v in described.modelVariables}
    inputs, output = [references[name] for name in run.inputs], [references[run.output]]
    samples = np.array(list(run.inputs.values())).T
    steps = round(SAMPLE_TIME / step_size)
    with _unpacked(path) as folder:
        slave = FMU2Slave(guid=described.guid, unzipDirectory=folder, modelIdentifier=run.name, instanceName="stepped")
        slave.instantiate()
        slave.setReal([references[name] for name in run.start], list(run.start.values()))
        slave.setReal(inputs, samples[0])
        slave.setupExperiment()
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        found = slave.getReal(output)
        for k, rates in enumerate(INWARDS * np.diff(samples, axis=0) / SAMPLE_TIME):
            slave.setReal(inputs, samples[k])
            for step in range(k * steps, (k + 1) * steps):
                slave.setRealInputDerivatives(inputs, [1] * len(inputs), rates)
                slave.doStep(step * step_size, step_size)
            found += slave.getReal(output)
        slave.freeInstance()
    return np.array(found)


def integrated(run: OpenLoop, path: Path, tolerance: float) -> Taken:
    """The output in model exchange, at the times of the samples."""
    described = fmpy.read_model_description(str(path)).modelVariables
    names = [variable.name for variable in described if variable.causality == "input"]  # FMI 3.0 has their rates too
    signals = np.zeros(len(run.times), dtype=[(name, float) for name in ("time", *names)])
    for name, values in {"time": run.times, **run.inputs}.items():
        signals[name] = values
    Solver.derivatives = Solver.restarts = 0
    with _unpacked(path) as folder, patch("fmpy.sundials.CVodeSolver", Solver):
        results = fmpy.simulate_fmu(
            folder,
            fmi_type="ModelExchange",
            start_values=dict(run.start),
            input=signals,
            output=[run.output],
            relative_tolerance=tolerance,
            stop_time=run.times[-1],
            output_interval=SAMPLE_TIME,
            record_events=False,
        )
    return Taken(np.asarray(results[run.output]), Solver.derivatives, Solver.restarts)


def sensitivity(run: OpenLoop, path: Path, expected: np.ndarray) -> float:
    """How far the output moves, in co-simulation, if the inertia of the motor is larger by 1e-8 of it."""
    moved = run._replace(start={**run.start, "J_1": CAR.J_1 * (1.0 + 1e-8)})
    return np.max(np.abs(stepped(moved, path) - expected))


COLUMNS = (
    *("manoeuvre", "FMU", "largest, N.m", "difference, N.m", "over it", "FMI 3.0"),
    *("derivatives", "events", "of J_1 + 1e-8", "over it"),
)
ROW = "{:15}{:18}{:>12}{:>17}{:>10}{:>10}{:>13}{:>8}{:>15}{:>10}"


def show(manoeuvres: Sequence[str], tolerance: float, folder: Path) -> None:
    """Prints a row for each run; manoeuvres on roads that the design model does not know are the other plant's."""
    print(ROW.format(*COLUMNS))
    for manoeuvre in manoeuvres:
        for plant in PLANTS[1:] if MANOEUVRES[manoeuvre].road else PLANTS:
            of_plant, of_motor = recorded(manoeuvre, plant, folder)
            for run in (of_plant, of_motor) if (manoeuvre, plant) == (manoeuvres[0], PLANTS[0]) else (of_plant,):
                path = folder / NATIVE / f"{run.name}.fmu"
                expected, taken = stepped(run, path), integrated(run, path, tolerance)
                difference, largest = np.max(np.abs(taken.output - expected)), np.max(np.abs(expected))
                shown = f"{largest:.1f}", f"{difference:.1e}", f"{difference / largest:.1e}"
                of_fmi3 = integrated(run, folder / FMI3_FOLDER / path.name, tolerance).output
                versions = f"{np.max(np.abs(of_fmi3 - taken.output)):.1e}"
                moved = sensitivity(run, path, expected) if run is of_plant else np.nan
                counts = taken.derivatives, taken.restarts, f"{moved:.1e}", f"{moved / largest:.1e}"
                print(ROW.format(manoeuvre, run.name, *shown, versions, *counts), flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--manoeuvres", default=",".join(MANOEUVRES), help="comma between the names (all)")
    parser.add_argument("--tolerance", type=float, default=1e-8, help="relative tolerance of CVode (1e-8)")
    parser.add_argument("--folder", type=Path, default=BUILD, help="of the FMUs (build)")
    given = parser.parse_args()
    show(given.manoeuvres.split(","), given.tolerance, given.folder)


if __name__ == "__main__":
    script(main)
