"""The draws: they fill the box, and each follows from the seed and its own number."""

import numpy as np
import pytest

from driveline.harness.design.uncertainty_box import BOX, DOUBLINGS, LOSS
from driveline.harness.studies.robustness.draws import draw


def test_a_draw_follows_from_the_seed_and_its_number():
    assert draw(7, 1) == draw(7, 1)
    others = [draw(number, seed) for seed in (1, 2) for number in range(1, 50)]
    assert len({each.deviation for each in others}) == len({each.noise for each in others}) == len(others)


@pytest.fixture(scope="module")
def thousand():
    return [draw(number, 1).deviation for number in range(1, 1001)]


@pytest.mark.parametrize("name", BOX)
def test_the_draws_fill_the_box_evenly(name, thousand):
    low, high = BOX[name]
    values = np.array([getattr(deviation, name) for deviation in thousand])
    assert low <= values.min() < values.max() <= high
    share = np.log2(values / low) / np.log2(high / low) if name in DOUBLINGS else (values - low) / (high - low)
    counts, _ = np.histogram(share, bins=5, range=(0.0, 1.0))
    assert counts.min() > 150  # 200 each; less than 150 has a chance of 1e-5


def test_draws_are_independent_and_lose_a_tenth_of_the_messages(thousand):
    values = np.array([[getattr(deviation, name) for name in BOX] for deviation in thousand])
    correlation = np.corrcoef(values.T) - np.eye(len(BOX))
    assert np.abs(correlation).max() < 0.13  # four standard deviations of 1/sqrt(1000)
    assert {deviation.loss for deviation in thousand} == {LOSS} == {0.1}


def test_a_draw_in_words_has_its_number_and_what_was_drawn():
    text = str(draw(17, 1))
    assert text.startswith("17: J_2 ")
    assert all(f"{name} " in text for name in BOX)
