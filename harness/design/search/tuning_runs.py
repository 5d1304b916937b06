"""Which runs a controller is tuned by, and what is held out: the proof is of what the tuning has never seen."""

from dataclasses import replace
from typing import NamedTuple

from ...loop.places import PLANTS
from ...manoeuvres import catalogue
from ...manoeuvres.catalogue import COMPARED
from ...manoeuvres.manoeuvre import Manoeuvre
from ..uncertainty_box import BOX, NOMINAL, Deviation, corner, screening

HELD_OUT_MANOEUVRES = ("tipin50r", "launch_brake", "hill_hold")
"""Neither these nor any recorded drive are among the runs."""

HELD_OUT_SEEDS = (11, 12, 13)
"""Of noise and jitter. The corners of the box are the only draws of its parameters; what is inside is held out."""

SEARCHED_MANOEUVRES = tuple(name for name in COMPARED if name not in HELD_OUT_MANOEUVRES)
SEEDS = (1, 2, 3)

LASTS = 2.0
"""How long in s a run goes on after a step: nothing that is damped lasts longer."""

AT_CORNERS = ("tipin15", "tipout", "launch")
SLOW_MOTOR = Deviation(tau=3.0)


class Run(NamedTuple):
    """A run that counts.

    Attributes:
        plant, name: of the plant and of the manoeuvre.
        deviation: of car and sensors from what the controller assumes.
        seed: of noise and jitter.
        weight: how much it counts.
    """

    plant: str
    name: str
    deviation: Deviation
    seed: int
    weight: float

    @property
    def manoeuvre(self) -> Manoeuvre:
        """As far as it is driven."""
        whole = catalogue.MANOEUVRES[self.name]
        return whole if whole.dT is None else replace(whole, duration=whole.t_0 + LASTS)

    def __str__(self) -> str:
        return f"{self.name} on {self.plant}, {self.deviation}, seed {self.seed}"


def _runs() -> tuple[Run, ...]:
    """All manoeuvres with the car as it is, and a few of them with a slow motor and at corners of the box."""
    cases = [(plant, name, NOMINAL, 1.0) for plant in PLANTS for name in SEARCHED_MANOEUVRES]
    cases += [(plant, "tipin15", SLOW_MOTOR, 0.5) for plant in PLANTS]
    for row in screening():
        high = dict(zip([*BOX, "plant"], row, strict=False))
        cases += [(PLANTS[high["plant"]], name, corner(high), 0.5) for name in AT_CORNERS]
    return tuple(
        Run(plant, name, deviation, SEEDS[k % len(SEEDS)], weight)
        for k, (plant, name, deviation, weight) in enumerate(cases)
    )


RUNS = _runs()
