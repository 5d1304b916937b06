"""Fuzz targets: odd input by the thousand, each answered as promised or told as a fault."""

from tests.fuzz import (
    archives,
    caches,
    calls,
    campaigns,
    options,
    parameter_files,
    plants,
    recordings,
    states,
    swollen,
)
from tests.fuzz.target import TARGETS

__all__ = [
    "TARGETS",
    "archives",
    "caches",
    "calls",
    "campaigns",
    "options",
    "parameter_files",
    "plants",
    "recordings",
    "states",
    "swollen",
]
