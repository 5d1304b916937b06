"""The likeliest parameters are found, from wherever the search begins, and as well as their covariance says."""

from dataclasses import replace

import numpy as np
import pytest

from driveline.harness.identification.drive_train import Parameters
from driveline.harness.identification.global_start import best_start
from driveline.harness.identification.identify import WIDE_LOAD_NOISE
from driveline.harness.identification.maximum_likelihood import Found, maximise, moved, scales
from driveline.harness.identification.prediction import Noise, Predictor
from driveline.harness.identification.time_shifts import MOST
from tests.harness.identification.simulated import NOISE, P, simulated

FREE = ("J_2", "C", "phi_B", "g_L", "d")


def found(start: Parameters, free: tuple[str, ...] = FREE, **drive: float) -> Found:
    """As `driveline identify` does: from the best of many starts, through a wide filter first."""
    given, predictor = simulated(**{"seed": 3, **drive}), Predictor(free)  # pyright: ignore[reportArgumentType]
    wide = Noise(NOISE.omega_1, NOISE.T_mot, WIDE_LOAD_NOISE)
    broad = maximise(predictor, given, best_start(predictor, given, start, wide), wide)
    return maximise(predictor, given, broad.p, NOISE, most=12)


def require_found(result: Found, p: Parameters = P) -> None:
    """Within four standard deviations, which are small."""
    deviations = np.sqrt(np.diag(result.covariance))
    for name, deviation in zip(result.free, deviations, strict=True):
        assert abs(getattr(result.p, name) - getattr(p, name)) < 4.0 * deviation, name
        if name in ("J_1", "J_2", "C", "phi_B"):
            assert deviation < 0.015 * getattr(p, name), name


@pytest.mark.parametrize(("J_2", "C", "phi_B"), [(0.25, 420.0, 0.36), (1.8, 35.0, 0.01)])
def test_from_wide_starts(J_2: float, C: float, phi_B: float) -> None:
    require_found(found(P._replace(J_2=J_2, C=C, phi_B=phi_B, d=0.0, g_L=1.0)))


def test_offsets_of_the_torques_do_not_bias_it() -> None:
    require_found(found(P._replace(J_2=0.5, C=90.0, phi_B=0.1, d=0.0, g_L=1.0), o_T=1.0, o_L=-1.5))


def test_the_motor_inertia_too() -> None:
    require_found(found(P._replace(J_1=0.05, J_2=0.4, d=0.0, g_L=1.0), free=("J_1", *FREE)))


def test_what_is_not_free_remains_and_the_search_ends_by_itself() -> None:
    result = maximise(Predictor(("J_2",)), simulated(seed=3), P._replace(J_2=0.5), NOISE, most=12)
    assert result.p._replace(J_2=P.J_2) == P
    assert result.passes < 12


def test_what_the_recording_tells_nothing_of_remains_and_is_unknown() -> None:
    """A gap that is not crossed, as the torque only drives."""
    drive = simulated(seed=3, n=1000, mean=120.0)
    start = P._replace(J_2=0.4, phi_B=0.2)
    result = maximise(Predictor(("J_2", "C", "phi_B")), drive, start, NOISE)
    J_2, _, phi_B = np.sqrt(np.diag(result.covariance))
    assert abs(result.p.J_2 - P.J_2) < 4.0 * J_2 < 0.1 * P.J_2
    assert result.p.phi_B == pytest.approx(0.2, rel=1e-3)
    assert phi_B > 10.0 * result.p.phi_B


def test_the_covariance_is_the_inverse_of_the_information_times_the_noise_that_is_left() -> None:
    result = found(P)
    assert result.innovations.rms == pytest.approx(np.sqrt(np.mean(result.innovations.size[100:-3] ** 2)))
    inverse = result.covariance / result.innovations.rms**2
    np.testing.assert_allclose(inverse @ result.innovations.information, np.eye(len(FREE)), atol=1e-3)
    np.testing.assert_allclose(inverse, result.inverse_information)


def test_noise_that_is_taken_for_half_is_found_in_the_innovations() -> None:
    """All of it, so that neither intervals nor what one more parameter gains depend on it."""
    half = replace(NOISE, **{name: 0.5 * value for name, value in vars(NOISE).items()})
    drive = simulated(seed=3)
    right, wrong = (maximise(Predictor(FREE), drive, P, noise) for noise in (NOISE, half))
    assert wrong.innovations.rms == pytest.approx(2.0 * right.innovations.rms, rel=0.01)
    np.testing.assert_allclose(np.diag(wrong.covariance), np.diag(right.covariance), rtol=0.03)
    away = P._replace(J_2=1.01 * P.J_2)
    near, near_too = (
        Found(away, FREE, Predictor(FREE).innovations(drive, away, noise), passes=1) for noise in (NOISE, half)
    )
    assert near_too.gain(wrong) == pytest.approx(near.gain(right), rel=0.03)


def test_no_more_passes_than_are_allowed() -> None:
    start = P._replace(J_2=0.06, C=400.0, phi_B=0.35)
    result = maximise(Predictor(FREE), simulated(seed=3, n=300), start, NOISE, most=3)
    assert result.passes == 3


def test_a_step_of_the_search_keeps_signs_and_scales_tell_it() -> None:
    free = ("J_2", "d", "late_L")
    step = np.array([-5.0, -1.0, 0.7])
    there = moved(P, free, step)
    assert there.late_L == pytest.approx(0.0007)
    assert moved(there, free, np.array([0.0, 0.0, 9.0])).late_L == MOST
    assert moved(there, free, np.array([0.0, 0.0, -9.0])).late_L == -MOST
    assert there.J_2 > 0.0
    assert there.d == pytest.approx(P.d - 1.0)
    by = 1e-6
    for k, name in enumerate(free):
        further = moved(P, free, by * np.eye(3)[k])
        assert (getattr(further, name) - getattr(P, name)) / by == pytest.approx(scales(P, free)[k], rel=1e-5)
