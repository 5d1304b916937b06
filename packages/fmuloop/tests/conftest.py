"""What the tests of the master share."""

import pytest
from fmutesting.foreign import build_relay
from fmutesting.plugin import *  # noqa: F403


@pytest.fixture(scope="session")
def relay(tmp_path_factory):
    """An FMU of somebody else's, in Python, that passes on what it gets."""
    return build_relay(tmp_path_factory.mktemp("relay"))
