"""The signal monitor: each signal just good enough and just not, and what bridges it."""

import math
from collections.abc import Iterable

import pytest

from driveline.models.controller import signal_monitor as monitor
from driveline.models.controller import torque_loop
from driveline.models.controller.signal_monitor import MonitorState
from driveline.models.controller.supervision import Input, Parameters
from driveline.models.controller.torque_loop import LoopState

P = Parameters(T_max=100.0, omega_max=500.0, e_jump=40.0, t_bad=1.0, t_frozen=1.0)
T_S = 0.25
U = Input(T_driver=50.0, omega_1_meas=150.0, T_mot_est=50.0, omega_2_can=150.0, valid=True, counter=7)
NO_NUMBERS = [math.nan, math.inf, -math.inf]
COARSE, DRIFT, OFTEN, T_MOVE, T_NOISE = 1.0, 0.3, 0.02, 0.1, 0.5
"""Of the signal monitor, by their numbers: a test has to fail when one changes."""

each_side = pytest.mark.parametrize("side", [1.0, -1.0])


def above(limit: float) -> float:
    return math.nextafter(limit, math.inf)


def after(
    inputs: Iterable[Input],
    x: MonitorState | None = None,
    increment: float = 0.0,
    T_ref: float = 50.0,
) -> MonitorState:
    """The state after these inputs."""
    x = monitor.start(U, P) if x is None else x
    for u in inputs:
        x = monitor.update(x, u, increment, T_ref, T_S, P)
    return x


def last(omega_1: float) -> MonitorState:
    """A state in which this was the motor speed of the last sample."""
    return monitor.start(U, P)._replace(omega_1=omega_1)


def changing(samples: int, **signals: float) -> list[Input]:
    """Motor signals that are never the same twice."""
    return [U._replace(omega_1_meas=150.0 + k / 64, T_mot_est=50.0 + k / 64, **signals) for k in range(1, samples + 1)]


def test_a_signal_that_is_no_number_is_bridged_by_what_is_expected() -> None:
    for signal in NO_NUMBERS:
        assert monitor.speed(signal, 7.0, P) == 7.0
        assert monitor.torque(signal, LoopState(7.0, 0.0), P) == 7.0
        x = after([U._replace(omega_1_meas=signal)], increment=2.0)
        assert (x.bad, x.omega_1) == (T_S, 152.0)
        x = after([U._replace(T_mot_est=signal)], last(150.0)._replace(loop=LoopState(48.0, 0.0)))
        assert (x.bad, x.T_mot) == (T_S, 48.0)


@each_side
def test_a_motor_speed_is_plausible_up_to_omega_max(side: float) -> None:
    most, more = side * 500.0, side * above(500.0)
    assert monitor.speed(most, 7.0, P) == most
    assert monitor.speed(more, 7.0, P) == 7.0
    assert after([U._replace(omega_1_meas=most)], last(side * 490.0)).bad == 0.0
    assert after([U._replace(omega_1_meas=more)], last(side * 490.0)).bad == T_S


@each_side
def test_a_speed_that_is_expected_for_long_stays_plausible(side: float) -> None:
    nothing = [U._replace(omega_1_meas=math.nan)] * 20
    assert after(nothing, last(side * 490.0), increment=side * 8.0).omega_1 == side * 500.0


@each_side
def test_a_motor_torque_is_plausible_up_to_twice_T_max(side: float) -> None:
    most, more = side * 200.0, side * above(200.0)
    loop = LoopState(side * 180.0, 0.0)
    assert monitor.torque(most, loop, P) == most
    assert monitor.torque(more, loop, P) == side * 180.0
    x = last(150.0)._replace(loop=loop)
    assert after([U._replace(T_mot_est=most)], x).bad == 0.0
    assert after([U._replace(T_mot_est=more)], x).bad == T_S
    assert monitor.start(U._replace(T_mot_est=most), P).T_mot == most
    assert monitor.start(U._replace(T_mot_est=more), P).T_mot == 0.0


@each_side
def test_a_motor_torque_far_from_what_the_motor_should_have_is_replaced_by_that(side: float) -> None:
    limit = torque_loop.FAR * 100.0 + torque_loop.SHARE * 40.0
    x = last(150.0)._replace(loop=LoopState(-40.0, 0.0))
    for distance, bad, T_mot in ((limit - 0.01, 0.0, -40.0 + side * (limit - 0.01)), (limit + 0.01, T_S, -40.0)):
        y = after([U._replace(T_mot_est=-40.0 + side * distance)], x)
        assert (y.bad, y.T_mot) == (bad, T_mot)


