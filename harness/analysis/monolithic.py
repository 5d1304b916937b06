"""The whole loop as one system: the solution that co-simulation approximates.

Motor and plant are integrated together, the sampled blocks tick exactly at their instants with the
values of that instant, and every torque between two instants is the true one. Used to measure the
coupling error of the master and to design the controller; it runs the models themselves.
"""

from collections import namedtuple
from collections.abc import Callable, Mapping
from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np

from models import damping_controller, motor_torque_loop, wheel_speed_can
from models.block.integrator import Integrator
from models.block.types import Block

STEP = wheel_speed_can.T_S
"""Interval in s of the results; the sample times of all blocks are whole multiples of it."""

Signals = Callable[[int], tuple[float, float, float]]
"""Number of the interval -> T_driver (N.m), T_brake (N.m) and slope (rad), held over it."""


def drive_train(plant: ModuleType) -> Block:
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

    def surfaces(x: Any, u: Any, p: Any) -> tuple[Any, ...]:
        _, _, x_plant, u_plant = parts(x, u)
        return plant.surfaces(x_plant, u_plant, p[1])

    return replace(plant.BLOCK, State=State, start=start, derivative=derivative, output=output, surfaces=surfaces)


class Ticking:
    """A sampled block; what a tick computes shows one sample later."""

    def __init__(self, model: ModuleType, u: Any, p: Any) -> None:
        self.model, self.p = model, p
        self.intervals = round(model.T_S / STEP)
        self.x = self.coming = model.start(u, p)

    def output(self, k: int) -> Any:
        """Output from the instant k * STEP on."""
        if k % self.intervals == 0:
            self.x = self.coming
        return self.model.output(self.x, None, self.p)

    def tick(self, k: int, u: Any) -> None:
        """Takes the inputs of the instant k * STEP, if there is a tick."""
        if k % self.intervals == 0:
            self.coming = self.model.update(self.x, u, self.p)


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
    p_d = (p["motor"], p["plant"])
    block = drive_train(plant)
    integrator = Integrator(block)

    u = plant.Input(*signals(0))
    x = block.start(u, p_d)
    motor, seen = block.output(x, u, p_d)
    can = Ticking(wheel_speed_can, wheels(seen), p["can"])
    measured = sensed(u.T_mot, motor, can.output(0), enable)
    controller = Ticking(damping_controller, measured, p["controller"])

    rows = []
    for k in range(round(duration / STEP) + 1):
        T_driver, T_brake, slope = signals(k)
        command, bus = controller.output(k), can.output(k)
        u = plant.Input(command.T_ref, T_brake, slope)
        motor, seen = block.output(x, u, p_d)
        rows.append((k * STEP, T_driver, *command, *motor, *seen, *bus))
        controller.tick(k, sensed(T_driver, motor, bus, enable))
        can.tick(k, wheels(seen))
        x = integrator.advance(x, u, p_d, STEP)
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
