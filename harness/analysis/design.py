"""Design of the damping controller for a car: Riccati equations and a few formulas, with dimensionless weights.

The estimator's gains are those of the stationary Kalman filter of its own model in contact, without
and with the wheel speed; the message, late and only once a cycle, enters as a delayed measurement of
a periodic system. The damping law follows from three times of the car: the drive train swings at omega_0,
the vehicle would swing on it at omega_v if the motor were held, and the loop acts T_dead late.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import solve_discrete_are

from fmus.description.variables import interface
from models import motor_torque_loop, two_mass_driveline, wheel_speed_can
from models.controller.supervision import T_S
from models.controller.torque_estimator import Estimate, integrated
from models.damping_controller import BLOCK

from ..errors import DrivelineError

Plant = two_mass_driveline.Parameters
Motor = motor_torque_loop.Parameters
Can = wheel_speed_can.Parameters


class DesignError(DrivelineError):
    """There is no controller for this car; the text says why."""


@dataclass(frozen=True)
class Weights:
    """What the designer decides, without dimension. The default car gets round parameters with them.

    Attributes:
        wheel_share: share of the gear torque that moves the wheels alone, over what is theirs when they move as one
            with the vehicle. With less than 1 the estimated wheels follow the motor less, as on a slipping tyre.
        torque_error, load_error, slow_load_error: standard deviations of what the estimator's model does not know
            of the torques at motor and wheels per sample, the last one added up; over T_max.
        twist_error: the same of the twist; over T_max/C.
        message_error: standard deviation of a wheel-speed message, over the speed that T_max adds to the car
            within a cycle and the spread of the delays.
        damping_ratio: of the drive train with the feedback of the speed difference alone, at the least.
        phase: that the dead time takes where the loop crosses over, rad; where it leaves more damping than asked
            for, this is used up.
        k_gap: factor on the damping inside the gap.
        washout: what the washout gives back of a step of the torque.
        withheld: time by which the feedback of the gear torque delays the driver's impulse, times omega_v.
        demand: step that the landing is made for, over T_max.
        landing: time by which a landing may delay the impulse of that step, times omega_v.
        impact: largest peak of the gear torque at the end of a landing, over T_max.
        longest_landing: how long the demand may be limited, times omega_v.
    """

    wheel_share: float = 0.523593
    torque_error: float = 1.0 / 180.0
    load_error: float = 5.0 / 180.0
    slow_load_error: float = 0.01 / 180.0
    twist_error: float = 6.52222e-4
    message_error: float = 0.4698217
    damping_ratio: float = 0.483596
    phase: float = 0.326211
    k_gap: float = 0.665
    washout: float = 0.0896779
    withheld: float = 0.0483824
    demand: float = 0.6
    landing: float = 0.0859882
    impact: float = 0.702836
    longest_landing: float = 0.806373


SAMPLES = 4000
"""After so many samples the periodic gains have settled to a share of 1e-7."""

PLANT, MOTOR, CAN, WEIGHTS = Plant(), Motor(), Can(), Weights()
"""The default car, and the weights."""


def records(vehicle: Mapping[str, Any]) -> tuple[Plant, Motor, Can]:
    """A car by the entries of its vehicle file; what these do not name is that of the default car."""

    def of(record: Any) -> Any:
        return record(**{name: vehicle[name] for name in record._fields if name in vehicle})

    return of(Plant), of(Motor), of(Can)


class DriveTrain(NamedTuple):
    """What the design works with; inertias in kg.m2 of the motor side, frequencies in rad/s, times in s.

    Attributes:
        M: inertia of the vehicle, m r^2/i^2.
        lambda_v: share of the gear torque that the vehicle takes.
        omega_0: own frequency of the drive train, sqrt(C/J_1 + (1 - lambda_v) C/J_2).
        omega_v: own frequency of vehicle and wheels on the drive train with the motor held, sqrt(C/(M + J_2)).
        T_dead: computation and hold of the controller, lag of the motor.
    """

    M: float
    lambda_v: float
    omega_0: float
    omega_v: float
    T_dead: float


def drive_train(plant: Plant, motor: Motor, weights: Weights) -> DriveTrain:
    M = plant.m * plant.r**2 / plant.i**2
    lambda_v = 1.0 - weights.wheel_share * plant.J_2 / (plant.J_2 + M)
    return DriveTrain(
        M=M,
        lambda_v=lambda_v,
        omega_0=sqrt(plant.C * (1.0 / plant.J_1 + (1.0 - lambda_v) / plant.J_2)),
        omega_v=sqrt(plant.C / (M + plant.J_2)),
        T_dead=1.5 * T_S + sqrt(2.0) * motor.tau,
    )


def design(plant: Plant = PLANT, motor: Motor = MOTOR, can: Can = CAN, weights: Weights = WEIGHTS) -> dict[str, float]:
    """All parameters of the controller that are designed, by name, in SI units.

    Args:
        plant, motor, can: the car.

    Raises:
        DesignError: the car leaves something undetermined, or needs what the controller cannot be set to.
    """
    train = drive_train(plant, motor, weights)
    T_age = possible({"T_age": 0.5 * (can.T_cyc + can.d_min + can.d_max)})["T_age"]
    return possible(
        {
            "lambda_v": train.lambda_v,
            **estimator_gains(plant, motor, can, train, T_age, weights),
            "T_age": T_age,
            **damping_law(plant, motor, train, weights),
        }
    )


def possible(parameters: dict[str, float]) -> dict[str, float]:
    """The parameters, if the controller can be set to them.

    Raises:
        DesignError: names those that are out of their bounds.
    """
    declared = {variable.name: variable for variable in interface(BLOCK) if variable.causality == "parameter"}
    problems = []
    for name, value in parameters.items():
        low, high = declared[name].bounds()
        if not low <= value <= high:
            problems.append(f"{name} would be {value:.4g}; the controller takes {declared[name].allowed()}")
    if problems:
        raise DesignError("\n".join(problems))
    return parameters


def estimator_gains(
    plant: Plant, motor: Motor, can: Can, train: DriveTrain, T_age: float, weights: Weights
) -> dict[str, float]:
    """Gains on the motor speed without and with the wheel speed, and on a wheel-speed message."""
    A, Q = transition(plant, train.lambda_v), process_noise(plant, motor, weights)
    R_1 = motor.sigma_omega**2 + motor.q_omega**2 / 12.0
    if R_1 == 0.0:
        raise DesignError("sigma_omega and q_omega are 0: a motor speed without error leaves nothing to estimate")
    R_2 = message_noise(plant, motor, can, train, weights)
    Lw, L_can = both_speed_gains(A, Q, R_1, R_2, round(T_age / T_S), round(can.T_cyc / T_S))
    rows = {"L": motor_speed_gains(A, Q, R_1), "Lw": Lw, "L_can": L_can}
    return {
        f"{name}_{state}": float(gain)
        for name, row in rows.items()
        for state, gain in zip(Estimate._fields, row, strict=True)
    }


def transition(plant: Plant, lambda_v: float, h: float = T_S) -> np.ndarray:
    """Matrix (4, 4) of the estimator's model over h seconds in contact, deviations from a state there."""
    model = SimpleNamespace(J_1=plant.J_1, J_2=plant.J_2, C=plant.C, phi_B=plant.phi_B, lambda_v=lambda_v)
    contact = np.array(Estimate(0.0, 0.0, 2.0 * plant.phi_B + 1.0, 0.0))
    base = np.array(integrated(Estimate(*contact.tolist()), 0.0, h, model))
    columns = [np.array(integrated(Estimate(*(contact + row).tolist()), 0.0, h, model)) - base for row in np.eye(4)]
    return np.array(columns).T