def test_what_the_motor_should_have_follows_the_demand() -> None:
    x = after([U], last(150.0), T_ref=80.0)
    assert x.loop == torque_loop.update(LoopState(50.0, 0.0), 80.0, T_S, P)


@each_side
def test_a_motor_speed_may_jump_by_e_jump_in_a_sample(side: float) -> None:
    most, more = (after([U._replace(omega_1_meas=side * jump)], last(0.0)) for jump in (40.0, above(40.0)))
    assert (most.bad, most.omega_1) == (0.0, side * 40.0)
    assert (more.bad, more.omega_1) == (T_S, 0.0)
    assert after([U._replace(omega_1_meas=190.0)], last(150.0)).bad == 0.0
    assert after([U._replace(omega_1_meas=191.0)], last(150.0)).bad == T_S


@each_side
def test_a_motor_speed_may_jump_where_it_is_expected_to(side: float) -> None:
    """Or not jump where it is, for the estimate may be wrong."""
    most, more = (U._replace(omega_1_meas=side * jump) for jump in (90.0, above(90.0)))
    assert after([most], last(0.0), increment=side * 50.0).bad == 0.0
    assert after([more], last(0.0), increment=side * 50.0).bad == T_S
    assert after([U._replace(omega_1_meas=-side * 40.0)], last(0.0), increment=side * 50.0).bad == 0.0


@each_side
def test_a_motor_speed_may_go_on_as_it_was_going(side: float) -> None:
    """By e_jump more or less, as it does when wheels lock and the model does not know."""
    going = last(0.0)._replace(omega_1_change=side * 60.0)
    most, more = (after([U._replace(omega_1_meas=side * jump)], going) for jump in (100.0, above(100.0)))
    assert (most.bad, most.omega_1, most.omega_1_change) == (0.0, side * 100.0, side * 100.0)
    assert (more.bad, more.omega_1, more.omega_1_change) == (T_S, 0.0, 0.0)


@each_side
def test_a_motor_speed_that_was_going_elsewhere_may_stay(side: float) -> None:
    going = last(0.0)._replace(omega_1_change=side * 60.0)
    for jump, bad in ((40.0, 0.0), (above(40.0), T_S)):
        assert after([U._replace(omega_1_meas=-side * jump)], going, increment=side * 500.0).bad == bad


def test_a_motor_speed_that_has_jumped_is_followed_after_t_bad() -> None:
    """It is bad for as long as it is not, and may then prove itself."""
    x, seen = last(0.0), []
    for k in range(7):
        x = after([U._replace(omega_1_meas=300.0 + k)], x, increment=1.0)
        seen.append((x.omega_1, x.bad))
    assert seen == [(1.0, 0.25), (2.0, 0.5), (3.0, 0.75), (4.0, 1.0), (304.0, 1.25), (305.0, 0.0), (306.0, 0.0)]


def test_what_was_received_last_is_finite_whatever_came() -> None:
    for signal in NO_NUMBERS:
        x = after([U._replace(omega_1_meas=signal, T_mot_est=signal)])
        assert x.omega_1_last == 0.0
        assert (x.omega_1, x.T_mot) == (150.0, 50.0)


MOVING = COARSE + DRIFT + 1e-9
"""Change in rad/s of the model's motor speed in a sample, with which the motor must move."""


@each_side
def test_a_motor_speed_unchanged_for_t_frozen_is_frozen_above_one_radian_per_second(side: float) -> None:
    for speed, frozen in ((side * 1.0, False), (side * above(1.0), True)):
        torques = [U._replace(omega_1_meas=speed, T_mot_est=u.T_mot_est) for u in changing(6)]
        seen = last(speed)._replace(omega_1_last=torques[0].omega_1_meas + 0.5)
        x = after(torques[:4], seen, increment=side * MOVING)
        assert (x.omega_1_unchanged, x.bad) == (0.75, 0.0)
        x = after(torques[:5], seen, increment=side * MOVING)
        assert (x.omega_1_unchanged, x.bad, x.frozen) == (1.0, T_S if frozen else 0.0, frozen)
        x = after(torques, seen, increment=side * MOVING)
        assert (x.omega_1_unchanged, x.bad) == (1.0, 2.0 * T_S if frozen else 0.0), "counted no further"


