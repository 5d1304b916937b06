"""Innovations of the filter: their derivatives, and what they are where parameters and noise are true."""

from dataclasses import replace

import numpy as np
import pytest

from driveline.harness.identification.drive_train import Parameters
from driveline.harness.identification.model_inputs import Drive
from driveline.harness.identification.prediction import Innovations, Noise, Predictor, filtered
from tests.harness.identification.simulated import NOISE, P, simulated

SETTLED = 100
"""Samples until the filter has forgotten what it began with."""

LAST = 3
"""Samples at the end of which nothing is known if a torque comes 6 ms late."""

SKEWED = P._replace(late_1=0.0004, late_T=0.0007, late_L=-0.0013)

STEP = 1e-5
"""Relative, of central differences."""


def moved(name: str, by: float) -> Parameters:
    return SKEWED._replace(**{name: getattr(SKEWED, name) + by})


@pytest.fixture(scope="module")
def drive() -> Drive:
    return simulated(seed=1)


@pytest.fixture(scope="module")
def innovations(drive: Drive) -> Innovations:
    return Predictor(Parameters._fields).innovations(drive, SKEWED, NOISE)


@pytest.mark.parametrize("name", Parameters._fields)
def test_the_derivatives_are_those_of_the_innovations(name: str) -> None:
    """Over the first half second, with teeth that meet and part."""
    drive = simulated(seed=1, n=250)
    found = Predictor([name]).innovations(drive, SKEWED, NOISE)
    step = STEP * getattr(SKEWED, name)
    more, less = (filtered(drive, moved(name, by), NOISE) for by in (step, -step))
    for derivative, high, low in (
        (found.d_size[:, 0], more.size, less.size),
        (found.d_log_S[:, 0], more.log_S, less.log_S),
    ):
        difference = (high - low) / (2.0 * step)
        largest = np.abs(difference).max()
        assert largest > 0.0
        np.testing.assert_allclose(derivative, difference, atol=1e-5 * largest)


def test_size_and_log_S_are_those_without_derivatives(drive: Drive, innovations: Innovations) -> None:
    alone = filtered(drive, SKEWED, NOISE)
    np.testing.assert_allclose(innovations.size, alone.size, atol=1e-9)
    np.testing.assert_allclose(innovations.log_S, alone.log_S, atol=1e-9)
    assert innovations.cost == pytest.approx(alone.cost, rel=1e-12)


@pytest.mark.parametrize("acts", [False, True])
def test_gradient_and_cost_belong_together(drive: Drive, acts: bool) -> None:
    noise = replace(NOISE, acts=acts)
    innovations = Predictor(Parameters._fields).innovations(drive, SKEWED, noise)
    for k, name in enumerate(Parameters._fields):
        step = STEP * getattr(SKEWED, name)
        more, less = (filtered(drive, moved(name, by), noise).cost for by in (step, -step))
        assert innovations.gradient[k] == pytest.approx((more - less) / (2.0 * step), rel=1e-4), name


def test_with_true_parameters_and_noise_the_innovations_are_white_and_of_size_1(drive: Drive) -> None:
    size = filtered(drive, P, NOISE).size[SETTLED:]
    n = len(size)
    assert np.mean(size**2) == pytest.approx(1.0, abs=3.0 * np.sqrt(2.0 / n))
    assert abs(size.mean()) < 3.0 / np.sqrt(n)
    correlations = np.array([size[lag:] @ size[:-lag] / (size @ size) for lag in range(1, 26)])
    assert np.abs(correlations).max() < 4.0 / np.sqrt(n)
    assert n * np.sum(correlations**2) < 52.6, "chi-square of 25, once in a thousand"


@pytest.mark.parametrize(
    ("parameters", "noise"),
    [
        (P._replace(J_1=1.03 * P.J_1), NOISE),
        (P._replace(C=1.03 * P.C), NOISE),
        (P._replace(phi_B=1.1 * P.phi_B), NOISE),
        (P, replace(NOISE, omega_1=0.8 * NOISE.omega_1)),
    ],
)
def test_with_wrong_ones_they_are_larger(drive: Drive, parameters: Parameters, noise: Noise) -> None:
    right = filtered(drive, P, NOISE).size[SETTLED:]
    wrong = filtered(drive, parameters, noise).size[SETTLED:]
    assert np.mean(wrong**2) > np.mean(right**2) + 0.1


