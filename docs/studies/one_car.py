"""One car in both plants: at which frequency its drive train swings in each, for the examples and for drawn cars.

    python -m docs.studies.one_car

The cars are drawn by what a short vehicle file names; all else follows. Rolling at 15 km/h, teeth in contact.
"""

from collections.abc import Mapping
from math import pi, sqrt
from random import Random
from typing import NamedTuple

from rich.table import Table

from docs.studies.imports import ROOT
from driveline.fmus.building.one_car import DEFAULT_CAR, DESIGN, DETAILED, FOLLOW, of_one_car
from driveline.fmus.building.oscillation import oscillation
from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.base.interruption import script
from driveline.harness.views.terminal import print_table

CARS, SEED = 20, 1

Car = Mapping[str, float]


class Frequencies(NamedTuple):
    """Frequencies in Hz.

    Attributes:
        free: of the two masses, sqrt(C (1/J_1 + 1/J_2))/(2 pi).
        design: of the design model on its tyre.
        detailed: of the validation vehicle.
    """

    free: float
    design: float
    detailed: float

    @property
    def apart(self) -> float:
        """The validation vehicle over the design model."""
        return self.detailed / self.design


def frequencies(car: Car) -> Frequencies:
    full = of_one_car(car, FOLLOW)
    swings = [
        oscillation(plant, plant.Parameters(**{name: full[name] for name in plant.Parameters._fields if name in full}))
        for plant in (DESIGN, DETAILED)
    ]
    J_1, J_2, C = (full.get(name, DEFAULT_CAR[name]) for name in ("J_1", "J_2", "C"))
    return Frequencies(sqrt(C * (1.0 / J_1 + 1.0 / J_2)) / (2.0 * pi), *(each.frequency for each in swings))


def drawn(random: Random) -> dict[str, float]:
    """A car between a small one and a truck of 12 t."""
    m = 800.0 * 15.0 ** random.random()
    r, i = 0.28 + 2e-5 * m * random.random(), random.uniform(8.0, 14.0) * (1.0 if m < 5000.0 else 1.6)
    M = m * r * r / (i * i)
    J_1 = M * random.uniform(0.025, 0.065)
    return {
        "m": m,
        "r": r,
        "i": i,
        "c_slip": 0.6 * m * 9.81 * random.uniform(13.0, 20.0),
        "J_1": J_1,
        "J_2": M * random.uniform(0.1, 0.3),
        "C": J_1 * (2.0 * pi * random.uniform(4.5, 8.0)) ** 2,
        "phi_B": i * random.uniform(0.005, 0.03),
    }


def cars() -> dict[str, dict[str, float]]:
    """The default car, those of the examples, and drawn ones."""
    examples = {path.stem: read_vehicle(path) for path in sorted((ROOT / "examples" / "cars").glob("*.toml"))}
    random = Random(SEED)
    return {"default": {}, **examples, **{f"drawn {k}": drawn(random) for k in range(1, CARS + 1)}}


def main() -> None:
    table = Table(title="drive train in Hz; apart: ValidationVehicle over TwoMassDriveline, and over that of default")
    for heading in ("car", "two masses", "TwoMassDriveline", "ValidationVehicle", "apart", "over default", "k_s"):
        table.add_column(heading, justify="left" if heading == "car" else "right")
    usual = frequencies({}).apart
    for name, car in cars().items():
        found = frequencies(car)
        k_s = of_one_car(car, FOLLOW).get("k_s", DEFAULT_CAR["k_s"])
        cells = [*(f"{f:.2f}" for f in found), *(f"{x:.4f}" for x in (found.apart, found.apart / usual)), f"{k_s:.0f}"]
        table.add_row(name, *cells)
    print_table(table)


if __name__ == "__main__":
    script(main)
