"""A torque that is recorded early or late is brought back to when it acted, between the samples too."""

import numpy as np
import pytest

from driveline.harness.identification.drive_train import STEPS
from driveline.harness.identification.time_shifts import MOST, integral, shifted

T_S, N = 0.002, 200


def means(late: float = 0.0) -> np.ndarray:
    """Of 30 sin(2 pi 8 Hz (t + late)) over each part of the samples, shape (N, STEPS)."""
    omega, edges = 2.0 * np.pi * 8.0, T_S * np.arange(STEPS * N + 1) / STEPS + late
    return (np.diff(-30.0 / omega * np.cos(omega * edges)) / T_S * STEPS).reshape(N, STEPS)


@pytest.mark.parametrize("late", [0.0, 0.0003, -0.0013, 0.005, -0.003])
def test_a_sine_is_shifted_by_any_part_of_a_sample(late: float) -> None:
    found, inside = shifted(integral(means(), T_S), 0, N, late / T_S), slice(5, -5)
    np.testing.assert_allclose(found[inside], means(late)[inside], atol=1e-5)


def test_a_piece_of_it_is_that_of_the_whole() -> None:
    of = integral(means(), T_S)
    np.testing.assert_allclose(shifted(of, 50, 90, 0.3), shifted(of, 0, N, 0.3)[50:90], rtol=1e-9, atol=1e-9)


def test_its_derivative_is_by_the_shift_in_samples() -> None:
    of, by = integral(means(), T_S), 1e-5
    difference = (shifted(of, 0, N, 0.3 + by) - shifted(of, 0, N, 0.3 - by)) / (2.0 * by)
    np.testing.assert_allclose(shifted(of, 0, N, 0.3, derivative=1), difference, atol=1e-5)


def test_a_torque_that_jumps_keeps_its_mean_and_is_held_beyond_both_ends() -> None:
    jump = np.where(np.arange(N * STEPS) < 400, -20.0, 40.0).reshape(N, STEPS)
    for late in (-MOST, MOST):
        found = shifted(integral(jump, T_S), 0, N, late / T_S)
        np.testing.assert_allclose(found[[0, -1]], [[-20.0] * STEPS, [40.0] * STEPS], atol=1e-6)
        gained = round(late / T_S * STEPS)
        assert found.sum() == pytest.approx(jump.sum() + gained * 60.0, rel=1e-9)
