"""Back to back: the same inputs through the functions of a block and through both builds of its FMU.

The loop runs with native FMUs under Jacobi, so that what an instance is fed with during a step is in the
row before. That is fed to the functions and to the other build of each block; then the loop runs again
with one instance after the other exchanged.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from driveline.fmus.catalogue import EVERY
from driveline.harness.loop.places import NATIVE
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import KMH
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.simulation.simulate import signals, start
from fmublocks.block.declaration import Boolean, Integer, Real, variables
from fmublocks.block.runner import runner
from fmublocks.block.types import Block
from fmuloop.experiment import Experiment, Source
from fmuloop.runs import run
from fmuloop.system import Scheme, System

STEP_SIZE = 1e-3
"""Communication step in s."""

SPREAD = 100.0
"""Random inputs without a nominal value lie between this and its negative."""


class Given(NamedTuple):
    """What a block is fed with: a sample of each input for every instant, and parameters; by name."""

    inputs: Mapping[str, np.ndarray]
    parameters: Mapping[str, float]


class Differences(NamedTuple):
    """How far others are from the native build of a block, see `difference`.

    Attributes:
        functions: the functions of the block, fed with the same.
        python: its FMU built with PythonFMU, fed with the same.
        exchanged: all signals of the loop when that FMU takes the place of the native one.
    """

    functions: float
    python: float
    exchanged: float = 0.0


def difference(one: Mapping[str, np.ndarray] | np.ndarray, other: np.ndarray) -> float:
    """Largest distance of two runs in a signal, over the largest value of the signal; of all signals the largest."""
    names = [name for name in other.dtype.names or () if name != "time"]
    return max(_distance(np.asarray(one[name], float), np.asarray(other[name], float)) for name in names)


def _distance(one: np.ndarray, other: np.ndarray) -> float:
    if np.array_equal(one, other, equal_nan=True):
        return 0.0
    return float(np.nan_to_num(np.max(np.abs(one - other)) / np.max(np.abs(other)), nan=np.inf))


def random_inputs(block: Block, steps: int, seed: int = 1) -> Given:
    """New independent values of all inputs at every instant; a vehicle starts at 15 km/h."""
    draw = np.random.default_rng(seed)
    inputs: dict[str, np.ndarray] = {}
    for name, declaration, _ in variables(block.Input):
        match declaration:
            case Real(minimum=minimum, maximum=maximum, nominal=nominal):
                spread = nominal or SPREAD
                inputs[name] = draw.uniform(max(minimum, -spread), min(maximum, spread), steps + 1)
            case Boolean():
                inputs[name] = draw.integers(0, 2, steps + 1).astype(bool)
            case Integer():
                inputs[name] = np.cumsum(draw.integers(0, 2, steps + 1))
    return Given(inputs, {v.name: 15 * KMH for v in variables(block.Parameters) if v.name == "v_0"})


def by_functions(block: Block, given: Given) -> dict[str, np.ndarray]:
    """Outputs of a block at all instants k * STEP_SIZE, by name; no FMU takes part."""
    p = block.Parameters(**given.parameters)
    rows = zip(*(given.inputs[v.name].tolist() for v in variables(block.Input)), strict=True)
    samples = [block.Input(*row) for row in rows]
    running = runner(block, samples[0], p)
    outputs = [running.output(samples[0])]
    for u in samples[:-1]:
        running.advance(u, STEP_SIZE)
        outputs.append(running.output(u))
    names = (v.name for v in variables(block.Output))
    return {name: np.array(column) for name, column in zip(names, zip(*outputs, strict=True), strict=True)}


def by_fmu(path: Path, given: Given) -> np.ndarray:
    """Outputs of an FMU at all instants k * STEP_SIZE, with the inputs of the step that ends there, by name."""
    steps = len(next(iter(given.inputs.values()))) - 1
    inputs: dict[str, Source] = {f"block.{name}": samples for name, samples in given.inputs.items()}
    parameters = {f"block.{name}": value for name, value in given.parameters.items()}
    results = run(
        System({"block": path}, own=frozenset({"block"})),
        Experiment(steps * STEP_SIZE, STEP_SIZE, inputs, parameters, scheme=Scheme.JACOBI, label=path.stem),
    )
    columns = {name: name.removeprefix("block.") for name in results.dtype.names or () if name not in inputs}
    chosen = results[list(columns)]
    chosen.dtype.names = tuple(columns.values())
    return chosen


def compare_block(name: str, given: Given, folder: Path) -> Differences:
    """A block of the project alone; the native FMUs are in the folder `native` of the folder."""
    native = by_fmu(folder / NATIVE / f"{name}.fmu", given)
    functions = by_functions(EVERY[name].block, given)
    return Differences(difference(functions, native), difference(by_fmu(folder / f"{name}.fmu", given), native))


def compare_loop(plant: str, manoeuvre: Manoeuvre, folder: Path) -> dict[str, Differences]:
    """All blocks in the loop, by the name of the instance; folder as for `compare_block`."""
    native, python = (loop(plant, folder=folder, build=build) for build in (NATIVE, "python"))
    reference = drive(native, manoeuvre)
    found = {}
    for instance, path in native.instances.items():
        block, given = EVERY[path.stem].block, fed(instance, native, reference, manoeuvre)
        own = outputs(instance, block, reference)
        other = python.instances[instance]
        exchanged = drive(replace(native, instances={**native.instances, instance: other}), manoeuvre)
        found[instance] = Differences(
            difference(by_functions(block, given), own),
            difference(by_fmu(other, given), own),
            difference(exchanged, reference),
        )
    return found


def drive(system: System, manoeuvre: Manoeuvre) -> np.ndarray:
    """The loop through a manoeuvre, with damping."""
    inputs, parameters = signals(manoeuvre), start(manoeuvre)
    return run(
        system, Experiment(manoeuvre.duration, STEP_SIZE, inputs, parameters, Scheme.JACOBI, label=manoeuvre.name)
    )


def fed(instance: str, system: System, results: np.ndarray, manoeuvre: Manoeuvre) -> Given:
    """What an instance is fed with in a run under Jacobi."""
    sources = {connection.target: connection.source for connection in system.connections}
    inputs = {}
    for name, _, value in variables(EVERY[system.instances[instance].stem].block.Input):
        target = f"{instance}.{name}"
        source = sources.get(target, target)
        inputs[name] = results[source] if source in (results.dtype.names or ()) else np.full(len(results), value)
    prefix = f"{instance}."
    parameters = {n.removeprefix(prefix): v for n, v in start(manoeuvre).items() if n.startswith(prefix)}
    return Given(inputs, parameters)


def outputs(instance: str, block: Block, results: np.ndarray) -> np.ndarray:
    """The outputs of one instance, by name."""
    names = [v.name for v in variables(block.Output)]
    chosen = results[[f"{instance}.{name}" for name in names]]
    chosen.dtype.names = tuple(names)
    return chosen
