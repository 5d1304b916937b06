"""What a communication step of the loop costs: under our master, call by call with fmpy, in each block.

Against whatever else the machine does, the contenders take turns, their time is that of the processor,
and the least of all turns is shown. What the master adds to the FMU calls if it makes its steps in Python,
and what each of these takes, is seen in further runs with a clock around every call: the median of their
shares, the least of their times.
"""

import argparse
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partialmethod
from statistics import median
from time import perf_counter, process_time
from typing import Any
from unittest.mock import patch

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.timed import Timed
from driveline.harness.loop.built_fmus import warn_of_stale
from driveline.harness.loop.places import BUILD_HELP, BUILDS, CONNECTIONS, INPUTS, PLANTS
from driveline.harness.loop.settings import chosen_build, loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import signals, start
from fmuloop.calls import Call
from fmuloop.compiled_steps import LIBRARY, CompiledSteps
from fmuloop.experiment import Experiment
from fmuloop.instance import Instance
from fmuloop.interface import type_of
from fmuloop.loading import loaded
from fmuloop.steps import MakeSteps, Steps, interpreted
from fmuloop.system import System
from toolground.interruption import script

STEP_SIZE = 1e-3
MICRO = 1e6

EXAMPLES = """\
examples:
  python -m benchmarks.step_cost
  python -m benchmarks.step_cost --plant TwoMassDriveline --repetitions 15
  python -m benchmarks.step_cost --build python
  python -m benchmarks.step_cost --plant my_vehicle.fmu --duration 5
"""


@dataclass
class Costs:
    """Microseconds per communication step of one plant's loop, one element a turn.

    Attributes:
        master: under our master.
        in_python: under our master with its steps in Python.
        fmpy: call by call, one variable each.
        added: what the master in Python adds to the FMU calls, as a share of these.
        calls: inside the calls, by instance and function.
    """

    master: list[float] = field(default_factory=list)
    in_python: list[float] = field(default_factory=list)
    fmpy: list[float] = field(default_factory=list)
    added: list[float] = field(default_factory=list)
    calls: dict[tuple[str, str], list[float]] = field(default_factory=lambda: defaultdict(list))


class Stopwatch:
    """Takes the time of FMU calls, less its own."""

    def __init__(self) -> None:
        self.laps: dict[tuple[str, str], list[float]] = defaultdict(list)
        self.outside, self.inside = self._own_cost()

    def function(self, instance: Instance, name: str) -> Callable[..., int]:
        """Stands in for `Instance.function`."""
        return self.traced(instance.slave.dll[name], (instance.name, name))

    def traced(self, call: Callable[..., int], key: tuple[str, str]) -> Callable[..., int]:
        clock, note = perf_counter, self.laps[key].append

        def watched_call(*arguments: Any) -> int:
            began = clock()
            status = call(*arguments)
            note(clock() - began)
            return status

        return watched_call

    def _own_cost(self) -> tuple[float, float]:
        """Seconds that watching adds to a call, outside and inside of the lap it takes."""
        count = 20_000
        key = ("", "")
        nothing = self.traced(id, key)
        began = perf_counter()
        for _ in range(count):
            nothing(self)
        total = (perf_counter() - began) / count
        lap = median(self.laps.pop(key))
        return total - lap, lap

    def spent(self) -> dict[tuple[str, str], float]:
        """Seconds inside the calls, by instance and function."""
        return {key: sum(laps) - len(laps) * self.inside for key, laps in self.laps.items()}

    @property
    def cost(self) -> float:
        """Seconds that all the watching took."""
        return sum(map(len, self.laps.values())) * (self.outside + self.inside)


def with_fmpy(begin: Sequence[Call], end: Sequence[Call], row: bytearray, known: int) -> Steps:
    """Steps under Jacobi with one call of FMU2Slave a variable; the last row alone is recorded."""
    sources = {target: source for source, target, _ in CONNECTIONS} | {port.name: port.name for port in INPUTS}
    plans = []
    for instance in dict.fromkeys(call.instance for call in begin):
        inputs = [
            (getattr(instance.slave, f"set{type_of(v)}"), v.valueReference, source)
            for v in instance.interface.of_causality("input")
            if (source := sources.get(f"{instance.name}.{v.name}"))
        ]
        outputs = [
            (getattr(instance.slave, f"get{type_of(v)}"), v.valueReference, f"{instance.name}.{v.name}")
            for v in instance.interface.of_causality("output")
        ]
        slave: Any = instance.slave
        plans.append((inputs, slave.doStep, outputs))
    values: dict[str, Any] = {}

    def steps(table: np.ndarray, numbers: range) -> None:
        if numbers.start == 0:
            values.update({name: table[name][0].item() for name in table.dtype.names or ()})
        given = {port.name: table[port.name][numbers.start : numbers.stop].tolist() for port in INPUTS}
        for k in numbers:
            for name, samples in given.items():
                values[name] = samples[k - numbers.start]
            for inputs, do_step, _ in plans:
                for set_value, reference, name in inputs:
                    set_value([reference], [values[name]])
                do_step(k * STEP_SIZE, STEP_SIZE)
            for _, _, outputs in plans:
                for get_value, reference, name in outputs:
                    values[name] = get_value([reference])[0]
        for name in (table.dtype.names or ())[1:]:
            table[name][numbers.stop] = values[name]

    return steps


