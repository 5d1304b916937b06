"""Fixtures of the tests of recordings."""

from packages.driverecords.tests.conftest import read, write  # noqa: F401
