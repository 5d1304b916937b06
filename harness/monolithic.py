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

from fmus.integrator import Integrator
from models import damping_controller, motor_torque_loop, wheel_speed_can
from models.block import Block

Signals = Callable[[int], tuple[float, float, float]]
"""Sample number -> T_driver (N.m), T_brake (N.m) and slope (rad), held until the next sample."""


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

    return replace(
        plant.BLOCK, State=State, start=start, derivative=derivative, output=output, surfaces=surfaces
    )


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
        signals: T_driver, T_brake and slope at sample k of 1 ms.
        duration: in s.
        parameters: values by instance (controller, motor, plant, can) and name.
        enable: whether the damping is on.

    Returns:
        Structured array of duration/1 ms + 1 rows: time and the outputs of all blocks as
        'instance.variable', besides 'controller.T_driver'.
    """
    given = parameters or {}
    p_c, p_m, p_s = (
        model.Parameters(**given.get(name, {}))
        for name, model in (
            ("controller", damping_controller),
            ("motor", motor_torque_loop),
            ("can", wheel_speed_can),
        )
    )
    p_d = (p_m, plant.Parameters(**given.get("plant", {})))
    block = drive_train(plant)
    integrator = Integrator(block)
    per_sample = round(damping_controller.BLOCK.sample_time / wheel_speed_can.T_S)

    T_driver, T_brake, slope = signals(0)
    x = block.start(plant.Input(T_driver, T_brake, slope), p_d)
    m, y = block.output(x, plant.Input(T_driver, T_brake, slope), p_d)
    s = wheel_speed_can.start(wheel_speed_can.Input(y.omega_wheel_L, y.omega_wheel_R), p_s)
    bus = wheel_speed_can.output(s, None, p_s)
    c = damping_controller.start(
        damping_controller.Input(T_driver, m.omega_1_meas, m.T_mot_est, *bus, enable), p_c
    )
    rows = []
    steps = round(duration / wheel_speed_can.T_S)
    held = c
    for k in range(steps + 1):
        T_driver, T_brake, slope = signals(k)
        if k % per_sample == 0:
            held = c
        command = damping_controller.output(held, None, p_c)
        u = plant.Input(command.T_ref, T_brake, slope)
        m, y = block.output(x, u, p_d)
        bus = wheel_speed_can.output(s, None, p_s)
        rows.append((k * wheel_speed_can.T_S, T_driver, *command, *m, *y, *bus))
        if k % per_sample == 0:
            c = damping_controller.update(
                held, damping_controller.Input(T_driver, m.omega_1_meas, m.T_mot_est, *bus, enable), p_c
            )
        s = wheel_speed_can.update(s, wheel_speed_can.Input(y.omega_wheel_L, y.omega_wheel_R), p_s)
        x = integrator.advance(x, u, p_d, wheel_speed_can.T_S)
    return np.array(rows, dtype=_columns(plant))


def _columns(plant: ModuleType) -> np.dtype:
    names = ["time", "controller.T_driver"]
    for instance, model in (
        ("controller", damping_controller),
        ("motor", motor_torque_loop),
        ("plant", plant),
        ("can", wheel_speed_can),
    ):
        names += [f"{instance}.{field}" for field in model.Output._fields]
    return np.dtype([(name, float) for name in names])
