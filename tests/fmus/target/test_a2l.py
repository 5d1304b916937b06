"""Bounds in an A2L file are numbers of single precision, as those of the target are."""

from pathlib import Path

import numpy as np
import pytest

from driveline.fmus.catalogue import EVERY
from driveline.fmus.description.a2l import DOUBLE, SINGLE, Item, _described
from driveline.fmus.description.variables import interface
from driveline.fmus.target import image
from driveline.models.damping_controller import BLOCK


def test_the_largest_number_is_that_of_single_precision() -> None:
    assert float(np.finfo(np.float32).max) == SINGLE.largest
    assert float(np.finfo(np.float64).max) == DOUBLE.largest


def test_what_has_no_bounds_is_bounded_by_the_largest_numbers_and_the_others_keep_theirs() -> None:
    found = {}
    for variable in interface(BLOCK):
        text = _described(Item(variable, 0), SINGLE).splitlines()[1]
        low, high = map(float, text.split()[-2:])
        assert low == max(variable.bounds()[0], -SINGLE.largest)
        assert high == min(variable.bounds()[1], SINGLE.largest)
        found[variable.name] = low, high
    assert found["T_driver"] == (-SINGLE.largest, SINGLE.largest)
    assert found["T_max"] == (1.0, 2000.0)


def test_a_group_has_what_can_be_turned_and_another_one_the_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(image, "symbols", lambda _: dict.fromkeys(image.A2L_RECORDS.values(), 0x20000000))
    text = image.a2l_description(EVERY["DampingController"], Path())
    for group, variability in (("Calibration", "tunable"), ("Fixed", "fixed")):
        listed = text.partition(f"/begin GROUP {group} ")[2].partition("REF_CHARACTERISTIC\n")[2].splitlines()[0]
        assert set(listed.split()) == {v.name for v in interface(BLOCK) if v.variability == variability}
