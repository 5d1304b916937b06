"""What docs/control.md says of healthy drives that are taken for faults: just beyond its limits, and just within."""

import pytest

from harness.analysis.false_alarms import cruising, rolling_back, share_in_fallback
from harness.control_loop import PLANTS


@pytest.mark.parametrize(
    ("drive", "taken"),
    [
        (rolling_back(40.0, 0.5), False),
        (rolling_back(60.0, 0.5), True),
        (cruising(8.56, sigma_omega=0.02), False),
        (cruising(8.56, sigma_omega=0.0), True),
    ],
)
def test_rolling_back_under_torque_and_a_speed_without_noise_are_taken_for_faults(native, drive, taken):
    assert (share_in_fallback(PLANTS[0], drive, native.parent) > 0.0) == taken
