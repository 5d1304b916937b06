"""The manoeuvres of the catalogue are shares of what the motor of a car can do."""

from math import inf

import numpy as np
from fmutesting.together import together

from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.composed import composed
from driveline.harness.manoeuvres.for_car import for_car
from driveline.harness.manoeuvres.parts import constant


@together("name", [*MANOEUVRES])
def test_a_motor_of_twice_the_torque_is_asked_for_twice_as_much_and_the_default_one_for_the_same(name: str) -> None:
    manoeuvre = MANOEUVRES[name]
    twice, t = for_car(manoeuvre, 360.0), np.linspace(0.0, manoeuvre.duration, 997)
    assert np.array_equal(twice.T_driver(t), 2.0 * manoeuvre.T_driver(t))
    assert twice.dT == (2.0 * manoeuvre.dT if manoeuvre.dT else manoeuvre.dT)
    assert (twice.T_brake, twice.slope, twice.v_0, twice.road) == (
        manoeuvre.T_brake, manoeuvre.slope, manoeuvre.v_0, manoeuvre.road
    )  # fmt: skip
    for same in (180.0, inf):
        assert for_car(manoeuvre, same) is manoeuvre
    assert np.array_equal(for_car(composed(name, 1.0, 0.0, constant(30.0)), 90.0).T_driver(t), 15 + 0 * t)
