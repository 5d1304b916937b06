"""Whether the damping feeds the oscillation that it should damp.

Behind a signal that is wrong in a way that no comparison shows, damping may push where it should pull. It
shows in the damping torque: in a damped drive train it dies away in fewer than MOST half swings after a
change of the demand. Half swings are counted that reach SWING on both sides; they are forgotten at one a
T_FORGET, and at one for each EXCUSE by which the demand changes.
"""

from typing import Annotated, Any, NamedTuple

from ..block.declaration import Real
from ..block.operators import maximum, where

SWING = 0.15
"""Least damping torque of a half swing, over T_max."""

EXCUSE = 0.2
"""Change of the demand that explains a half swing, over T_max."""

T_FORGET = 0.5
"""Time in s after which a half swing is forgotten."""

MOST = 3.2
"""Half swings that the damping does not make in a drive train that it damps."""


class SwingState(NamedTuple):
    """State of the count."""

    side: Annotated[float, Real("1", "sign of the half swing that was counted last, 0 at first")]
    count: Annotated[float, Real("1", "half swings that nothing explains")]
    T_driver: Annotated[float, Real("N.m", "demand of the last sample")]


def start(T_driver: Any) -> SwingState:
    return SwingState(side=0.0, count=0.0, T_driver=T_driver)


def is_calm(damping: Any, p: Any) -> Any:
    """Whether the damping torque (N.m) is too small for a half swing."""
    return abs(damping) <= SWING * p.T_max


def update(x: SwingState, damping: Any, T_driver: Any, acting: Any, T_s: Any, p: Any) -> SwingState:
    """The state after a sample with this damping torque and demand (N.m); `acting`: the damping is not faded out."""
    side = where(is_calm(damping, p), x.side, where(damping > 0.0, 1.0, -1.0))
    turned = where(side * x.side < 0.0, 1.0, 0.0)
    explained = T_s / T_FORGET + abs(T_driver - x.T_driver) / (EXCUSE * p.T_max)
    count = maximum(x.count - explained, 0.0) + turned
    return SwingState(side=where(acting, side, 0.0), count=where(acting, count, 0.0), T_driver=T_driver)


def feeds(x: SwingState) -> Any:
    return x.count >= MOST
