"""The messages with the wheel speed: which are taken, and what contradicts the motor speed."""

import math
from typing import Any

import pytest

from driveline.models.controller import wheel_messages as wheels
from driveline.models.controller.supervision import Input, Parameters
from driveline.models.controller.wheel_messages import WheelState
from tests.models.controller.controllers import above, each_side

P = Parameters(
    T_max=100.0, J_1=0.25, omega_max=500.0, omega_still=3.0, t_stale=1.0, t_apart=1.0, t_late=1.0,
    wheel_jump=0.2, wheel_deviation=0.16, g_radius=0.0625,
)  # fmt: skip
T_S = 0.25
LEAP, APART = 20.0, 16.0
"""In rad/s: these shares of what T_max adds to the free motor in such a sample."""
U = Input(omega_2_can=150.0, valid=True, counter=7)
NO_NUMBERS = [math.nan, math.inf, -math.inf]


def updated(
    u: Input,
    x: WheelState | None = None,
    omega_1: float = 150.0,
    strict: bool = False,
    direction: float = 1.0,
    apart: bool = False,
) -> tuple[WheelState, bool, bool]:
    """The state after a sample, whether a message was taken, and whether it contradicts."""
    x = wheels.start(U, 150.0, P) if x is None else x
    return wheels.update(x, u, omega_1, strict, apart, direction, T_S, P)


def new(omega_2_can: float = 150.0, **signals: Any) -> Input:
    return U._replace(omega_2_can=omega_2_can, counter=8)._replace(**signals)


def test_what_is_no_number_tells_no_speed() -> None:
    for signal in NO_NUMBERS:
        assert not wheels.tells_a_speed(U._replace(omega_2_can=signal), P)
        x, taken, contradicts = updated(new(signal), omega_1=400.0, strict=True)
        assert (x.omega_2, x.silence, taken, contradicts) == (0.0, T_S, False, False)


@each_side
def test_a_wheel_speed_is_one_above_standstill_and_up_to_omega_max_while_it_is_valid(side: float) -> None:
    """Standing wheels have no direction, and a bus with a lowest speed does not call them valid."""
    for speed, tells in ((3.0, False), (above(3.0), True), (500.0, True), (above(500.0), False)):
        assert wheels.tells_a_speed(U._replace(omega_2_can=side * speed), P) is tells
    assert not wheels.tells_a_speed(U._replace(valid=False), P)


def test_a_message_is_taken_once_and_while_it_is_valid() -> None:
    assert not updated(U)[1], "it was there at the start"
    for counter in (6, 8, -(2**31)):
        x, taken, _ = updated(new(counter=counter))
        assert taken
        assert not updated(new(counter=counter), x)[1]
        assert not updated(new(counter=counter, valid=False))[1]


def test_messages_are_a_reference_while_they_keep_coming() -> None:
    x, seen = updated(new())[0], []
    for _ in range(6):
        seen.append((x.silence, wheels.is_reference(x, U, P)))
        x, _, _ = updated(new(), x)
    assert seen == [(0.0, True), (0.25, True), (0.5, True), (0.75, True), (1.0, False), (1.0, False)]
    assert not wheels.is_reference(updated(new())[0], U._replace(valid=False), P)


@each_side
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_motor_speed_is_contradicted_from_a_distance_and_a_share_of_the_wheel_speed_on(
    side: float, direction: float
) -> None:
    limit = APART + P.g_radius * 200.0
    for distance, contradicts in ((limit, False), (limit + 1e-9, True)):
        omega_1 = direction * 200.0 + side * distance
        x = wheels.start(new(200.0, counter=7), omega_1, P)
        assert updated(new(200.0), x, omega_1, direction=direction)[1:] == (True, contradicts)


