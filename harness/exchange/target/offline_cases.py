"""What the controller is fed with off-line: what it got in the loop, and what no car would send."""

from collections.abc import Iterator, Sequence
from math import inf, nan
from pathlib import Path
from typing import NamedTuple

import numpy as np

from driverecords.drive import read_drive
from fmuloop.system import System

from ...loop.resolved import ResolvedLoop
from ...manoeuvres.catalogue import TOWN_DRIVE, USUAL_MANOEUVRES
from ...manoeuvres.for_car import for_car
from ...manoeuvres.manoeuvre import Manoeuvre
from ...manoeuvres.road_load import RoadLoad, Track
from ...metrics.evaluate import at_samples
from ...simulation.simulate import signals, simulate
from ...studies.drives.replay import followed

SAMPLES = 5000  # of each random case
LARGEST, SMALLEST = float(np.finfo(np.float32).max), float(np.finfo(np.float32).smallest_subnormal)
ABSURD = (nan, inf, -inf, LARGEST, -LARGEST, SMALLEST, -SMALLEST, 1e-40, 1e10, -1e10, 0.0, -0.0)
"""Of single precision; 1e-40 is a denormal number too."""

OFTEN = 0.1
"""Share of the absurd ones among the inputs."""

WIDER = 1.5
"""Over what a number of the state was in the manoeuvres, the range from which it is drawn."""


class Case(NamedTuple):
    """What the controller is fed with.

    Attributes:
        names: of the inputs, in the order of its record.
        inputs: a row a sample.
        states: a state that is set before each sample, a row each; None: it keeps its own.
        drawn: at random; no loop gave it.
    """

    name: str
    names: tuple[str, ...]
    inputs: np.ndarray
    states: np.ndarray | None = None
    drawn: bool = False


def recorded(manoeuvre: Manoeuvre, resolved: ResolvedLoop, names: Sequence[str]) -> Case:
    """What the controller of a loop, which has inputs of these names, got in a manoeuvre."""
    return fed(manoeuvre, at_samples(simulate(manoeuvre, resolved)), resolved.system, names)


def fed(manoeuvre: Manoeuvre, results: np.ndarray, system: System, names: Sequence[str]) -> Case:
    """What it got in a run, of which these are the results at its samples; 0 where the loop gives it nothing."""
    sources = {name: name for name in signals(manoeuvre)} | {target: source for source, target, _ in system.connections}
    sent = [sources.get(f"controller.{name}") for name in names]
    columns = [np.zeros(len(results)) if source is None else np.asarray(results[source], float) for source in sent]
    return Case(manoeuvre.name, tuple(names), np.column_stack(columns))


def cases_in_loop(resolved: ResolvedLoop, names: Sequence[str]) -> Iterator[Case]:
    """What it got in every manoeuvre and on the recorded drive; arguments as for `recorded`."""
    T_max = resolved.T_max
    for manoeuvre in USUAL_MANOEUVRES:
        yield recorded(for_car(manoeuvre, T_max), resolved, names)
    track = Track.of(read_drive(Path(TOWN_DRIVE)), T_max)
    yield recorded(followed(track, RoadLoad.of(resolved), resolved)[0], resolved, names)


def random_inputs(cases: Sequence[Case], seed: int, samples: int = SAMPLES) -> Iterator[Case]:
    """Random inputs from the ranges that the inputs of the cases have, and then absurd ones among them."""
    draw = np.random.default_rng(seed)
    inputs = np.concatenate([case.inputs for case in cases])
    random = draw.uniform(inputs.min(axis=0), inputs.max(axis=0), (samples, inputs.shape[1]))
    whole = np.all(inputs == np.round(inputs), axis=0)
    random[:, whole] = np.round(random[:, whole])
    names = cases[0].names
    yield Case("random inputs", names, random, drawn=True)
    absurd = np.where(draw.random(random.shape) < OFTEN, draw.choice(ABSURD, random.shape), random)
    yield Case("absurd inputs", names, absurd, drawn=True)


def random_states(random: Case, visited: np.ndarray, seed: int) -> Case:
    """Every sample from a random state, with the inputs of a case.

    Args:
        visited: states that were, a row each.
    """
    draw = np.random.default_rng(seed)
    low, high = visited.min(axis=0), visited.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * WIDER * (high - low)
    states = draw.uniform(middle - half, middle + half, (len(random.inputs), visited.shape[1]))
    return random._replace(name="random states", states=states.astype(np.float32).astype(float))
