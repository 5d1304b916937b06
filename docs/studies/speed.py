"""What a step, a run and a command take, beside plain C and other hosts.

    python -m docs.studies speed --turns 1 --duration 1    # a look at it

The contenders take turns, each in a process of its own. What is not installed is left out and named. Numbers to keep
are measured on a quiet machine. Times are no sentinels: nothing is timed in a test.
"""

import argparse
import resource
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from math import nan
from multiprocessing import get_context
from shutil import which
from time import process_time
from typing import Any

from benchmarks import commands, hosts, instructions, many_runs, simulate_parts
from benchmarks.hosts import CONTENDERS, MICRO, START, STEADY, STEP_SIZE
from benchmarks.timed import Timed
from driveline.harness.loop.places import NATIVE, PLANTS
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.signals import lines
from driveline.harness.simulation.simulate import signals, simulate
from fmuloop.compiled_steps import LIBRARY, CompiledSteps
from fmuloop.experiment import Experiment
from fmuloop.loading import loaded
from fmuloop.steps import interpreted

from .study import Cell, Column, Measured, Study, Table, cell
from .terminal import show

PLAIN = "plain C loop"
SPEEDS = (4.0, 10.0, 20.0, 30.0, 40.0)
"""In m/s."""

LENGTHS = (6.0, 60.0, 600.0)
"""Of runs in s."""

ENSEMBLES = (96, 384)
"""Runs, from whose processor times follow that of a start and that of a further run."""

COMPARED = (96, 192)
"""Runs that are compared one by one and in lanes."""

CRUISING = replace(STEADY, v_0=10.0, T_driver=lines((0.0, 10.0)))
"""Of any length, without getting fast."""

Cost = tuple[float, ...]


def alone(function: Callable[..., Any], *arguments: Any) -> Any:
    """What a function returns in a process of its own."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(function, *arguments).result()


def in_turns(
    turns: int, function: Callable[..., Cost], cases: Iterable[tuple[Any, ...]]
) -> dict[tuple[Any, ...], Cost]:
    """The least cost of each case."""
    least: dict[tuple[Any, ...], Cost] = {}
    for case in [*cases] * turns:
        cost = alone(function, *case)
        least[case] = min(cost, least.get(case, cost))
    return least


def at_speed(plant: str, v: float, duration: float) -> Cost:
    """Microseconds a step of the loop in our master from a speed in m/s on."""
    timed = Timed(CompiledSteps if LIBRARY else interpreted)
    with loaded(loop(plant, build=NATIVE), make_steps=timed) as running:
        running.run(Experiment(duration, STEP_SIZE, signals(STEADY), START | {"plant.v_0": v}, label="benchmark"))
    return (timed.seconds / round(duration / STEP_SIZE) * MICRO,)


def of_length(plant: str, duration: float) -> Cost:
    """Microseconds a step of a run from its start to its end, and the largest memory of the process in MB."""
    began = process_time()
    results = simulate(replace(CRUISING, duration=duration), plant, build=NATIVE)
    took = process_time() - began
    return took / (len(results) - 1) * MICRO, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def hosts_table(best: Mapping[str, Mapping[hosts.Contender, hosts.Run]]) -> Table:
    """A step in each host, over that of the plain C loop."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant, runs in best.items():
        limit = next((run.cost for contender, run in runs.items() if contender.name == PLAIN), float("nan"))
        for contender, (cost, _) in sorted(runs.items(), key=lambda item: item[1].cost):
            numbers = cost, STEP_SIZE * MICRO / cost, cell(cost / limit)
            rows[f"{plant}, {contender.name}, {contender.build}"] = numbers
    missing = [contender.name for contender in CONTENDERS if not contender.present]
    note = "* has threads: its ratio is another one on another machine."
    columns = (Column("a step", "µs", 2), Column("times real time", decimals=0), Column("over plain C", decimals=2))
    return Table(
        "plant, host, FMUs", columns, rows, f"{note} Not installed: {', '.join(missing)}." if missing else note
    )


