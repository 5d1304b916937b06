"""The cases of a campaign: each is data, and follows from the seed of the campaign and its own number."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...manoeuvres.catalogue import MANOEUVRES
from ...manoeuvres.manoeuvre import Manoeuvre
from ...manoeuvres.signals import lines
from .fault_catalogue import KINDS, PAIRS, Kind, uniform

DURATION = 4.0
"""Of a run in s."""

NOISES = 16
"""Seeds of the sensor noise; runs without faults are shared by the cases that have them in common."""


@dataclass(frozen=True)
class Situation:
    """Where a fault begins.

    Attributes:
        first, last: the fault begins between these instants, s.
    """

    name: str
    description: str
    manoeuvre: Manoeuvre
    first: float
    last: float


def _steady(name: str, v_0: float, T_driver: float) -> Manoeuvre:
    return Manoeuvre(name, name, DURATION, v_0, lines((0.0, T_driver)), t_0=1.0)


def _short(name: str) -> Manoeuvre:
    return replace(MANOEUVRES[name], duration=DURATION)


SITUATIONS = {
    situation.name: situation
    for situation in (
        Situation("gap", "in the gap of a tip-in at 15 km/h", _short("tipin15"), 1.005, 1.035),
        Situation("peak", "at the peak of the torque of that tip-in", _short("tipin15"), 1.05, 1.1),
        Situation("launch", "while pulling away", _short("launch"), 1.0, 1.2),
        Situation("coasting", "coasting at 15 m/s", _steady("coasting", 15.0, 0.0), 1.0, 1.1),
        Situation("cruising", "at 15 m/s with 40 N.m", _steady("cruising", 15.0, 40.0), 1.0, 1.1),
        Situation("standing", "standing", _steady("standing", 0.0, 0.0), 1.0, 1.1),
    )
}


@dataclass(frozen=True)
class Fault:
    """One thing that goes wrong, from `begin` to `end` (s); `size` and `share` as its kind means them."""

    name: str
    begin: float
    end: float
    size: float
    share: float

    @property
    def kind(self) -> Kind:
        return KINDS[self.name]

    def __str__(self) -> str:
        share = f", share {self.share:.3g}" if self.share != 1.0 else ""
        return f"{self.name} (size {self.size:.4g}{share}) from {self.begin:.3f} to {self.end:.3f} s"


@dataclass(frozen=True)
class Case:
    """One run of the campaign.

    Attributes:
        noise: seed of all noise.
    """

    number: int
    plant: str
    situation: str
    faults: tuple[Fault, ...]
    noise: int

    def __str__(self) -> str:
        return f"{self.number}: {self.plant}, {self.situation}, {' and '.join(map(str, self.faults))}"


def case(number: int, seed: int, plants: Sequence[str]) -> Case:
    """The case of a number, from 1 on; odd rounds over the plants are single faults, even ones pairs.

    Single faults go through all kinds and situations in turn, pairs through all situations with kinds at random.
    """
    rng = np.random.default_rng((seed, number))
    turn, plant = divmod(number - 1, len(plants))
    cell, is_pair = divmod(turn, 2)
    rest, place = divmod(cell, len(SITUATIONS))
    situation = list(SITUATIONS.values())[place]
    pair = PAIRS[int(rng.integers(len(PAIRS)))]
    kinds = pair if is_pair else (list(KINDS.values())[rest % len(KINDS)],)
    faults = tuple(_drawn(kind, situation, rng) for kind in kinds)
    return Case(number, plants[plant], situation.name, faults, int(rng.integers(1, NOISES + 1)))


def _drawn(kind: Kind, situation: Situation, rng: np.random.Generator) -> Fault:
    begin = round(uniform(situation.first, situation.last)(rng), 3)
    return Fault(
        name=kind.name,
        begin=begin,
        end=round(begin + kind.lasts(rng), 3) if kind.lasts else DURATION + 1.0,
        size=kind.size(rng),
        share=kind.share(rng),
    )
