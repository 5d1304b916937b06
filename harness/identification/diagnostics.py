"""Diagnostics: what may be wrong with a recording, or with what is taken as known, in words of the car."""

from collections.abc import Iterator

import numpy as np
from scipy.signal import welch

from driverecords.thresholds import Threshold

from .drive_train import Parameters, State
from .estimator import Z_95, Found
from .model_inputs import LATEST
from .noise import ENOUGH, noise_floor
from .prediction import Predicted
from .priors import OF_CAR, PRIORS
from .torque_loop import FittedLoop

SKEWED = Threshold(
    2.5e-4, "s", "skew that is named", "the load torque of the validation vehicle, not late, seems 2.0e-4 s early"
)
TOGETHER = Threshold(
    2e-4,
    "s",
    "difference of two skews up to which the motor speed has both",
    "either was off by 1.3e-4 s at most in 50 drives of other loops",
)
SURELY = Threshold(3.0, "1", "standard deviations by which what is named is off", "once in 400 times by chance")
DEMAND_LATE = Threshold(
    0.5, "1", "samples by which a torque demand that is named is late or early", "a demand is held for a sample"
)
LAG_OFF = Threshold(
    0.1,
    "1",
    "share of tau by which that of the vehicle file is off",
    "tau half as long again moves J_2 by 9 % where it is not identified",
)
MODEL_GAIN = Threshold(
    0.05,
    "1",
    "gain of the motor torque where the model does not explain the car",
    ".035 of the validation vehicle, whose motor has friction and stands on mounts",
)
LOAD_GAIN = Threshold(0.1, "1", "gain of the load torque", "measurement wheels are right to some per cent")
ZERO = Threshold(5.0, "N.m", "offset of a recorded torque", "offsets of 1.5 (motor) and 4.4 N.m (wheels) do no harm")
OUTLIER, LONELY = (
    Threshold(10.0, "1", "size of the innovation of an outlier", "3.7 is the largest of 5000 samples of white noise"),
    Threshold(3.0, "1", "the same over the median of the 20 largest", "where a model is wrong, many are large"),
)
CROWD = 20
"""These largest."""

COLOURED, UNEVEN, ABOVE = (
    Threshold(
        0.3,
        "1",
        "power of the motor speed in the last quarter of its band over that in the second",
        "0.5 and more as sampled with a noise of 0.15 rad/s, 0.25 and less interpolated or held",
    ),
    Threshold(
        0.3,
        "1",
        "noise of the motor speed between hits of the gear, at the frequency with least over that with most",
        "0.31 and more of 360 drives with a noise of 0.01 to 0.15 rad/s (of other 540, 4 are below 0.3), 0.24 and less "
        "interpolated half-way",
    ),
    Threshold(
        2.0,
        "1",
        "power of the motor speed in the second quarter of its band over that of its noise, above which it is of hits",
        "2.1 and more where a good sensor looks interpolated, 2.4 and less filtered with 0.15 rad/s of noise",
    ),
)
MOVED = Threshold(
    60.0,
    "Hz",
    "frequency below which the drive train itself moves",
    "with samples 4 ms apart the power at 31 Hz is 8 to 20 times that of the noise",
)
FLANK = Threshold(0.02, "1", "share of the time that the teeth spend on either flank", "0.2 s of a test drive of 10 s")
CLOSE = Threshold(
    0.1,
    "1",
    "95 % interval over the value of what is hardly known",
    "with C from 90 to 150 for 117 N.m/rad the vehicle is damped 9 % better or worse",
)
LACKING = Threshold(
    0.6,
    "1",
    "what an equation lacks in a sample, over the noise of its sensor",
    "0.4 at most in a loop that holds its torques; 1.4 and 2.7 of the validation vehicle (motor speed, load torque)",
)
OF_TYRE = Threshold(
    30.0, "1", "fit in % of the load torque over free runs", "92 of the design model, 60 of the validation vehicle"
)


