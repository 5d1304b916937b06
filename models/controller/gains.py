"""Designed parameters of the controller, as `driveline design` stores them."""

import tomllib
from pathlib import Path

GAINS: dict[str, float] = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
"""By name, in SI units."""
