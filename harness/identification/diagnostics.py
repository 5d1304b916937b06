"""Diagnostics: what may be wrong with a recording, or with what is taken as known, shows in the innovations."""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.signal import welch

from .drive_train import DELAYS, Parameters, damping
from .drive_train_response import Tyre
from .maximum_likelihood import deviations_if_known
from .output_error import Fitted, rivals
from .prediction import Filtered
from .quality import Z_95
from .time_shifts import MOST
from .torque_loop import FittedLoop

LIKELY = 15.1
"""Twice the gain in likelihood of one more parameter up to which it is not asked for: more comes by chance once in ten
thousand."""

SKEWED = 2e-4
"""Time in s from which on a shift between channels is named; what is smaller is allowed for too."""

CHANNELS = {"late_1": "motor speed", "late_T": "motor torque", "late_L": "load torque"}
"""By their delays."""

DEMAND_LATE = 0.5
"""Samples by which the torque demand must be late or early to be named."""

LAG_OFF = 0.1
"""Share of tau that the vehicle file may be wrong by without a warning."""

SURELY = 3.0
"""Standard deviations by which a shift or the gain of the motor torque must be off to be named."""

UNKNOWN_GAIN, LOAD_GAIN = 0.3, 0.1
"""Relative standard deviation of the gain of the load torque from which on it tells nothing, and what the gain may be
off by: measurement wheels are right to some per cent."""

WHITE = 0.25
"""Autocorrelation of the innovations up to which they count as white; of a good recording it is about 0.07."""

ZERO = 5.0
"""Offset of a recorded torque in N.m from which on it is named; smaller ones are found and do no harm."""

OUTLIER, LONELY = 10.0, 3.0
"""Size of the innovation of an outlier, and over the median of the CROWD largest: where a model is wrong, many are
large."""

CROWD = 20

COLOURED = 0.3
"""Power of the motor speed in the last quarter of its band over that in the second, from which on it counts as white;
0.5 and more as sampled, 0.25 and less interpolated or held."""

MOVED = 60.0
"""Frequency in Hz below which the drive train itself moves: with samples 4 ms apart the second quarter begins at 31 Hz
and has 8 to 20 times the power of the noise."""

EXPLAINS = 0.8
"""Share that a tyre must explain of what the spectra of load torque and wheel speed tell."""

FLANK = 0.02
"""Share of the time that the teeth must spend on either flank."""

CLOSE = 0.05
"""Relative standard deviation from which on a parameter counts as undetermined."""


def diagnose_delays(p: Parameters, deviations: Mapping[str, float], explained: bool) -> list[str]:
    """What channel is recorded late or early.

    Args:
        explained: whether the model explains the recording; else what it lacks may look like a delay.
    """
    others = {"late_1": "both torques", "late_T": "the motor speed", "late_L": "the motor speed"}
    texts = []
    for name, channel in CHANNELS.items():
        late, deviation = getattr(p, name), deviations.get(name, 0.0)
        if abs(late) <= max(SKEWED, SURELY * deviation):
            continue
        word, side = ("late", "after") if late > 0.0 else ("early", "before")
        within = " ms or more" if abs(late) >= MOST else f" +- {1e3 * Z_95 * deviation:.2f} ms"
        texts.append(
            f"the {channel} looks {word}: it is recorded {1e3 * abs(late):.2f}{within} {side} {others[name]}"
            f"{'' if explained else ', or what the two masses lack looks so'}, "
            "which is allowed for here; other commands take the channels as recorded"
        )
    return texts


def diagnose_motor_gain(p: Parameters, deviations: Mapping[str, float]) -> list[str]:
    """What a gain of the motor torque that is surely not 1 may mean."""
    if abs(p.g_T - 1.0) <= SURELY * deviations.get("g_T", 0.0):
        return []
    return [
        f"the recorded motor torque looks {p.g_T:.4g} times the true one, or J_1 = {p.J_1:g} kg.m2 should be "
        f"{p.J_1 * p.g_T:.4g} (--free J_1); in the latter case J_2, C and d are {p.g_T:.4g} times as large too"
    ]


