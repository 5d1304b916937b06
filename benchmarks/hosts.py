"""What a communication step of the loop costs in our master and in tools that we did not write.

Every host makes the same steps (all hand on outputs after the step, as Jacobi): T_gear in the end shows
it. The hosts take turns, each in a process of its own; what is shown is the least time of all turns, that
of the processor, without loading and initialization. Our master records all outputs, the others nothing.
The plain C loop only hands on what is connected: the limit.
"""

import argparse
import os
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from importlib.util import find_spec
from multiprocessing import get_context
from pathlib import Path
from shutil import which
from time import process_time
from typing import NamedTuple

from rich.console import Console
from rich.table import Table

from benchmarks import plain_loop
from benchmarks.step_cost import with_fmpy
from benchmarks.timed import Timed
from driveline.harness.loop.built_fmus import warn_of_stale
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.signals import lines
from driveline.harness.simulation.simulate import signals
from fmuloop.compiled_steps import LIBRARY, CompiledSteps
from fmuloop.experiment import Experiment
from fmuloop.loading import loaded
from fmuloop.steps import MakeSteps, interpreted
from fmuloop.system import Scheme, System
from toolground.interruption import script

STEP_SIZE = 1e-3
MICRO = 1e6
START = {"plant.v_0": 5.0, "plant.T_0": 20.0}
T_DRIVER = 60.0
STEADY = Manoeuvre("steady", "one demand all the time", 0.0, START["plant.v_0"], lines((0.0, T_DRIVER)))
KINDS = {"can.valid": "boolean", "can.counter": "integer"}
"""Types of the outputs that are not Real."""

EXAMPLES = """\
examples:
  python -m benchmarks.hosts
  python -m benchmarks.hosts --plant TwoMassDriveline --duration 10 --turns 9
"""


class Run(NamedTuple):
    """Microseconds a step, and the gear torque in the end in N.m."""

    cost: float
    T_gear: float


def compiled(system: System, steps: int) -> Run:
    return _in_our_master(system, steps, CompiledSteps)


def in_python(system: System, steps: int) -> Run:
    return _in_our_master(system, steps, interpreted)


def by_fmpy(system: System, steps: int) -> Run:
    """fmpy with one call a variable."""
    return _in_our_master(system, steps, with_fmpy)


def _in_our_master(system: System, steps: int, make: MakeSteps) -> Run:
    timed = Timed(make)
    with loaded(system, make_steps=timed) as running:
        duration = steps * STEP_SIZE
        results = running.run(Experiment(duration, STEP_SIZE, signals(STEADY), START, Scheme.JACOBI, label="benchmark"))
    return Run(timed.seconds / steps * MICRO, float(results["plant.T_gear"][-1]))


