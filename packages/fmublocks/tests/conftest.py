"""Fixtures and hooks of all tests."""

from fmutesting.plugin import *  # noqa: F403
