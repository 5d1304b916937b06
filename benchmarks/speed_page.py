"""docs/speed.md, all that is said of speed on one page: `python -m benchmarks.speed_page`.

Everything is measured anew, the contenders in turns and each in a process of its own. What is not installed is left out
and named. `--turns 1 --duration 1` is a look at it; a page to keep is made on a quiet machine.
"""

import argparse
import platform
import resource
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from shutil import which
from time import process_time
from typing import Any

from loky import cpu_count

from benchmarks import hosts, instructions, many_runs, start_up
from benchmarks.hosts import CONTENDERS, MICRO, START, STEADY, STEP_SIZE
from benchmarks.timed import Timed
from driveline.harness.base.atomic_files import write_text
from driveline.harness.base.interruption import script
from driveline.harness.cosimulation.compiled_steps import LIBRARY, CompiledSteps
from driveline.harness.cosimulation.experiment import Experiment
from driveline.harness.cosimulation.loading import loaded
from driveline.harness.cosimulation.steps import interpreted
from driveline.harness.loop.places import NATIVE, PLANTS
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.signals import lines
from driveline.harness.simulation.simulate import signals, simulate
from driveline.harness.views.markdown import markdown_table

TEMPLATE = Path(__file__).with_suffix(".md")
PAGE = Path(__file__).parents[1] / "docs" / "speed.md"

PLAIN = "plain C loop"
SPEEDS = (4.0, 10.0, 20.0, 30.0, 40.0)
"""In m/s."""

LENGTHS = (6.0, 60.0, 600.0)
"""Of runs in s."""

CARS = (1, 10, 100)

CRUISING = replace(STEADY, v_0=10.0, T_driver=lines((0.0, 10.0)))
"""Of any length, without getting fast."""

Cost = tuple[float, ...]


def alone(function: Callable[..., Any], *given: Any) -> Any:
    """What a function returns in a process of its own."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(function, *given).result()


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


def hosts_table(best: Mapping[str, Mapping[hosts.Contender, hosts.Run]]) -> str:
    rows = []
    for plant, runs in best.items():
        limit = next((run.cost for contender, run in runs.items() if contender.name == PLAIN), float("nan"))
        for contender, (cost, _) in sorted(runs.items(), key=lambda item: item[1].cost):
            factor = STEP_SIZE * MICRO / cost
            numbers = f"{cost:.2f}", f"{factor:.0f}", f"{cost / limit:.2f}"
            rows.append((plant, contender.name, contender.build, *numbers))
    headings = ("plant", "host", "FMUs", "µs a step", "times real time", "over plain C")
    return markdown_table(headings, rows, labels=3)


def instructions_table(costs: Mapping[str, float]) -> str:
    """Beside the time of the plain C loop, whose instructions they are."""
    if which("valgrind") is None:
        return "Not counted: there is no valgrind."
    counts = {plant: instructions.steps_of(plant) for plant in PLANTS}
    parts = list(next(iter(counts.values())))
    rows = [(plant, *(str(found[part]) for part in parts), f"{costs[plant]:.2f}") for plant, found in counts.items()]
    return markdown_table(("", *parts, "plain C, µs"), rows, labels=1)


def growth(least: Mapping[tuple[Any, ...], Cost], headings: Sequence[str], texts: Sequence[str]) -> str:
    """A row for each case, with its costs, and what the first of them is over that of the plant's first case."""
    return markdown_table(("plant", *headings, "ratio"), _grown(least, texts), labels=1)


def _grown(least: Mapping[tuple[Any, ...], Cost], texts: Sequence[str]) -> Iterator[tuple[str, ...]]:
    first: dict[str, float] = {}
    for (plant, case, *_), costs in least.items():
        ratio = costs[0] / first.setdefault(plant, costs[0])
        yield plant, f"{case:g}", *(f"{cost:{text}}" for cost, text in zip(costs, texts, strict=True)), f"{ratio:.2f}"


def of_cars(plant: str, runs: int) -> Cost:
    """Milliseconds a run, of so many on all cores."""
    return (many_runs.many(plant, runs)[0] / runs * 1e3,)


def commands_table(least: Mapping[str, float]) -> str:
    base = least["python, import numpy, scipy"]
    return markdown_table(("", "ms", "ratio"), [(n, f"{1e3 * s:.0f}", f"{s / base:.2f}") for n, s in least.items()], 1)


def page(turns: int, duration: float) -> str:
    """The page as Markdown.

    Args:
        turns: of each contender.
        duration: of its runs in s, where their length is not what is measured.
    """
    best = {plant: hosts.measure(plant, round(duration / STEP_SIZE), turns) for plant in PLANTS}
    plain = {
        plant: run.cost for plant, runs in best.items() for contender, run in runs.items() if contender.name == PLAIN
    }
    torques = [[run.T_gear for run in runs.values()] for runs in best.values()]
    missing = [contender.name for contender in CONTENDERS if not contender.present]
    speeds = in_turns(turns, at_speed, [(plant, v, duration) for plant in PLANTS for v in SPEEDS])
    lengths = in_turns(turns, of_length, [(plant, each) for plant in PLANTS for each in LENGTHS])
    cars = {(plant, n): of_cars(plant, n) for plant in PLANTS for n in CARS} if LIBRARY else {}
    return TEMPLATE.read_text(encoding="utf-8").format(
        python=platform.python_version(),
        cores=cpu_count(),
        machine=platform.machine(),
        same=f", to {max(max(each) - min(each) for each in torques):.0e} N·m",
        hosts=hosts_table(best),
        missing=f"Not installed: {', '.join(missing)}." if missing else "All of them are installed.",
        instructions=instructions_table(plain),
        speeds=growth(speeds, ("m/s", "µs a step"), (".2f",)),
        lengths=growth(lengths, ("s", "µs a step", "MB"), (".2f", ".0f")),
        cars=growth(cars, ("cars", "ms a car"), (".1f",)),
        commands=commands_table(start_up.measure(turns)),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--turns", type=int, default=7, help="of each contender (default: %(default)s)")
    parser.add_argument("--duration", type=float, default=5.0, help="of a run in s (default: %(default)s)")
    args = parser.parse_args()
    hosts.find_libraries()
    write_text(page(args.turns, args.duration), PAGE)
    print(PAGE, file=sys.stderr)


if __name__ == "__main__":
    script(main)
