"""From a recording of a test drive to the parameters of the drive train: prediction error, all skews free together."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from driverecords.measurement import Measurement
from driverecords.source import RecordingError
from driverecords.thresholds import Threshold

from .diagnostics import (
    diagnose_excitation,
    diagnose_model,
    diagnose_offsets,
    diagnose_outliers,
    diagnose_parameters,
    diagnose_spectrum,
    diagnose_torque_loop,
    is_coloured,
    lacking,
)
from .drive_train import DELAYS, Parameters, Vehicle
from .drive_train_response import Tyre, resonance, rolling_tyre
from .estimator import Found, search
from .free_runs import SIMULATED, free_runs
from .global_start import best_start
from .model_inputs import Drive, drive_of
from .noise import white_noise
from .prediction import BURN_IN, Noise, Predictor
from .step import Step
from .torque_loop import FittedLoop
from .wheel_speed import LateWheelSpeed, late_wheel_speed

COARSE = ("J_2", "C", "phi_B", "d", "c_t", "sigma_t", "lack_1", "lack_L")
"""What is searched from anywhere."""

FREE = (*COARSE, "g_T", "g_L", *DELAYS, "lack_phi")
"""What is identified with the load torque."""

ALONE = ("J_2", "C", "phi_B", "d", "late_T", "lack_1", "lack_phi", "lack_L")
"""And without: nothing sets the scale of the torque then."""

WIDE = {"lack_1": 1.0, "lack_phi": 1e-3, "lack_L": 10.0}
"""With these the filter follows what is recorded whatever the parameters are, and the cost has few valleys."""

NARROW = {"lack_1": 0.02, "lack_phi": 1e-4, "lack_L": 0.2}
"""With these it follows the model, and leaves a valley in which the lacks explain all."""

ROUNDS, BETTER = 4, 1.0
"""Searches at most, each from the end of the one before, and gain in likelihood for another one: a deviation is .5.
Where all lacks have come to half of NARROW there is no valley to leave."""

UNCONFIRMED = Threshold(
    0.1, "1", "share by which phi_B of more than two masses may be off", "9.5 % is the most of four detailed cars"
)
UNCONFIRMED_ALONE = Threshold(0.3, "1", f"{UNCONFIRMED.of}, without load torque", "28 % is the most of those cars")

HELD_OUT = 0.25
"""Share of the recording, its end, on which the fit is judged; for this the parameters are found without it."""

WITH_LOAD, WITHOUT_LOAD = "with load torque", "effective, without load torque"

Log = Callable[[str], None]


@dataclass(frozen=True)
class Quality:
    """How well the last quarter is met with parameters found on the rest.

    Attributes:
        omega_1, T_load: of free runs of SIMULATED, driven by the motor torque alone: 100 (1 - rms error/standard
            deviation of the signal) in %, the NRMSE of the field; NaN without load torque.
        size_1, size_L: rms of the innovations, 1 where model and noise are right.
    """

    omega_1: float
    T_load: float
    size_1: float
    size_L: float


@dataclass(frozen=True, eq=False)
class Identified:
    """What a recording tells of a drive train.

    Attributes:
        name: WITH_LOAD: J_2 is that of the wheels; WITHOUT_LOAD: J_2 carries the vehicle.
        found: the parameters in SI units, their covariance, and what told them.
        predictor: the filter on the recording.
        loop: motor control, if its demand was recorded.
        late_wheel_speed: by how much the wheel speed is late, if the recording tells.
        quality: on the last quarter of the recording.
        warnings: what may be wrong, a sentence each.
        plant_fit: C and phi_B as a plant tells them that was driven by the recorded torque, where the model does not
            explain the car.
    """

    name: str
    found: Found
    predictor: Predictor
    loop: FittedLoop | None
    late_wheel_speed: LateWheelSpeed | None
    quality: Quality
    warnings: tuple[str, ...]
    plant_fit: Step | None = None

    @property
    def explained(self) -> bool:
        """Whether the parameters are those of the car, and not of what predicts best."""
        return self.name == WITH_LOAD and not lacking(self.found)

    @property
    def unconfirmed(self) -> float:
        """Share by which phi_B of the filter may be off where the model does not explain the car."""
        return UNCONFIRMED if self.name == WITH_LOAD else UNCONFIRMED_ALONE

    @property
    def p(self) -> Parameters:
        return self.found.p

    @property
    def drive(self) -> Drive:
        """The recording."""
        return self.predictor.drive

    @property
    def speed(self) -> float:
        """Mean motor speed of the recording in rad/s."""
        return float(np.abs(self.drive.omega_1).mean())

    def tyre_of(self, p: Parameters) -> Tyre | None:
        """What hangs on the wheels at that speed; None if J_2 carries it."""
        return rolling_tyre(p, self.predictor.behind, self.speed) if self.predictor.measured else None

    @property
    def resonance(self) -> float:
        """Frequency in Hz at which the car answers most on its own."""
        return resonance(self.p, self.tyre_of(self.p))


def identify(
    recording: Measurement,
    start: Parameters,
    behind: Vehicle,
    tau: float,
    more: Sequence[str] = (),
    log: Log = lambda _: None,
) -> Identified:
    """
    Args:
        start: with which the search begins; what is not free remains.
        behind: what is known of the vehicle.
        tau: lag of motor control in s that the car should have.
        more: names of parameters that are to be free as well.
        log: gets a line for each step.

    Raises:
        RecordingError: it is too short, or its samples are not evenly spaced.
    """
    drive, loop = drive_of(recording)
    least = (BURN_IN + SIMULATED) / HELD_OUT
    if (duration := len(drive) * drive.T_s) < least - 0.5 * drive.T_s:
        raise RecordingError(
            f"{recording.name} is {duration:.3g} s long; {least:.3g} s or more are needed to judge the fit by the last "
            "quarter"
        )
    predictor = Predictor(drive, of_sensors(drive, recording.T_mot), behind)
    estimate = fit(predictor, start, more, log)
    measured = drive.T_load is not None
    log("judging it by data that were not used")
    quality = judged(predictor, estimate)
    at = drive.longest
    valid, omega_2 = recording.valid, estimate.predicted.states[at.start : at.stop - 1, 1]
    wheel_speed = late_wheel_speed(recording.omega_2[at], None if valid is None else valid[at], omega_2, drive.T_s)
    warnings = (
        *recording.warnings,
        *(diagnose_torque_loop(loop, drive.T_s, tau) if loop else ()),
        *diagnose_spectrum(drive.omega_1[at], drive.T_s),
        *diagnose_outliers(estimate.predicted, drive.T_s),
        *(diagnose_offsets(estimate.predicted, estimate.p) if measured else ()),
        *diagnose_parameters(estimate),
        *(diagnose_model(estimate, quality.T_load) if measured else ()),
        *diagnose_excitation(estimate),
    )
    name = WITH_LOAD if measured else WITHOUT_LOAD
    answers = loop if loop and loop.answers else None
    return Identified(name, estimate, predictor, answers, wheel_speed, quality, warnings)


def of_sensors(drive: Drive, T_mot: np.ndarray) -> Noise:
    """The noise that a recording shows.

    Args:
        T_mot: as recorded.
    """
    T_load = 0.0 if drive.T_load is None else white_noise(drive.T_load)
    coloured = is_coloured(drive.omega_1[drive.longest], drive.T_s)
    return Noise(white_noise(drive.omega_1, coloured), white_noise(T_mot), T_load)


def fit(predictor: Predictor, start: Parameters, more: Sequence[str] = (), log: Log = lambda _: None) -> Found:
    """The most likely parameters, from anywhere."""
    if predictor.measured:
        coarse, free = COARSE, FREE
    else:
        coarse, free = tuple(name for name in COARSE if name in ALONE), ALONE
    # of J_1 and the gain of the motor torque one sets the scale
    free = tuple(dict.fromkeys([*(name for name in free if name != "g_T" or "J_1" not in more), *more]))
    start = start._replace(d=start.damping)
    begin = start if predictor.measured else start._replace(c_t=0.0, J_2=10.0 * start.J_1)
    p = best_start(predictor, begin._replace(**WIDE), coarse)
    log(f"a wide filter finds {_shown(p)}")
    best = search(predictor, p, free, start)
    for _ in range(ROUNDS - 1):
        if all(getattr(best.p, name) <= 0.5 * lack for name, lack in NARROW.items() if name in free):
            break
        again = search(predictor, best.p._replace(**NARROW), free, start)
        gain = best.predicted.cost - again.predicted.cost
        best = again if gain > 0.0 else best
        if gain < BETTER:
            break
    log(f"predicted best with {_shown(best.p)}")
    return best


def judged(predictor: Predictor, estimate: Found) -> Quality:
    """The fit without the last quarter, on it."""
    cut = round((1.0 - HELD_OUT) * len(predictor.drive))
    p = search(predictor.of(predictor.drive.between(0, cut)), estimate.p, estimate.free, estimate.centre, most=6).p
    predicted = predictor.predicted(p)
    at, runs = free_runs(predictor, p, predicted.states, cut)
    size = predicted.size[:, predicted.counted[predicted.counted >= cut]]
    load = predictor.drive.T_load
    T_load = np.nan if load is None else nrmse(p.g_L * runs[..., 3] - load[at], load[at], centred=True)
    size_1, size_L = np.sqrt(np.mean(size**2, axis=1))
    omega_1 = predictor.drive.omega_1[at]
    return Quality(nrmse(runs[..., 0] - omega_1, omega_1), T_load, float(size_1), float(size_L))


def nrmse(error: np.ndarray, signal: np.ndarray, centred: bool = False) -> float:
    """In %.

    Args:
        centred: whether an offset counts as no error.
    """
    off = error - error.mean() if centred else error
    return 100.0 * (1.0 - float(np.sqrt(np.mean(off**2)) / signal.std()))


def _shown(p: Parameters) -> str:
    return f"J_2 = {p.J_2:.4g}, C = {p.C:.4g}, phi_B = {p.phi_B:.4g}, d = {p.d:.2g}"
