"""The whole loop as one system: the solution that co-simulation approximates.

Motor and plant are integrated together, the sampled blocks tick exactly at their instants with the
values of that instant, and every torque between two instants is the true one. Used to measure the
coupling error of the master and to design the controller; it runs the models themselves.
"""

from collections import namedtuple
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np

from models import damping_controller, motor_torque_loop, wheel_speed_can
from models.block.runner import runner
from models.block.types import ContinuousBlock

STEP = wheel_speed_can.T_S
"""Interval in s of the results; the sample times of all blocks are whole multiples of it."""

Signals = Callable[[int], tuple[float, float, float]]
"""Number of the interval -> T_driver (N.m), T_brake (N.m) and slope (rad), held over it."""


@cache
def drive_train(plant: ModuleType) -> ContinuousBlock:
    """Motor and plant as one continuous block; its input is that of the plant with T_ref for T_mot."""
    motor = motor_torque_loop
    split = len(motor.State._fields)
    State = namedtuple("State", [f"motor_{n}" for n in motor.State._fields] + list(plant.State._fields))

    def parts(x: Any, u: Any) -> tuple[Any, Any, Any, Any]:
        x_motor, x_plant = motor.State(*x[:split]), plant.State(*x[split:])
        u_motor = motor.Input(T_ref=u.T_mot, omega_1=x_plant.omega_1)
        return x_motor, u_motor, x_plant, u._replace(T_mot=x_motor.T_mot)

    def start(u: Any, p: Any) -> Any:
        x_plant = plant.start(u, p[1])
        return State(*motor.start(motor.Input(u.T_mot, x_plant.omega_1), p[0]), *x_plant)

    def derivative(x: Any, u: Any, p: Any) -> Any:
        x_motor, u_motor, x_plant, u_plant = parts(x, u)
        return State(*motor.derivative(x_motor, u_motor, p[0]), *plant.derivative(x_plant, u_plant, p[1]))

    def output(x: Any, u: Any, p: Any) -> Any:
        x_motor, u_motor, x_plant, u_plant = parts(x, u)
        return motor.output(x_motor, u_motor, p[0]), plant.output(x_plant, u_plant, p[1])

    def event_indicators(x: Any, u: Any, p: Any) -> tuple[Any, ...]:
        _, _, x_plant, u_plant = parts(x, u)
        return plant.event_indicators(x_plant, u_plant, p[1])

    functions = {"start": start, "derivative": derivative, "output": output, "event_indicators": event_indicators}
    return replace(plant.BLOCK, State=State, **functions)


def run(
    plant: ModuleType,
    signals: Signals,
    duration: float,
    parameters: Mapping[str, Mapping[str, Any]] | None = None,
    enable: bool = True,
) -> np.ndarray:
    """Simulate the loop.

    Args:
        plant: a model of a plant.
        signals: T_driver, T_brake and slope in each interval.
        duration: in s.
        parameters: values by instance (controller, motor, plant, can) and name.
        enable: whether the damping is on.

    Returns:
        Structured array of duration/STEP + 1 rows: time, controller.T_driver and the outputs of all
        blocks as 'instance.variable'.
    """
    models = instances(plant)
    p = {name: model.Parameters(**(parameters or {}).get(name, {})) for name, model in models.items()}
    u = plant.Input(*signals(0))
    driven = runner(drive_train(plant), u, (p["motor"], p["plant"]))
    motor, seen = driven.output(u)
    can = runner(wheel_speed_can.BLOCK, wheels(seen), p["can"])
    measured = sensed(u.T_mot, motor, can.output(None), enable)
    controller = runner(damping_controller.BLOCK, measured, p["controller"])

    rows = []
    for k in range(round(duration / STEP) + 1):
        T_driver, T_brake, slope = signals(k)
        command, bus = controller.output(None), can.output(None)
        u = plant.Input(command.T_ref, T_brake, slope)
        motor, seen = driven.output(u)
        rows.append((k * STEP, T_driver, *command, *motor, *seen, *bus))
        controller.advance(sensed(T_driver, motor, bus, enable), STEP)
        can.advance(wheels(seen), STEP)
        driven.advance(u, STEP)
    outputs = (f"{name}.{field}" for name, model in models.items() for field in model.Output._fields)
    return np.array(rows, dtype=[(name, float) for name in ("time", "controller.T_driver", *outputs)])


def instances(plant: ModuleType) -> dict[str, ModuleType]:
    """Models of the loop by the names that the wiring gives them."""
    return {
        "controller": damping_controller,
        "motor": motor_torque_loop,
        "plant": plant,
        "can": wheel_speed_can,
    }


def wheels(seen: Any) -> wheel_speed_can.Input:
    return wheel_speed_can.Input(seen.omega_wheel_L, seen.omega_wheel_R)


def sensed(T_driver: float, motor: Any, bus: Any, enable: bool) -> damping_controller.Input:
    return damping_controller.Input(
        T_driver, motor.omega_1_meas, motor.T_mot_est, bus.omega_2_can, bus.valid, bus.counter, enable
    )
