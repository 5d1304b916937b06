"""What is said of an estimate is what its error is."""

from math import isnan

import numpy as np
import pytest

from driveline.harness.metrics.estimate import estimate_metrics


def results(true: list[float], estimated: list[float], phi_hat: float = 0.1) -> np.ndarray:
    columns = ("time", "plant.T_gear", "controller.T_gear_hat", "controller.phi_hat")
    rows = [(0.002 * k, *each, phi_hat) for k, each in enumerate(zip(true, estimated, strict=True))]
    return np.array(rows, dtype=[(name, float) for name in columns])


def test_an_estimate_that_is_a_fifth_of_the_torque_is_biased_by_four_fifths() -> None:
    found = estimate_metrics(results([10.0, -20.0, 30.0], [2.0, -4.0, 6.0]))
    assert found.bias == pytest.approx(-0.8)
    assert found.wrong_mode == 0.0
    assert "the teeth are never in the gap" in found.absent["wrong_gap"]


def test_the_other_flank_and_the_gap_are_wrong_modes() -> None:
    found = estimate_metrics(results([10.0, 10.0, 0.0, 0.0, -5.0], [9.0, 0.0, 0.0, 3.0, 2.0]))
    assert found.wrong_mode == pytest.approx(0.6)
    assert found.wrong_gap == pytest.approx(0.5)
    assert found.error_rms == pytest.approx(np.sqrt((1.0 + 100.0 + 49.0) / 3.0))


def test_a_controller_that_estimates_no_twist_has_no_estimate() -> None:
    found = estimate_metrics(results([10.0, 0.0], [9.0, 9.0], phi_hat=0.0))
    assert isnan(found.bias)
    assert found.absent["bias"] == "the controller estimates no twist"
