"""What a run is worth: oscillation, response to the driver, and what the control took from him.

The signals are read at the samples of the controller, T_s apart.
"""

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np

from fmuloop.argument_kinds import require_kind
from fmuloop.results import Ended

from ..loop import roles
from ..loop.arguments import A_MANOEUVRE
from ..loop.places import T_S
from ..manoeuvres.manoeuvre import Manoeuvre
from .declaration import Absent, measured
from .oscillation import amplitude, straight_line
from .run_metrics import Metrics
from .spectrum import TO_50_HZ, BandSpectrum, band_rms, own_band
from .step_response import Response, height_of_step, response, settling_time

STATIONARY, FADED = 0.6, 0.9
"""Length in s of the end of a run that counts as stationary, and of the time before it in which what the control adds
after a change of the demand fades."""

WINDOW = (-0.2, 4.0)
"""From and to when in s, after a step, its rms and peak values are taken."""

FIRM = 0.1
"""Time in s for which teeth that have met for good stay together: a bounce is half a period of the drive train."""

WITHHELD = 2.0
"""Time in s after a step, in which what is withheld from the driver counts."""

COLUMNS = (
    "time",
    roles.DEMAND,
    roles.REFERENCE_TORQUE,
    roles.GEAR_TORQUE,
    roles.MOTOR_SPEED,
    roles.WHEEL_SPEED,
    roles.BODY_ACCELERATION,
)
"""What the metrics are computed from."""

Rows = np.ndarray | Mapping[str, np.ndarray]
"""Results, or columns of them by name."""


def evaluate(results: np.ndarray, manoeuvre: Manoeuvre, T_s: float = T_S) -> Metrics:
    """The metrics of one run. One that makes no sense for it is NaN, and `absent` has the reason; of a run that an FMU
    has ended before its time all are.

    Args:
        results: structured array of a run of `manoeuvre` with the COLUMNS, at equal intervals of which T_s is a
            multiple.
        T_s: sample time of the controller in s.

    Raises:
        WiringError: results or manoeuvre are something else.
        ValueError: T_s is not a multiple of the interval of the results.
    """
    require_kind("results", results, np.ndarray, "results of a run, as simulate gives them")
    require_kind("manoeuvre", manoeuvre, Manoeuvre, A_MANOEUVRE)
    t_0, band, ended = manoeuvre.t_0, own_band(getattr(results, "frequency", None)), end_of(results)
    every = 1 if ended else _stride(results, T_s)
    rows, sampled, kept = results, results[::every], _anew
    if getattr(results, "file", None) is None:  # else columns are read when needed: all would not fit in memory
        rows = {name: np.ascontiguousarray(results[name]) for name in COLUMNS}
        sampled, kept = {name: np.ascontiguousarray(column[::every]) for name, column in rows.items()}, cache

    def t() -> np.ndarray:
        return sampled["time"]

    def T_gear() -> np.ndarray:
        return sampled[roles.GEAR_TORQUE]

    @kept
    def e() -> np.ndarray:
        return added_torque(sampled[roles.DEMAND], sampled[roles.REFERENCE_TORQUE])

    @kept
    def a_body() -> BandSpectrum:
        return BandSpectrum(windowed(sampled[roles.BODY_ACCELERATION]), T_s)

    @kept
    def swing() -> np.ndarray:
        return amplitude(T_gear(), T_s)

    @cache
    def dT() -> float:
        return height_of_step(manoeuvre, t())

    @cache
    def step() -> Response:
        return response(t(), T_gear(), t_0, dT())

    @cache
    def impacts() -> np.ndarray:
        return impact_speeds(rows, t_0)

    @cache
    def window() -> slice:
        return slice(None) if manoeuvre.dT is None else _within(t(), t_0 + WINDOW[0], t_0 + WINDOW[1])

    def windowed(signal: np.ndarray) -> np.ndarray:
        return signal[window()]

    computed = {
        "settling_time": lambda: settling_time(swing(), T_s, t_0, dT()),
        "overshoot": lambda: step().overshoot,
        "damping_ratio": lambda: step().damping_ratio,
        "gear_torque_rms": lambda: band_rms(windowed(T_gear()), T_s, band),
        "jerk_rms": lambda: a_body().rms(band, derivative=True),
        "impact_speed": lambda: float(impacts().max(initial=0.0)),
        "impact_speed_90": lambda: nine_of_ten(impacts()),
        "crossing_time": lambda: crossing_time(rows, t_0),
        "response_delay": lambda: step().delay,
        "withheld_time": lambda: withheld_time(e()[_within(t(), t_0, t_0 + WITHHELD)], T_s, dT()),
        "stationary_torque_change": lambda: stationary_change(sampled[roles.DEMAND], e(), T_s),
        "jerk_rms_to_50_Hz": lambda: a_body().rms(TO_50_HZ, derivative=True),
        "added_torque_rms": lambda: float(np.sqrt(np.mean(windowed(e()) ** 2))),
        "added_torque_peak": lambda: float(np.abs(windowed(e())).max()),
        "gear_torque_peak": lambda: float(np.abs(windowed(T_gear())).max()),
        "end_swing": lambda: float(swing()[-round(1.0 / T_s) :].max()),
        "plateau_swing": lambda: plateau_swing(t(), T_gear(), manoeuvre.plateau_ends),
    }
    return Metrics(**measured(computed, none_because=ended or not_finite(rows)))