def test_the_errors_are_those_of_the_motor_speed(drive: Drive) -> None:
    """What the filter knows after a sample lies between what it predicted and what was recorded."""
    through = filtered(drive, P, NOISE)
    after = drive.omega_1[1:] - through.states[:, 0]
    share = after[SETTLED:] / through.errors[SETTLED:]
    assert share.min() > 0.0
    assert share.max() < 1.0


def test_the_filter_finds_twist_wheel_speed_and_offsets() -> None:
    drive = simulated(seed=2, noise=Noise(0.01, 0.01, 0.01), o_T=0.8, o_L=-1.2)
    states = filtered(drive, P, Noise(0.01, 0.01, 0.01)).states[-1]
    clean = simulated(seed=2, noise=Noise(0.0, 0.0, 0.0))
    assert states[0] == pytest.approx(clean.omega_1[-1], abs=0.02)
    assert states[3] == pytest.approx(0.8, abs=0.1)
    assert states[4] == pytest.approx(-1.2, abs=0.1)


def test_the_information_about_a_standard_deviation_is_that_of_the_textbook() -> None:
    """2 n about its logarithm; and n about a mean, in standard deviations."""
    n = 100_000
    size = np.random.default_rng(1).standard_normal(n)
    d_size, d_log_S = np.column_stack([-size, -np.ones(n)]), np.column_stack([np.full(n, 2.0), np.zeros(n)])
    information = Innovations(size, np.zeros(n), slice(n), True, d_size, d_log_S).information
    np.testing.assert_allclose(information / n, [[2.0, 0.0], [0.0, 1.0]], atol=0.02)


def test_the_information_tells_how_the_gradient_scatters() -> None:
    """Over seeds the gradient has mean 0 and the information as its covariance."""
    free = ("J_1", "J_2", "C", "phi_B")
    predictor = Predictor(free)
    each = [predictor.innovations(simulated(seed, n=750), P, NOISE) for seed in range(24)]
    information = np.mean([one.information for one in each], axis=0)
    root = np.linalg.cholesky(np.linalg.inv(information))
    scores = np.array([root.T @ one.gradient for one in each])
    assert np.abs(scores.mean(axis=0)).max() < 4.0 / np.sqrt(24)
    assert np.mean(scores**2) == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / scores.size))


def test_only_the_variance_of_noise_that_acts_counts(drive: Drive) -> None:
    of_sensors, acting = (filtered(drive, P, replace(NOISE, acts=acts)) for acts in (False, True))
    np.testing.assert_array_equal(of_sensors.size, acting.size)
    counted = acting.log_S[acting.counted]
    assert acting.cost - of_sensors.cost == pytest.approx(0.5 * counted.sum())


def test_noise_of_a_sensor_biases_no_inertia_and_would_if_it_counted_as_acting() -> None:
    """By the mean gradient over seeds, in standard deviations of that mean; the load torque is hardly known."""
    noise = replace(NOISE, T_load=20.0)
    seen = [Predictor(["J_2"]).innovations(simulated(seed, n=750, noise=noise), P, noise) for seed in range(64)]
    for likelihood, biased in ((False, False), (True, True)):
        gradients = np.array([replace(one, likelihood=likelihood).gradient[0] for one in seen])
        assert (abs(gradients.mean()) > 3.0 * gradients.std() / np.sqrt(len(seen))) == biased


def test_a_recording_that_begins_in_the_middle_of_a_swing_is_explained_as_well(drive: Drive) -> None:
    """What the filter is off by until it has found its state does not count."""
    for first in range(100, 700, 50):
        through = filtered(drive.between(first, len(drive)), P, NOISE)
        assert through.counted == slice(SETTLED, len(drive) - first - LAST)
        assert through.rms == pytest.approx(1.0, abs=0.1)
        assert through.cost == pytest.approx(0.5 * (through.size[SETTLED:-LAST] ** 2).sum())
