"""The FMUs of the controllers that ours is compared with; they are no part of the product."""

from ..models.comparators import (
    linear_observer,
    no_damping,
    paper_observer,
    perfect_state,
    speed_difference,
    speed_washout,
)
from .fmu import Fmu

COMPARATORS: dict[str, Fmu] = {
    module.BLOCK.name: Fmu(module.BLOCK, stop_time=10.0)
    for module in (no_damping, speed_washout, speed_difference, paper_observer, linear_observer, perfect_state)
}
"""By name, in the order of the tables."""
