"""What docs/control.md says of healthy drives that come near to a fault: which is taken for one, and which are not."""

import pytest

from docs.studies.false_alarms import cruising, rolling_back, share_in_fallback
from driveline.harness.loop.places import PLANTS


@pytest.mark.parametrize(
    ("drive", "taken"),
    [
        (rolling_back(60.0, 0.2), True),
        (rolling_back(60.0, 0.5), False),
        (cruising(8.56, sigma_omega=0.0), False),
        (cruising(8.56, q_omega=1.0), False),
    ],
)
def test_who_pushes_long_after_the_car_rolls_back_and_a_speed_without_noise_are_not_taken_for_faults(
    native, drive, taken
):
    assert (share_in_fallback(PLANTS[0], drive, native.parent) > 0.0) == taken
