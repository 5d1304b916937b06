"""The wheel monitor: messages just good enough and just not, to correct the estimate and as a reference."""

import math
from typing import Any

import pytest

from driveline.models.controller import launch_direction
from driveline.models.controller import wheel_monitor as wheels
from driveline.models.controller.launch_direction import LaunchState
from driveline.models.controller.supervision import Input, Parameters
from driveline.models.controller.wheel_monitor import LEAP, SHARE, WheelState

P = Parameters(omega_max=500.0, omega_still=3.0, e_max=40.0, e_wheel=16.0, t_stale=1.0, t_apart=1.0)
T_S = 0.25
ROLLING = 0.1
"""Of the wheel monitor, by its number: a test has to fail when it changes."""
U = Input(omega_1_meas=150.0, omega_2_can=150.0, valid=True, counter=7)
UNKNOWN = launch_direction.start()
NO_NUMBERS = [math.nan, math.inf, -math.inf]

each_side = pytest.mark.parametrize("side", [1.0, -1.0])


def above(limit: float) -> float:
    return math.nextafter(limit, math.inf)


def updated(
    u: Input,
    x: WheelState | None = None,
    omega_1: float = 150.0,
    omega_2_hat: float = 150.0,
    T_mot: float = 0.0,
    launch: LaunchState = UNKNOWN,
) -> WheelState:
    """The state after a sample."""
    x = wheels.start(U, 150.0, 0.0, P) if x is None else x
    return wheels.update(x, u, omega_1, T_mot, 0.0, launch, omega_2_hat, T_S, P)


def new(omega_2_can: float = 150.0, **signals: Any) -> Input:
    return U._replace(omega_2_can=omega_2_can, counter=8)._replace(**signals)


def test_what_is_no_number_says_no_speed() -> None:
    for signal in NO_NUMBERS:
        assert wheels.message(U._replace(omega_2_can=signal)) == 0.0
        assert not wheels.has_wheel_speed(U._replace(omega_2_can=signal), P)
        x = updated(new(signal), omega_2_hat=0.0)
        assert (x.omega_2, x.usable, x.reference_valid, x.silence) == (150.0, False, False, T_S)


@each_side
def test_a_wheel_speed_is_plausible_up_to_omega_max(side: float) -> None:
    assert wheels.has_wheel_speed(U._replace(omega_2_can=side * 500.0), P)
    assert not wheels.has_wheel_speed(U._replace(omega_2_can=side * above(500.0)), P)
    assert not wheels.has_wheel_speed(U._replace(valid=False), P)


@each_side
def test_standing_wheels_say_no_speed(side: float) -> None:
    """They tell no direction, and a bus with a lowest speed does not call them valid."""
    assert not wheels.has_wheel_speed(U._replace(omega_2_can=side * 3.0), P)
    assert wheels.has_wheel_speed(U._replace(omega_2_can=side * above(3.0)), P)


@each_side
def test_a_message_is_usable_up_to_e_max_from_the_estimate(side: float) -> None:
    assert updated(new(), omega_2_hat=150.0 + side * 40.0).usable
    assert not updated(new(), omega_2_hat=150.0 + side * 40.01).usable


def test_a_doubted_message_is_not_usable_however_near_the_estimate() -> None:
    x = updated(new(200.0), omega_2_hat=200.0)
    assert (x.implausible, x.usable) == (True, False)


def test_a_message_is_usable_once_and_while_it_is_valid() -> None:
    assert not updated(U).usable, "it was there at the start"
    for counter in (6, 8, -(2**31)):
        assert updated(new(counter=counter)).usable
        assert not updated(new(counter=counter, valid=False)).usable
        assert not updated(new(counter=counter), updated(new(counter=counter))).usable


def test_the_wheel_speed_is_in_use_while_usable_messages_keep_coming() -> None:
    """For less than t_stale without one, and while it is valid."""
    x, seen = wheels.start(U, 150.0, 0.0, P), []
    for _ in range(6):
        seen.append((x.unused, wheels.wheel_speed_in_use(x, U, P)))
        x = updated(U, x)
    assert seen == [(0.0, True), (0.25, True), (0.5, True), (0.75, True), (1.0, False), (1.0, False)]
    assert updated(new(), x).unused == 0.0
    assert not wheels.wheel_speed_in_use(wheels.start(U, 150.0, 0.0, P), U._replace(valid=False), P)


