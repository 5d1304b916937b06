"""The controllers that ours is compared with, each by its law."""

import math
from itertools import pairwise
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from driveline.models.comparators import (
    linear_observer,
    measured_speeds,
    no_damping,
    paper_observer,
    speed_difference,
    speed_washout,
    true_motion,
)
from driveline.models.comparators.fixed import NOT_LEARNED
from driveline.models.controller import T_S, supervision, torque_estimator
from driveline.models.controller.interfaces import Motion
from driveline.models.controller.supervision import Input, State
from driveline.models.physics.backlash import dead_zone
from fmublocks.block.declaration import without
from tests.models.controller.controllers import OURS, drive_inputs, run, shaken

LITERAL = {"lambda_v": 0.0, "L_T_l": 0.0, "L_can_T_l": 0.0, **paper_observer.NO_SLIP, **NOT_LEARNED}
UNSHAPED = {"t_land": 0.0, "shape_1": 0.0, "shape_2": 0.0}
"""Our law with neither landing nor shape."""


def torques(states: list[State]) -> list[float]:
    return [x.T_ref for x in states]


def test_without_damping_the_demand_is_passed_through() -> None:
    inputs = shaken(0.3)
    assert torques(run(no_damping.BLOCK, inputs))[1:] == [u.T_driver for u in inputs]


def washed_out(speeds: np.ndarray, **values: float) -> np.ndarray:
    """What the law opposes of a motor speed, over k_v; a value each sample."""
    p: Any = speed_washout.BLOCK.Parameters(k_v=1.0, **values)
    law = speed_washout.Washout()
    motions = [Motion(float(omega), float(omega), 0.0, 0.0, 0.0) for omega in speeds]
    x, opposed = law.start(motions[0], 0.0, p), []
    for motion in motions:
        x, addition = law.update(x, motion, motion, 0.0, T_S, p)
        opposed.append(-addition.damping)
    return np.array(opposed)


@pytest.mark.parametrize("frequency", [1.0, 4.0, 30.0])
@pytest.mark.parametrize(("omega_v", "zeta_v"), [(9.5, 0.373), (100.0, 2.0), (400.0, 10.0)])
def test_the_washout_has_the_response_of_second_order_that_it_states(
    frequency: float, omega_v: float, zeta_v: float
) -> None:
    """With frequencies as the trapezoidal rule warps them."""
    k = np.arange(20000)
    turning = np.exp(2j * np.pi * frequency * T_S * k)
    opposed = washed_out(np.imag(turning), omega_v=omega_v, zeta_v=zeta_v)
    found = 2j * np.mean((opposed / turning)[10000:])
    s = 2j / T_S * np.tan(np.pi * frequency * T_S)
    assert found == pytest.approx(s * s / (s * s + 2.0 * zeta_v * omega_v * s + omega_v**2), abs=1e-3)


def test_between_samples_measured_speeds_are_those_of_a_rigid_drive_train() -> None:
    """Whose gear torque is that of the motor; that of the wheels stays, and fades to that of the motor without it."""
    p = SimpleNamespace(J=2.0, t_fade=1.0, omega_max=500.0)
    x = measured_speeds.SpeedState(omega_1=100.0, omega_2=96.0, T_mot=10.0, share=0.5)
    for wheel, share in ((True, 0.75), (False, 0.25)):
        later = measured_speeds.predict(x, -40.0, wheel, 0.25, cast(Any, p))
        assert later == (95.0, 96.0, -40.0, share)
        assert measured_speeds.motion(later, cast(Any, p)) == Motion(95.0, 95.0 + share, 0.0, -40.0, -share)
    for side in (1.0, -1.0):
        fast = x._replace(omega_1=side * 499.0)
        for T_mot, omega_1 in ((8.0, 500.0), (8.1, 500.0), (7.0, 499.875)):
            assert measured_speeds.predict(fast, side * T_mot, True, 0.25, cast(Any, p)).omega_1 == side * omega_1


@pytest.mark.parametrize("omega_delta", [0.0, 20.0])
def test_the_speed_difference_is_that_to_the_wheel_speed_received_last(omega_delta: float) -> None:
    inputs, slow = shaken(0.4), 0.0
    received = inputs[0].omega_1_meas
    states = run(speed_difference.BLOCK, inputs, k_delta=1.5, omega_delta=omega_delta, swing=1.0)
    for x, before, u in zip(states[1:], [inputs[0], *inputs], inputs, strict=False):
        if u.counter != before.counter:
            received = u.omega_2_can
        changing = u.omega_1_meas - received - slow
        slow += omega_delta * T_S * changing
        assert x.T_damp == pytest.approx(-1.5 * changing, abs=1e-9)
    assert max(abs(x.T_damp) for x in states) > 5.0


