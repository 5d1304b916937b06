"""Signals within a band over time, low-passed, and over frequency, against scipy and systems that are known."""

from math import isnan

import numpy as np
import pytest
from scipy.signal import butter, lfilter, sosfiltfilt

from driveline.harness.metrics import band_filter, spectrum
from driveline.harness.metrics.band_filter import band_part, derivative, envelope, forwards_and_backwards
from driveline.harness.metrics.declaration import Absent
from driveline.harness.metrics.estimate import estimate_metrics
from driveline.harness.metrics.frequency_response import amplitude_spectrum, frequency_response
from driveline.harness.metrics.oscillation import low_passed
from driveline.harness.metrics.spectrum import DRIVE_TRAIN, TO_50_HZ, BandSpectrum, band_rms

T_S = 0.002
T = T_S * np.arange(3000)
MIDDLE = slice(500, -500)


def wave(f: float) -> np.ndarray:
    return 3.0 * np.sin(2.0 * np.pi * f * T)


def test_the_envelope_is_that_of_the_band_and_nothing_is_shifted() -> None:
    assert envelope(100.0 * T + wave(8.0), T_S)[MIDDLE] == pytest.approx(3.0, rel=0.02)
    assert band_part(wave(12.0), T_S)[MIDDLE] == pytest.approx(wave(12.0)[MIDDLE], abs=0.02)
    x = np.random.default_rng(1).standard_normal(len(T))
    assert (np.abs(band_part(x, T_S)) <= envelope(x, T_S) + 1e-12).all()
    assert envelope(np.array([0.0, 1.0]), T_S).shape == (2,)


@pytest.mark.parametrize("f", [1.0, 150.0])
def test_what_is_slower_or_faster_has_none(f: float) -> None:
    assert envelope(wave(f), T_S)[MIDDLE].max() < 0.01


def test_the_derivative_is_that_of_the_signal_and_of_numpy() -> None:
    expected = 2.0 * np.pi * 8.0 * 3.0 * np.cos(2.0 * np.pi * 8.0 * T)
    assert derivative(wave(8.0), T_S)[MIDDLE] == pytest.approx(expected[MIDDLE], abs=1.0)
    x = np.random.default_rng(3).standard_normal(len(T))
    np.testing.assert_array_equal(derivative(x, T_S), np.gradient(band_part(x, T_S, TO_50_HZ), T_S))


@pytest.mark.parametrize("at_once", [100, 2**17])
@pytest.mark.parametrize("ends", [0, 9, 200])
def test_a_filter_in_pieces_gives_what_scipy_gives(at_once: int, ends: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(band_filter, "FILTERED", at_once)
    x, sos = (
        np.random.default_rng(2).standard_normal(1001).cumsum(),
        butter(4, (5.0, 50.0), "band", fs=500.0, output="sos"),
    )
    np.testing.assert_array_equal(forwards_and_backwards(sos, x, ends), sosfiltfilt(sos, x, padlen=ends))


@pytest.mark.parametrize(("band", "of_slope"), [(DRIVE_TRAIN, False), (TO_50_HZ, True)])
@pytest.mark.parametrize("length", [999, 1000, 1009])
def test_a_spectrum_block_by_block_is_that_of_all_at_once(band, of_slope, length, monkeypatch) -> None:
    x = np.random.default_rng(4).standard_normal(length).cumsum()
    expected = BandSpectrum(x, T_S).parts(band, of_slope)
    monkeypatch.setattr(spectrum, "MOST_AT_ONCE", length - 1)
    monkeypatch.setattr(spectrum, "BLOCK", 256)
    found = BandSpectrum(x, T_S).parts(band, of_slope)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13 * abs(expected).max())
    assert not np.array_equal(found, expected), "it is computed otherwise"


def test_samples_that_are_too_far_apart_have_nothing_of_a_band() -> None:
    assert np.isnan(band_part(np.arange(20.0), 0.1)).all()
    assert np.isfinite(band_part(np.arange(20.0), 0.08)).all()
    assert np.isfinite(derivative(np.arange(20.0), 0.1)).all()


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


