"""Bounds in an A2L file are numbers of single precision, as those of the target are."""

import numpy as np

from driveline.fmus.description.variables import interface
from driveline.fmus.target.a2l import LARGEST, _described
from driveline.models.damping_controller import BLOCK


def test_the_largest_number_is_that_of_single_precision() -> None:
    assert float(np.finfo(np.float32).max) == LARGEST


def test_what_has_no_bounds_is_bounded_by_the_largest_numbers_and_the_others_keep_theirs() -> None:
    found = {}
    for variable in interface(BLOCK):
        low, high = map(float, _described(variable, 0, "{low} {high}").split())
        assert low == max(variable.bounds()[0], -LARGEST)
        assert high == min(variable.bounds()[1], LARGEST)
        found[variable.name] = low, high
    assert found["T_driver"] == (-LARGEST, LARGEST)
    assert found["T_max"] == (1.0, 2000.0)
