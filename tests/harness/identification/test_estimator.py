"""The most likely parameters: what they are, how surely, and what a recording does not tell."""

from dataclasses import replace

import numpy as np
import pytest

from driveline.harness.identification import estimator
from driveline.harness.identification.drive_train import Parameters
from driveline.harness.identification.estimator import (
    HESITATES,
    LINEARISED,
    UNTOLD,
    WINDOW,
    Found,
    search,
)
from driveline.harness.identification.identify import FREE, NARROW, fit
from driveline.harness.identification.model_inputs import LATEST
from driveline.harness.identification.prediction import Predictor
from driveline.harness.identification.priors import LEAST, PRIORS, before, moved, surprise
from tests.harness.identification.simulated import BEHIND, NOISE, T_S, P, found, simulated

SKEWED = P._replace(J_2=0.45, C=95.0, phi_B=0.09, d=0.02, late_T=-0.001, late_L=-0.0006)


@pytest.mark.parametrize("true", [P, SKEWED], ids=["aligned", "skewed"])
def test_parameters_and_skews_are_found_together(true: Parameters) -> None:
    """Begun 5 % off, without skew."""
    predictor = Predictor(simulated(seed=4, n=2000, p=true), NOISE, BEHIND)
    begin = true._replace(J_2=1.05 * true.J_2, C=0.95 * true.C, g_T=1.0, g_L=1.0, late_T=0.0, late_L=0.0, lack_L=1.0)
    one = search(predictor, begin, FREE, begin)
    for name in ("J_2", "C", "phi_B", "d", "g_T", "g_L", "late_T", "late_L", "c_t", "sigma_t"):
        off, deviation = getattr(one.p, name) - getattr(true, name), one.deviations[name]
        assert abs(off) < 3.5 * deviation, name
    assert one.deviations["J_2"] < 0.02 * true.J_2
    assert max(one.deviations["late_T"], one.deviations["late_L"]) < 2e-4
    assert one.p.lack_1 < 0.2 * NOISE.omega_1


@pytest.mark.slow
def test_they_are_found_from_a_car_that_is_another_one() -> None:
    predictor = Predictor(simulated(seed=4, n=2000, p=SKEWED), NOISE, BEHIND)
    p = fit(predictor, P._replace(J_2=0.08, C=290.0, phi_B=0.3, g_T=1.0, g_L=1.0)).p
    assert (p.J_2, p.C, p.phi_B) == pytest.approx((0.45, 95.0, 0.09), rel=0.03)


@pytest.mark.parametrize(
    ("name", "begin", "step", "end"),
    [
        ("d", 0.1, -2.0, 0.0),
        ("lack_1", 2e-3, -5.0, LEAST["lack_1"]),
        ("late_T", 0.0, 9.0, LATEST),
        ("late_L", 0.0, -9.0, -LATEST),
        ("late_L", 0.0, 1.5, 0.0015),
        ("C", 100.0, 0.5, 100.0 * np.exp(0.5)),
    ],
)
def test_a_step_stays_within_physical_bounds(name: str, begin: float, step: float, end: float) -> None:
    after = moved(P._replace(**{name: begin}), (name,), np.array([step]))
    assert getattr(after, name) == pytest.approx(end)


def test_damping_is_never_negative_and_the_others_are_found_with_none() -> None:
    """The motor speed is recorded half a millisecond early, which looks so where no delay is free."""
    true = P._replace(d=0.0, late_T=0.0005, late_L=0.0005)
    predictor = Predictor(simulated(seed=5, n=1000, p=true), NOISE, BEHIND)
    one = search(predictor, true._replace(late_T=0.0, late_L=0.0), ("J_2", "C", "d", "lack_1"), true, most=12)
    assert one.p.d >= 0.0
    assert one.p.C == pytest.approx(true.C, rel=0.05)


def test_what_is_known_before_is_counted_from_its_centre_in_its_unit() -> None:
    centre = P._replace(J_2=0.2, d=0.3)
    p = centre._replace(J_2=0.4, d=0.5, g_T=1.1, late_T=0.001)
    free = ("J_2", "d", "g_T", "late_T")
    z = surprise(p, free, centre) * np.sqrt(before(free))
    expected = [np.log(2.0) / PRIORS["J_2"].deviation, 0.2 / PRIORS["d"].deviation, np.log(1.1) / 0.05, 0.5]
    np.testing.assert_allclose(z, expected)


def of(information: np.ndarray, scores: np.ndarray) -> Found:
    """About J_2 and C, told by two channels."""
    return replace(found(), free=("J_2", "C"), information=information, scores=scores, p=P)


def test_the_deviations_are_those_of_the_likelihood_or_of_the_scatter_of_windows() -> None:
    """The larger one, each for itself; white scores have the scatter of the information."""
    n, length = 20_000, round(WINDOW / T_S)
    white = np.random.default_rng(1).standard_normal((n, 2)) * [1.0, 2.0]
    information = np.array([np.diag([n, 0.0]), np.diag([0.0, 4.0 * n])])
    likelihood = LINEARISED * np.array([P.J_2 / np.sqrt(n), P.C / np.sqrt(4.0 * n)])
    np.testing.assert_allclose(list(of(information, white).deviations.values()), likelihood, rtol=0.1)
    together = white.copy()
    together[:, 1] = np.repeat(white[: n // length, 1], length)
    widened = list(of(information, together).deviations.values())
    np.testing.assert_allclose(widened, likelihood * [1.0, np.sqrt(length)], rtol=0.15)
    np.testing.assert_allclose(list(of(information, 0.1 * white).deviations.values()), likelihood, rtol=1e-4)


def test_what_else_a_parameter_is_off_by_adds_to_its_deviation() -> None:
    information, scores = np.array([np.diag([1e4, 0.0]), np.diag([0.0, 1e4])]), np.zeros((500, 2))
    alone, more = (replace(of(information, scores), off=off).deviations for off in ({}, {"C": 2.0}))
    assert more == pytest.approx({"J_2": alone["J_2"], "C": np.hypot(alone["C"], 2.0)})


@pytest.mark.parametrize(("share", "told"), [(0.99, "load torque"), (1.01, "")])
def test_what_is_hardly_better_known_than_before_is_not_told(share: float, told: str) -> None:
    """And what is told is told by the channel that tells most of it."""
    known = (LINEARISED / (share * UNTOLD * PRIORS["J_2"].deviation)) ** 2 - 1.0 / PRIORS["J_2"].deviation ** 2
    one = of(np.array([np.diag([0.3 * known, 9.0]), np.diag([0.7 * known, 4.0])]), np.zeros((500, 2)))
    assert one.told_by("J_2") == told
    assert one.told_by("C") == "motor speed"


def test_samples_at_which_the_filter_hesitates_tell_no_more_than_others() -> None:
    derivatives = np.random.default_rng(2).uniform(-1.0, 1.0, (1, 1, 5000))
    derivatives[0, 0, 7] = 1e5
    cut = estimator._without_hesitation(derivatives)
    assert cut[0, 0, 7] == pytest.approx(HESITATES * 0.99, rel=0.02)
    np.testing.assert_array_equal(np.delete(cut, 7), np.delete(derivatives, 7))


def test_a_search_that_leaves_a_valley_of_lacks_begins_with_small_ones() -> None:
    assert all(getattr(P._replace(**NARROW), name) < bound for name, bound in (("lack_1", 0.15), ("lack_L", 1.1)))
