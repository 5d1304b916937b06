"""Fading from one mode to another, so that nothing jumps."""

from typing import Any

from ..block.operators import clip


def toward(value: Any, target: Any, T_s: Any, p: Any) -> Any:
    """A share, one sample nearer to its target; from 0 to 1 takes t_fade."""
    step = T_s / p.t_fade
    return value + clip(target - value, -step, step)
