"""Free runs over short segments: their derivatives, the starts, and the parameters with which they fit best."""

from dataclasses import replace

import numpy as np
import pytest

from driveline.harness.identification.drive_train import DELAYS
from driveline.harness.identification.model_inputs import Drive
from driveline.harness.identification.output_error import Segments, _Linear, _Point
from driveline.harness.identification.prediction import filtered
from driveline.harness.identification.quality import near_starts
from driveline.harness.identification.segment_simulation import Simulator
from tests.harness.identification.simulated import NOISE, P, simulated

FREE = ("J_2", "C", "phi_B", "d")
LENGTH = 125
DRIFT = 1.0


@pytest.fixture(scope="module")
def drive() -> Drive:
    return simulated(seed=4)


@pytest.fixture(scope="module")
def pieces(drive: Drive) -> Segments:
    return Segments(drive, LENGTH, FREE, DRIFT, first=100)


@pytest.fixture(scope="module")
def starts(drive: Drive, pieces: Segments) -> np.ndarray:
    return near_starts(pieces, filtered(drive, P, NOISE))


def test_the_derivatives_of_a_free_run_are_those_of_its_states(drive: Drive) -> None:
    """With torques that are late."""
    free, late = (*FREE, *DELAYS), P._replace(late_1=0.0004, late_T=0.0007, late_L=-0.0013)
    simulator, start = Simulator(LENGTH, free), np.array([130.0, 129.0, 0.3, 0.2, -0.4])
    states, d = simulator.run_with_derivatives(drive, 200, start, late)
    np.testing.assert_allclose(states, simulator.run(drive, 200, start, late), atol=1e-9)
    for k in range(len(start) + len(free)):
        by = np.zeros(len(start) + len(free))
        by[k] = 1e-6
        ends = []
        for sign in (1.0, -1.0):
            step = sign * by
            p = late._replace(**{name: getattr(late, name) + step[5 + j] for j, name in enumerate(free)})
            ends.append(simulator.run(drive, 200, start + step[:5], p))
        difference = (ends[0] - ends[1]) / 2e-6
        np.testing.assert_allclose(d[:, :, k], difference, atol=1e-4 * np.abs(difference).max(), err_msg=str(k))


def test_the_segments_are_those_that_fit_in(drive: Drive, pieces: Segments) -> None:
    assert list(pieces.firsts) == list(range(100, 1500 - LENGTH + 1, LENGTH))
    assert list(Segments(drive, 500, FREE, DRIFT).firsts) == [0, 500, 1000]


def test_the_gradient_after_the_starts_are_eliminated_is_that_of_the_cost(pieces: Segments, starts: np.ndarray) -> None:
    """Of the cost along the way on which the starts follow, which is that of the best starts. Away from the best
    parameters, where both are large."""
    point = _Point(P._replace(J_2=0.33, C=110.0, phi_B=0.15), 0.3, starts, starts)
    for _ in range(3):
        point = replace(point, starts=pieces.found(point))
    linear = pieces._linear(point)

    def cost(name: str, step: float, follow: float = 1.0) -> float:
        k = ("o_T", *FREE).index(name)
        p = point.p if name == "o_T" else point.p._replace(**{name: getattr(point.p, name) + step})
        o_T = point.o_T + step if name == "o_T" else point.o_T
        there = point.starts + follow * step * linear.follow[:, :, k]
        return pieces._linear(_Point(p, o_T, there, point.expected)).cost

    for k, name in enumerate(("o_T", *FREE)):
        size = 1.0 if name == "o_T" else getattr(point.p, name)
        by = 1e-6 * size
        gradient = (cost(name, by) - cost(name, -by)) / (2.0 * by)
        assert linear.scores.sum(axis=0)[k] == pytest.approx(gradient, rel=1e-4), name
        curvature = [cost(name, step) for step in (0.02 * size, -0.02 * size)]
        stiff = [cost(name, step, follow=0.0) for step in (0.02 * size, -0.02 * size)]
        assert sum(curvature) < sum(stiff), name


