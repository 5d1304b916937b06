"""A manoeuvre made from parts."""

from collections.abc import Sequence

from .demand_shape import plateau_ends, step_of
from .manoeuvre import Manoeuvre
from .parts import constant, summed
from .signals import NOTHING, Lines, Signal

Parts = float | Signal | Sequence[Signal]
"""A constant, a signal, or the parts whose sum it is (`harness.manoeuvres.parts`)."""


def composed(
    name: str,
    duration: float,
    v_0: float = 0.0,
    T_driver: Parts = 0.0,
    T_brake: Parts = 0.0,
    slope: Parts = 0.0,
    description: str | None = None,
) -> Manoeuvre:
    """A manoeuvre whose metrics refer to what it is: a step, of which they take instant and height, where the demand
    makes one and brake and slope stay as they are; of a demand of straight lines they take the plateaus.

        demand = [driveline.constant(-12.0), driveline.step(1.0, 112.0)]
        kick = driveline.composed("kick", duration=6.0, v_0=15 / 3.6, T_driver=demand)

    Args:
        name: of results and files.
        duration: in s.
        v_0: speed at the start in m/s.
        T_driver, T_brake, slope: see `Manoeuvre`.
        description: None: the name.

    Raises:
        ManoeuvreError: a constant is not finite.
    """
    demand, brake, road = (_signal(parts) for parts in (T_driver, T_brake, slope))
    drawn = demand if isinstance(demand, Lines) else NOTHING
    stays = all(isinstance(signal, Lines) and len(set(signal.values)) == 1 for signal in (brake, road))
    t_0, dT = (step_of(drawn) if stays else None) or (0.0, None)
    return Manoeuvre(name, description or name, duration, v_0, demand, brake, road, t_0, dT, plateau_ends(drawn))


def _signal(parts: Parts) -> Signal:
    if callable(parts):
        return parts
    return summed(parts) if isinstance(parts, Sequence) else constant(parts)
