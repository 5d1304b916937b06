"""The whole loop as one system: the solution that co-simulation approximates.

Motor and plant are integrated together, the sampled blocks tick exactly at their instants with the
values of that instant, and every torque between two instants is the true one. The coupling error and
the dead time of the master are measured against it; it runs the models themselves.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from driveline.harness.studies.margins.linear_plant import motor_and_plant
from driveline.models import (
    damping_controller,
    motor_torque_loop,
    two_mass_driveline,
    validation_vehicle,
    wheel_speed_can,
)
from fmublocks.block.runner import runner
from fmublocks.block.types import Block, ContinuousBlock

INTERVAL = wheel_speed_can.T_S
"""Interval in s of the results; the sample times of all blocks are whole multiples of it."""

MOTOR, CAN, CONTROLLER = motor_torque_loop.BLOCK, wheel_speed_can.BLOCK, damping_controller.BLOCK

PLANTS = {plant.name: plant for plant in (two_mass_driveline.BLOCK, validation_vehicle.BLOCK)}

Signals = Callable[[int], tuple[float, float, float]]
"""Number of the interval -> T_driver (N.m), T_brake (N.m) and slope (rad), held over it."""


Received = Callable[[float, Any], Any]
"""Time in s and what was sent to the controller -> what it receives."""


def run(
    plant: ContinuousBlock,
    signals: Signals,
    duration: float,
    parameters: Mapping[str, Mapping[str, Any]] | None = None,
    enable: bool = True,
    received: Received = lambda t, sent: sent,
) -> np.ndarray:
    """Runs the loop from the start of its blocks.

    Args:
        plant: one of PLANTS.
        signals: T_driver, T_brake and slope in each interval.
        duration: in s.
        parameters: values by instance (controller, motor, plant, can) and name.
        enable: whether the damping is on.
        received: what becomes of the signals on their way to the controller.

    Returns:
        Structured array of duration/INTERVAL + 1 rows: time, controller.T_driver and the outputs of all
        blocks as 'instance.variable'.
    """
    blocks: dict[str, Block] = {"controller": CONTROLLER, "motor": MOTOR, "plant": plant, "can": CAN}
    p = {name: block.Parameters(**(parameters or {}).get(name, {})) for name, block in blocks.items()}
    u = plant.Input(*signals(0))
    plant_runner = runner(motor_and_plant(plant), u, (p["motor"], p["plant"]))
    motor, seen = plant_runner.output(u)
    can = runner(CAN, wheels(seen), p["can"])
    sent = sensed(u.T_mot, motor, can.output(None), enable)
    controller = runner(CONTROLLER, received(0.0, sent), p["controller"])

    rows = []
    for k in range(round(duration / INTERVAL) + 1):
        T_driver, T_brake, slope = signals(k)
        command, bus = controller.output(None), can.output(None)
        u = plant.Input(command.T_ref, T_brake, slope)
        motor, seen = plant_runner.output(u)
        rows.append((k * INTERVAL, T_driver, *command, *motor, *seen, *bus))
        controller.advance(received(k * INTERVAL, sensed(T_driver, motor, bus, enable)), INTERVAL)
        can.advance(wheels(seen), INTERVAL)
        plant_runner.advance(u, INTERVAL)
    outputs = (f"{name}.{field}" for name, block in blocks.items() for field in block.Output._fields)
    return np.array(rows, dtype=[(name, float) for name in ("time", "controller.T_driver", *outputs)])


def wheels(seen: Any) -> Any:
    """What the bus is given of what the plant shows."""
    return CAN.Input(seen.omega_wheel_L, seen.omega_wheel_R)


def sensed(T_driver: float, motor: Any, bus: Any, enable: bool) -> Any:
    """What the controller is given."""
    return CONTROLLER.Input(
        T_driver, motor.omega_1_meas, motor.T_mot_est, bus.omega_2_can, bus.valid, bus.counter, enable
    )
