"""Some tries of every fuzz target; `make fuzz` makes many."""

import tempfile
from pathlib import Path

import pytest
from fmutesting.skipping import skipped_if_impossible
from fmutesting.slow import slow

from tests.fuzz import TARGETS


@pytest.mark.parametrize("name", slow(TARGETS, but=("recordings", "parameter_files")))
def test_odd_input_is_answered_as_promised(name: str, unpacked: Path) -> None:
    target, faults = TARGETS[name], []
    with skipped_if_impossible():
        counts = target.counts(tries=target.short, report=faults.append)
    assert faults == []
    assert counts.total() == target.short
    assert list(unpacked.iterdir()) == [], tempfile.tempdir
