"""Fading from one mode to another, so that nothing jumps."""

from ..block.operators import clip


def toward(value: float, target: float, T_s: float, t_fade: float) -> float:
    """A share, one sample nearer to its target; from 0 to 1 takes t_fade (s)."""
    step = T_s / t_fade
    return value + clip(target - value, -step, step)
