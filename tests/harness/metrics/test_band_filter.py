"""Signals within a band, over time."""

import numpy as np
import pytest

from driveline.harness.metrics.band_filter import band_part, derivative, envelope

T_S = 0.002
T = T_S * np.arange(3000)
MIDDLE = slice(500, -500)


def wave(f: float) -> np.ndarray:
    return 3.0 * np.sin(2.0 * np.pi * f * T)


def test_the_envelope_of_an_oscillation_on_a_ramp_is_its_amplitude() -> None:
    assert envelope(100.0 * T + wave(8.0), T_S)[MIDDLE] == pytest.approx(3.0, rel=0.02)


@pytest.mark.parametrize("f", [1.0, 150.0])
def test_what_is_slower_or_faster_has_none(f: float) -> None:
    assert envelope(wave(f), T_S)[MIDDLE].max() < 0.01


def test_no_sample_is_above_the_envelope() -> None:
    x = np.random.default_rng(1).standard_normal(len(T))
    assert (np.abs(band_part(x, T_S)) <= envelope(x, T_S) + 1e-12).all()


def test_nothing_is_shifted() -> None:
    assert band_part(wave(12.0), T_S)[MIDDLE] == pytest.approx(wave(12.0)[MIDDLE], abs=0.02)


def test_the_derivative_of_what_is_slow_is_that_of_the_signal() -> None:
    expected = 2.0 * np.pi * 8.0 * 3.0 * np.cos(2.0 * np.pi * 8.0 * T)
    assert derivative(wave(8.0), T_S)[MIDDLE] == pytest.approx(expected[MIDDLE], abs=1.0)


def test_samples_that_are_too_far_apart_have_nothing_of_a_band() -> None:
    assert np.isnan(band_part(np.arange(20.0), 0.1)).all()
    assert np.isfinite(band_part(np.arange(20.0), 0.08)).all()
    assert np.isfinite(derivative(np.arange(20.0), 0.1)).all()


def test_a_record_of_two_samples_has_an_envelope() -> None:
    assert envelope(np.array([0.0, 1.0]), T_S).shape == (2,)
