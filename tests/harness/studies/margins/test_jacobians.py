"""Rates of change by differences: exact on straight pieces, and kinks are seen."""

from math import sqrt
from typing import NamedTuple

import numpy as np
import pytest

from driveline.harness.studies.margins.jacobians import like, names, numbers, rates
from driveline.models.block.operators import clip


class Inner(NamedTuple):
    a: float
    b: tuple[float, ...]


class Outer(NamedTuple):
    inner: Inner
    c: float


RECORD = Outer(Inner(1.0, (2.0, 3.0)), 4.0)


def test_a_record_is_its_numbers_with_their_names() -> None:
    assert names(RECORD) == ["inner.a", "inner.b.0", "inner.b.1", "c"]
    assert numbers(RECORD) == [1.0, 2.0, 3.0, 4.0]
    assert like(RECORD, [5.0, 6.0, 7.0, 8.0]) == Outer(Inner(5.0, (6.0, 7.0)), 8.0)


def test_the_rates_of_a_straight_function_are_its_factors() -> None:
    found = rates(lambda x: [3.0 * x[0] - x[1], 0.5 * x[1]], [130.0, -20.0], [0, 1])
    np.testing.assert_allclose(found.mean, [[3.0, -1.0], [0.0, 0.5]], atol=1e-8)
    assert not found.has_kink.any()


@pytest.mark.parametrize(("limit", "has_kink"), [(1.0, True), (1.0 + 2e-4, False)])
def test_a_kink_is_seen_at_its_place_and_not_beside_it(limit: float, has_kink: bool) -> None:
    assert bool(rates(lambda x: [clip(x[0], -limit, limit)], [1.0], [0]).has_kink.any()) is has_kink


def test_a_bend_is_no_kink() -> None:
    found = rates(lambda x: [sqrt(x[0]), abs(x[0] - 0.25)], [0.25], [0])
    assert found.mean.tolist() == [[pytest.approx(1.0, rel=1e-6)], [pytest.approx(0.0, abs=1e-9)]]
    assert found.has_kink.tolist() == [[False], [True]]
