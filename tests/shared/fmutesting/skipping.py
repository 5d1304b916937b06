"""Tests are skipped where a machine lacks what they need, and say what."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from fmublocks.builds import NotPossible
from fmublocks.native.compiler import CompilerError


@contextmanager
def skipped_if_impossible() -> Iterator[None]:
    """Within it, what cannot be built or compiled on this machine skips the test."""
    try:
        yield
    except (NotPossible, CompilerError) as reason:
        pytest.skip(str(reason))
