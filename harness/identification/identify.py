"""From a recording of a test drive to the parameters of the drive train: prediction error where the model explains
the recording, output error where it does not."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import shift

from ..recordings.measurement import Measurement
from ..recordings.source import RecordingError
from .diagnostics import (
    LIKELY,
    diagnose_damping,
    diagnose_delays,
    diagnose_demand,
    diagnose_excitation,
    diagnose_innovations,
    diagnose_load_gain,
    diagnose_motor_gain,
    diagnose_offsets,
    diagnose_outliers,
    diagnose_rival,
    diagnose_spectrum,
    diagnose_tyre,
    is_coloured,
    is_determined,
)
from .drive_train import DELAYS, Parameters, damping
from .drive_train_response import Tyre, resonance, tyre
from .global_start import best_start
from .late_load import covariance_with_late_load, diagnose_late_load, price
from .maximum_likelihood import Found, maximise
from .model_inputs import Drive, model_inputs
from .noise import white_noise
from .output_error import Fitted, covariance_with_rival
from .prediction import BURN_IN, Noise, Predictor, filtered
from .quality import SIMULATED, Quality, judged, near_starts, segments
from .torque_loop import FittedLoop

DAMPED = ("J_2", "C", "phi_B", "d")
"""What is searched without the load torque."""

NEUTRAL = {"d": 0.0, "g_T": 1.0, **dict.fromkeys(DELAYS, 0.0)}
"""Parameters that may not be significant, and their values if they are not."""

WIDE_LOAD_NOISE = 5.0
"""Noise of the load torque in N.m with which the search begins: the filter then follows the motor speed whatever the
parameters are, and the cost has one valley."""

WIDEST_LOAD_NOISE = 20.0
"""The same where the model does not explain the recording."""

FEW, FEWER = 12, 6
"""Passes from a start that is near, and from one that is next to it."""

UNSURE = 3e-4
"""Shift in s up to which it may be what the model lacks where it does not explain all; 1.3e-4 of the validation
vehicle."""

MANY = 60
"""Passes along a bent valley: with a load torque 4 ms late some 50."""

SURELY = 4.0
"""Standard deviations by which the gain of the motor torque must be off where the model does not explain all."""

EXPLAINED = 1.25
"""Size of the innovations up to which the model explains the recording."""

MODEL_NOISE = Noise(omega_1=1.0, T_mot=0.0, T_load=3.0, acts=True)
"""Without the load torque: what model and resistance are off by. Narrower, the parameters are those of the next few
milliseconds."""

WITHIN, UNMEASURED = 1.0, 10.0
"""Standard deviation in N.m of the offset of a load torque that was measured, and of one that was not."""

HELD_OUT = 0.25
"""Share of the recording, its end, on which the fit is judged; for this the parameters are found without it."""

WITH_LOAD, WITHOUT_LOAD = "with load torque", "effective, without load torque"

Log = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Estimate:
    """Parameters that were found, in SI units.

    Attributes:
        method: "prediction error" or "output error".
        p: the parameters.
        covariance: of the free ones, in their order.
        free: their names.
        noise: of the recording, or what the model lacks.
        warnings: what may be wrong, a sentence each.
    """

    method: str
    p: Parameters
    covariance: np.ndarray
    free: tuple[str, ...]
    noise: Noise
    warnings: tuple[str, ...]

    @property
    def deviations(self) -> dict[str, float]:
        """Standard deviation of each free parameter, in its unit."""
        return dict(zip(self.free, map(float, np.sqrt(np.diag(self.covariance))), strict=True))


@dataclass(frozen=True, eq=False)
class Identified(Estimate):
    """What a recording tells of a drive train: parameters `p` in SI units, their `covariance` and `warnings`.

    Attributes:
        name: WITH_LOAD: J_2 is that of the wheels; WITHOUT_LOAD: J_2 carries the vehicle.
        loop: motor control, if its demand was recorded.
        tyre: what hangs on the wheels; None if J_2 carries it.
        quality: on the last quarter of the recording, with parameters found on the rest.
        drive: the recording.
    """

    name: str
    loop: FittedLoop | None
    tyre: Tyre | None
    quality: Quality
    drive: Drive

    @property
    def resonance(self) -> float:
        """Frequency in Hz at which the car answers most on its own."""
        return resonance(self.p, self.tyre)


def identify(
    recording: Measurement,
    start: Parameters,
    tau: float,
    J_v: float,
    more: Sequence[str] = (),
    log: Log = lambda _: None,
) -> Identified:
    """
    Args:
        start: with which the search begins; what is not free remains.
        tau: lag of motor control in s that the car should have.
        J_v: inertia of the vehicle in kg.m2, motor side.
        more: names of parameters that are to be free as well.
        log: gets a line for each step.

    Raises:
        RecordingError: it is too short; see `harness.identification.model_inputs.model_inputs`.
    """
    drive, demand = model_inputs(recording)
    loop = demand if demand and demand.answers else None
    _require_long(recording.name, drive, (BURN_IN + SIMULATED) / HELD_OUT, "to judge the fit by the last quarter")
    measured = recording.T_load is not None
    noise = of_sensors(recording, loop) if measured else MODEL_NOISE
    estimate = fit(drive, start, noise, measured, more, log)
    log("judging it by data that were not used")
    cut = round((1.0 - HELD_OUT) * len(drive))
    held_out = refit(drive.between(0, cut), estimate, measured)
    drift = WITHIN if measured else UNMEASURED
    filter_run = filtered(drive, estimate.p, estimate.noise)
    determined = is_determined(estimate.p, estimate.covariance, estimate.free)
    tyre_found, tyre_warnings = None, []
    if recording.T_load is not None and determined:
        load = shift(recording.T_load, -estimate.p.late_L / drive.T_s, mode="nearest")[1:] / estimate.p.g_L
        T_mot = drive.acting(estimate.p).T_mot.mean(axis=1)
        tyre_found = tyre(load, filter_run.states[:, 1], T_mot, drive.T_s, J_v)
        tyre_warnings = diagnose_tyre(tyre_found)
        tyre_found = None if tyre_warnings else tyre_found
    quality = judged(drive, held_out, estimate.noise, drift, cut)
    explained = measured and estimate.method == "prediction error"
    causes = (
        *(diagnose_offsets(filter_run, estimate.p) if measured else ()),
        *diagnose_delays(estimate.p, estimate.deviations, explained),
        *diagnose_motor_gain(estimate.p, estimate.deviations),
        *diagnose_load_gain(estimate.p, estimate.deviations),
        *diagnose_damping(estimate.p, estimate.deviations),
        *(diagnose_innovations(quality.correlation) if explained else ()),
        *tyre_warnings,
    )
    warnings = (
        *recording.warnings,
        *(diagnose_demand(demand, drive.T_s, tau) if demand else ()),
        *diagnose_spectrum(recording.omega_1, drive.T_s),
        *diagnose_outliers(filter_run, drive.T_s),
        *(causes if determined else ()),
        *estimate.warnings,
        *diagnose_excitation(filter_run.states[:, 2], estimate.p, estimate.deviations, estimate.free),
    )
    return Identified(
        **{**vars(estimate), "warnings": warnings},
        name=WITH_LOAD if measured else WITHOUT_LOAD,
        loop=loop,
        tyre=tyre_found,
        quality=quality,
        drive=drive,
    )


def _require_long(name: str, drive: Drive, least: float, reason: str) -> None:
    """Refuses less than so many seconds."""
    if (duration := len(drive) * drive.T_s) < least - 0.5 * drive.T_s:
        raise RecordingError(f"{name} is {duration:.3g} s long; {least:.3g} s or more are needed {reason}")


def of_sensors(recording: Measurement, loop: FittedLoop | None) -> Noise:
    """The noise that the recording shows; none of the motor torque if that is the answer of motor control."""
    T_mot = 0.0 if loop else white_noise(recording.T_mot)
    T_load = 0.0 if recording.T_load is None else white_noise(recording.T_load)
    coloured = is_coloured(recording.omega_1, float(np.median(np.diff(recording.time))))
    return Noise(white_noise(recording.omega_1, coloured), T_mot, T_load)


def fit(drive: Drive, start: Parameters, noise: Noise, measured: bool, more: Sequence[str], log: Log) -> Estimate:
    if not measured:
        free = _names(*DAMPED, *more)
        initial = best_start(Predictor(free), drive, start._replace(d=damping(start), J_2=10.0 * start.J_1), noise)
        found = maximise(Predictor(free), drive, initial, noise)
        _log_stage(log, "predicted without load torque", found.p)
        return Estimate("prediction error", found.p, sandwich_covariance(found), free, noise, ())
    initial = coarse_fit(drive, start, noise, more)
    _log_stage(log, "predicted by a wide filter", initial)
    best = prediction_error_fit(drive, initial, noise, more, log)
    if best.innovations.rms <= EXPLAINED:
        covariance = covariance_with_late_load(drive, best, noise)
        doubt = diagnose_late_load(best, float(np.sqrt(covariance[best.free.index("J_2"), best.free.index("J_2")])))
        return Estimate("prediction error", best.p, covariance, best.free, noise, tuple(doubt))
    log("the model does not explain all of the recording: pieces of 0.5 s are simulated")
    late = _sure_delays(best.p)
    free = (*more, *late)
    fitted = output_error_fit(drive, coarse_fit(drive, start._replace(**late), noise, more), noise, free)
    predicted = best.p._replace(**dict.fromkeys(DELAYS, 0.0))._replace(**late)
    if free_run_error(drive, predicted, noise) < fitted.error:
        fitted = output_error_fit(drive, predicted, noise, free, near=True)
    rival = output_error_fit(drive, start._replace(**late), noise, free, near=True)
    fitted, rival = sorted((fitted, rival), key=lambda each: each.error)
    _log_stage(log, "simulated", fitted.p)
    warnings = (
        *diagnose_rival(fitted, rival),
        "the two masses do not explain all of this car (with the noise of the sensors alone the innovations have the "
        f"size {best.innovations.rms:.2f}): "
        f"parameters are those with which free runs of 0.5 s fit best, to {fitted.error:.2g} rad/s",
    )
    of_model = Noise(fitted.error, noise.T_mot, noise.T_load)
    return Estimate("output error", fitted.p, covariance_with_rival(fitted, rival), fitted.free, of_model, warnings)


def coarse_fit(drive: Drive, start: Parameters, noise: Noise, more: Sequence[str] = ()) -> Parameters:
    """A coarse fit from anywhere, by a filter that follows the motor speed whatever the parameters are."""
    broad, free = Noise(noise.omega_1, noise.T_mot, WIDE_LOAD_NOISE, acts=True), _searched(more)
    initial = best_start(Predictor(free), drive, start._replace(d=damping(start)), broad)
    return maximise(Predictor((*free, "g_L")), drive, initial, broad, most=FEWER).p


def prediction_error_fit(
    drive: Drive, initial: Parameters, noise: Noise, more: Sequence[str] = (), log: Log = lambda _: None
) -> Found:
    """The fit by prediction error: of the channels that may be late those with which the recording is likeliest, each
    parameter being worth what it costs, and none that is not significant."""
    ends = [
        backward_elimination(drive, found, noise, more, log)
        for found in fits_with_delays(drive, initial, noise, more, log)
    ]
    likeliest = min(ends, key=lambda end: end.innovations.cost)
    return max(ends, key=lambda end: likeliest.gain(end) - sum(worth(name, end) for name in end.free))


def worth(name: str, found: Found) -> float:
    """Twice the gain in likelihood with which a parameter is free."""
    return price(found.deviations[name], found.free) if name == "late_L" else LIKELY


def fits_with_delays(
    drive: Drive, initial: Parameters, noise: Noise, more: Sequence[str], log: Log
) -> tuple[Found, Found, Found]:
    """With the motor torque late, the motor speed, and each torque for itself; the second begins where the first ends,
    the third where the better of both does."""

    def fit(begin: Parameters, *late: str) -> Found:
        found = maximise(Predictor((*_searched(more), "g_L", *late)), drive, begin, noise, most=MANY)
        _log_stage(log, f"predicted with {', '.join(late)} free", found.p)
        return found

    torque = fit(initial, "late_T")
    speed = fit(torque.p._replace(late_T=0.0, late_1=-torque.p.late_T), "late_1")
    better = torque if speed.gain(torque) > 0.0 else speed
    late_T, late_L = better.p.shifts
    return torque, speed, fit(better.p._replace(late_1=0.0, late_T=late_T, late_L=late_L), "late_T", "late_L")


def backward_elimination(drive: Drive, found: Found, noise: Noise, more: Sequence[str], log: Log) -> Found:
    """Backward elimination: without shifts, structural damping and gain of the motor torque, unless they are
    significant.

    Args:
        found: with all of them.
        more: what is to be free in any case.
    """
    best = found
    while optional := [name for name in NEUTRAL if name in best.free and name not in more]:
        deviations = best.deviations
        surplus = {
            name: ((getattr(best.p, name) - NEUTRAL[name]) / deviations[name]) ** 2 - worth(name, best)
            for name in optional
        }
        least = min(optional, key=lambda name: surplus[name])
        if surplus[least] > 0.0:
            break
        free = tuple(name for name in best.free if name != least)
        best = maximise(Predictor(free), drive, best.p._replace(**{least: NEUTRAL[least]}), noise, most=FEWER)
        _log_stage(log, f"without {least}, which is not significant", best.p)
    return best


def output_error_fit(
    drive: Drive, initial: Parameters, noise: Noise, more: Sequence[str] = (), near: bool = False
) -> Fitted:
    """The fit by output error; with the gain of the motor torque if that is surely not 1.

    Args:
        near: whether the search begins with `initial` itself, and not with what a wide filter makes of it.
    """
    free = (*_searched(more), "g_L")
    known = free if "g_T" in more else tuple(name for name in free if name != "g_T")
    least = BURN_IN + SIMULATED * (len(free) + 2)
    _require_long("the recording", drive, least, f"for {len(free)} parameters of a car that two masses do not explain")
    wider = Noise(noise.omega_1, noise.T_mot, WIDEST_LOAD_NOISE, acts=True)
    begin = initial._replace(d=damping(initial), g_T=1.0)
    p = begin if near else maximise(Predictor(known), drive, begin, wider, most=FEW).p
    pieces = segments(drive, known, WITHIN)
    fitted = pieces.fit(p._replace(d=damping(p)), near_starts(pieces, filtered(drive, p, wider)))
    if free == known:
        return fitted
    scaled = segments(drive, free, WITHIN).fit(fitted.p, fitted.starts, most=FEW)
    return scaled if abs(scaled.p.g_T - 1.0) > SURELY * scaled.deviation("g_T") else fitted


def free_run_error(drive: Drive, p: Parameters, noise: Noise) -> float:
    """What the motor speed of free runs is off by in rad/s (rms)."""
    pieces = segments(drive, (), WITHIN)
    runs, recorded = pieces.free_runs(p, near_starts(pieces, filtered(drive, p, noise)))
    return float(np.sqrt(np.mean((runs[..., 0] - recorded) ** 2)))


def refit(drive: Drive, estimate: Estimate, measured: bool) -> Parameters:
    """The fit to another part of the recording."""
    if estimate.method == "prediction error":
        return maximise(Predictor(estimate.free), drive, estimate.p, estimate.noise).p
    pieces = segments(drive, estimate.free, WITHIN)
    return pieces.fit(estimate.p, near_starts(pieces, filtered(drive, estimate.p, estimate.noise)), most=6).p


def sandwich_covariance(found: Found, block: int = 250) -> np.ndarray:
    """Sandwich covariance of the free parameters, from blocks of innovations that are not white."""
    seen = found.innovations
    inverse = found.inverse_information
    each = seen.scores
    scores = np.array([part.sum(axis=0) for part in np.array_split(each, max(len(each) // block, 2))])
    scores = scores - scores.mean(axis=0)
    return inverse @ (scores.T @ scores) @ inverse


def _searched(more: Sequence[str]) -> tuple[str, ...]:
    """What a search begins with; of J_1 and the gain of the motor torque one sets the scale."""
    return _names(*DAMPED, *(() if "J_1" in more else ("g_T",)), *more)


def _names(*names: str) -> tuple[str, ...]:
    """Each once."""
    return tuple(dict.fromkeys(names))


def _sure_delays(p: Parameters) -> dict[str, float]:
    """Delays in s that are more than what the model may lack; of both torques alike it is that of the motor speed."""
    late_T, late_L = p.shifts
    if min(abs(late_T), abs(late_L)) > UNSURE >= abs(late_T - late_L):
        return {"late_1": -0.5 * (late_T + late_L)}
    return {name: late for name, late in (("late_T", late_T), ("late_L", late_L)) if abs(late) > UNSURE}


def _log_stage(log: Log, stage: str, p: Parameters) -> None:
    log(f"{stage}: J_2 = {p.J_2:.4g}, C = {p.C:.4g}, phi_B = {p.phi_B:.4g}, d = {p.d:.2g}")