def process_noise(plant: Plant, motor: Motor, weights: Weights) -> np.ndarray:
    """Covariance (4, 4) of what the model does not know, per sample."""
    deviations = (
        T_S * weights.torque_error / plant.J_1,
        T_S * weights.load_error / plant.J_2,
        weights.twist_error / plant.C,
        weights.slow_load_error,
    )
    return np.diag(np.square(motor.T_max * np.array(deviations)))


def message_noise(plant: Plant, motor: Motor, can: Can, train: DriveTrain, weights: Weights) -> float:
    """Variance of a wheel-speed message, (rad/s)^2: what the speed may have changed by since."""
    acceleration = motor.T_max / (plant.J_1 + plant.J_2 + train.M)
    return (weights.message_error * acceleration * (can.T_cyc + can.d_max - can.d_min)) ** 2


def motor_speed_gains(A: np.ndarray, Q: np.ndarray, R_1: float) -> np.ndarray:
    """Stationary Kalman gains (4,) with the motor speed alone, whose variance is R_1."""
    H = np.eye(4)[:1]
    try:
        P = solve_discrete_are(A.T, H.T, Q, np.array([[R_1]]))
    except np.linalg.LinAlgError as error:
        raise DesignError(f"no stationary Kalman filter: {error}; A =\n{A}\nQ =\n{Q}\nR = {R_1:g}") from error
    return P[:, 0] / (P[0, 0] + R_1)