def end_of(results: np.ndarray) -> str | None:
    """When an FMU has ended a run before its time; None if none has."""
    ended: Ended | None = getattr(results, "ended", None)
    return f"the run ended at {ended.time:g} s" if ended else None


def not_finite(results: Rows) -> str | None:
    """Which signal is not finite, and from when on; None if all are."""
    for name in COLUMNS:
        finite = np.isfinite(results[name])
        if not finite.all():
            return f"{name} is not finite at {results['time'][finite.argmin()]:g} s"
    return None


def _anew(function: Callable[[], Any]) -> Callable[[], Any]:
    """What is not kept."""
    return function


def nine_of_ten(values: np.ndarray) -> float:
    """What nine of ten values do not exceed, between two of them on the line through both; 0 without values."""
    return float(np.interp(0.9 * (len(values) - 1), np.arange(len(values)), np.sort(values))) if len(values) else 0.0


def stationary_change(T_driver: np.ndarray, e: np.ndarray, T_s: float) -> float:
    """Mean of e in N.m over the last STATIONARY s.

    Raises:
        Absent: the demand T_driver is not constant there and in the time before in which the response to it fades.
    """
    constant = -round((FADED + STATIONARY) / T_s)
    if len(T_driver) <= -constant or np.ptp(T_driver[constant - 1 :]) != 0.0:
        raise Absent(f"the demand is not constant in the last {FADED + STATIONARY:g} s")
    return float(e[-round(STATIONARY / T_s) :].mean())


def at_samples(results: np.ndarray, T_s: float = T_S) -> np.ndarray:
    """The rows of a run at 0, T_s, 2 T_s, ...

    Raises:
        ValueError: T_s is not a multiple of the interval of the results, or there is one row alone.
    """
    return results[:: _stride(results, T_s)]


def _stride(results: np.ndarray, T_s: float) -> int:
    if len(results) < 2:
        raise ValueError("the results have fewer than two rows: there is nothing to evaluate")
    interval = float(np.diff(results[:2]["time"])[0])
    stride = round(T_s / interval)
    if stride < 1 or abs(stride * interval - T_s) > 1e-6 * T_s:
        raise ValueError(
            f"the results are {interval * 1e3:g} ms apart; the metrics need a whole fraction of the "
            f"controller's sample time of {T_s * 1e3:g} ms, such as {0.5 * T_s * 1e3:g} ms"
        )
    return stride


def added_torque(T_driver: np.ndarray, T_ref: np.ndarray) -> np.ndarray:
    """e = T_ref - T_driver in N.m, the demand delayed by the one sample that every controller needs."""
    e = np.array(T_ref)
    e[0] -= T_driver[0]
    e[1:] -= T_driver[:-1]
    return e


def withheld_time(e: np.ndarray, T_s: float, dT: float) -> float:
    """-(integral of e)/dT in s: by how much the added torque e delays the driver's step dT."""
    return -float(np.sum(e)) * T_s / dT + 0.0  # nothing withheld is 0, not -0