@pytest.mark.parametrize("samples", [0, 99])
def test_a_band_below_a_period_of_the_run_has_no_answer(samples: int) -> None:
    with pytest.raises(Absent, match="shorter than a period of 5 Hz"):
        band_rms(np.zeros(samples), 2e-3, (5.0, 50.0))
    assert band_rms(np.zeros(100), 2e-3, (5.0, 50.0)) == 0.0


def test_the_response_to_a_step_is_that_of_the_filter() -> None:
    u = np.where(np.arange(3000) < 500, -12.0, 100.0)
    pole = np.exp(-T_S / 0.05)
    y = lfilter([1.0 - pole], [1.0, -pole], u - u[0]) + u[0]
    f, answer = frequency_response(u, y, T_S)
    at = (f > 0.5) & (f < 20.0)
    z = np.exp(2j * np.pi * f[at] * T_S)
    np.testing.assert_allclose(np.abs(answer[at]), np.abs((1.0 - pole) / (1.0 - pole / z)), rtol=0.02)


def test_there_is_no_response_where_the_input_has_nothing_as_a_constant_one() -> None:
    t = T_S * np.arange(5000)
    f, answer = frequency_response(np.sin(2.0 * np.pi * 2.0 * t), np.sin(2.0 * np.pi * 2.0 * t), T_S)
    assert np.abs(answer[np.argmin(np.abs(f - 2.0))]) == pytest.approx(1.0)
    assert np.isnan(answer[f > 10.0]).all()
    with np.errstate(all="raise"):
        _, answer = frequency_response(np.full(1000, 5.0), np.arange(1000.0), T_S)
    assert np.isnan(answer).all()


@pytest.mark.parametrize(("share", "told"), [(1.01e-3, 20), (0.99e-3, 10)])
def test_spectra_are_averaged_over_half_a_hertz_and_a_thousandth_of_the_power_is_nothing(share, told) -> None:
    """Ten of 10 499 frequencies about each of two, however small the input is."""
    one, other = (np.cos(2.0 * np.pi * k * np.arange(10_499) / 10_499) for k in (100, 300))
    u = 1e-6 * np.append(0.0, np.cumsum(one + np.sqrt(share) * other))
    _, answer = frequency_response(u, 3.0 * u, T_S)
    assert answer[np.isfinite(answer)] == pytest.approx([3.0] * told)
    _, answer = frequency_response(u[:100], 3.0 * u[:100], T_S)
    assert answer[np.isfinite(answer)] == pytest.approx(3.0), "shorter than that, each by itself"


def test_the_amplitude_of_a_sine_on_a_drift_is_its_own() -> None:
    t = T_S * np.arange(5001)
    f, amplitude = amplitude_spectrum(3.0 * np.sin(2.0 * np.pi * 8.0 * t) + 20.0 * t, T_S)
    assert amplitude.max() == pytest.approx(3.0, rel=0.01)
    assert f[amplitude.argmax()] == pytest.approx(8.0, abs=0.05)
    assert amplitude_spectrum(20.0 * t, T_S)[1] == pytest.approx(0.0, abs=1e-9)


def results(true: list[float], estimated: list[float], phi_hat: float = 0.1) -> np.ndarray:
    columns = ("time", "plant.T_gear", "controller.T_gear_hat", "controller.phi_hat")
    rows = [(0.002 * k, *each, phi_hat) for k, each in enumerate(zip(true, estimated, strict=True))]
    return np.array(rows, dtype=[(name, float) for name in columns])


def test_an_estimate_is_biased_or_in_a_wrong_mode_or_none() -> None:
    found = estimate_metrics(results([10.0, -20.0, 30.0], [2.0, -4.0, 6.0]))
    assert found.bias == pytest.approx(-0.8)
    assert found.wrong_mode == 0.0
    assert "the teeth are never in the gap" in found.absent["wrong_gap"]
    found = estimate_metrics(results([10.0, 10.0, 0.0, 0.0, -5.0], [9.0, 0.0, 0.0, 3.0, 2.0]))
    assert found.wrong_mode == pytest.approx(0.6)
    assert found.wrong_gap == pytest.approx(0.5)
    assert found.error_rms == pytest.approx(np.sqrt((1.0 + 100.0 + 49.0) / 3.0))
    found = estimate_metrics(results([10.0, 0.0], [9.0, 9.0], phi_hat=0.0))
    assert isnan(found.bias)
    assert found.absent["bias"] == "the controller estimates no twist"