def libcosim(system: System, steps: int) -> Run:
    """libcosim with its fixed-step algorithm, through its Python package."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.ERROR)
    execution = CosimExecution.from_step_size(round(STEP_SIZE * 1e9))
    # its method for Integer connections calls this by another name than it was given
    execution._CosimExecution__connect_integer_variables = execution._CosimExecution__connect_int_variables
    slaves, references = {}, {}
    for name, path in system.instances.items():
        slaves[name] = execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name=name))
        for variable in execution.slave_variables(slaves[name]):
            references[f"{name}.{variable.name.decode()}"] = variable.reference

    def place(name: str) -> tuple[int, int]:
        return slaves[name.partition(".")[0]], references[name]

    for name, value in {**START, "controller.T_driver": T_DRIVER}.items():
        execution.real_initial_value(*place(name), value)
    for source, target, _ in system.connections:
        connect = getattr(execution, f"connect_{KINDS.get(source, 'real')}_variables")
        connect(*place(source), *place(target))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    execution.step(1)  # which initializes
    began = process_time()
    execution.step(steps - 1)
    took = process_time() - began
    slave, reference = place("plant.T_gear")
    return Run(took / (steps - 1) * MICRO, float(observer.last_real_values(slave, [reference])[0]))


def ecos(system: System, steps: int) -> Run:
    """Ecos with its fixed-step algorithm, through its Python package."""
    from ecospy import EcosSimulation, EcosSimulationStructure

    names = {"boolean": "bool", "integer": "int"}
    with EcosSimulationStructure() as structure:
        for name, path in system.instances.items():
            structure.add_model(name, path)
        for source, target, _ in system.connections:
            connect = getattr(structure, f"make_{names.get(KINDS.get(source, ''), 'real')}_connection")
            connect(source.replace(".", "::"), target.replace(".", "::"))
        start = {**START, "controller.T_driver": T_DRIVER}
        structure.add_parameter_set("start", {name.replace(".", "::"): value for name, value in start.items()})
        with EcosSimulation(structure=structure, step_size=STEP_SIZE) as simulation:
            simulation.init(parameter_set="start")
            began = process_time()
            simulation.step(steps)
            took = process_time() - began
            return Run(took / steps * MICRO, simulation.get_real("plant::T_gear"))


def plain_c(system: System, steps: int) -> Run:
    """A C program that makes the calls and nothing else."""
    start = {**START, "controller.T_driver": T_DRIVER}
    cost, T_gear = plain_loop.run(system, steps, STEP_SIZE, start, "plant.T_gear")
    return Run(cost * MICRO, T_gear)


class Contender(NamedTuple):
    """A host, the build of the FMUs that it runs, and whether it is installed.

    The name of one that has threads ends in a star: its ratio to others is another one on another machine.
    """

    name: str
    build: str
    host: Callable[[System, int], Run]
    present: bool = True


CONTENDERS = (
    Contender("our master", "native", compiled, LIBRARY is not None),
    Contender("our steps in Python", "native", in_python),
    Contender("plain C loop", "native", plain_c, os.name == "posix" and which(os.environ.get("CC", "cc")) is not None),
    Contender("libcosim*", "native", libcosim, find_spec("libcosimpy") is not None),
    Contender("Ecos*", "native", ecos, find_spec("ecospy") is not None),
    Contender("fmpy", "native", by_fmpy),
    Contender("our master", "python", compiled, LIBRARY is not None),
    Contender("our steps in Python", "python", in_python),
)


def measure(plant: str, steps: int, turns: int) -> dict[Contender, Run]:
    """The best of the turns of each contender that is installed."""
    best: dict[Contender, Run] = {}
    for _ in range(turns):
        for contender in CONTENDERS:
            if contender.present:
                warn_of_stale(system := loop(plant, build=contender.build))
                with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
                    run = pool.submit(contender.host, system, steps).result()
                best[contender] = min(run, best.get(contender, run))
    return best


def table(plant: str, best: dict[Contender, Run]) -> Table:
    columns = ("host", "FMUs", "µs a step", "× real time", "ratio", "T_gear, N.m")
    result = Table(*columns, title=f"the loop with {plant} at 1 ms")
    ours = next(iter(best.values())).cost
    for contender, (cost, T_gear) in best.items():
        numbers = (f"{cost:.2f}", f"{STEP_SIZE * MICRO / cost:.0f}", f"{cost / ours:.1f}", f"{T_gear:.6f}")
        result.add_row(contender.name, contender.build, *numbers)
    missing = [contender.name for contender in CONTENDERS if not contender.present]
    result.caption = f"not installed: {', '.join(missing)}" if missing else None
    return result


def find_libraries() -> None:
    """Where the package tbb puts the library that Ecos needs; it is looked for when a process starts."""
    os.environ["LD_LIBRARY_PATH"] = str(Path(sys.prefix) / "lib")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--plant", choices=PLANTS, action="append", help="only this one (repeatable)")
    parser.add_argument("--duration", type=float, default=5.0, help="of a run in s (default: %(default)s)")
    parser.add_argument("--turns", type=int, default=5, help="of each (default: %(default)s)")
    args = parser.parse_args()
    find_libraries()
    console = Console()
    for plant in args.plant or PLANTS:
        console.print(table(plant, measure(plant, round(args.duration / STEP_SIZE), args.turns)))


if __name__ == "__main__":
    script(main)
