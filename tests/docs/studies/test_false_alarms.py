"""What docs/control.md says of healthy drives that come near to a fault: none is taken for one."""

import pytest

from docs.studies.false_alarms import cruising, rolling_back, share_in_fallback
from driveline.harness.loop.places import PLANTS


@pytest.mark.parametrize(
    "drive",
    [
        rolling_back(60.0, 0.2),
        rolling_back(60.0, 0.5),
        cruising(8.56, sigma_omega=0.0),
        cruising(8.56, q_omega=1.0),
    ],
)
def test_a_car_that_rolls_back_and_a_speed_without_noise_are_not_taken_for_faults(native, drive):
    assert share_in_fallback(PLANTS[0], drive, native.parent) == 0.0
