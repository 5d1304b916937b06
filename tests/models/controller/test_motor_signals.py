"""The motor signals: each just good enough and just not, and what is used in its place."""

import math
from collections.abc import Iterable

import pytest

from driveline.models.controller import motor_signals
from driveline.models.controller.causes import FRAME_LATE, SPEED_FROZEN, SPEED_JUMP, SPEED_RANGE, TORQUE_IMPLAUSIBLE
from driveline.models.controller.motor_signals import MotorState
from driveline.models.controller.supervision import Input, Parameters
from driveline.models.controller.torque_loop import LoopState
from tests.models.controller.controllers import above, each_side

P = Parameters(T_max=100.0, J_1=0.25, omega_max=500.0, t_move=2.0, jump=0.4, q_omega=1.0, frozen=0.02, omega_still=3.0)
T_S = 0.25
UNIT = 100.0
"""Speed in rad/s that T_max adds to the free motor in such a sample."""
LOOP = LoopState(7.0, 3.0)
"""What the motor should have next."""

U = Input(T_driver=50.0, omega_1_meas=150.0, T_mot_est=50.0)
NO_NUMBERS = [math.nan, math.inf, -math.inf]


def with_speed(omega_1: float) -> Input:
    return U._replace(omega_1_meas=omega_1)


def last(omega_1: float, **state: float) -> MotorState:
    """A state in which this was the motor speed of the last sample."""
    return motor_signals.start(with_speed(omega_1), P)._replace(**state)


def updated(
    u: Input, x: MotorState, increment: float = 0.0, trusted: bool = True
) -> tuple[MotorState, float, list[int]]:
    """The state after a sample, the speed that is used, and what is found; the model expects so much more speed."""
    x, used, found = motor_signals.update(x, u, x.omega_1 + increment, trusted, T_S, P)
    return x, used, [number for number, wrong in found.items() if wrong]


def after(
    speeds: Iterable[float], x: MotorState, increment: float = 0.0, trusted: bool = True
) -> tuple[list[float], list[list[int]]]:
    """The speeds used in samples with these measured, and what is found in each; the model goes on from those used."""
    expected, seen, findings = x.omega_1 + increment, [], []
    for omega_1 in speeds:
        x, used, found = updated(with_speed(omega_1), x, expected - x.omega_1, trusted)
        expected = used + increment
        seen.append(used)
        findings.append(found)
    return seen, findings


def test_a_signal_that_is_no_number_is_bridged_by_what_is_expected() -> None:
    for signal in NO_NUMBERS:
        x, used, found = updated(with_speed(signal), last(150.0), increment=2.0)
        assert (x.omega_1, x.received, used, found) == (152.0, 152.0, 152.0, [SPEED_RANGE])
        u, x = U._replace(T_mot_est=signal), last(151.0)._replace(loop=LoopState(48.0, 0.0))
        assert updated(u, x)[2] == [TORQUE_IMPLAUSIBLE]
        assert motor_signals.torque(x, signal, P) == 48.0


@each_side
def test_a_motor_speed_is_plausible_up_to_omega_max(side: float) -> None:
    """But for one that gets there step by step, as wheels that spin take it along."""
    for speed, before, used, found in (
        (500.0, 459.0, 459.0, [SPEED_JUMP]),
        (above(500.0), 459.0, 459.0, [SPEED_RANGE]),
        (530.0, 490.0, 530.0, []),
        (above(530.0), 490.0, 490.0, [SPEED_RANGE]),
    ):
        assert updated(with_speed(side * speed), last(side * before))[1:] == (side * used, found)


@each_side
def test_a_motor_torque_is_plausible_as_long_as_it_agrees_with_what_the_motor_should_have(side: float) -> None:
    limit = P.T_off * P.T_max + P.g_off * 40.0
    x = last(151.0)._replace(loop=LoopState(-40.0, 0.0))
    for distance, found, T_mot in (
        (limit - 0.01, [], -40.0 + side * (limit - 0.01)),
        (limit + 0.01, [TORQUE_IMPLAUSIBLE], -40.0),
    ):
        T_mot_est = -40.0 + side * distance
        assert updated(U._replace(T_mot_est=T_mot_est), x)[2] == found
        assert motor_signals.torque(x, T_mot_est, P) == T_mot


@each_side
def test_a_motor_speed_may_jump_by_jump_from_the_last_one_or_from_what_is_expected(side: float) -> None:
    most = P.jump * UNIT
    for increment in (0.0, side * 50.0):
        jumped = increment + side * most
        assert updated(with_speed(jumped), last(0.0), increment)[1:] == (jumped, [])
        jumped = increment + side * (most + 1e-9)
        x, used, found = updated(with_speed(jumped), last(0.0), increment)
        assert (used, found) == (increment, [SPEED_JUMP])
        assert (x.omega_1, x.received, x.change) == (increment, jumped, jumped)
    for jump, found in ((most, []), (most + 1e-9, [SPEED_JUMP])):
        assert updated(with_speed(-side * jump), last(0.0), increment=side * 50.0)[2] == found


