"""Backlash: the dead zone between the flanks of the teeth (paper, Fig. 4)."""

from typing import Any

from .operators import where


def dead_zone(x: Any, half_width: Any) -> Any:
    """Part of x beyond a gap of total width 2 half_width: the b(x) of the paper."""
    return where(x > half_width, x - half_width, where(x < -half_width, x + half_width, 0.0))
