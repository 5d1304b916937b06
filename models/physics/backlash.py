"""Backlash: the dead zone between the flanks of the teeth (paper, Fig. 4)."""

from fmublocks.block.operators import clip


def dead_zone(x: float, half_width: float) -> float:
    """Part of x beyond a gap of total width 2 half_width: the b(x) of the paper."""
    return x - clip(x, -half_width, half_width)