@each_side
@pytest.mark.parametrize("resolution", [0.125, COARSE])
def test_a_motor_speed_is_frozen_that_should_have_moved_by_more_than_its_resolution(
    side: float, resolution: float
) -> None:
    """A car that cruises need not move, and a speed without noise then does not change."""
    x = last(150.0)._replace(omega_1_unchanged=P.t_frozen, resolution=resolution)
    for movement, frozen in ((resolution + DRIFT - 1e-9, False), (resolution + DRIFT + 1e-9, True)):
        y = after([U], x, increment=side * movement)
        assert (y.movement, y.frozen, y.bad > 0.0) == (side * movement, frozen, frozen)


def test_a_motor_speed_that_noise_was_moving_is_frozen_whatever_the_model_expects() -> None:
    x = last(150.0)._replace(omega_1_unchanged=P.t_frozen)
    for noise, frozen in ((OFTEN, False), (above(OFTEN), True)):
        y = after([U], x._replace(noise=noise))
        assert (y.noise, y.frozen) == (noise, frozen), "and remembered while nothing changes"


@each_side
def test_only_noise_moves_a_speed_to_and_fro_by_more_than_a_step_of_its_resolution(side: float) -> None:
    """From one sample to the next; what is so coarse that noise makes it flicker from step to step may stay on one."""
    for change, before, noise in (
        (1.51, -1.51, 0.75),
        (1.49, -1.51, 0.25),
        (1.51, -1.49, 0.25),
        (1.51, 1.51, 0.25),
        (1.51, 0.0, 0.25),
    ):
        x = last(150.0)._replace(noise=0.5, resolution=1.0, change=side * before)
        assert monitor.noise_share(x, side * change, 0.5 * T_NOISE) == noise
        assert monitor.noise_share(x, side * change, 1.1 * T_NOISE) == 2.0 * noise - 0.5, (
            "not beyond that of this sample"
        )
    y = after([U._replace(omega_1_meas=152.0), U], last(150.0))
    assert (y.change, y.noise) == (-2.0, T_S / T_NOISE)


def test_a_movement_that_the_model_expects_is_forgotten_in_T_MOVE() -> None:
    """Or when the speed changes."""
    x = last(150.0)._replace(movement=1.0)
    y = monitor.update(x, U, 0.25, 50.0, 0.25 * T_MOVE, P)
    assert y.movement == 1.0
    assert after([U], x, increment=0.25).movement == 0.25, "with samples that are longer than that"
    assert after([U._replace(omega_1_meas=above(150.0))], x, increment=0.25).movement == 0.0


def test_a_frozen_motor_speed_stays_so_until_it_changes() -> None:
    """In fallback the model follows it, and expects no movement."""
    frozen = last(150.0)._replace(omega_1_unchanged=P.t_frozen, frozen=True)
    assert after([U] * 4, frozen).bad == 4 * T_S
    x = after([U._replace(omega_1_meas=above(150.0))], frozen)
    assert (x.omega_1_unchanged, x.frozen, x.bad) == (0.0, False, 0.0)


def test_the_resolution_of_the_motor_speed_is_its_smallest_change() -> None:
    x, seen = last(150.0), []
    for speed in (152.0, 152.5, 152.5, 151.5, 151.625, math.nan, math.inf):
        x = after([U._replace(omega_1_meas=speed)], x)
        seen.append(x.resolution)
    assert seen == [COARSE, 0.5, 0.5, 0.5, 0.125, 0.125, 0.125]


def test_both_motor_signals_must_be_good() -> None:
    (good,) = changing(1)
    for bad in (good._replace(omega_1_meas=600.0), good._replace(T_mot_est=300.0)):
        assert after([bad]).bad == T_S
    assert after([good]).bad == 0.0


def test_bad_signals_count_their_time_no_further_than_needed() -> None:
    bad = [u._replace(T_mot_est=math.nan) for u in changing(8)]
    assert [after(bad[:n]).bad for n in (3, 4, 5, 8)] == [0.75, 1.0, 1.25, 1.25]


def test_at_the_start_all_that_is_plausible_is_believed() -> None:
    assert monitor.start(U, P) == MonitorState(
        omega_1=150.0,
        omega_1_change=0.0,
        T_mot=50.0,
        omega_1_last=150.0,
        omega_1_unchanged=0.0,
        change=0.0,
        noise=0.0,
        resolution=COARSE,
        movement=0.0,
        frozen=False,
        loop=LoopState(50.0, 0.0),
        bad=0.0,
    )
    x = monitor.start(Input(omega_1_meas=math.nan, T_mot_est=300.0), P)
    assert (x.omega_1, x.T_mot, x.omega_1_last) == (0.0, 0.0, 0.0)
