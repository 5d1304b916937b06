"""What a run is worth: oscillation, response to the driver, and what the control took from him.

The signals are read at the samples of the controller, T_s apart.
"""

from math import nan

import numpy as np
from numpy.polynomial import Polynomial

from ..manoeuvres.manoeuvre import Manoeuvre
from .oscillation import amplitude, damping_ratio
from .record import Metrics
from .spectrum import band_rms

T_S = 0.002
"""Sample time of the controller in s."""


def evaluate(results: np.ndarray, manoeuvre: Manoeuvre, T_s: float = T_S) -> Metrics:
    """The metrics of one run.

    Args:
        results: structured array of a run of `manoeuvre` with the columns `time`,
            `controller.T_driver`, `controller.T_ref`, `plant.T_gear`, `plant.omega_1`,
            `plant.omega_2` and `plant.a_body`, at equal intervals of which T_s is a multiple.
        T_s: sample time of the controller in s.

    Raises:
        ValueError: T_s is not a multiple of the interval of the results.
    """
    sampled = at_samples(results, T_s)
    t, T_gear = sampled["time"], sampled["plant.T_gear"]
    e = added_torque(sampled["controller.T_driver"], sampled["controller.T_ref"])
    t_0, dT = manoeuvre.t_0, manoeuvre.dT
    window = np.full(len(t), True) if dT is None else _between(t, t_0 - 0.2, t_0 + 4.0)
    settling, delay, overshoot, zeta, withheld = (nan,) * 5
    if dT is not None:
        settling = settling_time(T_gear, T_s, t_0, dT)
        delay, overshoot, zeta = step_response(t, T_gear, t_0)
        withheld = withheld_time(e[_between(t, t_0, t_0 + 2.0)], T_s, dT)
    return Metrics(
        settling_time=settling,
        overshoot=overshoot,
        damping_ratio=zeta,
        gear_torque_rms=band_rms(T_gear[window], T_s),
        jerk_rms=band_rms(sampled["plant.a_body"][window], T_s, derivative=True),
        impact_speed=impact_speed(results, t_0),
        response_delay=delay,
        withheld_time=withheld,
        stationary_torque_change=stationary_change(sampled["controller.T_driver"], e, T_s),
        jerk_rms_to_50_Hz=band_rms(sampled["plant.a_body"][window], T_s, (0.0, 50.0), derivative=True),
        added_torque_rms=float(np.sqrt(np.mean(e[window] ** 2))),
        added_torque_peak=float(np.abs(e[window]).max()),
        end_swing=float(amplitude(T_gear, T_s)[-round(1.0 / T_s) :].max()),
        plateau_swing=plateau_swing(t, T_gear, manoeuvre.plateau_ends),
    )


def stationary_change(T_driver: np.ndarray, e: np.ndarray, T_s: float) -> float:
    """Mean of e in N.m over the last 0.6 s, NaN if the demand T_driver is not constant there."""
    last = -round(0.6 / T_s)
    return float(e[last:].mean()) if np.ptp(T_driver[last - 1 :]) == 0.0 else nan


def at_samples(results: np.ndarray, T_s: float = T_S) -> np.ndarray:
    """The rows of a run at 0, T_s, 2 T_s, ...

    Raises:
        ValueError: T_s is not a multiple of the interval of the results.
    """
    interval = float(results["time"][1] - results["time"][0])
    stride = round(T_s / interval)
    if stride < 1 or abs(stride * interval - T_s) > 1e-6 * T_s:
        raise ValueError(
            f"the results are {interval * 1e3:g} ms apart; the metrics need a whole fraction of the "
            f"controller's sample time of {T_s * 1e3:g} ms"
        )
    return results[::stride]


def added_torque(T_driver: np.ndarray, T_ref: np.ndarray) -> np.ndarray:
    """e = T_ref - T_driver in N.m, the demand delayed by the one sample that every controller needs."""
    return T_ref - np.concatenate((T_driver[:1], T_driver[:-1]))


def settling_time(T_gear: np.ndarray, T_s: float, t_0: float, dT: float) -> float:
    """Time in s from t_0 to the last sample at which the swing exceeds 5 % of dT, plus one sample."""
    first = round(t_0 / T_s)
    exceeding = np.flatnonzero(amplitude(T_gear, T_s)[first:] > 0.05 * abs(dT))
    return float(exceeding[-1] + 1) * T_s if len(exceeding) else 0.0


def step_response(t: np.ndarray, T_gear: np.ndarray, t_0: float) -> tuple[float, float, float]:
    """Response delay in s, overshoot and damping ratio of T_gear after a step at t_0.

    The final value is a straight line fitted to the last 0.9 s and extended backwards (the torque of a
    car that gains speed drifts). Delay and damping ratio are NaN if 90 % are never reached.
    """
    T_s = float(t[1] - t[0])
    last = t > t[-1] - 0.9 + T_s / 2
    final = Polynomial.fit(t[last], T_gear[last], 1)
    first = round(t_0 / T_s)
    initial = T_gear[first - 1] if abs(T_gear[first - 1]) >= 0.1 else 0.0
    way = final(t[first]) - initial
    z = (T_gear - initial) / way
    y = (T_gear - final(t)) / way
    overshoot = max(0.0, float(y[first:].max()))
    reached = np.flatnonzero(z[first:] >= 0.9)
    if not len(reached):
        return nan, overshoot, nan
    return float(reached[0] * T_s), overshoot, damping_ratio(y, T_s, first + int(reached[0]), overshoot)


def withheld_time(e: np.ndarray, T_s: float, dT: float) -> float:
    """-(integral of e)/dT in s: by how much the added torque e delays the driver's step dT."""
    return -float(np.sum(e)) * T_s / dT + 0.0  # nothing withheld is 0, not -0


def impact_speed(results: np.ndarray, t_0: float) -> float:
    """Largest speed in rad/s, motor side, with which the teeth meet from t_0 on; 0 if they never do.

    The gap closes between two rows when T_gear leaves zero or changes its sign. The speed is that of
    the twist, omega_1 - omega_2, as the mean of the two rows. In the design model this is the speed of
    the teeth. In a plant with compliance behind the gear it contains the twisting of that compliance,
    which is small because it carries no torque while the gap is open; the interface that every plant
    shares shows no more.
    """
    side = np.sign(results["plant.T_gear"])
    closes = np.flatnonzero((side[1:] != 0) & (side[1:] != side[:-1]))
    closes = closes[results["time"][closes] >= t_0 - 1e-9]
    speed = np.abs(results["plant.omega_1"] - results["plant.omega_2"])
    return float((0.5 * (speed[closes] + speed[closes + 1])).max(initial=0.0))


def plateau_swing(t: np.ndarray, T_gear: np.ndarray, plateau_ends: tuple[float, ...]) -> float:
    """Mean over the plateaus of half the peak-to-peak of T_gear about a straight line, N.m.

    Of each plateau the piece from 0.45 s to 0.02 s before its end is taken. NaN without plateaus.
    """
    swings = []
    for end in plateau_ends:
        piece = _between(t, end - 0.45, end - 0.02)
        rest = T_gear[piece] - Polynomial.fit(t[piece], T_gear[piece], 1)(t[piece])
        swings.append(np.ptp(rest) / 2.0)
    return float(np.mean(swings)) if swings else nan


def _between(t: np.ndarray, start: float, end: float) -> np.ndarray:
    return (t >= start - 1e-9) & (t <= end + 1e-9)
