"""The response of one signal to another, against systems of which it is known."""

import numpy as np
import pytest
from scipy.signal import lfilter

from driveline.harness.metrics.frequency_response import amplitude_spectrum, frequency_response

T_s = 0.002


def test_the_response_to_a_step_is_that_of_the_filter() -> None:
    u = np.where(np.arange(3000) < 500, -12.0, 100.0)
    pole = np.exp(-T_s / 0.05)
    y = lfilter([1.0 - pole], [1.0, -pole], u - u[0]) + u[0]
    f, answer = frequency_response(u, y, T_s)
    at = (f > 0.5) & (f < 20.0)
    z = np.exp(2j * np.pi * f[at] * T_s)
    np.testing.assert_allclose(np.abs(answer[at]), np.abs((1.0 - pole) / (1.0 - pole / z)), rtol=0.02)


def test_there_is_no_response_where_the_input_has_nothing_as_a_constant_one() -> None:
    t = T_s * np.arange(5000)
    f, answer = frequency_response(np.sin(2.0 * np.pi * 2.0 * t), np.sin(2.0 * np.pi * 2.0 * t), T_s)
    assert np.abs(answer[np.argmin(np.abs(f - 2.0))]) == pytest.approx(1.0)
    assert np.isnan(answer[f > 10.0]).all()
    _, answer = frequency_response(np.full(1000, 5.0), np.arange(1000.0), T_s)
    assert np.isnan(answer).all()


def test_the_amplitude_of_a_sine_on_a_drift_is_its_own() -> None:
    t = T_s * np.arange(5001)
    f, amplitude = amplitude_spectrum(3.0 * np.sin(2.0 * np.pi * 8.0 * t) + 20.0 * t, T_s)
    assert amplitude.max() == pytest.approx(3.0, rel=0.01)
    assert f[amplitude.argmax()] == pytest.approx(8.0, abs=0.05)
