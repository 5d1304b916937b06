"""The controller of the project, another one from two other parts, and what they are given."""

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import Annotated, Any, NamedTuple

import pytest
from hypothesis import strategies as st

from driveline.models import damping_controller
from driveline.models.comparators import measured_speeds
from driveline.models.controller import T_S
from driveline.models.controller.damping_law import washed_out
from driveline.models.controller.interfaces import Addition, Motion
from driveline.models.controller.supervised_controller import supervised
from driveline.models.controller.supervision import Input, State
from fmublocks.block.declaration import Real
from fmublocks.block.types import SampledBlock

OURS = damping_controller.BLOCK


class WashoutParameters(NamedTuple):
    k_v: Annotated[float, Real("N.m.s/rad", "damping over the motor speed", 0.0, 20.0)] = 2.0
    omega_v: Annotated[float, Real("rad/s", "corner frequency of the washout", 0.0, 400.0)] = 25.0


class WashoutState(NamedTuple):
    slow: Annotated[float, Real("rad/s", "part of the motor speed that does not change")]


class Washout:
    """The plainest law: T_damp = -k_v s/(s + omega_v) omega_1."""

    Parameters = WashoutParameters

    def start(self, motion: Motion, T_driver: float, p: WashoutParameters) -> WashoutState:
        return WashoutState(motion.omega_1)

    def update(
        self, x: WashoutState, motion: Motion, expected: Any, T_driver: float, T_s: float, p: WashoutParameters
    ) -> tuple[WashoutState, Addition]:
        slow = washed_out(x.slow, motion.omega_1, p.omega_v, T_s)
        return WashoutState(slow), Addition(damping=-p.k_v * (motion.omega_1 - x.slow), landing=0.0)


OTHER = supervised("PlainWashout", "with the plainest law", __name__, measured_speeds, Washout())
EVERY = (OURS, OTHER)

every_controller = pytest.mark.parametrize("block", EVERY, ids=lambda block: block.name)

ROLLING = Input(T_driver=50.0, omega_1_meas=150.0, T_mot_est=50.0, omega_2_can=150.0, valid=True, counter=0)
ABSURD = [math.nan, math.inf, -math.inf, 1e308, -1e308, 1e9, -3e3]

each_side = pytest.mark.parametrize("side", [1.0, -1.0])

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
    alive=st.integers(-(2**31), 2**31 - 1),
    slip_control=st.booleans(),
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
        states.append(block.update(states[-1], u._replace(T_mot_est=states[-1].motor.loop.T_mot), p))
    return states


def above(limit: float) -> float:
    """The next number."""
    return math.nextafter(limit, math.inf)


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
