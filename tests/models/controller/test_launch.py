"""A motor that sets off against its torque: found just like one that does, and nothing else."""

import math

import pytest

from driveline.models.controller import T_S as SAMPLE
from driveline.models.controller import launch
from driveline.models.controller.causes import NONE, WRONG_LAUNCH
from driveline.models.controller.launch import LaunchState
from driveline.models.controller.supervision import Input, Parameters, State
from driveline.models.physics.vehicle import added_speed
from tests.models.controller.controllers import OURS, each_side

P = Parameters(T_max=1.0, J_1=0.25, T_still=0.25, launch_speed=4.5)
T_S = 0.25
FREE = 4.5
"""Speed in rad/s of the free motor at which is looked; T_max adds 1 rad/s in such a sample."""
AT_REST = LaunchState(free=0.0, off=0.0)


def after(
    speeds: list[float],
    x: LaunchState = AT_REST,
    T_mot: float = 0.5,
    T_driver: float | None = None,
    resting: bool = False,
) -> tuple[LaunchState, list[bool]]:
    """The state after samples with these motor speeds, and in which the motor has set off against its torque."""
    found = []
    for omega_1 in speeds:
        demand = T_mot if T_driver is None else T_driver
        x, against = launch.update(x, demand, T_mot, omega_1, resting, T_S, P)
        found.append(against)
    return x, found


def against(side: float) -> list[float]:
    """Speeds of a motor that sets off against a torque of 0.5 N.m, in the middle of each sample."""
    return [-side * 0.5 * (k + 0.5) for k in range(9)]


@each_side
def test_a_motor_sets_off_against_its_torque_as_a_free_one_with_it(side: float) -> None:
    """It is looked at when the torque has given a free motor a speed."""
    x, found = after(against(side), T_mot=side * 0.5)
    assert found == [False] * 8 + [True]
    assert x == LaunchState(free=side * FREE, off=0.0)
    assert not any(after(against(-side), T_mot=side * 0.5)[1])


@each_side
@pytest.mark.parametrize(("off", "found"), [(0.5625, True), (0.563, False), (-0.5625, True), (-0.563, False)])
def test_it_may_be_off_by_a_quarter_of_that_in_the_mean(side: float, off: float, found: bool) -> None:
    speeds = [speed + side * off for speed in against(side)]
    assert after(speeds, T_mot=side * 0.5)[1][-1] is found


def test_it_is_looked_at_once_after_each_rest() -> None:
    x, _ = after(against(1.0))
    assert not any(after(against(1.0), x)[1])
    x, _ = after([0.0], x, T_driver=0.3, resting=True)
    assert x == AT_REST
    assert after(against(1.0), x)[1][-1]
    assert not any(after(against(1.0), launch.start(T_S, P))[1]), "nor at the start of a car that drives"


@each_side
def test_it_is_the_demand_that_ends_the_rest(side: float) -> None:
    """A car that rolls back is thrown about by its drive train."""
    for T_driver, looked_at in ((0.25, False), (math.nextafter(0.25, 1.0), True)):
        x, _ = after([0.0], T_driver=side * T_driver)
        assert any(after(against(side), x, T_mot=side * 0.5)[1]) is looked_at


@each_side
def test_torque_against_the_demand_is_left_out(side: float) -> None:
    """However the motor turns meanwhile, and without an end of the launch."""
    x, _ = after(against(side)[:4], T_mot=side * 0.5)
    y, found = after([99.0, -99.0], x, T_mot=-side * 0.5, T_driver=side * 0.5)
    assert (y, found) == (x, [False, False])
    assert after(against(side)[4:], y, T_mot=side * 0.5)[1] == [False] * 4 + [True]
    nearly, _ = after(against(side)[:8], T_mot=side * 0.5)
    assert after([-side * 4.25], nearly, T_mot=side * 0.5, T_driver=-side * 0.5) == (nearly, [False])


@each_side
def test_how_far_it_is_off_is_what_the_motor_differs_from_the_mean_speed_in_the_sample(side: float) -> None:
    for omega_1, free, off in ((1.0, 0.0, 0.625), (-1.0, 0.0, 0.375), (1.0, 1.0, 1.125), (-2.0, 1.0, 0.375)):
        x, _ = after([side * omega_1], LaunchState(side * free, 0.25), T_mot=side * 0.5)
        assert x == LaunchState(side * (free + 0.5), 0.25 + off)


CAR = OURS.Parameters()


def set_off(side: float) -> list[State]:
    """States of the controller as a free motor sets off against its torque, up to when it is looked at."""
    states, omega_1 = [OURS.start(Input(), CAR)], 0.0
    while len(states) == 1 or abs(states[-1].launch.free) < CAR.launch_speed * added_speed(CAR, SAMPLE):
        gained = -SAMPLE * states[-1].motor.loop.T_mot / CAR.J_1
        states += driven(states[-1], side, [omega_1 + 0.5 * gained])
        omega_1 += gained
    return states


def driven(x: State, side: float, speeds: list[float]) -> list[State]:
    """States after samples with these motor speeds, where the motor has the torque demanded of it."""
    states = [x]
    for omega_1 in speeds:
        u = Input(T_driver=side * 60.0, omega_1_meas=omega_1, T_mot_est=states[-1].motor.loop.T_mot)
        states.append(OURS.update(states[-1], u, CAR))
    return states[1:]


def pulled_away(lost: int, T_mot_share: float = 1.0) -> list[State]:
    """States in a launch within 0.1 s, whose motor speed has the wrong sign and is lost in one sample."""
    states, omega_1 = [OURS.start(Input(), CAR)], 0.0
    for k in range(40):
        T_mot = states[-1].motor.loop.T_mot
        measured = math.nan if k == lost else -omega_1
        u = Input(T_driver=min(2.4 * k, 120.0), omega_1_meas=measured, T_mot_est=T_mot_share * T_mot)
        states.append(OURS.update(states[-1], u, CAR))
        omega_1 += SAMPLE * T_mot / CAR.J_1
    return states


def test_a_sample_without_a_motor_speed_and_a_wrong_estimate_of_the_torque_hide_nothing() -> None:
    """Unless it is one of the last before the speed is looked at, by which it would be off by too much."""
    for states in (pulled_away(lost=-1, T_mot_share=0.8), *(pulled_away(lost=k) for k in range(7))):
        assert [x.trust.cause == WRONG_LAUNCH for x in states[9:13]] == [False, False, True, True]


@each_side
def test_trust_is_back_once_the_motor_turns_the_other_way_or_rests_and_not_before(side: float) -> None:
    """Other wrong directions heal in t_turn."""
    turning = [-side * (3.5 + 0.01 * (-1.0) ** k) for k in range(2 * round(CAR.t_turn / SAMPLE))]
    states = driven(set_off(side)[-1], side, turning)
    assert {(x.trust.cause, x.trust.clock) for x in states} == {(WRONG_LAUNCH, 0.0)}
    proof, still = round(CAR.t_proof / SAMPLE), CAR.omega_still
    beyond = math.nextafter(still, math.inf)
    for omega_1, other, heals in ((3.5, 3.6, True), (beyond, 3.1, True), (-still, -2.9, True), (-beyond, -3.1, False)):
        speeds = [side * (other if k % 2 else omega_1) for k in range(proof)]
        causes = [x.trust.cause for x in driven(states[-1], side, speeds)]
        assert causes == [WRONG_LAUNCH] * (proof - 1) + [NONE if heals else WRONG_LAUNCH]