def diagnose_load_gain(p: Parameters, deviations: Mapping[str, float]) -> list[str]:
    """What a gain of the load torque that is not about 1 may mean."""
    if abs(p.g_L - 1.0) <= max(LOAD_GAIN, SURELY * deviations.get("g_L", 0.0)):
        return []
    return [
        f"the recorded load torque looks {p.g_L:.3g} times the true one: its unit, its gain or the gear ratio is wrong"
    ]


def diagnose_innovations(correlation: float) -> list[str]:
    """Whether the intervals hold, by the largest autocorrelation of the innovations."""
    if abs(correlation) <= WHITE:
        return []
    return [
        f"the innovations are not white (correlation {correlation:.2f}): the intervals are too narrow; the recording "
        "may be sampled too slowly, filtered or interpolated"
    ]


def diagnose_offsets(through: Filtered, p: Parameters) -> list[str]:
    """What zeros of the recorded torques are off, as the filter has found at the end."""
    motor, load = -through.states[-1, 3:5] * (p.g_T, p.g_L)
    return [
        f"the recorded {which} torque looks {abs(offset):.3g} N.m too {'large' if offset > 0.0 else 'small'}: "
        "its zero, or that of the other torque, is off"
        for which, offset in (("motor", motor), ("load", load))
        if abs(offset) > ZERO
    ]


def diagnose_outliers(through: Filtered, T_s: float) -> list[str]:
    """Samples of the motor speed that are off alone."""
    size = np.abs(through.size[through.counted])
    largest = np.sort(size)[-CROWD:]
    at = np.flatnonzero(size > max(OUTLIER, LONELY * float(np.median(largest)))) + through.counted.start
    if not len(at):
        return []
    k = int(at[np.argmax(np.abs(through.size[at]))])
    others = f" and {len(at) - 1} more" if len(at) > 1 else ""
    return [
        f"the motor speed {(k + 1) * T_s:.4g} s after the start is {through.errors[k]:+.3g} rad/s off{others}: "
        "an outlier, which moves what is found; correct it"
    ]


def is_coloured(omega_1: np.ndarray, T_s: float) -> bool:
    """Whether the motor speed has less noise at high frequencies than a sensor has, as what was interpolated.

    Args:
        T_s: its sample time in s.
    """
    f, power = welch(np.diff(omega_1), nperseg=min(1024, len(omega_1) - 1))
    f, power = f[1:-1], power[1:-1] / np.sin(np.pi * f[1:-1]) ** 2  # of the speed, not of its differences
    lower = min(max(0.125, MOVED * T_s), 0.25)
    last, before = (float(np.median(power[(f > low) & (f < low + 0.125)])) for low in (0.375, lower))
    return last < COLOURED * before


def diagnose_spectrum(omega_1: np.ndarray, T_s: float) -> list[str]:
    """Whether the motor speed has the white noise that a sensor has."""
    if not is_coloured(omega_1, T_s):
        return []
    return [
        "the motor speed has no white noise (it looks interpolated, filtered or calculated): "
        "the intervals do not hold, and J_2, C and phi_B may be wrong; give it as it was sampled"
    ]