def crossing_time(results: Rows, t_0: float) -> float:
    """Longest time in s from where the teeth part to where they meet for good, from t_0 on; 0 if they never part.

    They meet for good where they stay together for FIRM s, or at the end of the run; one that has not ended does not
    count. Teeth that are apart at t_0 part then.
    """
    t = results["time"]
    since = int(np.searchsorted(t, t_0 - 1e-9))
    together = np.concatenate(([True], results[roles.GEAR_TORQUE][since:] != 0.0, [False])).astype(np.int8)
    parts, meets = (np.flatnonzero(np.diff(together) == change) for change in (-1, 1))
    if not len(meets):
        return 0.0
    interval = float(t[1] - t[0])
    firm = (parts[1:] - meets) * interval >= FIRM
    begins = parts[:-1][np.concatenate(([True], firm[:-1]))]
    ends = meets[firm]
    return float((ends - begins[: len(ends)]).max(initial=0)) * interval


def impact_speeds(results: Rows, t_0: float) -> np.ndarray:
    """The speeds in rad/s, motor side, with which the teeth meet from t_0 on.

    The gap closes between two rows when T_gear leaves zero or changes its sign, at the moment to which its
    rise after them leads back. The speed is that of the twist, omega_1 - omega_2, at this moment: as it grew in
    the gap before, or between the two rows where these are not both in the gap. In the design model this is
    the speed of the teeth. In a plant with compliance behind the gear it contains the twisting of that compliance,
    which is small because it carries no torque while the gap is open; the interface that every plant
    shares shows no more.

    Raises:
        Absent: T_gear goes from one sign to the other without ever staying zero between them: there is no backlash.
    """
    side = np.sign(results[roles.GEAR_TORQUE]).astype(np.int8)
    closes = np.flatnonzero((side[1:] != 0) & (side[1:] != side[:-1]))
    if _never_apart(side):
        raise Absent("the gear torque is never zero between both flanks: the plant shows no backlash")
    closes = closes[(results["time"][closes] >= t_0 - 1e-9) & (closes > 0) & (closes < len(side) - 2)]
    around = closes + np.array([[-1], [0], [1]])
    before, speed, after = np.abs(results[roles.MOTOR_SPEED][around] - results[roles.WHEEL_SPEED][around])
    in_gap = (side[closes - 1] == 0) & (side[closes] == 0)
    growth = np.where(in_gap, speed - before, after - speed)
    part = _part_of_interval(results[roles.GEAR_TORQUE], closes)
    return speed + part * growth


def _never_apart(side: np.ndarray) -> bool:
    """Whether the torque goes from one sign to the other, and always from one row to the next."""
    loaded = np.flatnonzero(side)
    rows_apart = np.diff(loaded)[np.diff(side[loaded]) != 0]
    return len(rows_apart) > 0 and bool((rows_apart == 1).all())


def _part_of_interval(T_gear: np.ndarray, closes: np.ndarray) -> np.ndarray:
    """After what share of the interval from these rows on the torque begins that the two rows after it show."""
    first, rise = T_gear[closes + 1], T_gear[closes + 2] - T_gear[closes + 1]
    since = np.divide(first, rise, out=np.full(len(closes), 0.5), where=rise * first > 0.0)
    return 1.0 - np.clip(since, 0.0, 1.0)


def plateau_swing(t: np.ndarray, T_gear: np.ndarray, plateau_ends: tuple[float, ...]) -> float:
    """Mean over the plateaus of half the peak-to-peak of T_gear about a straight line, N.m.

    Of each plateau the piece from 0.45 s to 0.02 s before its end is taken.

    Raises:
        Absent: there is none, or the run ends before the last one.
    """
    if not plateau_ends:
        raise Absent("the demand has no plateaus")
    if t[-1] < max(plateau_ends) - 0.02:
        raise Absent("the run ends before the last plateau of the demand")
    swings = []
    for end in plateau_ends:
        times, torques = (signal[_within(t, end - 0.45, end - 0.02)] for signal in (t, T_gear))
        swings.append(np.ptp(torques - straight_line(times, torques, times)) / 2.0)
    return float(np.mean(swings))


def _within(t: np.ndarray, start: float, end: float) -> slice:
    """Which samples are from start to end.

    Raises:
        Absent: there are less than two.
    """
    first, stop = np.searchsorted(t, start - 1e-9), np.searchsorted(t, end + 1e-9, side="right")
    if stop - first < 2:
        raise Absent(f"the run has no samples from {start:g} to {end:g} s")
    return slice(first, stop)