@each_side
def test_a_fast_change_may_go_on(side: float) -> None:
    """Wheels that lock take the motor along, and the model does not know: it is bad for a sample."""
    most = P.jump * UNIT
    x = last(0.0, received=side * 60.0, change=side * 60.0)
    for change, found in (
        (60.0 + most, []),
        (60.0 + most + 1e-9, [SPEED_JUMP]),
        (60.0 - most, []),
        (60.0 - most - 1e-9, [SPEED_JUMP]),
    ):
        omega_1 = side * (60.0 + change)
        y, used, findings = updated(with_speed(omega_1), x)
        assert findings == found
        assert (y.omega_1, y.received, y.change) == (used, omega_1, omega_1 - side * 60.0)
        assert used == (0.0 if found else omega_1)
    used_last = last(side * 60.0, change=side * 60.0)
    assert updated(with_speed(side * 120.0), used_last)[2] == [SPEED_JUMP], "nor one whose beginning was used"
    for change, found in ((most, [SPEED_JUMP]), (above(most), [])):
        slow = last(0.0, received=side * 60.0, change=side * change)
        assert updated(with_speed(side * (60.0 + most)), slow)[2] == found, "one that was not fast is none"


COURSES = {
    "a fast change that goes on is never bad for two": (
        *(0.0, [60.0 * k for k in range(1, 7)], [0.0, 120.0, 120.0, 240.0, 240.0, 360.0]),
        [[SPEED_JUMP], []] * 3,
    ),
    "spikes of alternating sign are not taken": (
        *(0.5, [(-1.0) ** k * 60.0 for k in range(6)], [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]),
        [[SPEED_JUMP]] * 6,
    ),
    "a spike says nothing of the speed after it": (
        *(0.0, [60.0, 1.0, 60.0, 2.0], [0.0, 1.0, 1.0, 2.0]),
        [[SPEED_JUMP], []] * 2,
    ),
    "a speed that has jumped and stays is bad": (0.0, [60.0, 61.0, 62.0], [0.0] * 3, [[SPEED_JUMP]] * 3),
    "a step that the car's own motion makes up for is still one": (
        *(25.0, [25.0 * k - 80.0 for k in range(1, 8)], [25.0 * k for k in range(1, 8)]),
        [[SPEED_JUMP]] * 7,
    ),
}


@each_side
@pytest.mark.parametrize(("increment", "speeds", "used", "found"), COURSES.values(), ids=COURSES)
def test_a_fast_change_is_told_from_spikes_and_steps(
    increment: float, speeds: list[float], used: list[float], found: list[list[int]], side: float
) -> None:
    seen = after([side * omega_1 for omega_1 in speeds], last(0.0), side * increment)
    assert seen == ([side * omega_1 for omega_1 in used], found)


def test_a_motor_speed_that_has_jumped_is_followed_once_it_is_not_trusted() -> None:
    """It is bad for as long as it is not, and may then prove itself."""
    x, seen = last(0.0), []
    expected = 1.0
    for k in range(7):
        x, used, found = updated(with_speed(300.0 + k), x, expected - x.omega_1, trusted=k < 4)
        expected = used + 1.0
        seen.append((used, bool(found)))
    assert seen == [*((1.0 + k, True) for k in range(4)), (304.0, True), (305.0, False), (306.0, False)]


def test_a_speed_out_of_range_is_not_followed_without_trust_either() -> None:
    assert updated(with_speed(above(500.0)), last(150.0), increment=2.0, trusted=False)[1:] == (152.0, [SPEED_RANGE])


@each_side
def test_a_motor_speed_is_frozen_that_should_have_moved(side: float) -> None:
    """By more than its resolution and the share of what the torque estimate may be off by; a car may cruise."""
    most = P.q_omega + P.frozen * UNIT
    for movement, found in ((most, []), (above(most), [SPEED_FROZEN])):
        x, used, findings = updated(U, last(150.0, movement=side * movement))
        assert (x.movement, used, findings) == (side * movement, 150.0, found)
    x, _, found = updated(with_speed(above(150.0)), last(150.0, movement=side * 10.0))
    assert (x.movement, found) == (0.0, [])


@each_side
def test_a_motor_that_hardly_turns_is_not_frozen(side: float) -> None:
    for speed, found in ((3.0, []), (above(3.0), [SPEED_FROZEN])):
        assert updated(with_speed(side * speed), last(side * speed, movement=10.0))[2] == found


