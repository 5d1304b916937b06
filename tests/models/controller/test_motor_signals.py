"""The motor signals: each just good enough and just not, and what is used in its place."""

import math
from collections.abc import Iterable

import pytest

from driveline.models.controller import causes, motor_signals, torque_loop
from driveline.models.controller.causes import NONE, SPEED_FROZEN, SPEED_JUMP, SPEED_RANGE, TORQUE_IMPLAUSIBLE
from driveline.models.controller.motor_signals import MotorState
from driveline.models.controller.supervision import Input, Parameters
from driveline.models.controller.torque_loop import LoopState

P = Parameters(
    T_max=100.0, J_1=0.25, omega_max=500.0, t_bad=1.0, t_move=2.0, jump=0.4, q_omega=1.0, frozen=0.02, omega_still=3.0
)
T_S = 0.25
UNIT = 100.0
"""Speed in rad/s that T_max adds to the free motor in such a sample."""
U = Input(T_driver=50.0, omega_1_meas=150.0, T_mot_est=50.0)
NO_NUMBERS = [math.nan, math.inf, -math.inf]

each_side = pytest.mark.parametrize("side", [1.0, -1.0])


def above(limit: float) -> float:
    return math.nextafter(limit, math.inf)


def last(omega_1: float, **state: float) -> MotorState:
    """A state in which this was the motor speed of the last sample."""
    return motor_signals.start(U, P)._replace(omega_1=omega_1, **state)


def after(
    inputs: Iterable[Input], x: MotorState, increment: float = 0.0, T_ref: float = 50.0
) -> tuple[MotorState, int]:
    finding = NONE
    for u in inputs:
        x, finding = motor_signals.update(x, u, increment, T_ref, T_S, P)
    return x, finding


def test_a_signal_that_is_no_number_is_bridged_by_what_is_expected() -> None:
    for signal in NO_NUMBERS:
        x, finding = after([U._replace(omega_1_meas=signal)], last(150.0), increment=2.0)
        assert (x.omega_1, x.bad, finding) == (152.0, T_S, SPEED_RANGE)
        x, finding = after([U._replace(T_mot_est=signal)], last(151.0)._replace(loop=LoopState(48.0, 0.0)))
        assert (x.T_mot, x.bad, finding) == (48.0, T_S, TORQUE_IMPLAUSIBLE)


@each_side
def test_a_motor_speed_is_plausible_up_to_omega_max(side: float) -> None:
    for speed, finding in ((500.0, NONE), (above(500.0), SPEED_RANGE)):
        assert after([U._replace(omega_1_meas=side * speed)], last(side * 490.0))[1] == finding


@each_side
def test_a_speed_that_is_expected_for_long_stays_plausible(side: float) -> None:
    nothing = [U._replace(omega_1_meas=math.nan)] * 20
    assert after(nothing, last(side * 490.0), increment=side * 8.0)[0].omega_1 == side * 500.0


@each_side
def test_a_motor_torque_is_plausible_as_long_as_it_agrees_with_what_the_motor_should_have(side: float) -> None:
    limit = P.T_off * P.T_max + P.g_off * 40.0
    x = last(151.0)._replace(loop=LoopState(-40.0, 0.0))
    for distance, finding, T_mot in (
        (limit - 0.01, NONE, -40.0 + side * (limit - 0.01)),
        (limit + 0.01, TORQUE_IMPLAUSIBLE, -40.0),
    ):
        y, found = after([U._replace(T_mot_est=-40.0 + side * distance)], x)
        assert (found, y.T_mot) == (finding, T_mot)


def test_what_the_motor_should_have_follows_the_demand() -> None:
    assert after([U], last(151.0), T_ref=80.0)[0].loop == torque_loop.update(LoopState(50.0, 0.0), 80.0, T_S, P)


@each_side
def test_a_motor_speed_may_jump_by_jump_from_the_last_one_or_from_what_is_expected(side: float) -> None:
    most = P.jump * UNIT
    for increment in (0.0, side * 50.0):
        for jump, finding in ((most, NONE), (most + 1e-9, SPEED_JUMP)):
            u = U._replace(omega_1_meas=increment + side * jump)
            x, found = after([u], last(0.0), increment=increment)
            assert (found, x.omega_1) == (finding, increment + side * jump if finding == NONE else increment)
    assert after([U._replace(omega_1_meas=-side * most)], last(0.0), increment=side * 50.0)[1] == NONE