def both_speed_gains(
    A: np.ndarray, Q: np.ndarray, R_1: float, R_2: float, delay: int, cycle: int
) -> tuple[np.ndarray, np.ndarray]:
    """Gains (4,) on the motor speed (mean over a cycle) and on a message, in the periodic optimum.

    The state is augmented by the past values of omega_2, so that a message measures the last of them.

    Args:
        R_1, R_2: variances of the motor speed and of a message.
        delay, cycle: of the messages, in samples.
    """
    size = 4 + delay
    F, noise = np.zeros((size, size)), np.zeros((size, size))
    F[:4, :4], noise[:4, :4] = A, Q
    F[4, 1] = 1.0
    F[5:, 4:-1] = np.eye(delay - 1)
    H_1, H_2 = np.eye(size)[0], np.eye(size)[-1]
    P, gains, L_2 = np.eye(size), [], np.zeros(size)
    for k in range(SAMPLES):
        P = F @ P @ F.T + noise
        P, L_1 = _measured(P, H_1, R_1)
        gains = [*gains[1 - cycle :], L_1[:4]]
        if k % cycle == 0:
            P, L_2 = _measured(P, H_2, R_2)
    return np.mean(gains, axis=0), L_2[:4]


def _measured(P: np.ndarray, H: np.ndarray, R: float) -> tuple[np.ndarray, np.ndarray]:
    """Covariance and gain after a scalar measurement H x with variance R."""
    L = P @ H / (H @ P @ H + R)
    return P - np.outer(L, H @ P), L


def damping_law(plant: Plant, motor: Motor, train: DriveTrain, weights: Weights) -> dict[str, float]:
    """The parameters of the damping law.

    In contact k_d damps the drive train with the ratio k_d/(2 J_1 omega_0). Above the resonance, where J_1 alone
    is left, the loop crosses over at k_d/J_1, and there the dead time takes the phase T_dead k_d/J_1. After a step
    dT of the torque the twist has changed by dT/C; the washout of k_d times its rate gives omega_w k_d/C of the
    step back, that of k_T takes its impulse away for k_T/omega_w.
    """
    k_d = plant.J_1 * max(2.0 * weights.damping_ratio * train.omega_0, weights.phase / train.T_dead)
    omega_w = weights.washout * plant.C / k_d
    return {
        "T_pred": sqrt(2.0) * motor.tau,
        "k_d": k_d,
        "k_T": omega_w * weights.withheld / train.omega_v,
        "k_gap": weights.k_gap,
        "omega_w": omega_w,
        "T_land": landing_torque(plant, motor, train, weights),
        "t_land": weights.longest_landing / train.omega_v,
    }


def landing_torque(plant: Plant, motor: Motor, train: DriveTrain, weights: Weights) -> float:
    """T_land in N.m: as low as the withheld impulse allows, or lower where the impact would be too hard.

    The torque T takes the motor across the gap of 2 phi_B in t = sqrt(4 phi_B J_1/T) and lets it arrive with the
    speed sqrt(4 phi_B T/J_1); of the demand T_d it withholds the time (1 - T/T_d) t. The spring turns the
    impact into a torque of 2 sqrt(C phi_B T), on top of T. Both conditions are quadratic in s = sqrt(T).
    """
    T_d, delay = weights.demand * motor.T_max, weights.landing / train.omega_v
    travel = sqrt(4.0 * plant.phi_B * plant.J_1)
    soft = 2.0 * travel / (delay + sqrt(delay**2 + 4.0 * travel**2 / T_d))
    bounce = plant.C * plant.phi_B
    bearable = sqrt(bounce + weights.impact * motor.T_max) - sqrt(bounce)
    return min(soft, bearable) ** 2


def gains_file(parameters: Mapping[str, float], comment: str) -> str:
    """Designed parameters as TOML, to six significant digits, each with its unit and meaning, under a comment."""
    declared = {variable.name: variable.declaration for variable in interface(BLOCK)}
    entries = [f"{name} = {float(f'{value:.6g}')!r}" for name, value in parameters.items()]
    width = max(map(len, entries))
    lines = [f"# {line}" for line in comment.splitlines()] + [""]
    for name, entry in zip(parameters, entries, strict=True):
        declaration: Any = declared[name]
        lines.append(f"{entry:{width}}  # {declaration.unit}, {declaration.description}")
    return "\n".join(lines) + "\n"