def test_the_speed_difference_fades_in_with_the_first_valid_message() -> None:
    """A fiftieth more of it with each sample, so that no jump comes of it."""
    silent = drive_inputs(0.2, valid=False)
    states = run(speed_difference.BLOCK, [*silent, *(u._replace(counter=900 + u.counter) for u in shaken(0.3))])
    changes = [abs(b.T_damp - a.T_damp) for a, b in pairwise(states[100:])]
    assert {x.T_damp for x in states[:101]} == {0.0}
    assert max(changes[:3]) < 0.6


def test_the_gear_torque_that_it_estimates_is_washed_out() -> None:
    """That of the sample: what was expected, corrected by what came."""
    inputs = shaken(0.4)
    states = run(paper_observer.BLOCK, inputs, k_T=0.5, swing=1.0)
    p, slow = paper_observer.BLOCK.Parameters(k_T=0.5), states[0].law.washout
    every: Any = SimpleNamespace(**p._asdict() | LITERAL)
    for before, x, u in zip(states, states[1:], inputs, strict=False):
        e = torque_estimator.take_motor_speed(before.estimator, u.omega_1_meas, False, T_S, every)
        if x.wheel.silence == 0.0:
            e = torque_estimator.take_wheel_speed(e, u.omega_2_can, T_S, every)
        fed_back = 0.5 * p.C * dead_zone(e.estimate.phi, p.phi_B)
        assert x.T_damp == pytest.approx(slow - fed_back, abs=1e-9)
        slow += p.omega_w * T_S * (fed_back - slow)


def test_the_linear_observer_is_ours_without_a_gap_and_without_shape() -> None:
    """Where the gear torque is not fed back."""
    inputs, p = shaken(0.4), linear_observer.BLOCK.Parameters(k_T=0.0)
    states = run(linear_observer.BLOCK, inputs, k_T=0.0)
    same = {name: getattr(p, name) for name in ("k_d", "omega_w", "T_pred")}
    ours = run(OURS, inputs, phi_B=0.0, **UNSHAPED, **same)
    assert torques(states) == pytest.approx(torques(ours), abs=1e-9)
    for x in states:
        seen = linear_observer.BLOCK.output(x, inputs[0], p)
        assert seen.T_gear_hat == p.C * seen.phi_hat


@pytest.mark.parametrize(
    ("block", "names"),
    [
        (paper_observer.BLOCK, [*LITERAL, "k_d", "T_pred"]),
        (linear_observer.BLOCK, ["phi_B", *NOT_LEARNED]),
        (true_motion.BLOCK, ["L_phi", "Ls_phi", "L_can_phi", "T_age"]),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_what_is_fixed_cannot_be_set(block: Any, names: Any) -> None:
    assert not set(names) & set(block.Parameters._fields)


def informed(inputs: list[Input], **truth: float) -> list[Any]:
    """Inputs of TrueMotion, for which the motor turns faster and faster than the wheels."""
    motion_of_plant = {"omega_1": 150.0, "omega_2": 140.0, "phi": 0.5, "T_gear": 40.0} | truth
    return [true_motion.BLOCK.Input(*u)._replace(**motion_of_plant) for u in inputs]


def test_perfect_signals_are_fed_back_as_they_are() -> None:
    states = run(true_motion.BLOCK, informed(shaken(0.1)), T_pred=0.0, k_d=1.0, omega_w=0.0)
    assert [x.T_damp for x in states[1:]] == pytest.approx([-10.0] * 50, abs=1e-9)


def test_what_is_measured_changes_nothing_of_what_perfect_signals_damp() -> None:
    calm, noisy = (run(true_motion.BLOCK, informed(inputs)) for inputs in (drive_inputs(0.2), shaken(0.2)))
    assert torques(calm) == torques(noisy)


def test_in_the_gap_the_twist_is_the_true_one_and_beyond_it_that_of_the_gear_torque() -> None:
    p = true_motion.BLOCK.Parameters()
    e = true_motion.MODEL.start(150.0, 50.0, False, p)
    for phi, T_gear, expected in ((0.1, 0.0, 0.1), (0.9, 11.74, p.phi_B + 0.1), (-0.9, -11.74, -p.phi_B - 0.1)):
        (u,) = informed([Input()], phi=phi, T_gear=T_gear)
        motion = true_motion.MODEL.motion(true_motion.with_true_motion(e, u, p), p)
        assert motion.phi == pytest.approx(expected, rel=1e-12)
        assert motion.T_gear == pytest.approx(T_gear, rel=1e-12)


@pytest.mark.parametrize("name", ["omega_1", "omega_2", "phi", "T_gear"])
@pytest.mark.parametrize("value", [math.nan, math.inf, -1e308])
def test_a_truth_that_is_none_ends_in_no_torque_that_is_none(name: str, value: float) -> None:
    for x in run(true_motion.BLOCK, informed(shaken(0.05), **{name: value})):
        assert abs(x.T_damp) <= supervision.Parameters().T_take_max


def test_only_what_is_declared_can_be_left_out() -> None:
    with pytest.raises(TypeError, match="has no field J_3"):
        without(supervision.Parameters, ["T_max", "J_3"])
    assert "T_max" not in without(supervision.Parameters, ["T_max"])._fields
