"""Free runs of the true model are the truth, and the wheel speed is as late as it is."""

import numpy as np
import pytest

from driveline.harness.identification.free_runs import free_runs
from driveline.harness.identification.prediction import Noise, Predictor
from driveline.harness.identification.wheel_speed import EARLIEST, LATEST, late_wheel_speed
from tests.harness.identification.simulated import BEHIND, SPARE, T_S, P, simulated, states


def test_free_runs_of_the_true_model_are_the_truth() -> None:
    small = Noise(1e-3, 1e-3, 1e-3)
    drive = simulated(seed=1, noise=small, p=P._replace(g_T=1.0, g_L=1.0))
    predictor = Predictor(drive, small, BEHIND)
    p = P._replace(g_T=1.0, g_L=1.0)
    at, runs = free_runs(predictor, p, predictor.predicted(p).states, 400)
    _, omega_1, omega_2, phi, T_load = (row[SPARE + at] for row in states(1500 + 2 * SPARE, P, 10.0))
    assert at[0, 0] == 401
    assert at[-1, -1] <= 1500
    assert at.shape == runs.shape[:2] == (4, 250)
    for k, (true, within) in enumerate(((omega_1, 0.3), (omega_2, 0.3), (None, 0.0), (T_load, 2.0))):
        if true is not None:
            np.testing.assert_allclose(runs[..., k], true, atol=within)
    contact = np.abs(phi) > P.phi_B + 0.03
    spring = P.C * (np.abs(phi) - P.phi_B) * np.sign(phi)
    np.testing.assert_allclose(runs[..., 2][contact], spring[contact], atol=P.d * 120.0)


@pytest.mark.parametrize("late", [0.0, 0.031, -0.011])
def test_a_wheel_speed_is_found_as_late_as_it_is(late: float) -> None:
    """Of messages every 20 ms, which are 10 ms old on average; where it is not valid it is nonsense."""
    _, _, omega_2, _, _ = states(1500 + 2 * SPARE, P, 10.0)
    time = np.arange(len(omega_2)) * T_S
    held = np.interp(np.floor(time / 0.02) * 0.02 - late + 0.01 - 0.001, time, omega_2)
    valid = time > 0.5
    found = late_wheel_speed(np.where(valid, held, 0.0), valid, omega_2[1:], T_s=T_S)
    assert found is not None
    assert found.time == pytest.approx(late, abs=0.002)
    assert found.deviation < 0.002


def test_a_delay_beyond_what_is_looked_at_is_none() -> None:
    _, _, omega_2, _, _ = states(1500 + 2 * SPARE, P, 10.0)
    for late in (LATEST + 0.02, EARLIEST - 0.02):
        shifted = np.interp(np.arange(len(omega_2)) - late / T_S, np.arange(len(omega_2)), omega_2)
        assert late_wheel_speed(shifted, None, omega_2[1:], T_S) is None
    assert late_wheel_speed(omega_2[:200], None, omega_2[1:200], T_S) is None, "too short"
