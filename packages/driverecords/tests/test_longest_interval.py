"""The longest time for which something holds without a break."""

import numpy as np
import pytest

from driverecords.longest_interval import longest_run


@pytest.mark.parametrize(
    ("held", "run"),
    [
        ("", (0, 0)),
        ("000", (0, 0)),
        ("111", (0, 3)),
        ("0110111011", (4, 3)),
        ("1101100", (0, 2)),
        ("100111", (3, 3)),
    ],
)
def test_the_first_of_the_longest_runs_is_found_wherever_it_is(held: str, run: tuple[int, int]) -> None:
    assert longest_run(np.array([sign == "1" for sign in held], dtype=bool)) == run
