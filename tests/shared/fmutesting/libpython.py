"""What a program that is no Python program needs to run FMUs with Python in them."""

import sys
import sysconfig
from pathlib import Path

import pytest


def with_libpython() -> dict[str, str]:
    """Its environment; skips the test where this Python has no library for it."""
    name = sysconfig.get_config_var("INSTSONAME") or ""
    folder = Path(sysconfig.get_config_var("LIBDIR") or "")
    places = (folder / name, folder / (sysconfig.get_config_var("MULTIARCH") or "") / name)
    library = next((path for path in places if ".so" in name and path.is_file()), None)
    if library is None or not sys.platform.startswith("linux"):
        pytest.skip("LD_PRELOAD loads libpython on Linux alone, where this Python has it as a library")
    return {"LD_PRELOAD": str(library), "PYTHONHOME": sys.base_prefix, "LC_ALL": "C.UTF-8"}