def timed(system: System, duration: float, make: MakeSteps, clock: Callable[[], float] = process_time) -> float:
    """Microseconds per communication step."""
    manoeuvre, steps = MANOEUVRES["drive"], Timed(make, clock)
    with loaded(system, make_steps=steps) as running:
        table = running.run(Experiment(duration, STEP_SIZE, signals(manoeuvre), start(manoeuvre), label="benchmark"))
    return steps.seconds / (len(table) - 1) * MICRO


def measure(plant: str, build: str, duration: float, repetitions: int) -> Costs:
    """Lets the contenders take turns."""
    system, costs = loop(plant, build=build), Costs()
    warn_of_stale(system)
    steps = round(duration / STEP_SIZE)
    for _ in range(repetitions):
        costs.master.append(timed(system, duration, CompiledSteps if LIBRARY else interpreted))
        costs.in_python.append(timed(system, duration, interpreted))
        costs.fmpy.append(timed(system, duration, with_fmpy))
        watch = Stopwatch()
        with patch.object(Instance, "function", partialmethod(_watched, watch)):
            total = timed(system, duration, interpreted, perf_counter) - watch.cost / steps * MICRO
        spent = {key: seconds / steps * MICRO for key, seconds in watch.spent().items()}
        costs.added.append(total / sum(spent.values()) - 1.0)
        for key, value in spent.items():
            costs.calls[key].append(value)
    return costs


def _watched(instance: Instance, watch: Stopwatch, name: str) -> Callable[..., int]:
    return watch.function(instance, name)


def contenders(plant: str, build: str, costs: Costs) -> Table:
    table = Table(
        "", "µs a step", "times real time", "our master = 1", title=f"the loop with {plant} at 1 ms, {build} FMUs"
    )
    master, in_python, added = min(costs.master), min(costs.in_python), median(costs.added)
    for name, cost in (
        ("our master", master),
        ("its steps in Python", in_python),
        ("of it the FMU calls", in_python / (1.0 + added)),
        ("fmpy, one variable a call", min(costs.fmpy)),
    ):
        table.add_row(name, f"{cost:.1f}", f"{STEP_SIZE * MICRO / cost:.1f}", f"{cost / master:.2f}")
    table.caption = f"in Python the master adds {100.0 * added:.1f} % to the FMU calls"
    return table


def blocks(plant: str, costs: Costs) -> Table:
    table = Table("", "set", "step", "get", "sum", "share", title=f"FMU calls with {plant}, µs a step")
    least = {key: min(values) for key, values in costs.calls.items()}
    for instance in dict.fromkeys(instance for instance, _ in least):
        parts = [
            sum(cost for (name, function), cost in least.items() if name == instance and part in function)
            for part in ("fmi2Set", "fmi2DoStep", "fmi2Get")
        ]
        share = f"{100.0 * sum(parts) / sum(least.values()):.0f} %"
        table.add_row(instance, *(f"{cost:.1f}" for cost in (*parts, sum(parts))), share)
    return table


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--plant", action="append", metavar="NAME|FILE", help="only this one (repeatable)")
    parser.add_argument("--build", choices=BUILDS, help=BUILD_HELP)
    parser.add_argument("--duration", type=float, default=2.0, help="of a run in s (default: %(default)s)")
    parser.add_argument("--repetitions", type=int, default=7, help="turns of each (default: %(default)s)")
    args = parser.parse_args()
    console = Console()
    for plant in args.plant or PLANTS:
        build = args.build or chosen_build(plant)
        costs = measure(plant, build, args.duration, args.repetitions)
        console.print(contenders(plant, build, costs), blocks(plant, costs))


if __name__ == "__main__":
    script(main)
