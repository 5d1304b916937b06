import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from driveline.harness.metrics.declaration import Absent
from driveline.harness.metrics.oscillation import low_passed


@pytest.mark.parametrize(("samples", "T_s"), [(10, 2e-3), (500, 1e-2), (3001, 2e-3), (4097, 1e-3)])
def test_the_low_pass_is_that_of_scipy_to_rounding(samples, T_s):
    x = np.random.default_rng(1).standard_normal(samples)
    expected = sosfiltfilt(butter(2, 12.0, fs=1.0 / T_s, output="sos"), x)
    assert low_passed(x, T_s, 12.0) == pytest.approx(expected, abs=1e-13)


def test_the_low_pass_leaves_a_straight_line_in_its_middle():
    x = 3.0 + 0.01 * np.arange(2000)
    assert low_passed(x, 2e-3, 12.0)[500:1500] == pytest.approx(x[500:1500], rel=1e-10)


@pytest.mark.parametrize(("samples", "T_s"), [(9, 2e-3), (0, 2e-3), (500, 1.0 / 24.0)])
def test_too_few_samples_for_the_low_pass_have_no_answer(samples, T_s):
    with pytest.raises(Absent, match=f"{samples} samples every"):
        low_passed(np.ones(samples), T_s, 12.0)
    assert low_passed(np.ones(10), 0.99 / 24.0, 12.0) == pytest.approx(np.ones(10))
