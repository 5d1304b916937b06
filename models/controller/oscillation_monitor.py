"""Whether the damping feeds the oscillation that it should damp.

Behind a signal that is wrong in a way that no comparison shows, damping may push where it should pull. It
shows in the damping torque: in a damped drive train it dies away after a change of the demand, each half
swing far smaller than the one before. Half swings are counted that reach SWING on both sides and GROWS of
the one before; they are forgotten at one a T_FORGET, and at one for each EXCUSE by which the demand changes.
What counts is the torque that acts: at full demand T_max leaves the damping one side only, and an
oscillation that is braked by half the swings dies away slowly.
"""

from typing import Annotated, NamedTuple

from ..block.declaration import Real
from ..block.operators import clip, logical_and, logical_not, maximum, where
from .supervision_interface import Parameters

SWING = 0.12
"""Least damping torque of a half swing, over T_max."""

GROWS = 0.7
"""Least size of a half swing that is counted, over the one before."""

EXCUSE = 0.2
"""Change of the demand that explains a half swing, over T_max."""

AHEAD = 1.0
"""Half swings that a change of the demand can explain before they come."""

T_FORGET = 0.5
"""Time in s after which a half swing is forgotten, or no longer explained ahead."""

MOST = 2.5
"""Half swings that the damping does not make in a drive train that it damps."""

CALM = 0.15
"""Damping torque over T_max up to which no oscillation needs it."""


class SwingState(NamedTuple):
    """State of the count."""

    side: Annotated[float, Real("1", "sign of the present half swing, 0 at first")]
    peak: Annotated[float, Real("N.m", "largest torque of that half swing, in magnitude")]
    enough: Annotated[float, Real("N.m", "torque with which it counts, 0 if it does not or has")]
    count: Annotated[float, Real("1", "half swings that nothing explains")]  # pyright: ignore[reportIncompatibleMethodOverride]
    T_driver: Annotated[float, Real("N.m", "demand of the last sample")]


def start(T_driver: float) -> SwingState:
    return SwingState(side=0.0, peak=0.0, enough=0.0, count=0.0, T_driver=T_driver)


def is_calm(damping: float, p: Parameters) -> bool:
    """Whether the damping torque (N.m) is small."""
    return abs(damping) <= CALM * p.T_max


def update(x: SwingState, damping: float, T_driver: float, acting: bool, T_s: float, p: Parameters) -> SwingState:
    """The state after a sample with this damping torque and demand (N.m); `acting`: the damping is not faded out."""
    size = abs(damping)
    side = where(size > SWING * p.T_max, where(damping > 0.0, 1.0, -1.0), x.side)
    turned = side * x.side < 0.0
    peak = where(side * damping > 0.0, maximum(where(turned, 0.0, x.peak), size), x.peak)
    enough = where(turned, GROWS * x.peak, x.enough)
    counts = logical_and(enough > 0.0, peak >= enough)
    forgotten = x.count - clip(x.count, -T_s / T_FORGET, T_s / T_FORGET)
    explained = abs(T_driver - x.T_driver) / (EXCUSE * p.T_max)
    count = maximum(forgotten - explained, -AHEAD) + where(counts, 1.0, 0.0)
    return SwingState(
        side=where(acting, side, 0.0),
        peak=where(acting, peak, 0.0),
        enough=where(logical_and(acting, logical_not(counts)), enough, 0.0),
        count=where(acting, count, 0.0),
        T_driver=T_driver,
    )


def feeds(x: SwingState) -> bool:
    return x.count >= MOST