def diagnose_excitation(
    phi: np.ndarray, p: Parameters, deviations: Mapping[str, float], free: Sequence[str]
) -> list[str]:
    """What the excitation does not determine.

    Args:
        phi: twist in rad as the filter sees it, shape (n,).
    """
    warnings = []
    driving, braking = (float(np.mean(side * phi > p.phi_B)) for side in (1.0, -1.0))
    if min(driving, braking) < FLANK:
        side = "never drive" if driving < FLANK else "never brake"
        warnings.append(
            f"phi_B is not determined: the teeth {side}, so that the gap is not crossed; excite about zero torque"
        )
    if "J_1" in free and "g_T" in free:
        warnings.append(
            "J_1 and the gain of the motor torque are both free, and nothing sets their scale: free one of them"
        )
    if deviations.get("g_L", 0.0) > UNKNOWN_GAIN * p.g_L:
        warnings.append(
            "the load torque tells nothing (its gain is not determined), so that J_2 is not that of the wheels: "
            "leave its channel away"
        )
    crossed = ("phi_B",) if min(driving, braking) >= FLANK else ()
    over = {name: Z_95 * deviations.get(name, 0.0) / _size(name, p) for name in ("J_2", "C", *crossed, "d")}
    unknown = [name for name, share in over.items() if share > 1.0]
    wide = [name for name, share in over.items() if Z_95 * CLOSE < share <= 1.0 and name != "d"]
    if unknown:
        warnings.append(f"{', '.join(unknown)}: not determined; excite more or longer")
    if wide:
        warnings.append(
            f"{', '.join(wide)}: 95 % interval wider than +- {100.0 * Z_95 * CLOSE:.2g} %; excite more or longer"
        )
    return warnings


def is_determined(p: Parameters, covariance: np.ndarray, free: Sequence[str]) -> bool:
    """Whether J_2 and C would be known if damping and delays were. Else no cause can be told: what the recording lacks
    may look like any.

    Args:
        covariance: of the free parameters, in their order.
    """
    deviations = deviations_if_known(covariance, free, ("d", *DELAYS))
    return all(deviations.get(name, 0.0) <= CLOSE * _size(name, p) for name in ("J_2", "C"))


def _size(name: str, p: Parameters) -> float:
    """What the interval of a parameter is compared with: its value, of damping at least a damping ratio of 0.1."""
    return max(abs(p.d), damping(p)) if name == "d" else abs(getattr(p, name))


def diagnose_damping(p: Parameters, deviations: Mapping[str, float]) -> list[str]:
    """Whether damping is surely negative."""
    if p.d >= -SURELY * deviations.get("d", 0.0):
        return []
    return [f"d = {p.d:.3g} N.m.s/rad is negative, which no damper is: something else is wrong"]


def diagnose_rival(best: Fitted, other: Fitted) -> list[str]:
    """Whether free runs fit about as well with quite other parameters."""
    if not rivals(best, other):
        return []
    return [
        f"free runs of 0.5 s fit about as well with J_2 = {other.p.J_2:.3g} and C = {other.p.C:.3g} (to "
        f"{other.error:.2g} instead of {best.error:.2g} rad/s), which the intervals allow for; excite more, about zero "
        "torque"
    ]


def diagnose_tyre(behind: Tyre) -> list[str]:
    """Whether the load torque is that of a tyre."""
    if behind.explained >= EXPLAINS and min(behind.c_t, behind.d_t) > 0.0:
        return []
    why = (
        f"{100.0 * behind.explained:.0f} % explained"
        if behind.explained < EXPLAINS
        else "spring or damper would be negative"
    )
    return [
        f"the load torque is not that of a tyre with a vehicle behind it ({why}): "
        "how the car answers on its own, and C in the vehicle file, are those of the drive train alone"
    ]


def diagnose_demand(loop: FittedLoop, T_s: float, tau: float) -> list[str]:
    """What the torque demand tells against the recording or the vehicle file, where tau is the lag in s."""
    if not loop.answers:
        return [
            f"the torque demand explains {100.0 * loop.explained:.0f} % of the motor torque only, so that it is not "
            "that of motor control: the recorded motor torque is used, and tau is not identified"
        ]
    warnings = []
    if abs(loop.loop.delay) > DEMAND_LATE * T_s:
        early = loop.loop.delay > 0.0
        when, why = ("after", "") if early else ("before", ", or the two exchanged")
        warnings.append(
            f"the motor torque comes {1e3 * abs(loop.loop.delay):.2f} ms {when} its demand, "
            f"beside the lag of motor control: one of the two channels looks shifted{why}"
        )
    if abs(loop.loop.tau / tau - 1.0) > LAG_OFF:
        warnings.append(f"tau = {tau:g} s of the vehicle file looks wrong: motor control has {loop.loop.tau:.4g} s")
    return warnings