def diagnose_parameters(estimate: Found) -> Iterator[str]:
    """What skews and gains surely are, and what else they may mean."""
    p, off = estimate.p, estimate.deviations
    if any(Z_95 * off.get(name, 0.0) > CLOSE * getattr(p, name) for name in ("J_2", "C")):
        return  # what a weak excitation lacks may look like any cause
    yield from _skews(p, off)
    unsure = MODEL_GAIN if lacking(estimate) else 0.0
    if abs(p.g_T - 1.0) > max(unsure, SURELY * off.get("g_T", np.inf)):
        yield (
            f"the recorded motor torque looks {p.g_T:.4g} times the true one, or J_1 = {p.J_1:g} kg.m2 should be "
            f"{p.J_1 * p.g_T:.4g} (--free J_1); in the latter case J_2, C and d are {p.g_T:.4g} times as large too"
        )
    if abs(p.g_L - 1.0) > max(LOAD_GAIN, SURELY * off.get("g_L", np.inf)):
        yield (
            f"the recorded load torque looks {p.g_L:.3g} times the true one: its unit, its gain or the gear "
            "ratio is wrong"
        )


def _skews(p: Parameters, off: dict[str, float]) -> Iterator[str]:
    named = {
        name: late
        for name, late in (("late_T", p.late_T), ("late_L", p.late_L))
        if abs(late) > max(SKEWED, SURELY * off.get(name, np.inf))
    }
    allowed = "which is allowed for here; other commands take the channels as recorded"
    if len(named) == 2 and abs(p.late_T - p.late_L) <= max(
        TOGETHER, Z_95 * float(np.linalg.norm([off[n] for n in named]))
    ):
        # both torques alike: weighed by how well each is known
        weights = [1.0 / off[name] ** 2 for name in named]
        late = -float(np.average(list(named.values()), weights=weights))
        yield f"motor speed comes {_late(late)} (or both torques {_late(-late)}), {allowed}"
        return
    for name, late in named.items():
        channel = PRIORS[name].meaning.removeprefix("delay of the ")
        yield f"{channel} comes {_late(late)}, against motor speed, {allowed}"


def _late(time: float) -> str:
    least = " or more" if abs(time) >= LATEST else ""
    return f"{1e3 * abs(time):.1f} ms{least} {'late' if time > 0.0 else 'early'}"


def lacking(estimate: Found) -> list[str]:
    """The channels that the model does not explain."""
    p, noise = estimate.p, estimate.noise
    lacks = {"motor speed": p.lack_1 / noise.omega_1, "load torque": p.lack_L / noise.T_load if noise.T_load else 0.0}
    return [channel for channel, share in lacks.items() if share > LACKING]


def diagnose_model(estimate: Found, T_load: float) -> Iterator[str]:
    """Whether the model explains the car.

    Args:
        T_load: fit of the load torque over free runs in %.
    """
    if lacks := lacking(estimate):
        yield (
            f"two masses and a tyre do not explain all of this car: {' and '.join(lacks)} "
            f"{'have' if len(lacks) > 1 else 'has'} more in every sample than the noise of the sensors; the intervals "
            "are wider for that, and J_2 is the one that predicts best, not that of the wheels"
        )
    if T_load < OF_TYRE:
        yield (
            f"the load torque is not that of a tyre with a vehicle behind it ({max(T_load, 0.0):.0f} % explained): how "
            "the car answers on its own, and C in the vehicle file, may be wrong"
        )


def diagnose_offsets(predicted: Predicted, p: Parameters) -> Iterator[str]:
    """What zeros of the recorded torques are off, as the filter has found at the end."""
    at = State._make(range(len(State._fields)))
    last = predicted.states[-1]
    for which, offset in (("motor", -last[at.o_T] * p.g_T), ("load", last[at.o_L])):
        if abs(offset) > ZERO:
            yield (
                f"the recorded {which} torque looks {abs(offset):.3g} N.m too {'large' if offset > 0.0 else 'small'}: "
                "its zero, or that of the other torque, is off"
            )


