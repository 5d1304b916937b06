"""Inputs are handed to an FMU when they have changed, and only then."""

from ctypes import c_double

import pytest

from driveline.harness.cosimulation.calls import _change


@pytest.mark.parametrize("factors", [(), (1.0, 1e3)])
def test_inputs_have_changed_if_one_of_them_has(factors: tuple[float, ...]) -> None:
    row, buffer = (c_double * 3)(4.0, 0.0, 7.0), (c_double * 2)()
    changed = _change(memoryview(row).cast("B").cast("d"), (0, 16), buffer, factors)
    by = factors or (1.0, 1.0)
    assert changed()
    assert tuple(buffer) == (4.0 / by[0], 7.0 / by[1])
    assert not changed()
    row[1] = 9.0  # not among them
    assert not changed()
    row[2] = 8.0
    assert changed()
    assert tuple(buffer) == (4.0 / by[0], 8.0 / by[1])
