"""What keeps a simulated car at the recorded speed: brake and grade, as signals of time, too slow to damp anything.

Friction brakes are seldom recorded, elevation is coarse, and the simulated car is not the recorded one. What the
recorded motion takes beside the motor is one force along the road,

    F = 1.09 m dv/dt + m g c_rr + c_wa v^2 - i T_driver/r,

to which is added what a car that was simulated with it without control lacked:

    F + 1.09 m d(v - v_sim)/dt + c_wa (v^2 - v_sim^2),

its friction and its true inertia. Each is smoothed by a Gaussian of SMOOTHING, of which 1 Hz has 0.7 % left and the
8 Hz of a drive train nothing. A controller cannot change F, and F reacts to none: all are compared on the same road.
"""

import numpy as np

from fmuloop.errors import WiringError

from ..loop.places import STEP_SIZE
from .manoeuvre import Manoeuvre
from .road_load import RoadLoad, Track
from .signals import Count, Held, Lines

SMOOTHING = 0.5
"""Standard deviation in s of the Gaussian: half of the power is left at 0.27 Hz."""
F_UNCERTAIN = 300.0
"""Force in N that the balance of forces cannot tell from an error; the grade takes it, and the brakes the rest."""
F_BRAKE_MAX = 4000.0
"""Largest brake force in N, and the one that holds a standing car."""
SLOW = 2.0
"""Speed in m/s below which the brakes alone decelerate: a car that stands too early is not pushed back by its motor."""
STILL = 0.3
"""Speed in m/s up to which brakes may hold a car, so that its motion tells nothing of the forces."""
SIN_MAX = 0.4
"""Sine of the steepest grade."""


def needed_force(track: Track, load: RoadLoad) -> np.ndarray:
    """F in N, of which the recording tells: a sample of the track each."""
    return smooth(load.motion(track.v, track.interval) - load.motor_force(track.T_driver), track)


def lacking_force(track: Track, load: RoadLoad, t: np.ndarray, v: np.ndarray) -> np.ndarray:
    """What F lacked in N, a sample of the track each, where a car without control had the speed v (m/s) at t (s)."""
    simulated = np.interp(track.t, t, v)
    lacking = load.motion(track.v, track.interval) - load.motion(simulated, track.interval)
    return smooth(np.where(np.minimum(track.v, simulated) > STILL, lacking, 0.0), track)


def smooth(force: np.ndarray, track: Track) -> np.ndarray:
    """The slow part of a force."""
    from scipy.ndimage import gaussian_filter1d  # a recorded drive alone needs it

    return gaussian_filter1d(force, SMOOTHING / track.interval, mode="nearest")


def brake_force(track: Track, load: RoadLoad, F: np.ndarray) -> np.ndarray:
    """What of F in N the brakes do while the car rolls: what the recorded grade and F_UNCERTAIN leave over."""
    surplus = -F - load.m * load.g * np.sin(track.slope) - F_UNCERTAIN
    deceleration = -load.inertia * np.gradient(track.v, track.interval)
    demanded = np.where(track.v < SLOW, np.maximum(surplus, deceleration), surplus)
    return smooth(np.clip(demanded, 0.0, F_BRAKE_MAX), track)


def holding(track: Track, load: RoadLoad, F: np.ndarray) -> np.ndarray:
    """Whether brakes hold the car: where the recorded one stands, whose speed stays zero for a moment after the
    driver has begun to pull away."""
    return (track.v == 0.0) & (load.motor_force(track.T_driver) + np.minimum(F, 0.0) <= F_UNCERTAIN)


def require_held(held: float | None) -> None:
    """Refuses to sample and hold a demand for so many seconds; None: it is not held.

    Raises:
        WiringError: that is less than a communication step.
    """
    if held is not None and not held >= STEP_SIZE:
        raise WiringError(f"a demand that is held for {held:g} s: it must be {STEP_SIZE:g} s or more")


def drive(track: Track, load: RoadLoad, F: np.ndarray, held: float | None = None) -> Manoeuvre:
    """The manoeuvre of a whole recorded trip, with the force F along the road as brake and grade.

    Args:
        track: the drive.
        load: of the vehicle that will drive it.
        F: in N, a sample of the track each.
        held: if given, the demand is sampled and held for so many seconds: a rougher foot.

    Raises:
        WiringError: as of `require_held`.
    """
    require_held(held)
    F_brake, duration = brake_force(track, load, F), float(track.t[-1])
    sine = np.clip(-(F + F_brake) / (load.m * load.g), -SIN_MAX, SIN_MAX)
    demand = Lines(track.t, track.T_driver)
    return Manoeuvre(
        name=track.name,
        description=f"recorded drive of {duration:.0f} s",
        duration=duration,
        v_0=float(track.v[0]),
        T_driver=demand if held is None else Held(held, demand(np.arange(0.0, duration + held, held))),
        T_brake=Lines(track.t, load.r * np.where(holding(track, load, F), F_BRAKE_MAX, F_brake)),
        slope=Lines(track.t, np.arcsin(sine)),
        offered={
            name: Count(Lines(track.t, values)) if name == "alive" else Held(track.interval, values)
            for name, values in track.offered.items()
        },
    )
