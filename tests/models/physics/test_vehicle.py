"""What all blocks that know the vehicle take."""

import pytest

from driveline.fmus.building.one_car import of_one_car
from driveline.fmus.errors import ParameterFileError


def test_a_motor_turns_at_least_as_fast_as_the_wheels() -> None:
    assert of_one_car({"i": 1.0}, ())["i"] == 1.0
    with pytest.raises(ParameterFileError, match=r"^i = 0\.99: .* takes 1 to 30"):
        of_one_car({"i": 0.99}, ())
