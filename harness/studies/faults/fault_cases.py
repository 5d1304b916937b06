"""The cases of a campaign: each is data, and follows from the campaign, its seed and its own number."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...manoeuvres.catalogue import EVERYDAY, GRADE, MANOEUVRES
from ...manoeuvres.manoeuvre import Manoeuvre
from ...manoeuvres.signals import lines
from .fault_catalogue import AT_STARTS, IN_SITUATIONS, KINDS, ON_ROADS, Kind, pairs, uniform

DURATION = 4.0
"""Of a run in a situation in s."""

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

    @property
    def duration(self) -> float:
        """Of a run in s."""
        return self.manoeuvre.duration


def _steady(name: str, v_0: float, T_driver: float) -> Manoeuvre:
    return Manoeuvre(name, name, DURATION, v_0, lines((0.0, T_driver)), t_0=1.0)


def _short(name: str) -> Manoeuvre:
    return replace(MANOEUVRES[name], duration=DURATION)


_SITUATIONS = {
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


def _abs(mu: float, frequency: float, T_brake: float) -> Manoeuvre:
    """Brakes as they are let go: half of each period."""
    pulses: list[tuple[float, float]] = []
    for t in np.arange(1.0, 3.5, 1.0 / frequency):
        pulses += [
            (t, 200.0),
            (t, 200.0 + T_brake),
            (t + 0.5 / frequency, 200.0 + T_brake),
            (t + 0.5 / frequency, 200.0),
        ]
    demand, brakes = lines((0.8, 12.0), (1.0, 0.0)), lines(*pulses)
    return Manoeuvre("abs", "abs", 4.0, 22.0, demand, brakes, t_0=1.0, road={"mu": mu})


def _rolls_back(mu: float, grade: float) -> Manoeuvre:
    demand, slope = lines((2.0, 0.0), (2.1, 120.0), (2.6, 120.0), (2.8, 15.0)), lines((0.2, 0.0), (0.7, grade))
    return Manoeuvre("rolls back", "rolls back", 6.0, 0.0, demand, slope=slope, t_0=1.5, road={"mu": mu})


def _rocks(mu: float) -> Manoeuvre:
    demand = lines((1.0, 0.0), (1.0, 80.0), (2.0, 80.0), (2.0, -80.0))
    return Manoeuvre("rocks", "rocks", 5.0, 0.0, demand, t_0=1.0, road={"mu": mu})


def _on_road(name: str, description: str, manoeuvre: Manoeuvre) -> Situation:
    """The fault begins in the first two thirds of what the manoeuvre is about."""
    last = manoeuvre.t_0 + 2.0 / 3.0 * (manoeuvre.duration - manoeuvre.t_0)
    return Situation(name, description, manoeuvre, manoeuvre.t_0, last)


_ROADS = {
    situation.name: situation
    for situation in (
        *(_on_road(each.name, each.description, each) for each in EVERYDAY),
        _on_road(
            "ice_hill_20",
            "rolls back on a 20 % grade of ice (mu 0.1), then 120 N.m until the wheels spin",
            _rolls_back(0.1, 0.2),
        ),
        _on_road(
            "snow_hill",
            "rolls back on a 12 % grade (mu 0.2), then 120 N.m until the wheels spin",
            _rolls_back(0.2, GRADE),
        ),
        _on_road("rocking", "80 N.m and back on ice (mu 0.15)", _rocks(0.15)),
        _on_road("abs_wet", "brake pulses of 1500 N.m at 8 Hz (mu 0.5)", _abs(0.5, 8.0, 1500.0)),
        _on_road("abs_ice", "brake pulses of 500 N.m at 4 Hz (mu 0.2)", _abs(0.2, 4.0, 500.0)),
    )
}


_REVERSE = Manoeuvre(
    name="reverse",
    description="pull away backwards, let go of the pedal, and a tip-in through the backlash",
    duration=DURATION,
    v_0=0.0,
    T_driver=lines((0.1, 0.0), (0.2, -100.0), (1.2, -100.0), (1.3, 12.0), (2.0, 12.0), (2.0, -100.0)),
    t_0=2.0,
)

_STARTS = {
    f"starts in {each.name}": Situation(f"starts in {each.name}", each.description, each, 0.0, 0.0)
    for each in (*map(_short, ("tipin15", "tipin50", "tipout", "creep", "one_pedal_soft", "regen")), _REVERSE)
}


@dataclass(frozen=True)
class Plan:
    """What the cases of a campaign are drawn from.

    Attributes:
        name: as on the command line.
        to_the_end: share of the faults that last to the end of the run, whatever their kind.
        excused: judges that do not count: nothing before the first samples tells that these are wrong.
    """

    name: str
    situations: Mapping[str, Situation]
    kinds: Mapping[str, Kind]
    to_the_end: float = 0.0
    excused: frozenset[str] = frozenset()
    pairs: Sequence[tuple[Kind, Kind]] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "pairs", pairs(self.kinds.values()))


PLANS = {
    plan.name: plan
    for plan in (
        Plan("dry", _SITUATIONS, IN_SITUATIONS),
        Plan("roads", _ROADS, ON_ROADS, 0.5),
        Plan("starts", _STARTS, AT_STARTS, excused=frozenset({"noticed", "kick", "rms", "swing"})),
    )
}
"""Of the campaigns, by name."""

SITUATIONS = _SITUATIONS | _ROADS | _STARTS


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
        size = f"{self.size:.4g} {self.kind.unit}".rstrip()
        return f"{self.name} (size {size}{share}) from {self.begin:.3f} to {self.end:.3f} s"


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

    @property
    def plan(self) -> "Plan":
        """That has its situation."""
        return next(plan for plan in PLANS.values() if self.situation in plan.situations)

    def __str__(self) -> str:
        return f"{self.number}: {self.plant}, {self.situation}, {' and '.join(map(str, self.faults))}"


def case(number: int, seed: int, plants: Sequence[str], plan: Plan = PLANS["dry"]) -> Case:
    """The case of a number, from 1 on; odd rounds over the plants are single faults, even ones pairs.

    Single faults go through all kinds and situations in turn, pairs through all situations with kinds at random.
    """
    rng = np.random.default_rng((seed, number))
    turn, plant = divmod(number - 1, len(plants))
    cell, is_pair = divmod(turn, 2)
    rest, place = divmod(cell, len(plan.situations))
    situation = list(plan.situations.values())[place]
    pair = plan.pairs[int(rng.integers(len(plan.pairs)))]
    kinds = pair if is_pair else (list(plan.kinds.values())[rest % len(plan.kinds)],)
    faults = tuple(_drawn(kind, situation, plan, rng) for kind in kinds)
    return Case(number, plants[plant], situation.name, faults, int(rng.integers(1, NOISES + 1)))


def _drawn(kind: Kind, situation: Situation, plan: Plan, rng: np.random.Generator) -> Fault:
    begin = round(uniform(situation.first, situation.last)(rng), 3)
    lasts = None if plan.to_the_end > 0.0 and rng.random() < plan.to_the_end else kind.lasts
    return Fault(
        name=kind.name,
        begin=begin,
        end=round(begin + lasts(rng), 3) if lasts else situation.duration + 1.0,
        size=kind.size(rng),
        share=kind.share(rng),
    )