def test_messages_are_a_reference_while_they_keep_coming() -> None:
    """For less than t_stale without one, and while they are valid; be they near the estimate or not."""
    x, seen = updated(new(), omega_2_hat=0.0), []
    for _ in range(6):
        seen.append((x.silence, x.reference_valid))
        x = updated(new(), x)
    assert seen == [(0.0, True), (0.25, True), (0.5, True), (0.75, True), (1.0, False), (1.0, False)]
    assert not updated(new(valid=False)).reference_valid


@each_side
def test_messages_that_leap_while_the_motor_speed_does_not_are_doubted(side: float) -> None:
    """Until one is near the motor speed again."""
    nearest = LEAP + SHARE * 150.0
    x = updated(new(150.0 + side * 20.0), omega_1=150.0 - side * 40.0)
    assert (x.implausible, x.reference_valid, x.mismatch_time) == (False, True, T_S)
    x = updated(new(150.0 + side * 20.1), omega_1=150.0 - side * 40.0)
    assert (x.implausible, x.reference_valid, x.mismatch_time) == (True, False, 0.0)
    stays = updated(new(counter=9), x, omega_1=150.0 + side * (nearest + 0.1))
    assert (stays.implausible, stays.reference_valid) == (True, False)
    back = updated(new(counter=10), stays, omega_1=150.0 + side * (nearest - 0.1))
    assert (back.implausible, back.reference_valid) == (False, True)


@each_side
def test_messages_that_follow_the_motor_speed_are_believed(side: float) -> None:
    """Up to LEAP from where it went, for a contradiction needs more."""
    start = wheels.start(new(300.0, counter=7), 150.0, 0.0, P)
    for moved, implausible in ((20.0, False), (19.9, True)):
        x = updated(new(300.0 + side * 40.0), start, omega_1=150.0 + side * moved)
        assert (x.implausible, x.reference_valid) == (implausible, not implausible)
        assert x.late_then == 150.0 + side * moved, "from the next message on it counts from here"


def test_messages_that_drift_away_are_believed() -> None:
    x = updated(new(168.0), omega_2_hat=100.0, omega_1=110.0)
    assert (x.usable, x.implausible, x.reference_valid) == (False, False, True)


def test_the_first_message_after_silence_has_not_leapt() -> None:
    assert updated(new(250.0)).implausible
    silent = wheels.start(U._replace(valid=False), 150.0, 0.0, P)
    assert not updated(new(250.0), silent).implausible


def test_a_speed_without_a_message_is_not_heard() -> None:
    assert updated(U._replace(omega_2_can=250.0)).omega_2 == 150.0
    assert updated(new(250.0), updated(U._replace(omega_2_can=250.0))).implausible, "it has leapt all the same"


def test_no_message_no_leap() -> None:
    assert not updated(U._replace(omega_2_can=250.0)).implausible
    assert not updated(new(250.0, valid=False)).implausible


def test_the_motor_speed_is_held_back_to_be_as_late_as_the_messages() -> None:
    x = wheels.update(wheels.start(U, 150.0, 0.0, P), U, 250.0, 0.0, 0.0, UNKNOWN, 150.0, 0.00625, P)
    assert x.late == 175.0
    assert updated(U, omega_1=250.0).late == 250.0, "with samples that are longer than that"


@each_side
def test_a_motor_speed_is_contradicted_from_e_wheel_and_a_share_of_the_wheel_speed_on(side: float) -> None:
    u = new(200.0)
    forwards = wheels.start(new(200.0, counter=7), 200.0, 0.0, P)
    limit = P.e_wheel + SHARE * 200.0
    for distance, mismatch_time in ((limit - 0.01, 0.0), (limit + 0.01, T_S)):
        assert updated(u, forwards, omega_1=200.0 + side * distance).mismatch_time == mismatch_time
    backwards = wheels.start(new(200.0, counter=7), -200.0, 0.0, P)
    for distance, mismatch_time in ((limit - 0.01, 0.0), (limit + 0.01, T_S)):
        assert updated(u, backwards, omega_1=-200.0 + side * distance).mismatch_time == mismatch_time