@each_side
def test_a_message_tells_what_the_wheels_did_some_time_ago(side: float) -> None:
    """Wheels that lock take the motor far from it; what the motor speed was is forgotten in t_late."""
    x, far = wheels.start(U, 150.0, P), 150.0 + side * 100.0
    for forgotten in (0.25, 0.4375, 0.578125):
        x, _, contradicts = updated(new(), x, omega_1=far)
        near, other = (x.least, x.largest) if side > 0.0 else (x.largest, x.least)
        assert (near, other) == (150.0 + side * 100.0 * forgotten, far)
        assert contradicts is (100.0 * forgotten > APART + P.g_radius * 150.0)


@each_side
def test_a_message_that_leaps_while_the_motor_speed_does_not_is_not_taken(side: float) -> None:
    """Until one is near the motor speed again."""
    for leap, taken in ((LEAP, True), (LEAP + 1e-9, False)):
        assert updated(new(150.0 + side * leap), omega_1=150.0 - side * 40.0, strict=True)[1] is taken
    wide = LEAP + P.g_radius * (150.0 + side * 40.0)
    for distance, taken in ((wide - 1e-6, True), (wide + 1e-6, False)):
        u = new(150.0 + side * 40.0)
        x, found, _ = updated(u, omega_1=150.0 + side * 40.0 - side * distance, strict=True)
        assert (found, x.omega_2) == (taken, 150.0 + side * 40.0 if taken else 150.0)


@each_side
def test_a_message_that_has_leapt_is_not_taken_and_contradicts_as_those_before_it(side: float) -> None:
    """So that single ones neither cost trust nor hide that the others contradict, nor keep a fallback from healing."""
    x, omega_1 = wheels.start(U, 150.0, P), 150.0 - side * 40.0
    for counter in range(8, 20):
        x, _, contradicts = updated(new(counter=counter), x, omega_1, strict=True)
        assert contradicts
    for leap, leapt in ((LEAP, False), (LEAP + 1e-9, True), (LEAP + 200.0, True)):
        for apart in (True, False):
            y, taken, contradicts = updated(new(150.0 + side * leap), x, omega_1, strict=True, apart=apart)
            assert (taken, contradicts) == (not leapt, apart or not leapt)
            assert (y.omega_2, y.silence) == ((150.0, T_S) if leapt else (150.0 + side * leap, 0.0))


def test_the_first_message_has_not_leapt() -> None:
    silent = wheels.start(U._replace(valid=False), 150.0, P)
    assert not updated(new(250.0))[1]
    assert updated(new(250.0), silent)[1]
    assert updated(new(250.0, counter=9), updated(new(valid=False))[0])[1], "nor one after an interruption"


def test_a_contradiction_lasts_until_the_next_message_or_the_next_motor_speed() -> None:
    x = wheels.start(U._replace(omega_2_can=200.0), 200.0, P)
    x, *found = updated(new(200.0), x, omega_1=300.0, strict=True)
    assert found == [True, True]
    x, *found = updated(new(200.0), x, omega_1=300.0, strict=True)
    assert found == [False, True], "no message came"
    assert updated(new(280.0, counter=9), x, omega_1=300.0, strict=True)[1:] == (True, False)
    assert updated(new(200.0), x, omega_1=200.0, strict=True)[1:] == (False, False)


def test_only_messages_that_keep_coming_contradict() -> None:
    x = wheels.start(U, 150.0, P)._replace(silence=0.75)
    assert updated(U, x, omega_1=300.0, strict=True)[1:] == (False, False)
    assert updated(U, x._replace(silence=0.5), omega_1=300.0, strict=True)[1:] == (False, True)
    assert updated(new(), x, omega_1=300.0, strict=True)[1:] == (True, True)
    assert updated(new(valid=False), omega_1=300.0, strict=True)[1:] == (False, False)


def test_at_the_start_all_that_is_plausible_is_believed() -> None:
    assert wheels.start(U, 140.0, P) == WheelState(7.0, 150.0, 140.0, 140.0, 0.0)
    assert wheels.start(U._replace(valid=False), 140.0, P) == WheelState(7.0, 0.0, 140.0, 140.0, 1.0)
