"""Fuzz targets: odd input by the thousand, each answered as promised or told as a fault."""

from importlib import import_module
from pkgutil import iter_modules

from tests.fuzz.target import TARGETS

__all__ = ["TARGETS"]

for module in iter_modules(__path__, f"{__name__}."):
    if not module.name.endswith("__main__"):
        import_module(module.name)
