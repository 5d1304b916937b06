"""Motor and plant as one block, and as a linear system at an operating point."""

from collections import namedtuple
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from fmublocks.block.types import ContinuousBlock

from .jacobians import like, numbers, rates, reached
from .operating_point import CAN, MOTOR, Point

NOISELESS = {"sigma_T": 0.0, "sigma_omega": 0.0, "q_omega": 0.0}
"""Errors of the motor's signals that have no linear model."""

NO_RIPPLE = {"r_6a": 0.0, "r_6b": 0.0, "r_12a": 0.0, "r_12b": 0.0}
"""The ripple is a disturbance far above the drive train, no stiffness over the angle of the rotor."""

TWISTS = ("phi", "gamma")
"""What the twist of the teeth is called in the plants."""

MESSAGE = "omega_2_can"
"""Of the outputs, the speed whose mean over a cycle is in the messages."""


@cache
def motor_and_plant(plant: ContinuousBlock) -> ContinuousBlock:
    """Motor and plant as one continuous block; its input is that of the plant with T_ref for T_mot."""
    split = len(MOTOR.State._fields)
    motor_declared = {f"motor_{name}": declared for name, declared in MOTOR.State.__annotations__.items()}
    declared = motor_declared | plant.State.__annotations__
    State: Any = namedtuple("State", declared)
    State.__annotations__ = declared

    def parts(x: Any, u: Any) -> tuple[Any, Any, Any, Any]:
        x_motor, x_plant = MOTOR.State(*x[:split]), plant.State(*x[split:])
        u_motor = MOTOR.Input(T_ref=u.T_mot, omega_1=x_plant.omega_1)
        return x_motor, u_motor, x_plant, u._replace(T_mot=x_motor.T_mot)

    def start(u: Any, p: Any) -> Any:
        x_plant = plant.start(u, p[1])
        return State(*MOTOR.start(MOTOR.Input(u.T_mot, x_plant.omega_1), p[0]), *x_plant)

    def derivative(x: Any, u: Any, p: Any) -> Any:
        x_motor, u_motor, x_plant, u_plant = parts(x, u)
        return State(*MOTOR.derivative(x_motor, u_motor, p[0]), *plant.derivative(x_plant, u_plant, p[1]))

    def output(x: Any, u: Any, p: Any) -> Any:
        x_motor, u_motor, x_plant, u_plant = parts(x, u)
        return MOTOR.output(x_motor, u_motor, p[0]), plant.output(x_plant, u_plant, p[1])

    def event_indicators(x: Any, u: Any, p: Any) -> tuple[Any, ...]:
        x_motor, u_motor, x_plant, u_plant = parts(x, u)
        return (
            *MOTOR.event_indicators(x_motor, u_motor, p[0]),
            *plant.event_indicators(x_plant, u_plant, p[1]),
        )

    functions = {"start": start, "derivative": derivative, "output": output, "event_indicators": event_indicators}
    return replace(plant, State=State, **functions)


class LinearPlant(NamedTuple):
    """Motor and plant as dx/dt = A x + B T_ref, y = C x, deviations from a point.

    Attributes:
        A, B, C: matrices (n, n), (n,), (m, n).
        outputs: names of the rows of C: what motor and plant put out, and MESSAGE.
        y, dy: (m,), the outputs at the point, and how fast they change there.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    outputs: tuple[str, ...]
    y: np.ndarray
    dy: np.ndarray

    def rows(self, names: Sequence[str]) -> np.ndarray:
        """(k, n), some outputs over the state."""
        return self.C[[self.outputs.index(name) for name in names]]


def linear_plant(point: Point) -> LinearPlant:
    """Motor and plant at a point; the vehicle, which speeds up there, is taken as if it kept its speed."""
    return in_contact_and_gap(point)[0]


def in_contact_and_gap(point: Point) -> tuple[LinearPlant, LinearPlant]:
    """The same, and with the teeth in the middle of the gap, over the same states."""
    block = motor_and_plant(point.plant)
    ripple = {name: value for name, value in NO_RIPPLE.items() if name in point.plant.Parameters._fields}
    given = point.with_parameters(motor=NOISELESS, plant={"v_0": point.v, "T_0": point.T, **ripple})
    p, can = (given.of("motor", MOTOR), given.of("plant", point.plant)), given.of("can", CAN)
    u = point.plant.Input(T_mot=point.T)
    start = block.start(u, p)
    motor, plant = block.output(start, u, p)
    outputs = (*motor._fields, *plant._fields, MESSAGE)

    def derivative(values: Sequence[Any]) -> list[Any]:
        return numbers(block.derivative(like(start, values[:-1]), u._replace(T_mot=values[-1]), p))

    def output(values: Sequence[Any]) -> list[Any]:
        motor, plant = block.output(like(start, values), u, p)
        wheels = 0.5 * (plant.omega_wheel_L + plant.omega_wheel_R)
        return [*motor, *plant, can.g_w2 * can.i * wheels]

    n = len(numbers(start))
    places = [numbers(x) for x in (start, start._replace(**{twist: 0.0 for twist in TWISTS if twist in start._fields}))]
    AB = [rates(derivative, [*x, u.T_mot], range(n + 1)).mean for x in places]
    C = [rates(output, x, range(n)).mean for x in places]
    dx = np.array(derivative([*places[0], u.T_mot]))
    kept = _coupled(abs(AB[0]) + abs(AB[1]), abs(C[0]) + abs(C[1]))
    contact, gap = (
        LinearPlant(
            AB[k][np.ix_(kept, kept)], AB[k][kept, n], C[k][:, kept], outputs, np.array(output(places[k])), C[k] @ dx
        )
        for k in range(2)
    )
    return contact, gap


def _coupled(AB: np.ndarray, C: np.ndarray) -> np.ndarray:
    """The states that the input changes, be it over others, and that the outputs show, be it over others."""
    moves, n = AB != 0.0, len(AB)
    return np.flatnonzero(reached(moves[:, :n], moves[:, n]) & reached(moves[:, :n].T, (C != 0.0).any(axis=0)))
