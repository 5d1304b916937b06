"""Sentences about the physics, the FMUs and the loop, in the rooms of what they are about."""

import sys
from pathlib import Path
from shutil import copy, copytree, ignore_patterns

ROOT = Path(__file__).resolve().parents[1]
"""Of the checkout."""

sys.path.append(str(ROOT / "tests" / "shared"))  # pytest has it too; what runs tests' code without it has not


def copied_sources(folder: Path, *packages: str) -> Path:
    """A checkout with these packages, and what is needed to import and build them; returns its folder."""
    for package in packages:
        copytree(ROOT / package, folder / package, ignore=ignore_patterns("__pycache__", "*.so"))
    (folder / "driveline").mkdir()
    for path in (ROOT / "driveline").glob("*.py*"):
        copy(path, folder / "driveline")
    for file in ("build_fmus.py", "LICENSE"):
        copy(ROOT / file, folder)
    return folder
