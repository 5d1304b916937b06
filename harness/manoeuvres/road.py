"""A recorded drive as a manoeuvre: the driver's torque demand and the road, brakes filled in.

Friction brakes are not recorded. They get what the motor's force leaves over from the balance of
forces along the road, less 300 N that its uncertainties deserve; where the recorded car stands and the
driver does not drive, they hold the simulated one. The simulated speed is free: it follows
the recorded one as far as the vehicle resembles the recorded car.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from math import inf
from typing import Self

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.ndimage import gaussian_filter1d

from ..cosimulation.interface import Interface
from ..errors import WiringError
from .manoeuvre import Manoeuvre
from .recording import Recording
from .signals import Held, Lines

ROTATING_MASS = 1.09
"""Mass including the rotating parts, over the mass."""
F_UNCERTAIN = 300.0
"""Force in N that the balance of forces cannot tell from an error."""
F_BRAKE_MAX = 4000.0
"""Largest brake force in N, and the one that holds a standing car."""
SLOPE_LIMIT = 0.08
"""Steepest road in rad."""
HELD_MIN = 1e-3
"""Shortest time in s for which a demand is held, the communication step."""
SPEED_MIN = 3.0
"""Speed in m/s below which the climb over the distance says nothing of the slope."""


@dataclass(frozen=True)
class RoadLoad:
    """What the balance of forces along the road needs to know of a vehicle (parameters of the plant)."""

    i: float
    r: float
    m: float
    g: float
    c_rr: float
    c_wa: float

    @classmethod
    def of_plant(cls, plant: Interface, parameters: Mapping[str, float] | None = None) -> Self:
        """The start values of the parameters of these names.

        Args:
            parameters: `plant.name` -> value, which a run sets instead; others are ignored.

        Raises:
            WiringError: the plant lacks one of them.
        """
        starts = {
            name: float(variable.start) * plant.factors.get(name, 1.0)
            for name, variable in plant.variables.items()
            if variable.type == "Real" and variable.start
        }
        starts |= {name.removeprefix("plant."): value for name, value in (parameters or {}).items()}
        names = [field.name for field in fields(cls)]
        missing = [name for name in names if name not in starts]
        if missing:
            raise WiringError(
                f"{plant.path} has no parameter {', '.join(missing)}; a recorded drive needs {', '.join(names)} "
                f"of the vehicle to work out the brakes"
            )
        return cls(*(starts[name] for name in names))

    def surplus(
        self,
        T_mot: np.ndarray,
        v: np.ndarray,
        a: np.ndarray,
        slope: np.ndarray,
    ) -> np.ndarray:
        """Force in N by which the motor pushes more than the motion takes.

        F = i T_mot/r - m g (c_rr + sin(slope)) - c_wa v^2 - 1.09 m a
        """
        grade = self.m * self.g * (self.c_rr + np.sin(slope))
        return self.i * T_mot / self.r - grade - self.c_wa * v**2 - ROTATING_MASS * self.m * a


def torque_limit(motor: Interface, parameters: Mapping[str, float] | None = None) -> float:
    """T_max of a motor in N.m as `parameters` (`motor.T_max` -> value), else its start value says; inf without one."""
    variable = motor.variables.get("T_max")
    start = float(variable.start) * motor.factors.get("T_max", 1.0) if variable and variable.start else inf
    return (parameters or {}).get("motor.T_max", start)


def road(recording: Recording, load: RoadLoad, held: float | None = None, T_max: float = inf) -> Manoeuvre:
    """The manoeuvre of a whole recorded trip, from its start (time 0) to its last sample.

    Args:
        recording: the drive; resampled to its median interval.
        load: of the vehicle that will drive it.
        held: if given, the demand is sampled and held for so many seconds: a rougher foot.
        T_max: largest torque of the motor in N.m, to which the demand is limited.

    Raises:
        WiringError: it is held for less than HELD_MIN.
    """
    if held is not None and not held >= HELD_MIN:
        raise WiringError(f"a demand that is held for {held:g} s: it must be {HELD_MIN:g} s or more")
    interval = round(float(np.median(np.diff(recording.time))), 9)
    t = np.arange(int((recording.time[-1] - recording.time[0]) / interval + 1e-6) + 1) * interval
    v, elevation, T_mot = (
        np.interp(t, recording.time - recording.time[0], signal)
        for signal in (recording.v, recording.elevation, recording.T_mot)
    )
    T_driver = np.clip(T_mot, -T_max, T_max)
    slope = road_slope(v, elevation, interval)
    demand = Lines(t, T_driver)
    return Manoeuvre(
        name=recording.name,
        description=f"recorded drive of {t[-1]:.0f} s",
        duration=float(t[-1]),
        v_0=float(v[0]),
        T_driver=demand if held is None else Held(held, demand(np.arange(0.0, t[-1] + held, held))),
        T_brake=Lines(t, brake_torque(T_driver, v, slope, interval, load)),
        slope=Lines(t, slope),
    )


def road_slope(v: np.ndarray, elevation: np.ndarray, interval: float) -> np.ndarray:
    """Slope in rad from coarse elevation (m) and speed (m/s), `interval` seconds apart.

    Elevation is smoothed over 8 s (Gaussian), the slope over 2 s and limited to +-0.08.
    """
    distance = cumulative_trapezoid(v, dx=interval, initial=0.0)
    climb = np.gradient(gaussian_filter1d(elevation, 8.0 / interval), interval)
    advance = np.maximum(np.gradient(distance, interval), SPEED_MIN)
    return np.clip(gaussian_filter1d(climb / advance, 2.0 / interval), -SLOPE_LIMIT, SLOPE_LIMIT)


def brake_torque(
    T_driver: np.ndarray,
    v: np.ndarray,
    slope: np.ndarray,
    interval: float,
    load: RoadLoad,
) -> np.ndarray:
    """Torque of the brakes in N.m, wheel side; acceleration is smoothed over 0.5 s."""
    a = gaussian_filter1d(np.gradient(v, interval), 0.5 / interval)
    F = np.clip(load.surplus(T_driver, v, a, slope) - F_UNCERTAIN, 0.0, F_BRAKE_MAX)
    # the recorded speed stays zero for a moment after the driver has begun to pull away
    holding = (v == 0.0) & (load.i * T_driver / load.r <= F_UNCERTAIN)
    return load.r * np.where(holding, F_BRAKE_MAX, F)
