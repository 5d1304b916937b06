"""Fuzz targets: odd input by the thousand, each answered as promised or told as a fault."""

from tests.fuzz import archives, calls, options, parameter_files, plants, recordings, swollen
from tests.fuzz.target import TARGETS

__all__ = ["TARGETS", "archives", "calls", "options", "parameter_files", "plants", "recordings", "swollen"]
