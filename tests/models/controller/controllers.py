"""The controller of the project, another one from two other parts, and what they are given."""

import math
from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import strategies as st

from driveline.models import damping_controller
from driveline.models.block.declaration import with_defaults
from driveline.models.block.types import SampledBlock
from driveline.models.comparators import speed_washout
from driveline.models.controller.supervision import T_S, Input, State

OURS = damping_controller.BLOCK
OTHER = replace(
    speed_washout.BLOCK, Parameters=with_defaults(speed_washout.BLOCK.Parameters, {"k_v": 2.0, "omega_v": 25.0})
)
"""With gains of its own, whatever the search finds."""
EVERY = (OURS, OTHER)

every_controller = pytest.mark.parametrize("block", EVERY, ids=lambda block: block.name)

ROLLING = Input(T_driver=50.0, omega_1_meas=150.0, T_mot_est=50.0, omega_2_can=150.0, valid=True, counter=0)
ABSURD = [math.nan, math.inf, -math.inf, 1e308, -1e308, 1e9, -3e3]

any_signal = st.one_of(st.floats(allow_nan=True, allow_infinity=True), st.floats(-300.0, 300.0))
any_input = st.builds(
    Input,
    T_driver=any_signal,
    omega_1_meas=any_signal,
    T_mot_est=any_signal,
    omega_2_can=any_signal,
    valid=st.booleans(),
    counter=st.integers(-(2**31), 2**31 - 1),
    enable=st.booleans(),
)


def run(block: SampledBlock, inputs: Iterable[Input], **parameters: float) -> list[State]:
    """States: that of the start, and after each input."""
    inputs, p = list(inputs), block.Parameters(**parameters)
    states = [block.start(inputs[0], p)]
    for u in inputs:
        states.append(block.update(states[-1], u, p))
    return states


def run_with_motor(block: SampledBlock, inputs: Iterable[Input], **parameters: float) -> list[State]:
    """As `run`, but the motor has the torque that is demanded of it."""
    inputs, p = list(inputs), block.Parameters(**parameters)
    states = [block.start(inputs[0], p)]
    for u in inputs:
        states.append(block.update(states[-1], u._replace(T_mot_est=states[-1].monitor.loop.T_mot), p))
    return states


def drive_inputs(seconds: float, **changes: Any) -> list[Input]:
    """A vehicle that speeds up evenly, a message every 20 ms; the motor signals are never the same twice."""
    inputs, oldest = [], OURS.Parameters().T_age
    for k in range(round(seconds / T_S)):
        omega = 150.0 + 2.0 * k * T_S + 0.05 * (-1.0) ** k
        wheels = 150.0 + 2.0 * (k * T_S - oldest - k % 10 * T_S)
        u = ROLLING._replace(
            omega_1_meas=omega, T_mot_est=50.0 + 0.1 * (-1.0) ** k, omega_2_can=wheels, counter=k // 10
        )
        inputs.append(u._replace(**changes))
    return inputs


def shaken(seconds: float, **changes: Any) -> list[Input]:
    """The drive train swings at 8 Hz, so that the damping torque is large."""
    swing = [6.0 * math.sin(2.0 * math.pi * 8.0 * k * T_S) for k in range(round(seconds / T_S))]
    pairs = zip(drive_inputs(seconds, **changes), swing, strict=True)
    return [u._replace(omega_1_meas=u.omega_1_meas + a) for u, a in pairs]


def bump(states: list[State]) -> float:
    """Largest change of T_ref in N.m from one sample to the next."""
    return max(abs(b.T_ref - a.T_ref) for a, b in pairwise(states))
