"""Random numbers that are functions: the same everywhere, and random all the same."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmublocks.block.noise import M, normals, uniform

seeds = st.integers(0, 1_000_000)
streams = st.integers(0, 60).map(float)
COUNT = 5000


def drawn(seed: int, stream: float) -> np.ndarray:
    return np.array([uniform(seed, stream, float(k)) for k in range(COUNT)])


@given(seed=seeds, stream=streams, index=st.integers(0, 2**26))
def test_a_number_is_within_its_bounds_and_always_the_same(seed: int, stream: float, index: int) -> None:
    number = uniform(seed, stream, index)
    assert 0.0 < number < 1.0
    assert number == uniform(float(seed), stream, float(index))
    assert all(abs(value) <= 6.2 for value in normals(seed, stream, index))


def test_numbers_are_exact_products_of_integers() -> None:
    """The arithmetic in floating point is that of whole numbers, so it is the same on every machine."""
    m = int(M)

    def scrambled(x: int, c: int) -> int:
        return (x**3 + c) % m

    for seed, stream, index in ((1, 0, 0), (1, 31, 12345), (1_000_000, 60, 2**26)):
        x = scrambled((seed * 40692 + 7368787) % m, 19088743)
        x = scrambled((scrambled(x, 1013904 * stream + 40014) + index) % m, 40503)
        assert uniform(seed, float(stream), index) == (scrambled(scrambled(x, 29282417), 52711) + 0.5) / M


@pytest.mark.parametrize("seed", [0, 1, 2, 999_999])
@pytest.mark.parametrize("stream", [0.0, 31.0])
def test_numbers_are_uniform_and_without_memory(seed: int, stream: float) -> None:
    numbers = drawn(seed, stream)
    counts, _ = np.histogram(numbers, 50, (0.0, 1.0))
    assert ((counts - COUNT / 50) ** 2 / (COUNT / 50)).sum() < 100.0, "chi squared of 49 degrees: 74 at 1 %"
    for lag in (1, 2, 48):
        assert abs(np.corrcoef(numbers[lag:], numbers[:-lag])[0, 1]) < 4.0 / np.sqrt(COUNT)


def test_neighbouring_seeds_and_streams_have_nothing_in_common() -> None:
    first = drawn(1, 0.0)
    for other in (drawn(2, 0.0), drawn(1, 1.0), drawn(1, 2.0)):
        assert abs(np.corrcoef(first, other)[0, 1]) < 4.0 / np.sqrt(COUNT)


def test_normal_numbers_are_normal_and_independent() -> None:
    pairs = np.array([normals(3, 5.0, float(k)) for k in range(COUNT)])
    assert pairs.mean(axis=0) == pytest.approx([0.0, 0.0], abs=4.0 / np.sqrt(COUNT))
    assert pairs.std(axis=0) == pytest.approx([1.0, 1.0], rel=0.05)
    assert abs(np.corrcoef(pairs.T)[0, 1]) < 4.0 / np.sqrt(COUNT)
    within = [(np.abs(pairs) < limit).mean() for limit in (1.0, 2.0, 3.0)]
    assert within == pytest.approx([0.6827, 0.9545, 0.9973], abs=0.01)