def instructions_table() -> Table:
    """Of a step; they do not depend on what else the machine does."""
    counts = {plant: instructions.steps_of(plant) for plant in PLANTS}
    parts = tuple(Column(part, decimals=0) for part in next(iter(counts.values())))
    return Table("plant", parts, {plant: tuple(count.values()) for plant, count in counts.items()})


def growth(least: Mapping[tuple[Any, ...], Cost], case: str, columns: Sequence[Column]) -> Table:
    """A row for each case, with its costs, and what the first of them is over that of the plant's first case."""
    rows: dict[str, tuple[Cell, ...]] = {}
    first: dict[str, float] = {}
    for (plant, value, *_), costs in least.items():
        rows[f"{plant}, {value:g}"] = (*costs, costs[0] / first.setdefault(plant, costs[0]))
    return Table(f"plant, {case}", (*columns, Column("ratio", decimals=2)), rows)


def ensembles_table() -> Table:
    """What many runs of a tip-in with their metrics cost at the start and each of them, and over those one by one."""
    rows: dict[str, tuple[Cell, ...]] = {}
    for plant in PLANTS:
        alone = (nan, nan)
        for how in ("one by one", "in lanes"):
            few, many = (many_runs.many(plant, runs, how == "in lanes")[1] for runs in ENSEMBLES)
            marginal = (many - few) / (ENSEMBLES[1] - ENSEMBLES[0])
            start = few - ENSEMBLES[0] * marginal
            alone = (start, marginal) if how == "one by one" else alone
            ratios = [(alone[0] + runs * alone[1]) / (start + runs * marginal) for runs in COMPARED]
            rows[f"{plant}, {how}"] = start, 1e3 * marginal, *ratios, alone[1] / marginal
    faster = [Column(f"times as fast, {runs} runs", decimals=2) for runs in COMPARED]
    columns = (Column("start", "s", 2), Column("a further run", "ms", 1), *faster, Column("any number", decimals=2))
    return Table("plant, runs", columns, rows)


def commands_table(least: Mapping[str, float]) -> Table:
    rows = {name: (1e3 * seconds, seconds / least[commands.UNIT]) for name, seconds in least.items()}
    return Table("command", (Column("processor time", "ms", 0), Column("ratio", decimals=2)), rows)


def parts_table(least: Mapping[str, float]) -> Table:
    """Of `driveline simulate`."""
    rows = {name: (1e3 * seconds, seconds / sum(least.values())) for name, seconds in least.items()}
    return Table("driveline simulate", (Column("processor time", "ms", 1), Column("share", decimals=2)), rows)


def measured(turns: int, duration: float) -> Measured:
    """All tables.

    Args:
        turns: of each contender.
        duration: of its runs in s, where their length is not what is measured.
    """
    hosts.find_libraries()
    best = {plant: hosts.measure(plant, round(duration / STEP_SIZE), turns) for plant in PLANTS}
    speeds = in_turns(turns, at_speed, [(plant, v, duration) for plant in PLANTS for v in SPEEDS])
    lengths = in_turns(turns, of_length, [(plant, length) for plant in PLANTS for length in LENGTHS])
    step = Column("a step", "µs", 2)
    tables = {
        "steps": hosts_table(best),
        "speeds": growth(speeds, "m/s", (step,)),
        "lengths": growth(lengths, "s", (step, Column("memory", "MB", 0))),
        "ensembles": ensembles_table(),
        "commands": commands_table(commands.measure(turns)),
        "parts": parts_table(simulate_parts.measure(turns)),
    }
    return Measured(tables | ({"instructions": instructions_table()} if which("valgrind") else {}))


def explore(arguments: Sequence[str]) -> None:
    parser = argparse.ArgumentParser(
        prog="python -m docs.studies speed", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--turns", type=int, default=7, help="of each contender (default: %(default)s)")
    parser.add_argument("--duration", type=float, default=5.0, help="of a run in s (default: %(default)s)")
    args = parser.parse_args(arguments)
    for name, table in measured(args.turns, args.duration).tables.items():
        show(name, table)


STUDY = Study("what a step, a run and a command take", lambda: measured(7, 5.0), explore=explore, seconds=200)