@each_side
def test_a_fast_change_may_go_on(side: float) -> None:
    """Wheels that lock take the motor along, and the model does not know: it is bad for a sample."""
    most = P.jump * UNIT
    x = last(0.0, received=side * 60.0, change=side * 60.0, bad=T_S)
    for change, finding in ((60.0 + most, NONE), (60.0 + most + 1e-9, SPEED_JUMP), (60.0 - most - 1e-9, SPEED_JUMP)):
        y, found = after([U._replace(omega_1_meas=side * (60.0 + change))], x)
        assert (found, y.change) == (finding, pytest.approx(side * change))
    back = last(side * 60.0, received=side * 60.0, change=side * 60.0, bad=0.0)
    assert after([U._replace(omega_1_meas=side * 120.0)], back)[1] == SPEED_JUMP, "nor one back from a spike"
    slow = last(-side * 60.0, received=side * 60.0, change=side * most, bad=T_S)
    assert after([U._replace(omega_1_meas=side * 90.0)], slow)[1] == SPEED_JUMP, "one that was not fast is none"


@each_side
def test_a_speed_that_has_jumped_and_stays_is_bad(side: float) -> None:
    x, findings = last(0.0, received=0.0), []
    for k in range(3):
        x, finding = after([U._replace(omega_1_meas=side * (60.0 + k))], x)
        findings.append(finding)
    assert findings == [SPEED_JUMP] * 3


def test_a_motor_speed_that_has_jumped_is_followed_after_t_bad() -> None:
    """It is bad for as long as it is not, and may then prove itself."""
    x, seen = last(0.0), []
    for k in range(7):
        x, _ = after([U._replace(omega_1_meas=300.0 + k)], x, increment=1.0)
        seen.append((x.omega_1, x.bad))
    assert seen == [(1.0, 0.25), (2.0, 0.5), (3.0, 0.75), (4.0, 1.0), (304.0, 1.25), (305.0, 0.0), (306.0, 0.0)]


@each_side
def test_a_motor_speed_is_frozen_that_should_have_moved(side: float) -> None:
    """By more than its resolution and the share of what the torque estimate may be off by; a car may cruise."""
    most = P.q_omega + P.frozen * UNIT
    for movement, finding in ((most, NONE), (above(most), SPEED_FROZEN)):
        x, found = after([U], last(150.0), increment=side * movement)
        assert (x.movement, found) == (side * movement, finding)
    assert after([U._replace(omega_1_meas=above(150.0))], last(150.0), increment=side * 10.0)[1] == NONE


@each_side
def test_a_motor_that_hardly_turns_is_not_frozen(side: float) -> None:
    for speed, finding in ((3.0, NONE), (above(3.0), SPEED_FROZEN)):
        assert after([U._replace(omega_1_meas=side * speed)], last(side * speed), increment=10.0)[1] == finding


def test_a_movement_that_the_model_expects_is_forgotten_in_t_move() -> None:
    """Or when the speed changes."""
    assert after([U], last(150.0, movement=1.0), increment=0.25)[0].movement == 0.875 + 0.25
    assert after([U._replace(omega_1_meas=151.0)], last(150.0, movement=1.0), increment=0.25)[0].movement == 0.0


def test_a_frozen_motor_speed_stays_so_until_it_changes() -> None:
    """In fallback the model follows it, and expects no movement."""
    x, finding = after([U] * 9, last(150.0, movement=9.0, bad=T_S))
    assert (finding, x.movement) == (SPEED_FROZEN, 9.0)
    x, finding = after([U._replace(omega_1_meas=151.0)], x)
    assert (finding, x.movement, x.bad) == (NONE, 0.0, 0.0)
    assert after([U._replace(omega_1_meas=151.0)], x)[1] == NONE, "two samples alike are no fault"


def test_what_is_found_first_is_what_the_table_has_first() -> None:
    order = [row.number for row in causes.FAILURES]
    assert order.index(SPEED_RANGE) < order.index(SPEED_JUMP) < order.index(TORQUE_IMPLAUSIBLE)
    assert after([U._replace(omega_1_meas=300.0, T_mot_est=math.nan)], last(150.0))[1] == SPEED_JUMP
    assert after([U._replace(omega_1_meas=math.nan, T_mot_est=math.nan)], last(150.0))[1] == SPEED_RANGE


def test_bad_signals_count_their_time_no_further_than_needed() -> None:
    bad = [U._replace(omega_1_meas=150.0 + k, T_mot_est=math.nan) for k in range(1, 9)]
    assert [after(bad[:n], last(150.0))[0].bad for n in (3, 4, 5, 8)] == [0.75, 1.0, 1.25, 1.25]


def test_at_the_start_all_that_is_in_range_is_believed() -> None:
    assert motor_signals.start(U, P) == MotorState(150.0, 150.0, 0.0, 0.0, 50.0, LoopState(50.0, 0.0), 0.0)
    x = motor_signals.start(Input(omega_1_meas=math.nan, T_mot_est=300.0), P)
    assert (x.omega_1, x.T_mot) == (0.0, 0.0)
    assert motor_signals.start(Input(T_mot_est=200.0), P).T_mot == 200.0, "twice T_max"
