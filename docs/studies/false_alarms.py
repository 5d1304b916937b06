"""Healthy drives that come nearest to a fault, and are taken for one or nearly: the share of them in fallback.

The car rolls back on a grade of 20 % until the driver pushes, too little or late, or though he does; or it cruises
at 15 m/s with the torque that keeps this speed, or speeds up from there, and the speed of the motor is measured with
little noise or coarsely.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.signals import lines
from driveline.harness.simulation.simulate import simulate
from driveline.models.controller.supervision import FALLBACK
from fmuloop.many_runs import run_many

from .study import Column, Measured, Study, Table

GRADE = 0.2
HOLDING = 2400.0
"""Of the brakes that hold the car on that grade, N.m."""

RELEASED = 2.0
"""When they are released, s."""


class Drive(NamedTuple):
    """What is driven, and parameters of the loop."""

    manoeuvre: Manoeuvre
    parameters: Mapping[str, float] = {}


def rolling_back(T_driver: float, after: float) -> Drive:
    """The driver pushes with T_driver (N.m) so many seconds after the brakes were released."""
    pushes = RELEASED + after
    return Drive(
        Manoeuvre(
            name=f"rolling back, {T_driver:g} N.m after {after:g} s",
            description="",
            duration=8.0,
            v_0=0.0,
            T_driver=lines((pushes, 0.0), (pushes + 0.1, T_driver)),
            T_brake=lines((RELEASED, HOLDING), (RELEASED + 0.1, 0.0)),
            slope=lines((0.5, 0.0), (1.0, GRADE)),
        )
    )


def cruising(T_driver: float, **sensor: float) -> Drive:
    """With these parameters of the sensor."""
    name = f"from 15 m/s with {T_driver:g} N.m, {', '.join(f'{name} {value:g}' for name, value in sensor.items())}"
    parameters = {f"motor.{name}": value for name, value in sensor.items()}
    return Drive(Manoeuvre(name, "", 10.0, 15.0, lines((0.0, T_driver))), parameters)


DRIVES = (
    rolling_back(10.0, -1.0),
    rolling_back(60.0, -1.0),
    rolling_back(20.0, 0.0),
    rolling_back(60.0, 0.0),
    rolling_back(60.0, 0.1),
    rolling_back(60.0, 0.2),
    rolling_back(40.0, 0.5),
    rolling_back(60.0, 0.5),
    rolling_back(150.0, 0.5),
    rolling_back(150.0, 1.0),
    cruising(8.56, sigma_omega=0.02),
    cruising(8.56, sigma_omega=0.0),
    cruising(8.56, q_omega=0.5),
    cruising(8.56, q_omega=1.0),
    cruising(8.56, sigma_omega=0.0, q_omega=1.0),
    cruising(40.0, sigma_omega=0.0),
    cruising(40.0, sigma_omega=0.0, q_omega=1.0),
)


def share_in_fallback(plant: str, drive: Drive) -> float:
    """In %."""
    results = simulate(drive.manoeuvre, plant, parameters=drive.parameters)
    return 100.0 * float(np.mean(results["controller.status"] == FALLBACK))


def shares(drives: Sequence[Drive]) -> Table:
    """A row for each drive."""
    cases = [(plant, drive) for drive in drives for plant in PLANTS]
    answers = iter(run_many(lambda case: share_in_fallback(*case), cases, label="healthy drives"))
    rows = {drive.manoeuvre.name: tuple(next(answers) for _ in PLANTS) for drive in drives}
    return Table("drive", tuple(Column(f"{plant}, in fallback", "%", 0) for plant in PLANTS), rows)


STUDY = Study(
    "healthy drives that come nearest to a fault",
    lambda: Measured({"shares": shares(DRIVES)}),
    lambda: {"shares": shares([DRIVES[6], DRIVES[12]])},
    {"shares": [DRIVES[6].manoeuvre.name, DRIVES[12].manoeuvre.name]},
    seconds=10,
)
