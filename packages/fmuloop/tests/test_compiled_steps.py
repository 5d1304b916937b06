"""Compiled steps are those of the source that is there."""

import _ctypes
import os
from pathlib import Path

import pytest

from fmuloop.compiled_steps import LIBRARY, SOURCE, SPEC, library


@pytest.mark.skipif(LIBRARY is None, reason="the package was installed without a C compiler")
def test_a_library_of_another_source_is_not_used_whichever_is_older(tmp_path: Path) -> None:
    assert SPEC
    assert SPEC.origin
    same, other = tmp_path / "same.c", tmp_path / "other.c"
    same.write_bytes(SOURCE.read_bytes())
    other.write_bytes(SOURCE.read_bytes() + b"\n")
    for source in (same, other):
        os.utime(source, (0.0, 0.0))
    assert library(SPEC.origin, same)
    assert library(SPEC.origin, other) is None
    assert library(_ctypes.__file__, same) is None, "it does not tell"
