"""One car in both plants: at which frequency its drive train swings in each, for the examples and for drawn cars.

The cars are drawn by what a short vehicle file names; all else follows. Rolling at 15 km/h, teeth in contact.
"""

from collections.abc import Mapping
from math import pi, sqrt
from random import Random
from typing import NamedTuple

from driveline.fmus.building.one_car import DEFAULT_CAR, DESIGN, DETAILED, FOLLOW, of_one_car
from driveline.fmus.building.oscillation import oscillation
from driveline.fmus.building.parameter_files import read_vehicle

from .data_file import ROOT
from .study import Cell, Column, Measured, Study, Table

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
    return Frequencies(sqrt(C * (1.0 / J_1 + 1.0 / J_2)) / (2.0 * pi), *(swing.frequency for swing in swings))


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


COLUMNS = (
    Column("two masses", "Hz", 2),
    Column("TwoMassDriveline", "Hz", 2),
    Column("ValidationVehicle", "Hz", 2),
    Column("vehicle over model", "", 4, 0.0),
    Column("over that of default", "", 4, 0.0),
    Column("k_s", "N.m/rad", 0),
)


def frequencies_table(chosen: Mapping[str, Car]) -> Table:
    """How the drive trains of cars swing."""
    usual = frequencies({}).apart
    rows: dict[str, tuple[Cell, ...]] = {}
    for name, car in chosen.items():
        own = frequencies(car)
        k_s = of_one_car(car, FOLLOW).get("k_s", DEFAULT_CAR["k_s"])
        rows[name] = (*own, own.apart, own.apart / usual, k_s)
    return Table("car", COLUMNS, rows)


def spread_table(table: Table) -> Table:
    """The least and the largest of each column."""
    columns = list(zip(*table.rows.values(), strict=True))
    return Table("of all cars", COLUMNS, {extreme.__name__: tuple(map(extreme, columns)) for extreme in (min, max)})


def measure() -> Measured:
    table = frequencies_table(cars())
    return Measured({"frequencies": table, "spread": spread_table(table)})


def again() -> dict[str, Table]:
    return {"frequencies": frequencies_table({name: cars()[name] for name in SENTINELS})}


SENTINELS = ("default", "van", "drawn 1")

STUDY = Study(
    "at which frequency the drive train of one car swings in either plant",
    measure,
    again,
    {"frequencies": SENTINELS},
    (SEED,),
    seconds=2,
)
