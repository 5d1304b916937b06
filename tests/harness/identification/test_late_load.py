"""A load torque that may be late widens the intervals by what the data do not exclude, and that is said."""

import numpy as np
import pytest

from driveline.harness.identification import late_load
from driveline.harness.identification.late_load import (
    COLLINEAR,
    RANGE,
    SELDOM,
    covariance_with_late_load,
    diagnose_late_load,
    price,
)
from driveline.harness.identification.maximum_likelihood import Found, maximise
from driveline.harness.identification.prediction import Innovations, Predictor
from driveline.harness.identification.quality import Z_95
from tests.harness.identification.simulated import NOISE, P, simulated

FREE = ("J_2", "C", "phi_B", "g_L")
DRIVE = simulated(seed=5)
BEST = maximise(Predictor(FREE), DRIVE, P, NOISE)


def with_odds(odds: float, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """The covariance with such odds of a late load torque."""
    monkeypatch.setattr(late_load, "SELDOM", odds)
    return covariance_with_late_load(DRIVE, BEST, NOISE)


def test_a_load_torque_that_is_surely_aligned_leaves_the_covariance(monkeypatch: pytest.MonkeyPatch) -> None:
    np.testing.assert_allclose(with_odds(0.0, monkeypatch), BEST.covariance)


def test_one_that_is_surely_late_gives_that_of_the_fit_with_its_delay_about_the_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    wider = maximise(Predictor((*FREE, "late_L")), DRIVE, BEST.p, NOISE)
    off = np.array([getattr(wider.p, name) - getattr(BEST.p, name) for name in FREE])
    expected = np.diag(wider.covariance)[:-1] + off**2
    np.testing.assert_allclose(np.diag(with_odds(1e12, monkeypatch)), expected, rtol=0.1)


def test_between_both_it_counts_by_its_probability(monkeypatch: pytest.MonkeyPatch) -> None:
    """Odds times the height of the normal distribution of what is found, over that of the range of delays."""
    wider = maximise(Predictor((*FREE, "late_L")), DRIVE, BEST.p, NOISE)
    deviation = np.sqrt(wider.covariance[-1, -1])
    z = wider.p.late_L / deviation
    odds = 0.3 * np.sqrt(2.0 * np.pi) * deviation / 0.008 * np.exp(0.5 * z**2)
    surely = with_odds(1e12, monkeypatch)
    mixed = with_odds(0.3, monkeypatch)
    expected = (BEST.covariance + odds * surely) / (1.0 + odds)
    np.testing.assert_allclose(np.diag(mixed), np.diag(expected), rtol=0.05)


def test_where_its_delay_is_free_the_covariance_has_it_already() -> None:
    freed = maximise(Predictor((*FREE, "late_L")), DRIVE, BEST.p, NOISE)
    np.testing.assert_array_equal(covariance_with_late_load(DRIVE, freed, NOISE), freed.covariance)


@pytest.mark.parametrize(("free", "before"), [(("late_L",), SELDOM), (("late_T", "late_L"), 1.0)])
def test_a_late_load_torque_costs_what_makes_it_likelier_than_an_aligned_one(
    free: tuple[str, ...], before: float
) -> None:
    """By Bayes: the likelihood of all delays in the range, integrated, against that of none."""
    deviation, n = 1.3e-4, 20001
    found = np.sqrt(price(deviation, free)) * deviation
    delays = np.linspace(-0.003, -0.003 + RANGE, n)
    late = before * np.mean(np.exp(-0.5 * ((delays - found) / deviation) ** 2))
    assert late == pytest.approx(np.exp(-0.5 * (found / deviation) ** 2), rel=1e-3)


def test_a_delay_that_the_data_tell_nothing_of_is_not_free() -> None:
    """With a wide prior anything would be likely enough."""
    assert price(1.0, ("late_T", "late_L")) == pytest.approx(Z_95**2)


def seen(correlation: float, names: tuple[str, ...]) -> Found:
    """J_2, and what cannot be told apart from it, with so much correlation."""
    root = np.linalg.cholesky(np.array([[1.0, correlation], [correlation, 1.0]]))
    d_size = 1e4 * np.repeat(root, 100, axis=0)
    innovations = Innovations(np.ones(200), np.zeros(200), slice(None), False, d_size.T.reshape(2, -1).T, d_size)
    return Found(P._replace(d=1.0), names, innovations, passes=1)


@pytest.mark.parametrize("name", ["late_L", "d"])
@pytest.mark.parametrize(("share", "named"), [(0.999, False), (1.001, True)])
def test_what_cannot_be_told_apart_is_named_from_its_correlation_on(name: str, share: float, named: bool) -> None:
    found = seen(0.9, ("J_2", name))
    known = 1.0 / np.sqrt(np.linalg.inv(found.covariance)[0, 0])
    texts = diagnose_late_load(found, share * known / np.sqrt(1.0 - COLLINEAR**2))
    assert bool(texts) == named
    if named:
        together = "J_2, d and late_L" if name == "d" else "J_2 and late_L"
        assert texts[0].startswith(f"{together} cannot be told apart")
        assert f"it would be +- {196.0 * known / P.J_2:.2g} %" in texts[0]