@each_side
def test_a_message_contradicts_neither_the_motor_speed_of_now_nor_that_of_when_it_came(side: float) -> None:
    """Wheels that lock take the motor far from the last message before the next one comes."""
    limit = P.e_wheel + SHARE * 200.0
    x = wheels.start(new(200.0, counter=7), 200.0, 0.0, P)
    moved = updated(new(200.0, counter=7), x, omega_1=200.0 + side * (limit + 0.01))
    assert (moved.late, moved.late_then, moved.mismatch_time) == (200.0 + side * (limit + 0.01), 200.0, 0.0)
    repeated = updated(new(200.0), moved, omega_1=moved.late)
    assert (repeated.late_then, repeated.mismatch_time) == (moved.late, T_S)
    assert updated(new(200.0), repeated, omega_1=200.0 + side * (limit - 0.01)).mismatch_time == 0.0


@pytest.mark.parametrize("sent", [60.0, -60.0])
def test_the_direction_is_that_of_the_motor_when_the_speed_becomes_known(sent: float) -> None:
    """Whether the bus sends a sign or not; the motor may turn round no more while it is known."""
    standing = wheels.start(U._replace(valid=False), 0.0, 0.0, P)
    x = updated(new(sent), standing, omega_1=-60.0, omega_2_hat=-60.0)
    assert (x.direction, x.omega_2, x.usable) == (-1.0, -60.0, True)
    assert updated(new(sent), x, omega_1=60.0).omega_2 == -60.0
    for silence, speed in ((P.t_stale, 60.0), (math.nextafter(P.t_stale, 0.0), -60.0)):
        silent = x._replace(silence=silence)
        assert updated(new(sent, counter=9), silent, omega_1=60.0).omega_2 == speed
    for omega_1, direction in ((-3.0, 1.0), (-above(3.0), -1.0)):
        assert wheels.direction_of(omega_1, 0.0, 0.0, UNKNOWN, P) == direction


def test_messages_in_doubt_take_their_direction_from_the_motor_again() -> None:
    x = updated(new(60.0), wheels.start(new(60.0, counter=7), -60.0, 0.0, P), omega_1=-60.0)
    x = updated(new(100.0, counter=9), x, omega_1=-60.0)
    assert (x.omega_2, x.implausible) == (-100.0, True)
    x = updated(new(100.0, counter=10), x, omega_1=100.0, omega_2_hat=100.0)
    assert (x.omega_2, x.usable, x.reference_valid) == (100.0, True, True)


def test_no_car_rolls_backwards_against_a_quarter_of_the_torque() -> None:
    p = P._replace(T_max=100.0)
    assert wheels.direction_of(-60.0, 25.0, 0.0, UNKNOWN, p) == 1.0
    assert wheels.direction_of(-60.0, math.nextafter(25.0, 0.0), 0.0, UNKNOWN, p) == -1.0
    x = wheels.start(U._replace(valid=False), 0.0, 0.0, P)
    assert updated(new(60.0), x, omega_1=-60.0, T_mot=180.0).omega_2 == 60.0
    assert wheels.start(U, -60.0, 180.0, P).direction == 1.0


def test_a_car_that_was_seen_to_roll_back_does_so_under_any_torque() -> None:
    """Not one whose motor has only crossed the gap."""
    x = wheels.start(U._replace(valid=False), 0.0, 0.0, P)
    for rolling, direction in ((math.nextafter(ROLLING, 0.0), 1.0), (ROLLING, -1.0)):
        assert wheels.direction_of(-60.0, 180.0, rolling, UNKNOWN, P) == direction
        y = updated(new(60.0), x._replace(rolling=rolling), omega_1=-60.0, T_mot=180.0, omega_2_hat=-60.0)
        assert (y.direction, y.omega_2, y.rolling) == (direction, direction * 60.0, rolling)
    assert wheels.direction_of(-3.0, 180.0, ROLLING, UNKNOWN, P) == 1.0


def test_a_motor_that_has_set_off_with_its_torque_is_believed_under_any_torque() -> None:
    """It was pushed too little to hold the car, which rolls back now."""
    x = wheels.start(U._replace(valid=False), 0.0, 0.0, P)
    right = UNKNOWN._replace(free=2.0, way=1.0)
    assert updated(new(60.0), x, omega_1=-60.0, T_mot=180.0, launch=right).omega_2 == -60.0
    assert updated(new(60.0), x, omega_1=60.0, T_mot=180.0, launch=right).omega_2 == 60.0


