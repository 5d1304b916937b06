"""Some tries of every fuzz target; `make fuzz` makes many."""

import tempfile
from random import Random

import pytest

from tests.fuzz.targets import TARGETS
from tests.skipping import skipped_if_impossible
from tests.slow import slow


@pytest.mark.parametrize("name", slow(TARGETS, but=TARGETS.keys() - {"calls"}))
def test_odd_input_is_answered_as_promised(name, tmp_path, unpacked):
    target, own = TARGETS[name], tmp_path / "own"
    own.mkdir()
    with skipped_if_impossible(), target.open(own) as attempt:
        for k in range(target.short):
            attempt(Random(f"1 {k}"))
    assert list(unpacked.iterdir()) == [], tempfile.tempdir