@each_side
def test_a_movement_that_the_model_expects_is_forgotten_in_t_move(side: float) -> None:
    """Or when the speed changes."""
    x = motor_signals.predict(last(150.0, movement=side), LOOP, side * 0.25, T_S, P)
    assert x == last(150.0, movement=side * (0.875 + 0.25))._replace(loop=LOOP)
    assert updated(U, x)[0].movement == side * 1.125
    assert updated(with_speed(151.0), x)[0].movement == 0.0


@each_side
def test_a_movement_that_is_one_stays_one(side: float) -> None:
    """Without trust the model follows a frozen speed, and expects none."""
    most = P.q_omega + P.frozen * UNIT
    for movement, later in ((most, 0.875 * most - 1.0), (above(most), above(most))):
        x = last(150.0, movement=side * movement)
        assert motor_signals.predict(x, LOOP, -side, T_S, P).movement == side * later


def test_a_frozen_motor_speed_stays_so_until_it_changes() -> None:
    x = last(150.0, movement=9.0)
    for _ in range(9):
        x, _, found = updated(U, x, trusted=False)
        assert (found, x.movement) == ([SPEED_FROZEN], 9.0)
        x = motor_signals.predict(x, x.loop, 0.0, T_S, P)
    x, _, found = updated(with_speed(151.0), x, trusted=False)
    assert (found, x.movement) == ([], 0.0)
    assert updated(with_speed(151.0), x, trusted=False)[2] == [], "two samples alike are no fault"


def test_at_the_start_all_that_is_in_range_is_believed() -> None:
    assert motor_signals.start(U, P) == MotorState(-1.0, 0.0, 150.0, 150.0, 0.0, 0.0, LoopState(50.0, 0.0))
    x = motor_signals.start(Input(omega_1_meas=math.nan, T_mot_est=300.0), P)
    assert x == MotorState(-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, LoopState(0.0, 0.0))
    for T_mot_est, T_mot in ((200.0, 200.0), (above(200.0), 0.0)):
        assert motor_signals.start(Input(T_mot_est=T_mot_est), P).loop.T_mot == T_mot, "twice T_max"


def ages(counters: Iterable[int], p: Parameters = P, samples_of_frame: int = 1) -> list[float]:
    """Of the frame with these counters in samples, from the second one on, to the hundredth."""
    first, *others = counters
    p = p._replace(T_frame=samples_of_frame * T_S)
    x, found = motor_signals.start(U._replace(alive=first), p), []
    for counter in others:
        x, _, _ = motor_signals.update(x, U._replace(alive=counter), 150.0, True, T_S, p)
        found.append(round(x.age / T_S, 2))
    return found


def test_a_frame_is_as_old_as_its_counter_is_behind_the_time() -> None:
    assert ages([5, 5, 6, 7, 8]) == [0.0] * 4, "the sample of the start is made again"
    assert ages([5, 5, 5, 5, 6, 7, 9, 11]) == [0.0, 1.0, 2.0, 2.0, 2.0, 1.0, 0.0], "late, and made up for"
    assert ages([9, 9, 7, 8, 9]) == [0.0, 3.0, 3.0, 3.0], "as one that is late from now on"
    assert ages([9, 9, 10, 1, 2]) == [0.0] * 4, "a second and more: counted anew"
    assert ages([0, 0, 0, 7, 8, 0, 9]) == [0.0] * 6, "not counted"
    assert ages([5, 5, 5, 5, 6, 6, 6, 7], samples_of_frame=3) == [0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 0.0]


def test_an_age_is_forgotten_as_two_clocks_part() -> None:
    x = motor_signals.start(U._replace(alive=1), P)._replace(alive=1.0, age=0.5)
    x, _, _ = motor_signals.update(x, U._replace(alive=2), 150.0, True, P.T_frame, P)
    assert x.age == pytest.approx(0.5 - motor_signals.DRIFT * P.T_frame, abs=1e-15)


def test_a_frame_that_is_not_new_is_what_is_expected_and_late_after_t_bad() -> None:
    p = P._replace(t_bad=3.0 * T_S, T_frame=T_S)
    x = motor_signals.start(U._replace(alive=3), p)._replace(alive=3.0, loop=LOOP)
    for counter, omega_1, T_mot in ((3, 160.0, 7.0), (4, 150.0, 50.0), (0, 150.0, 50.0)):
        u = motor_signals.filled(x, U._replace(alive=counter), 160.0)
        assert (u.omega_1_meas, u.T_mot_est) == (omega_1, T_mot)
    late = []
    for _ in range(4):
        x, _, found = motor_signals.update(x, U._replace(alive=3, T_mot_est=7.0), 150.0, True, T_S, p)
        late.append(found[FRAME_LATE])
    assert late == [False, False, False, True]
