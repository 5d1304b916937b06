"""Convex programmes of which the answer is known, and bounds that hold whatever the multipliers are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from docs.studies.optimal_torque.programme import Cone, Programme, Rows, bound, joined, reached, solve

EACH = np.arange(3)
"""Every sample has a torque of its own."""


def programme(least: float = 1.0, counts: bool = True) -> Programme:
    """|u_k| <= 2, u_0 + u_1 + u_2 >= 3 least, u_2 <= rho, ||u||/sqrt(3) <= rho (or, where it does not count, 1)."""
    rows = joined(
        [
            Rows(np.array([[3.0 * least, -1.0, -1.0, -1.0]]), np.zeros(1), np.ones(1)),
            Rows(np.array([[0.0, 0.0, 0.0, 1.0]]), np.ones(1), np.ones(1)),
        ]
    )
    cone = Cone(np.eye(3, 4, 1) / np.sqrt(3.0), counts)
    return Programme(rows, [cone], np.full(3, -2.0), np.full(3, 2.0))


def test_the_smallest_norm_is_found_and_proven() -> None:
    found = solve(programme(), EACH)
    assert found.u == pytest.approx([1.0, 1.0, 1.0], abs=1e-2)
    assert found.ratio == pytest.approx(1.0, abs=1e-4)
    assert found.bound == pytest.approx(1.0, abs=1e-4)


def test_a_norm_that_does_not_count_is_kept() -> None:
    """u_0 = u_1 = 1.2, u_2 = 0 keeps it with rho = 0."""
    found = solve(programme(0.8, counts=False), EACH)
    assert found.ratio == pytest.approx(0.0, abs=1e-4)
    assert np.linalg.norm(found.u) <= np.sqrt(3.0) + 1e-3


def test_what_cannot_be_kept_has_no_ratio_but_a_bound() -> None:
    found = solve(programme(3.0), EACH)
    assert found.ratio == np.inf
    assert found.bound > 2.0


def test_the_bound_of_a_torque_that_is_held_holds_for_a_free_one() -> None:
    one = Rows(np.array([[1.0, -1.0, 0.0, 0.0]]), np.zeros(1), np.ones(1))
    favouring = programme()._replace(rows=joined([one]))
    held, free = solve(favouring, np.array([0])), solve(favouring, EACH)
    assert held.ratio == pytest.approx(1.0, abs=1e-4)
    assert free.ratio == pytest.approx(1.0 / np.sqrt(3.0), abs=1e-4)
    assert held.bound <= free.ratio + 1e-6


@given(st.lists(st.floats(0.0, 3.0), min_size=2, max_size=2), st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3))
def test_no_multipliers_prove_too_much(y: list[float], v: list[float]) -> None:
    assert bound(programme(), np.array(y), [np.array(v)]) <= 1.0 + 1e-9


def test_ratio_and_violation_are_those_of_the_torque_itself() -> None:
    assert reached(programme(), np.array([1.0, 1.0, 1.0])) == pytest.approx((1.0, 0.0))
    assert reached(programme(), np.array([0.0, 0.0, 1.5])) == pytest.approx((1.5, 1.5))
    assert reached(programme(counts=False), np.array([2.0, 2.0, 0.5])) == pytest.approx(
        (0.5, np.sqrt(8.25 / 3.0) - 1.0)
    )
