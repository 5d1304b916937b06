"""The true loop, in contact and without noise: the models themselves, stepped, after a small step of the demand,
which the controller does not shape."""

from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from driveline.harness.studies.margins.linear_loop import LinearLoop, linear_loop
from driveline.harness.studies.margins.linear_plant import NOISELESS, motor_and_plant
from driveline.harness.studies.margins.modes import Mode, modes
from driveline.harness.studies.margins.operating_point import CAN, MOTOR, Point
from fmublocks.block.runner import runner

INTERVAL = 0.001
"""In s; dead times are multiples of it."""

EVEN = {"q_v": 0.0, "sigma_tooth": 0.0, "d_min": 0.013, "d_max": 0.013}
"""A bus without rounding and tooth errors, on which every message takes the mean of the usual times."""


def torque(point: Point, step: float = 0.1, gain: float = 1.0, duration: float = 0.3) -> np.ndarray:
    """Gear torque in N.m every INTERVAL.

    Args:
        step: by which the demand is higher from the first sample on, N.m.
        gain: factor on what the controller adds.
        duration: in s.
    """
    unshaped = {name: 0.0 for name in ("shape_1", "shape_2") if name in point.controller.Parameters._fields}
    given = point.with_parameters(
        motor=NOISELESS, can=EVEN, plant={"v_0": point.v, "T_0": point.T}, controller={"swing": 1.0, **unshaped}
    )
    block, p = motor_and_plant(point.plant), (given.of("motor", MOTOR), given.of("plant", point.plant))
    demand = {"T_driver": point.T}
    drive = runner(block, point.plant.Input(T_mot=point.T), p)

    def wheels(plant: Any) -> Any:
        return CAN.Input(plant.omega_wheel_L, plant.omega_wheel_R)

    def measured(motor: Any, plant: Any) -> Any:
        known = plant._asdict() | motor._asdict() | bus.output(None)._asdict() | demand
        return point.controller.Input(**{name: known[name] for name in point.controller.Input._fields if name in known})

    motor, plant = drive.output(point.plant.Input())
    bus = runner(CAN, wheels(plant), given.of("can", CAN))
    controller = runner(point.controller, measured(motor, plant), given.of("controller", point.controller))
    demand["T_driver"] = point.T + step
    held, torques = deque([point.T] * round(point.late / INTERVAL)), []
    for _ in range(round(duration / INTERVAL)):
        motor, plant = drive.output(point.plant.Input())
        torques.append(plant.T_gear)
        command = controller.output(None)
        held.append(command.T_ref + (gain - 1.0) * command.T_damp)
        controller.advance(measured(motor, plant), INTERVAL)
        bus.advance(wheels(plant), INTERVAL)
        drive.advance(point.plant.Input(T_mot=held.popleft()), INTERVAL)
    return np.array(torques)


def growth(point: Point, frequency: float, gain: float = 1.0) -> float:
    """By what factor the swing with a frequency (Hz) grows from 0.1 to 0.5 s to 0.5 to 0.9 s after a step."""
    begin, length = round(0.1 / INTERVAL), round(0.4 / INTERVAL)
    swinging = torque(point, gain=gain, duration=0.9)[begin:]
    t = INTERVAL * np.arange(length)
    wave = np.hanning(length) * np.exp(-2j * np.pi * frequency * t)
    first, second = (abs(np.dot(wave, part - np.mean(part))) for part in (swinging[:length], swinging[length:]))
    return float(second / first)


def swing(plant: Any, motor: Any, gains: Mapping[str, float]) -> tuple[Mode, Mode]:
    """The drive train without and with damping: its own mode, and the least damped one below twice its frequency.

    Vehicle and wheels move as one here, without the damping by the tyre; the wheel speed is not used.

    Args:
        plant, motor: parameters of the design model and of the motor.
        gains: parameters of the controller, beside those of the plant.
    """
    loop = rigid(plant, motor, gains)
    alone = min(modes(loop, gain=0.0), key=lambda mode: abs(mode.damping_ratio))
    slow = (mode for mode in modes(loop) if mode.frequency < 2.0 * alone.frequency)
    return alone, min(slow, key=lambda mode: mode.damping_ratio)


def rigid(plant: Any, motor: Any, gains: Mapping[str, float]) -> LinearLoop:
    """The loop in which the wheels carry the vehicle; arguments as of `swing`."""
    car = plant._replace(J_2=plant.J_2 + plant.m * plant.r**2 / plant.i**2, recorded_load=True)
    known = {name: getattr(plant, name) for name in ("J_1", "J_2", "C", "phi_B")}
    limits = {"T_max": motor.T_max, "tau": motor.tau}
    point = Point(T=0.2 * motor.T_max, wheel=False)
    given = {"plant": car._asdict(), "motor": motor._asdict(), "controller": known | limits | dict(gains)}
    return linear_loop(replace(point, parameters=given))
