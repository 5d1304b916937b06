"""Dead time that the master adds to each connection of the loop, measured in the running loop.

A sine goes round the open loop. How late a signal is, compared with the monolithic solution, is told
by least squares: by what multiple of the difference that it makes to have the driver T_S later. The
dead time of a connection is how much later the signal behind it is than the signal before it.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from driveline.harness.loop.places import BUILD
from driveline.harness.manoeuvres.signals import Signal
from driveline.models.controller.torque_estimator import Estimate
from fmuloop.system import Scheme

from .coupling_error import NOISELESS, T_S, cosimulated, reference, short

PLANT = "TwoMassDriveline"

OPEN = NOISELESS | {
    "controller.k_d": 0.0,
    "controller.shape_1": 0.0,
    "controller.shape_2": 0.0,
    "controller.L_phi_B": 0.0,
    "controller.t_land": 0.0,
    **{f"controller.{name}": 1000.0 for name in ("jump", "wheel_deviation", "wheel_jump", "frozen")},
    "controller.slip_drift": 100.0,
    "controller.slip_load": 4.0,
}
"""The estimator takes its signals however far off they are, and nothing is done with what it finds."""

NO_MOTOR_SPEED = {f"controller.{gain}_{state}": 0.0 for gain in ("L", "Ls") for state in Estimate._fields}
NO_WHEEL_SPEED = {f"controller.L_can_{state}": 0.0 for state in Estimate._fields}
NO_TORQUE = {"controller.J_1": 10.0}
WHEEL_SPEED_HELD = NO_WHEEL_SPEED | {
    "controller.L_can_omega_2": 1.0,
    "controller.T_age": 0.002,
    "controller.J_2": 100.0,
}
"""Parameters that make the estimator deaf to one of its signals, or repeat the wheel speed."""


class Section(NamedTuple):
    """A piece of the loop, between two signals."""

    name: str
    source: str
    sink: str


EXPERIMENTS: tuple[tuple[Mapping[str, float], tuple[Section, ...]], ...] = (
    (
        OPEN,
        (
            Section("T_ref to the motor", "controller.T_ref", "motor.T_mot"),
            Section("T_mot to the plant", "motor.T_mot", "plant.omega_1"),
            Section("omega_1 to the motor", "plant.omega_1", "motor.omega_1_meas"),
            Section("wheel speeds to the bus", "plant.omega_2", "can.omega_2_can"),
        ),
    ),
    (
        OPEN | NO_TORQUE | NO_WHEEL_SPEED,
        (
            Section("omega_1_meas to the controller", "motor.omega_1_meas", "controller.T_gear_hat"),
            Section("around the loop by omega_1", "controller.T_ref", "controller.T_gear_hat"),
        ),
    ),
    (
        OPEN | NO_MOTOR_SPEED | NO_WHEEL_SPEED,
        (
            Section("T_mot_est to the controller", "motor.T_mot_est", "controller.T_gear_hat"),
            Section("around the loop by T_mot_est", "controller.T_ref", "controller.T_gear_hat"),
        ),
    ),
    (
        OPEN | NO_MOTOR_SPEED | WHEEL_SPEED_HELD,
        (
            Section("omega_2_can to the controller", "can.omega_2_can", "controller.omega_2_hat"),
            Section("around the loop by omega_2_can", "controller.T_ref", "controller.omega_2_hat"),
        ),
    ),
)
"""What is measured with which parameters; those let each sink depend on its source alone."""

SECTIONS = tuple(section for _, sections in EXPERIMENTS for section in sections)


def sine(late: float) -> Signal:
    """6 + 4 N.m at 4 Hz from (0.1 + late) s on: no gap is crossed, and the car keeps its speed."""
    return lambda t: 6.0 + 4.0 * np.sin(8.0 * np.pi * np.maximum(np.asarray(t) - 0.1 - late, 0.0))


PROBE = short("probe", "sine with the teeth in contact", sine(0.0))
LATE_PROBE = short("late probe", "the same, T_S later", sine(T_S))


def dead_times(scheme: Scheme, step_size: float, folder: Path = BUILD) -> dict[str, float]:
    """Dead time in s of every section, by its name; negative where a signal comes too early."""
    times = {}
    for parameters, sections in EXPERIMENTS:
        exact, late = (reference(PLANT, probe, parameters) for probe in (PROBE, LATE_PROBE))
        results = cosimulated(PLANT, PROBE, parameters, step_size, scheme, folder)
        for section in sections:
            after, before = (lateness(results[s], exact[s], late[s]) for s in (section.sink, section.source))
            times[section.name] = after - before
    return times


def lateness(signal: np.ndarray, exact: np.ndarray, late: np.ndarray) -> float:
    """By how many s a signal is late, given the exact one and the exact one T_S later."""
    unit = late - exact
    return T_S * float(np.dot(signal - exact, unit) / np.dot(unit, unit))
