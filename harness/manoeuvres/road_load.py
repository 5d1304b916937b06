"""A recorded drive on even samples, and what the balance of forces along the road knows of a vehicle."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf, isnan, nan
from typing import TYPE_CHECKING, Self

import numpy as np

from fmuloop.errors import WiringError

from ..loop.places import ROAD_LOAD
from ..loop.resolved import ResolvedLoop

if TYPE_CHECKING:
    from driverecords.drive import Drive

ROTATING_MASS = 1.09
"""Mass including the rotating parts, over the mass."""
SLOPE_LIMIT = 0.08
"""Steepest recorded road in rad."""
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
    def of(cls, resolved: ResolvedLoop) -> Self:
        """Of the plant of a loop, or what is told of a car beside it.

        Raises:
            WiringError: neither tells one of them.
        """
        beside = resolved.settings.road_load
        values = {name: resolved.value(f"plant.{name}", beside.get(name, nan)) for name in ROAD_LOAD}
        if missing := [name for name, value in values.items() if isnan(value)]:
            path = resolved.fit.interfaces["plant"].path
            raise WiringError(
                f"{path} has no parameter {', '.join(missing)}; a recorded drive needs {', '.join(ROAD_LOAD)} "
                f"of the vehicle to work out the brakes; the file of --vehicle may tell them"
            )
        return cls(**values)

    @property
    def inertia(self) -> float:
        """Mass in kg that is accelerated, with what rotates."""
        return ROTATING_MASS * self.m

    def motor_force(self, T_mot: np.ndarray) -> np.ndarray:
        """Force in N with which the motor pushes: i T/r."""
        return self.i * T_mot / self.r

    def motion(self, v: np.ndarray, interval: float) -> np.ndarray:
        """Force in N that a motion takes on a level road: 1.09 m dv/dt + m g c_rr sign(v) + c_wa v |v|.

        Args:
            v: speed in m/s, `interval` seconds apart.
        """
        resistance = self.m * self.g * self.c_rr * np.sign(v) + self.c_wa * v * np.abs(v)
        return self.inertia * np.gradient(v, interval) + resistance


@dataclass(frozen=True, eq=False)
class Track:
    """A recording from its start (time 0) to its last sample, resampled to its median interval.

    Attributes:
        name: of the recording.
        interval: between the samples in s.
        t: in s.
        v: speed in m/s.
        T_driver: motor torque in N.m within the limits of the motor: the driver's demand.
        slope: of the road in rad, 0 where no elevation was recorded.
        offered: what a bus tells the controller, by name, as it was received last.
    """

    name: str
    interval: float
    t: np.ndarray
    v: np.ndarray
    T_driver: np.ndarray
    slope: np.ndarray
    offered: Mapping[str, np.ndarray] = field(default_factory=dict[str, np.ndarray])

    @classmethod
    def of(cls, recording: "Drive", T_max: float = inf) -> Self:
        """
        Args:
            T_max: largest torque of the motor in N.m.
        """
        time = recording.time - recording.time[0]
        interval = round(float(np.median(np.diff(time))), 9)
        t = np.arange(int(time[-1] / interval + 1e-6) + 1) * interval
        v, T_mot = (np.interp(t, time, x) for x in (recording.v, recording.T_mot))
        slope = np.zeros_like(v)
        if recording.elevation is not None:
            slope = road_slope(v, np.interp(t, time, recording.elevation), interval)
        last = np.searchsorted(time, t + 1e-6 * interval, side="right") - 1
        offered = {name: values[last] for name, values in recording.offered.items()}
        return cls(recording.name, interval, t, v, np.clip(T_mot, -T_max, T_max), slope, offered)


def road_slope(v: np.ndarray, elevation: np.ndarray, interval: float) -> np.ndarray:
    """Slope in rad from coarse elevation (m) and speed (m/s), `interval` seconds apart.

    Elevation is smoothed over 8 s (Gaussian), the slope over 2 s and limited to +-0.08.
    """
    from scipy.integrate import cumulative_trapezoid  # every run asks for the rest of this file
    from scipy.ndimage import gaussian_filter1d

    distance = cumulative_trapezoid(v, dx=interval, initial=0.0)
    climb = np.gradient(gaussian_filter1d(elevation, 8.0 / interval), interval)
    advance = np.maximum(np.gradient(distance, interval), SPEED_MIN)
    return np.clip(gaussian_filter1d(climb / advance, 2.0 / interval), -SLOPE_LIMIT, SLOPE_LIMIT)
