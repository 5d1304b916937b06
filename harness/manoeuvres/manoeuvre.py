"""What a manoeuvre is."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from .signals import NOTHING, Signal


@dataclass(frozen=True, eq=False)
class Manoeuvre:
    """One run of the loop and what its metrics refer to.

    Attributes:
        name: as on the command line.
        description: one line.
        duration: in s.
        v_0: speed at the start in m/s.
        T_driver: demanded motor torque in N.m.
        T_brake: brake torque capacity of the driven wheels in N.m, wheel side.
        slope: of the road in rad, positive uphill.
        road: parameters of the plant that are of the road too, by name, such as `mu`; not every plant has them.
        t_0: instant in s from which the metrics count; of a step, its first instant.
        dT: height of the demanded step in N.m, None if the manoeuvre is not a step.
        plateau_ends: instants in s at which the demand leaves a constant value, for the metric `plateau_swing`.
        offered: what a bus tells the controller beside, by the names of its inputs.
    """

    name: str
    description: str
    duration: float
    v_0: float
    T_driver: Signal
    T_brake: Signal = NOTHING
    slope: Signal = NOTHING
    t_0: float = 0.0
    dT: float | None = None
    plateau_ends: tuple[float, ...] = ()
    road: Mapping[str, float] = field(default_factory=dict[str, float])
    offered: Mapping[str, Signal] = field(default_factory=dict[str, Signal])

    @property
    def T_0(self) -> float:
        """Demanded torque at the start in N.m, with which a rolling start is stationary."""
        return float(self.T_driver(0.0))
