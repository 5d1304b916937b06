"""Whether the damping feeds the oscillation that it should damp.

Behind a signal that is late, or wrong in a way that no comparison shows, damping may push where it should pull. It
shows in the damping torque: in a damped drive train it dies away after a change of the demand, each half swing far
smaller than the one before. Half swings are counted that reach `swing` on both sides and `swing_decay` of the one
before. From SWINGS on there is no damping, and less in the one before. They are forgotten at one a t_forget, once there
is none at one a t_relapse, and at one where the demand changes by `demand_excuse` times the largest torque of the
present half swing and `swing` together. Whatever shakes the drive train from outside (ABS, a road without grip) is
counted too, and the damping can do little against it: it only becomes less, and there is no fallback.
"""

from typing import Annotated, NamedTuple

from fmublocks.block.declaration import Real
from fmublocks.block.operators import clip, logical_and, logical_not, logical_or, maximum, minimum, where

from .supervision_interface import Parameters

AHEAD = 1.0
"""Half swings that a change of the demand can explain before they come."""

SWINGS, LONGEST = 2.0, 5.5
"""Half swings with which there is no damping, and that are counted at most. The output follows from the state alone."""


class SwingState(NamedTuple):
    """State of the count."""

    peak: Annotated[float, Real("N.m", "largest torque of the present half swing, 0 at first")] = 0.0
    enough: Annotated[float, Real("N.m", "torque with which it counts, 0 if it does not or has")] = 0.0
    count: Annotated[float, Real("1", "half swings that nothing explains")] = 0.0  # pyright: ignore[reportIncompatibleMethodOverride]


def update(x: SwingState, damping: float, change: float, acting: bool, T_s: float, p: Parameters) -> SwingState:
    """The state after a sample with this damping torque and change of the demand (N.m).

    Args:
        damping: as it would be if nothing was counted.
        acting: there is damping.
    """
    swings = abs(damping) > p.swing * p.T_max
    turned = logical_and(swings, damping * x.peak < 0.0)
    larger = logical_and(swings, logical_or(damping * x.peak <= 0.0, abs(damping) > abs(x.peak)))
    peak = where(larger, damping, x.peak)
    enough = where(turned, p.swing_decay * abs(x.peak), x.enough)
    counts = logical_and(enough > 0.0, abs(peak) >= enough)
    least = T_s / where(x.count < SWINGS, p.t_forget, p.t_relapse)
    forgotten = where(x.count > 0.0, maximum(x.count - least, 0.0), minimum(x.count + least, 0.0))
    explained = abs(change) / (p.demand_excuse * (abs(peak) + p.swing * p.T_max))
    count = minimum(maximum(forgotten - explained, -AHEAD) + where(counts, 1.0, 0.0), LONGEST)
    return SwingState(
        peak=where(acting, peak, 0.0),
        enough=where(logical_and(acting, logical_not(counts)), enough, 0.0),
        count=where(acting, count, 0.0),
    )


def share(x: SwingState) -> float:
    """Of the damping that is left."""
    return clip(SWINGS - x.count, 0.0, 1.0)


def is_less(x: SwingState) -> bool:
    """Whether less of the damping is left than all."""
    return x.count > SWINGS - 1.0