@each_side
def test_a_motor_that_has_set_off_against_its_torque_goes_where_that_pushed(side: float) -> None:
    x = wheels.start(U._replace(valid=False), 0.0, 0.0, P)
    wrong = UNKNOWN._replace(free=side * 2.0, way=-1.0)
    for T_mot in (0.0, 180.0):
        y = updated(new(60.0), x, omega_1=-side * 60.0, T_mot=T_mot, omega_2_hat=-side * 60.0, launch=wrong)
        assert (y.omega_2, y.usable, y.mismatch_time) == (side * 60.0, False, T_S)


@each_side
def test_a_motor_speed_of_the_wrong_sign_gives_no_direction_but_the_torque_does(side: float) -> None:
    wrong_sign = UNKNOWN._replace(pushed=True, free=side * 3.0, way=1.0, wrong_sign=True)
    x = wheels.start(U._replace(valid=False), 0.0, 0.0, P)
    y = updated(new(60.0), x, omega_1=-side * 60.0, omega_2_hat=-side * 60.0, launch=wrong_sign)
    assert (y.omega_2, y.rolling, y.mismatch_time) == (side * 60.0, 0.0, T_S)


@pytest.mark.parametrize(
    ("omega_1", "T_mot", "bad", "rolling"),
    [
        (-above(3.0), math.nextafter(45.0, 0.0), 0.0, 0.125),
        (-above(3.0), 45.0, 0.0, 0.0625),
        (-3.0, 0.0, 0.0, 0.0),
        (-3.0, 180.0, 0.0, 0.0),
        (-60.0, 0.0, T_S, 0.0),
    ],
)
def test_a_car_is_seen_to_roll_back_while_its_motor_turns_backwards_and_does_not_push(
    omega_1: float, T_mot: float, bad: float, rolling: float
) -> None:
    """And no more after as long a time in which it does not turn backwards, or with a bad motor speed."""
    assert wheels.rolling_time(0.0625, omega_1, T_mot, bad > 0.0, 0.0625, P) == rolling


def test_the_time_of_rolling_back_is_counted_up_to_twice_what_is_needed() -> None:
    """A swing of the motor past standstill does not take it back."""
    x, times = wheels.start(U._replace(valid=False), 0.0, 0.0, P).rolling, []
    for _ in range(5):
        x = wheels.rolling_time(x, -60.0, 0.0, False, 0.0625, P)
        times.append(x)
    assert times == [0.0625, 0.125, 0.1875, 2.0 * ROLLING, 2.0 * ROLLING]
    assert updated(new(60.0), omega_1=-60.0, omega_2_hat=-60.0).rolling == 2.0 * ROLLING, "a sample of 0.25 s"


def test_the_time_of_contradiction_is_counted_no_further_than_needed() -> None:
    x, times = None, []
    for k in range(7):
        x = updated(new(150.0, counter=8 + k), x, omega_1=300.0)
        times.append(x.mismatch_time)
    assert times == [0.25, 0.5, 0.75, 1.0, 1.25, 1.25, 1.25]
    assert updated(new(150.0, counter=20), x).mismatch_time == 0.0


def test_only_a_valid_reference_contradicts() -> None:
    assert updated(new(), omega_1=300.0).mismatch_time == T_S
    assert updated(new(valid=False), omega_1=300.0).mismatch_time == 0.0
    assert updated(new(250.0), omega_1=100.0).mismatch_time == 0.0, "it has leapt"


def test_at_the_start_all_that_is_plausible_is_believed() -> None:
    x = wheels.start(U, 140.0, 0.0, P)
    assert x == WheelState(
        counter=7.0, omega_2=150.0, direction=1.0, rolling=0.0, usable=False, unused=0.0, silence=0.0,
        implausible=False, reference_valid=True, late=140.0, late_then=140.0, mismatch_time=0.0,
    )  # fmt: skip
    assert type(x.counter) is type(updated(U).counter) is float, "as it is declared"
    deaf = wheels.start(U._replace(valid=False), 140.0, 0.0, P)
    assert (deaf.unused, deaf.silence, deaf.reference_valid) == (1.0, 1.0, False)
