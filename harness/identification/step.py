"""C and phi_B from the recording of one tip-in or let-off without control: both plants are driven by the recorded
torque of the motor, and the car is looked for whose motor speed is the recorded one.

    |omega_1 - recorded|^2/noise^2 + sum of (ln(p/known)/spread)^2  is least

What is known of the car only roughly is free too, with a spread: C and phi_B are as sure as all of that lets them be.
The validation vehicle stands for a car, the design model for recordings that were simulated with it; what predicts
better is taken. What it does not explain beyond the noise may be as wrong as the answers of the two differ.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import hypot, log, sqrt
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import least_squares

from driverecords.measurement import Measurement
from driverecords.source import RecordingError
from driverecords.thresholds import Threshold
from driverecords.time_base import interval_of
from fmuloop.errors import SimulationError
from fmuloop.experiment import Experiment
from fmuloop.runs import kept_loaded, run
from fmuloop.system import Port, System

from ...fmus.building.one_car import DAMPERS, DEFAULT_CAR, FOLLOW, of_one_car, with_estimates
from ...fmus.catalogue import EVERY
from ...fmus.errors import ParameterFileError
from ..loop import roles
from ..loop.places import PLANTS
from ..loop.settings import Settings, loop
from .estimator import Z_95
from .noise import white_noise


class Spread(NamedTuple):
    """What is searched: by its logarithm, or as it is.

    Attributes:
        known: standard deviation of what is known before, of the logarithm or in its unit.
    """

    known: float
    logarithm: bool = True


SEARCHED: Mapping[str, Spread] = {
    "C": Spread(1.0),
    "phi_B": Spread(1.5),
    "J_2": Spread(0.5),
    "c_slip": Spread(0.3),
    "damping": Spread(0.7),
    "g_T": Spread(0.02),
    "slope": Spread(0.02, logarithm=False),
    "v_0": Spread(0.005),
}
"""Entries of a vehicle file; a factor on the dampers; gain of the recorded torque; the road in rad; a factor on the
speed at the beginning."""

STIFFNESSES, GAPS = (0.4, 0.6, 0.85, 1.2, 1.7, 2.4), (0.25, 0.7, 2.0)
"""Factors on what is known, from which the search begins."""

BEFORE, AFTER = 0.2, 1.0
"""Time in s from the step that is looked at."""

RISE = 0.2
"""Time in s within which the torque has made its step."""

STEP_OVER_NOISE = Threshold(10.0, "1", "least step of a torque over its noise", "noise moves the step by a tenth then")

STEP_SIZE = 1e-3

ORIGIN = 1.0
"""Of what is searched: finite differences of least_squares are relative to it; about 0 they vanish in rounding."""

CORRELATED = 0.1
"""Time in s of a window beyond which errors of the model no longer go together."""

EXPLAINED = Threshold(
    1.1,
    "1",
    "error over the noise up to which a plant explains a step",
    "the rms of 500 samples of noise scatters by 3 %",
)
UNLIKE = Threshold(
    1.4,
    "1",
    "how wrong what no plant explains makes the answer, over how far both are apart",
    "cars whose mounts, hubs and body are others than those of their file are within, 2 of 40 values off by 3 % more",
)

APART = {"C": (0.08, 0.25), "phi_B": (0.3, 0.45)}
"""How far the answers are apart at the least, of usual cars, and how far at the most that counts."""

LEAST = {"C": 0.01, "phi_B": 0.05}
"""Of the halves, for the noise of the torque, which acts on the car and is not that of the speed."""


class Tip(NamedTuple):
    """A step of the torque as it was recorded.

    Attributes:
        time: in s from the beginning on, STEP_SIZE apart.
        T_mot: in N.m, in the middle of the steps that begin there.
        at: instants of the samples of the motor speed.
        omega_1: in rad/s.
        T_0, omega_0: torque in N.m and motor speed in rad/s at the beginning.
        reversal: whether the torque changes its sign.
    """

    time: np.ndarray
    T_mot: np.ndarray
    at: np.ndarray
    omega_1: np.ndarray
    T_0: float
    omega_0: float
    reversal: bool


@dataclass(frozen=True)
class Step:
    """What a step tells.

    Attributes:
        plant: that predicts the motor speed best.
        values: of C in N.m/rad and, where the torque changes its sign, phi_B in rad.
        halves: of their 95 % intervals, in the logarithm.
        error: rms of what is not predicted of the motor speed, in rad/s.
        noise: of the motor speed before the step, in rad/s: that of its sensor, and ripple.
    """

    plant: str
    values: Mapping[str, float]
    halves: Mapping[str, float]
    error: float
    noise: float


def tip(recording: Measurement) -> Tip:
    """The largest step of a recording.

    Raises:
        RecordingError: there is none that can be used.
    """
    t, T = recording.time, recording.T_mot
    T_s = interval_of(t)
    span = max(round(RISE / T_s), 2)
    k = int(np.abs(T[span:] - T[:-span]).argmax()) + span // 2
    before, after = (
        float(np.median(part)) for part in (T[max(k - 2 * span, 0) : max(k - span, 1)], T[k + span :][:span])
    )
    if k < 2 * span or not abs(after - before) > STEP_OVER_NOISE * white_noise(T):
        raise RecordingError(f"{recording.name}: the torque has no step beyond its noise that begins after {RISE:g} s")
    onset = k - span + int((np.abs(T[k - span : k + 1] - before) > 0.1 * abs(after - before)).argmax())
    if t[onset] - t[0] < BEFORE or t[-1] - t[onset] < 0.5 * AFTER:
        raise RecordingError(
            f"{recording.name}: the step at {t[onset]:.3g} s needs {BEFORE:g} s before and {0.5 * AFTER:g} s after it"
        )
    first, last = np.searchsorted(t, [t[onset] - BEFORE, t[onset] + AFTER])
    t, T, omega = t[first:last], T[first:last], recording.omega_1[first:last]
    steady = t < t[0] + 0.5 * BEFORE
    T_0, omega_0 = float(T[steady].mean()), float(omega[steady].mean())
    time = np.arange(0.0, t[-1] - t[0], STEP_SIZE)
    T_mot = np.interp(time + 0.5 * STEP_SIZE, t - t[0], T)
    return Tip(time, T_mot, t - t[0], omega, T_0, omega_0, T_0 * after < 0.0)


def identify_step(recording: Measurement, vehicle: Mapping[str, Any], settings: Settings) -> Step:
    """
    Args:
        vehicle: entries of the vehicle file as the car is known.
        settings: whose plants are driven.

    Raises:
        RecordingError: it has no step that can be used.
    """
    step = tip(recording)
    quiet = step.at < 0.9 * BEFORE
    before = step.at[quiet], step.omega_1[quiet]
    noise = float(np.std(before[1] - np.polyval(np.polyfit(*before, 2), before[0])))
    with kept_loaded():
        starts = [{"C": log(C), "phi_B": log(phi_B)} for C, phi_B in product(STIFFNESSES, GAPS)]
        fits = [fitted(plant, step, noise, vehicle, settings, starts)[0] for plant in PLANTS]
    best, other = sorted(fits, key=lambda step: step.error)
    apart = {
        name: float(np.clip(abs(log(other.values[name] / value)), *APART[name])) for name, value in best.values.items()
    }
    unlike = {name: hypot(LEAST[name], UNLIKE * unexplained(best) * apart[name]) for name in apart}
    return replace(best, halves={name: hypot(half, unlike[name]) for name, half in best.halves.items()})


def unexplained(step: Step) -> float:
    """Share of the error that is beyond the noise."""
    return sqrt(max(1.0 - (EXPLAINED * step.noise / step.error) ** 2, 0.0))


def fitted(
    plant: str,
    step: Tip,
    noise: float,
    vehicle: Mapping[str, Any],
    settings: Settings,
    starts: Sequence[Mapping[str, float]],
    most: int = 12,
) -> tuple[Step, dict[str, float]]:
    """The car whose motor speed is the recorded one, and by what it is moved from what is known.

    Args:
        noise: of the motor speed in rad/s.
        vehicle: entries of the vehicle file as the car is known.
        starts: by what it may be moved; the search begins with the best of them.
        most: evaluations of each of two searches, without those for derivatives.
    """
    system, known = _plant(settings.replace(plant=plant)), with_estimates(vehicle)
    names = [name for name in SEARCHED if name != "damping" or plant != PLANTS[0]]
    names = [name for name in names if name != "phi_B" or step.reversal]
    deviation_of = np.array([SEARCHED[name].known for name in names])
    size = noise

    def error(x: np.ndarray) -> np.ndarray:
        """Over the noise, then what is known before."""
        x = x - ORIGIN
        try:
            omega_1 = _motor_speed(system, plant, step, known, dict(zip(names, x.tolist(), strict=True)))
        except (ParameterFileError, SimulationError):
            return np.full(len(step.omega_1) + len(x), 1e3)
        return np.concatenate([(omega_1 - step.omega_1) / size, x / deviation_of])

    begin = min(
        (np.array([ORIGIN + start.get(name, 0.0) for name in names]) for start in starts),
        key=lambda x: float(error(x) @ error(x)),
    )
    for _ in range(2):
        fit = least_squares(error, begin, diff_step=1e-3, x_scale=np.minimum(deviation_of, 0.3), max_nfev=most)
        begin, n = fit.x, len(step.omega_1)
        rms = float(np.sqrt(np.mean((fit.fun[:n] * size) ** 2)))
        size = max(noise, rms)  # what the model does not explain counts as noise from now on
    J, r = fit.jac[:n], fit.fun[:n]
    H = np.linalg.inv(fit.jac.T @ fit.jac)
    windows = max(round(float(step.at[-1]) / CORRELATED), 2)
    scores = np.array([part.sum(axis=0) for part in np.array_split(J * r[:, None], windows)])
    sandwich = H @ (scores.T @ scores) @ H
    deviations = np.sqrt(np.maximum(np.diag(H), np.diag(sandwich)))
    moved = dict(zip(names, (fit.x - ORIGIN).tolist(), strict=True))
    halves = {name: Z_95 * float(of) for name, of in zip(names, deviations, strict=True) if name in ("C", "phi_B")}
    values = {name: known[name] * float(np.exp(moved[name])) for name in halves}
    return Step(plant, values, halves, rms, noise), moved


def _plant(settings: Settings) -> System:
    """The plant alone."""
    whole = loop(settings)
    inputs = tuple(
        Port(f"plant.{name}", unit) for name, unit in (("T_mot", "N.m"), ("T_brake", "N.m"), ("slope", "rad"))
    )
    return System(
        {"plant": whole.instances["plant"]},
        inputs=inputs,
        outputs=(Port(roles.MOTOR_SPEED, "rad/s"),),
        own=whole.own,
        lane_libraries=whole.lane_libraries,
    )


def _motor_speed(
    system: System, plant: str, step: Tip, known: Mapping[str, Any], moved: Mapping[str, float]
) -> np.ndarray:
    """In rad/s at the samples, of a car that is moved from what is known."""
    by = {name: float(np.exp(value)) for name, value in moved.items()}
    car = {**known, **{name: known.get(name, DEFAULT_CAR[name]) * by[name] for name in by if name in DEFAULT_CAR}}
    full = {**DEFAULT_CAR, **of_one_car(car, FOLLOW)}
    full |= {name: full[name] * by.get("damping", 1.0) for name in DAMPERS}
    full |= {"v_0": by["v_0"] * step.omega_0 * full["r"] / full["i"], "T_0": step.T_0 / by["g_T"]}
    parameters = {f"plant.{name}": full[name] for name in EVERY[plant].block.Parameters._fields if name in full}
    inputs = {"plant.T_mot": step.T_mot / by["g_T"], roles.BRAKE_TORQUE: 0.0, roles.SLOPE: moved["slope"]}
    experiment = Experiment(float(step.time[-1]), STEP_SIZE, inputs, parameters)
    results = run(system, experiment)
    return np.interp(step.at, results["time"], results[roles.MOTOR_SPEED])