def diagnose_outliers(predicted: Predicted, T_s: float) -> Iterator[str]:
    """Samples of the motor speed that are off alone."""
    counted, size = predicted.counted, np.abs(predicted.size[0, predicted.counted])
    largest = np.sort(size)[-CROWD:]
    at = counted[size > max(OUTLIER, LONELY * float(np.median(largest)))]
    if len(at):
        k = int(at[np.argmax(np.abs(predicted.size[0, at]))])
        others = f" and {len(at) - 1} more" if len(at) > 1 else ""
        yield (
            f"the motor speed {(k + 1) * T_s:.4g} s after the start is {predicted.errors[0, k]:+.3g} rad/s "
            f"off{others}: an outlier, which moves what is found; correct it"
        )


def is_coloured(omega_1: np.ndarray, T_s: float) -> bool:
    """Whether the motor speed has less noise at high frequencies than a sensor has, as what was interpolated. Beside a
    sensor with little noise the hits of the gear look so too, but what is between them does not. Less than ENOUGH
    samples do not tell.

    Args:
        omega_1: shape (n,).
        T_s: its sample time in s.
    """
    if len(omega_1) < ENOUGH:
        return False
    f, power = welch(np.diff(omega_1), nperseg=min(1024, len(omega_1) - 1))
    # of the speed, not of its differences, and over that of white noise of unit variance
    f, power = f[1:-1], power[1:-1] / (8.0 * np.sin(np.pi * f[1:-1]) ** 2)
    lower = min(max(0.125, MOVED * T_s), 0.25)
    last, before = (float(np.median(power[(f > low) & (f < low + 0.125)])) for low in (0.375, lower))
    if last >= COLOURED * before:
        return False
    floor = noise_floor(omega_1)
    is_noise = before < ABOVE * floor.max()  # then what falls is not what the hits do
    return is_noise or bool(floor.min() < UNEVEN * floor.max())


def diagnose_spectrum(omega_1: np.ndarray, T_s: float) -> Iterator[str]:
    """Whether the motor speed has the white noise that a sensor has."""
    if is_coloured(omega_1, T_s):
        yield (
            "the motor speed has no white noise (it looks interpolated, filtered or calculated): "
            "the intervals do not hold, and J_2, C and phi_B may be wrong; give it as it was sampled"
        )


def diagnose_excitation(estimate: Found) -> Iterator[str]:
    """What the recording does not tell, or hardly."""
    p, phi = estimate.p, estimate.predicted.states[:, State._fields.index("phi")]
    driving, braking = (float(np.mean(side * phi > p.phi_B)) for side in (1.0, -1.0))
    if min(driving, braking) < FLANK:
        side = "never drive" if driving < FLANK else "never brake"
        yield f"the teeth {side}, so that the gap is not crossed and phi_B is not told; excite about zero torque"
    known = [name for name in estimate.free if name in OF_CAR]
    untold = [name for name in known if not estimate.told_by(name)]
    if untold:
        meanings = ", ".join(PRIORS[name].meaning for name in untold)
        yield (
            f"the recording does not tell {meanings} ({', '.join(untold)}): there the "
            "answer is what is known of cars; excite more or longer"
        )
    wide = [
        name
        for name in ("J_2", "C", "phi_B")
        if name not in untold and Z_95 * estimate.deviations.get(name, 0.0) > CLOSE * getattr(p, name)
    ]
    if wide:
        yield f"{', '.join(wide)}: 95 % interval wider than +- {100.0 * CLOSE:g} %; excite more or longer"


def diagnose_torque_loop(loop: FittedLoop, T_s: float, tau: float) -> Iterator[str]:
    """What the torque demand tells against the recording or the vehicle file, where tau is the lag in s."""
    if not loop.answers:
        yield (
            f"the torque demand explains {100.0 * loop.explained:.0f} % of the motor torque only, so that it is not "
            "that of motor control, and tau is not identified"
        )
        return
    if abs(loop.loop.delay) > DEMAND_LATE * T_s:
        early = loop.loop.delay > 0.0
        when, why = ("after", "") if early else ("before", ", or the two exchanged")
        yield (
            f"the motor torque comes {1e3 * abs(loop.loop.delay):.2f} ms {when} its demand, "
            f"beside the lag of motor control: one of the two channels looks shifted{why}"
        )
    if abs(loop.loop.tau / tau - 1.0) > LAG_OFF:
        yield f"tau = {tau:g} s of the vehicle file looks wrong: motor control has {loop.loop.tau:.4g} s"