def test_the_parameters_are_found_with_deviations_that_tell_how_far_off_they_are(drive: Drive) -> None:
    """With another offset of the motor torque, which is found too."""
    shifted = replace(drive, T_mot=drive.T_mot - P.g_T * 0.5)
    pieces = Segments(shifted, LENGTH, FREE, DRIFT, first=100)
    start = P._replace(J_2=0.36, C=108.0, phi_B=0.14, d=0.5)
    found = pieces.fit(start, near_starts(pieces, filtered(shifted, start, NOISE)))
    for name, deviation in zip(FREE, np.sqrt(np.diag(found.covariance)), strict=True):
        assert abs(getattr(found.p, name) - getattr(P, name)) < 4.0 * deviation, name
        assert deviation < (0.1 if name != "d" else 0.5) * getattr(P, name), name
    assert found.o_T == pytest.approx(0.5, abs=0.3)
    assert NOISE.omega_1 < found.error < 2.5 * NOISE.omega_1
    assert found.free == FREE


def test_the_covariance_is_what_the_segments_say_each_for_itself(
    pieces: Segments, starts: np.ndarray, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Twice the noise, four times the variance; the Hessian knows nothing of it."""
    best: list[_Linear] = []
    descend = pieces._descend

    def descended(now: _Point, most: int) -> tuple[_Point, _Linear]:
        now, linear = descend(now, most)
        best.append(linear)
        return now, linear

    monkeypatch.setattr(pieces, "_descend", descended)
    found, linear = pieces.fit(P, starts, most=2), best[-1]
    inverse, scores = np.linalg.inv(linear.H), linear.scores
    n, m = scores.shape
    expected = sum(np.outer(inverse @ one, inverse @ one) for one in scores) * n / (n - m)
    np.testing.assert_allclose(found.covariance, expected[1:, 1:], rtol=1e-9)


def test_a_start_on_the_wrong_flank_is_found(drive: Drive) -> None:
    """In pieces of 0.5 s the search from there alone ends elsewhere."""
    pieces = Segments(drive, 250, (), DRIFT, first=100)
    near = near_starts(pieces, filtered(drive, P, NOISE))
    right = pieces.found(_Point(P, 0.0, near, near), anywhere=True)
    assert right[:, 2].min() < -P.phi_B < P.phi_B < right[:, 2].max()
    wrong = _Point(P, 0.0, right * [1.0, 1.0, -1.5, 1.0], near)
    assert np.abs(pieces.found(wrong) - right)[:, 2].max() > 0.1
    np.testing.assert_allclose(pieces.found(wrong, anywhere=True)[:, 2], right[:, 2], atol=0.01)


def test_free_runs_from_the_best_starts_are_off_by_little_more_than_the_noise(
    drive: Drive, pieces: Segments, starts: np.ndarray
) -> None:
    simulated, recorded = Segments(drive, LENGTH, (), DRIFT, first=100).free_runs(P, starts)
    np.testing.assert_array_equal(recorded[1], drive.omega_1[100 + LENGTH + 1 : 100 + 2 * LENGTH + 1])
    assert NOISE.omega_1 * 0.9 < np.std(simulated[..., 0] - recorded) < 2.5 * NOISE.omega_1


def test_the_starts_stay_about_those_that_are_expected(drive: Drive, starts: np.ndarray) -> None:
    """However often they are looked for: a load offset that is expected elsewhere draws them there."""
    pieces = Segments(drive, LENGTH, (), 0.01, first=100)
    point = _Point(P, 0.0, starts, starts)
    for _ in range(5):
        point = replace(point, starts=pieces.found(point))
    assert np.abs(point.starts - starts)[:, 3].max() < 0.05
    away = replace(point, expected=starts + np.array([0.0, 0.0, 0.0, 2.0]))
    np.testing.assert_allclose(pieces.found(away)[:, 3], starts[:, 3] + 2.0, atol=0.1)
