"""How modes fade from one to the other."""

from fmublocks.block.operators import maximum, minimum, where


def faded(level: float, on: bool, T_s: float, t_fade: float) -> float:
    """The level one sample later, which goes to 1 where it is on and to 0 where not, within t_fade (s)."""
    step = T_s / t_fade
    return where(on, minimum(level + step, 1.0), maximum(level - step, 0.0))
