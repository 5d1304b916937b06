"""The supervision: what holds for every controller, whatever its estimator and its law are."""

import math
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from driveline.models.controller import T_S, causes, supervision, torque_loop
from driveline.models.controller.supervision import FALLBACK, OFF, WITH_WHEEL_SPEED, WITHOUT_WHEEL_SPEED, Input, State
from fmublocks.block.declaration import Enumeration, variables
from fmublocks.block.types import SampledBlock
from tests.models.controller.controllers import (
    ABSURD,
    OTHER,
    OURS,
    ROLLING,
    any_input,
    any_signal,
    bump,
    drive_inputs,
    every_controller,
    run,
    run_with_motor,
    shaken,
)

P = OTHER.Parameters()
UNIT = P.T_max * T_S / P.J_1
"""Speed in rad/s that T_max adds to the free motor in a sample."""

PATIENT = {"swing": 1.0}
"""With it no half swing is counted: what shakes the motor here does not die away."""


@every_controller
@given(
    inputs=st.lists(any_input, min_size=1, max_size=40),
    T_max=st.floats(1.0, 500.0),
    T_take_max=st.floats(0.0, 300.0),
    T_add_max=st.floats(0.0, 300.0),
)
@settings(max_examples=75)
def test_the_torque_is_finite_and_limited_whatever_comes_in(
    block: SampledBlock, inputs: list[Input], T_max: float, T_take_max: float, T_add_max: float
) -> None:
    """And no more is taken from the demand and added to it than is said."""
    limits = {"T_max": T_max, "T_take_max": T_take_max, "T_add_max": T_add_max}
    p, states = block.Parameters(**limits), run(block, inputs, **limits)
    for x, u in zip(states, [inputs[0], *inputs], strict=True):
        y, T_driver = block.output(x, u, p), supervision.demand(u, p)
        assert all(math.isfinite(value) for value in y)
        assert abs(y.T_ref) <= T_max
        assert y.status in (1, 2, 3, 4)
        assert x.T_damp == x.T_ref - T_driver
        assert supervision.limited(x.T_damp, T_driver, p) == pytest.approx(x.T_damp, abs=1e-9)


@every_controller
def test_the_demand_of_the_driver_is_passed_through_when_off(block: SampledBlock) -> None:
    states = run(block, shaken(0.5, enable=False))
    assert {(x.T_ref, x.T_damp, x.status) for x in states} == {(50.0, 0.0, OFF)}


@every_controller
@given(T=any_signal)
def test_a_demand_is_limited_and_one_that_is_no_number_is_none(block: SampledBlock, T: float) -> None:
    u = ROLLING._replace(T_driver=T, enable=False)
    wanted = max(-180.0, min(T, 180.0)) if math.isfinite(T) else 0.0
    assert {x.T_ref for x in run(block, [u, u])} == {wanted}


@every_controller
def test_it_is_switched_on_and_off_without_a_bump(block: SampledBlock) -> None:
    """The change per sample is at most that of the damping torque itself and of its fading."""
    steady = shaken(1.5)
    switched = [u._replace(enable=100 < k < 400) for k, u in enumerate(steady)]
    states, always = run(block, switched, **PATIENT), run(block, steady, **PATIENT)
    largest = max(abs(x.T_damp) for x in always)
    assert states[100].T_damp == states[-1].T_damp == 0.0
    assert max(abs(x.T_damp) for x in states) > 10.0
    assert bump(states) <= bump(always) + largest * T_S / P.t_fade


FAULTS = {
    "speed is no number": {"omega_1_meas": math.nan},
    "speed infinite": {"omega_1_meas": math.inf},
    "speed absurd": {"omega_1_meas": 1e7},
    "speed frozen": {"omega_1_meas": 151.0},
    "torque is no number": {"T_mot_est": math.nan},
    "torque infinite": {"T_mot_est": -math.inf},
    "torque absurd": {"T_mot_est": 1e5},
    "torque that is not demanded": {"T_mot_est": 20.0},
}


@every_controller
@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
def test_bad_motor_signals_lead_to_the_demand_of_the_driver_and_back(
    block: SampledBlock, fault: dict[str, float]
) -> None:
    onset, end = round(0.5 / T_S), round(1.0 / T_S)
    good = shaken(2.5)
    faulty = [u._replace(**fault) if onset <= k < end else u for k, u in enumerate(good)]
    states = run(block, faulty, **PATIENT)
    latest = onset + round((P.t_bad + P.t_move + P.t_fade) / T_S) + 3
    assert states[onset].status == WITH_WHEEL_SPEED
    assert {(x.T_ref, x.status) for x in states[latest : end + 1]} == {(50.0, FALLBACK)}
    assert max(abs(x.T_damp) for x in states[-250:]) > 5.0, "damping again"
    assert states[-1].status == WITH_WHEEL_SPEED


@every_controller
@pytest.mark.parametrize("bad", ABSURD)
def test_an_absurd_wheel_speed_only_ends_its_mode(block: SampledBlock, bad: float) -> None:
    states = run(block, [u._replace(omega_2_can=bad) if k >= 100 else u for k, u in enumerate(drive_inputs(0.5))])
    assert states[100].status == WITH_WHEEL_SPEED
    assert {x.status for x in states[100 + round(P.t_stale / T_S) + 10 :]} == {WITHOUT_WHEEL_SPEED}
    assert states[-1].T_ref == pytest.approx(50.0, abs=3.0)


@every_controller
def test_a_wheel_speed_that_is_not_valid_ends_its_mode_at_once(block: SampledBlock) -> None:
    states = run(block, [u._replace(valid=not 100 <= k < 150) for k, u in enumerate(drive_inputs(0.5))])
    without = [k for k, x in enumerate(states) if x.status == WITHOUT_WHEEL_SPEED]
    assert without == list(range(101, 151)), "messages came all the time"


def test_the_numbers_of_the_status_are_those_declared() -> None:
    names, _ = (
        [name for name, _ in v.declaration.items]
        for v in variables(supervision.Output)
        if isinstance(v.declaration, Enumeration)
    )
    numbers = {"off": OFF, "fallback": FALLBACK}
    numbers |= {"damping_with_wheel_speed": WITH_WHEEL_SPEED, "damping_without_wheel_speed": WITHOUT_WHEEL_SPEED}
    assert {name: number for number, name in enumerate(names, start=1)} == numbers


# from here on in detail, seen through an estimator and a law of which all is known


def started(u: Input = ROLLING, **parameters: float) -> tuple[State, Any]:
    p = OTHER.Parameters(**parameters)
    return OTHER.start(u, p), p


def test_it_starts_with_the_demand_and_what_is_measured() -> None:
    x, p = started()
    assert (x.T_ref, x.T_damp, x.quiet, x.level, x.status) == (50.0, 0.0, 0.0, 1.0, WITH_WHEEL_SPEED)
    assert x.estimator == (150.0, 150.0, 50.0, 1.0)
    assert x.law == (150.0,)
    assert OTHER.output(x, ROLLING, p).T_gear_hat == 50.0


def test_it_starts_in_the_mode_that_it_is_asked_for() -> None:
    off, _ = started(ROLLING._replace(enable=False))
    assert (off.level, off.status) == (0.0, OFF)
    deaf, _ = started(ROLLING._replace(valid=False))
    assert (deaf.level, deaf.status, deaf.estimator.share) == (1.0, WITHOUT_WHEEL_SPEED, 0.0)


def test_a_car_that_stands_at_the_start_is_at_rest() -> None:
    standing = Input(T_driver=2.0, omega_1_meas=3.0, T_mot_est=0.0)
    x, p = started(standing)
    assert x.quiet == p.t_rest + p.t_fade
    x = OTHER.update(x, standing, p)
    T_mot = 0.5 * x.motor.loop.T_mot
    assert x.estimator[:3] == (T_S * T_mot / p.J, 0.0, T_mot), "from rest on, under what is demanded"
    assert OTHER.update(x, standing, p).estimator.omega_1 < 2.0 * T_S * standing.T_driver / p.J, (
        "and again from rest on"
    )
    assert started(standing._replace(T_driver=2.1))[0].quiet == 0.0


def test_the_estimator_is_predicted_under_the_torque_that_the_motor_has_and_will_have() -> None:
    """Half of the change until the next sample acts; a speed that is no number is the predicted one."""
    x, p = started(ROLLING._replace(T_driver=70.0))
    loop = torque_loop.update(x.motor.loop, 70.0, T_S, p)
    assert loop.T_mot - x.motor.loop.T_mot > 2.0
    y = OTHER.update(x, ROLLING._replace(T_driver=70.0, T_mot_est=51.0, omega_1_meas=math.nan), p)
    assert y.motor.omega_1 == x.estimator.omega_1
    T_mot = 51.0 + 0.5 * (loop.T_mot - x.motor.loop.T_mot)
    assert y.estimator[:3] == (y.motor.omega_1 + T_S * T_mot / p.J, 150.0, T_mot)


def test_the_motion_shown_is_ahead_by_a_sample() -> None:
    x, p = started()
    x = OTHER.update(x, ROLLING._replace(T_mot_est=70.0, omega_1_meas=151.0, omega_2_can=149.0, counter=1), p)
    assert x.estimator == (151.0 + T_S * 70.0 / p.J, 149.0, 70.0, 1.0)
    y = OTHER.output(x, ROLLING, p)
    assert (y.T_ref, y.T_damp, y.status) == (x.T_ref, x.T_damp, WITH_WHEEL_SPEED)
    assert (y.T_gear_hat, y.phi_hat, y.omega_2_hat) == (70.0, 0.0, 149.0)


def test_what_the_law_says_is_added_to_the_demand() -> None:
    x, p = started()
    x = OTHER.update(x, ROLLING._replace(omega_1_meas=153.0), p)
    assert (x.T_ref, x.T_damp) == (50.0 - p.k_v * 3.0, -p.k_v * 3.0)
    assert x.law.slow == 150.0 + p.omega_v * T_S * 3.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_demand_and_damping_together_are_limited(side: float) -> None:
    x, p = started(ROLLING._replace(T_driver=side * 170.0), jump=3.0)
    x = OTHER.update(x, ROLLING._replace(T_driver=side * 170.0, omega_1_meas=150.0 - side * 10.0), p)
    assert (x.T_ref, x.T_damp) == (side * 180.0, side * 10.0)


def test_the_damping_fades_in_and_out_with_its_switch() -> None:
    x, p = started(ROLLING._replace(enable=False), t_fade=4.0 * T_S)
    levels = []
    for enable in [True] * 5 + [False] * 5:
        x = OTHER.update(x, ROLLING._replace(omega_1_meas=153.0, enable=enable), p)
        levels.append(x.level)
        assert x.T_damp == pytest.approx(-x.level * p.k_v * 3.0, rel=0.5)
        assert (x.T_damp == 0.0) is (x.level == 0.0)
    assert levels == [0.25, 0.5, 0.75, 1.0, 1.0, 0.75, 0.5, 0.25, 0.0, 0.0]


def test_the_damping_fades_out_at_rest() -> None:
    standing = Input(omega_1_meas=1.0)
    x, p = started(ROLLING, t_rest=2.0 * T_S, t_fade=4.0 * T_S, k_v=1.0, omega_v=0.0)
    x = x._replace(law=x.law._replace(slow=-9.0), estimator=x.estimator._replace(omega_1=1.0))
    x = x._replace(motor=x.motor._replace(omega_1=1.0))
    torques = []
    for _ in range(7):
        x = OTHER.update(x, standing, p)
        torques.append(x.T_damp)
    assert torques == pytest.approx([-10.0, -10.0, -7.5, -5.0, -2.5, 0.0, 0.0])


def test_signals_are_bridged_before_they_lead_to_fallback() -> None:
    """What was added last fades while the law has lost its estimate."""
    x, p = started(ROLLING, t_bad=2.0 * T_S, t_fade=4.0 * T_S, k_v=1.0, omega_v=0.0, jump=3.0)
    x = OTHER.update(x, ROLLING._replace(omega_1_meas=160.0), p)
    seen = []
    for k in range(7):
        x = OTHER.update(x, ROLLING._replace(omega_1_meas=math.nan, T_mot_est=0.001 * k), p)
        seen.append((x.status, x.level))
        assert x.T_damp == pytest.approx(-10.0 * x.level, abs=0.2)
    assert seen == [(WITH_WHEEL_SPEED, 1.0)] * 2 + [(FALLBACK, level) for level in (0.75, 0.5, 0.25, 0.0, 0.0)]
    assert OTHER.output(x, ROLLING, p).cause == causes.SPEED_RANGE


def test_in_fallback_the_estimator_starts_anew_from_what_it_gets() -> None:
    """From any plausible speed, however far from the estimate; it is trusted when it has proved itself."""
    x, p = started(ROLLING._replace(valid=False), t_bad=2.0 * T_S, t_proof=3.0 * T_S, k_v=1.0, omega_v=0.0)
    statuses, slow = [], []
    for k in range(8):
        x = OTHER.update(x, ROLLING._replace(valid=False, omega_1_meas=300.0 + k, T_mot_est=60.0 + k), p)
        statuses.append(x.status)
        slow.append(x.law.slow)
    assert statuses == [WITHOUT_WHEEL_SPEED] * 2 + [FALLBACK] * 4 + [WITHOUT_WHEEL_SPEED] * 2
    assert slow[:2] == [150.0] * 2
    assert slow[3:] == [303.0] + [304.0] * 4, "the law starts anew with the first good sample"
    assert x.motor.omega_1 == 307.0


def test_a_wheel_speed_that_contradicts_the_motor_speed_leads_to_fallback() -> None:
    """For as long as it does: both cannot be right, and nothing says which one is."""
    states = run(OTHER, [u._replace(omega_2_can=240.0) if k < 200 else u for k, u in enumerate(drive_inputs(1.0))])
    statuses = [x.status for x in states]
    first = statuses.index(FALLBACK)
    assert first * T_S == pytest.approx(P.t_apart, abs=2.0 * T_S)
    back = statuses.index(WITH_WHEEL_SPEED, first)
    assert set(statuses[first:back]) == {FALLBACK}
    assert (back - 200) * T_S == pytest.approx(P.t_proof, abs=0.02 + 2.0 * T_S), "a message comes every 20 ms"
    assert set(statuses[back:]) == {WITH_WHEEL_SPEED}


@every_controller
def test_a_motor_that_sets_off_against_its_torque_is_not_believed(block: SampledBlock) -> None:
    """Below the least wheel speed; until the car rests."""

    def launched_with(sign: float) -> tuple[list[int], float]:
        """Statuses of a launch with 10 N.m and of the rest after it, and when the free motor had its speed."""
        p, omega, statuses, found = block.Parameters(), 0.0, [], math.inf
        x = block.start(Input(), p)
        for k in range(500):
            T_mot = x.motor.loop.T_mot
            driving = k < 100
            omega = omega + T_S * T_mot / p.J_1 if driving else max(omega - 5.0, 0.0)
            u = Input(T_driver=10.0 if driving else 0.0, T_mot_est=T_mot + 1e-3 * (k % 2), omega_1_meas=sign * omega)
            x = block.update(x, u, p)
            statuses.append(x.status)
            found = min(found, k) if omega > P.launch_speed * UNIT else found
        return statuses, found

    wrong, found = launched_with(-1.0)
    first = wrong.index(FALLBACK)
    assert abs(first - found) <= 2
    assert set(wrong[first:100]) == {FALLBACK}
    assert wrong[-1] == WITHOUT_WHEEL_SPEED
    assert set(launched_with(1.0)[0][:100]) == {WITHOUT_WHEEL_SPEED}


def test_damping_that_feeds_an_oscillation_lets_go_without_fallback() -> None:
    """And takes half swings that are forgotten at one a t_relapse to come back."""
    swinging = [u._replace(omega_1_meas=4.0 * u.omega_1_meas - 450.0) for u in shaken(1.0)]
    states, p = run_with_motor(OTHER, swinging + drive_inputs(15.0))[1:], OTHER.Parameters()
    shown = [OTHER.output(x, ROLLING, p) for x in states]
    let_go = next(k for k, y in enumerate(shown) if y.cause == causes.FEEDS and y.T_damp == 0.0)
    assert let_go * T_S < 0.35
    assert {(y.T_damp, y.cause) for y in shown[let_go : len(swinging)]} == {(0.0, causes.FEEDS)}
    assert FALLBACK not in {y.status for y in shown}
    back = next(k for k in range(len(swinging), len(shown)) if shown[k].cause == causes.NONE)
    assert 10.0 < (back - len(swinging)) * T_S <= 3.5 * p.t_relapse + p.t_forget + T_S


@pytest.mark.parametrize(
    ("T_driver", "lower", "upper"), [(0.1, -100.0, 60.0), (0.0, -60.0, 60.0), (-0.1, -60.0, 100.0)]
)
def test_less_may_be_added_to_the_demand_than_taken_from_it(T_driver: float, lower: float, upper: float) -> None:
    p = P._replace(T_take_max=100.0, T_add_max=60.0)
    for torque, left in (
        (lower + 0.5, lower + 0.5),
        (lower - 0.5, lower),
        (upper - 0.5, upper - 0.5),
        (upper + 1, upper),
    ):
        assert supervision.limited(torque, T_driver, p) == left


def test_a_landing_is_limited_and_fades_as_the_damping_does() -> None:
    """`T_max` is so large that the motor need not have what is demanded, and `tau` too long for it to begin."""
    afloat = ROLLING._replace(T_driver=120.0, T_mot_est=0.0)
    inputs = [afloat._replace(omega_1_meas=150.0 + 1e-9 * k) for k in range(40)]
    still = {"frozen": 1000.0, "T_max": 2000.0, "T_pred": 0.0, "tau": 10.0}
    states = run(OURS, inputs, **still, T_take_max=40.0)
    assert {x.T_damp for x in states[2:30]} == {-40.0}, "no more than may be taken"
    whole = run(OURS, inputs, **still)[2].T_damp
    assert -100.0 < whole < -40.0
    fading = run(OURS, [u._replace(enable=k < 10) for k, u in enumerate(inputs)], **still)
    for x in fading[1:40]:
        assert x.T_damp == pytest.approx(whole * x.level, abs=1e-3)


def test_in_fallback_the_wheel_speed_is_not_in_use() -> None:
    x, p = started(ROLLING, t_bad=0.0)
    x = OTHER.update(x, ROLLING._replace(T_mot_est=math.nan), p)
    assert (x.status, x.estimator.share) == (FALLBACK, 1.0 - T_S / p.t_fade)


def test_the_state_moves_by_one_sample_a_sample() -> None:
    """Nothing of it is left behind."""
    states = run(
        OTHER,
        [u._replace(T_driver=50.0 + 0.01 * k**2) for k, u in enumerate(shaken(0.1))],
        swing=1e-3,
        demand_excuse=10.0,
    )
    for a, b in pairwise(states[1:]):
        for name in ("estimator", "law", "motor", "wheel", "swings", "T_ref", "T_damp"):
            assert getattr(a, name) != getattr(b, name), name


@every_controller
def test_a_lost_motor_speed_is_answered_within_a_fifth_of_a_period_of_the_drive_train(block: SampledBlock) -> None:
    """22 ms at 8 Hz, but not before a tenth: single lost samples must not end the damping."""
    good = drive_inputs(0.3)
    lost = [u._replace(omega_1_meas=math.nan) if k >= 100 else u for k, u in enumerate(good)]
    statuses = [x.status for x in run(block, lost)][100:]
    assert statuses[round(0.012 / T_S)] != FALLBACK
    assert statuses[round(0.022 / T_S)] == FALLBACK


def swinging(seconds: float, **changes: Any) -> list[Input]:
    """A drive train that swings on and on, with wheels that turn by a third slower than the motor."""
    return [u._replace(omega_2_can=0.67 * u.omega_2_can, **changes) for u in shaken(seconds)]


def test_while_a_slip_control_is_active_wheels_may_part_and_no_half_swing_counts() -> None:
    """And the gains are those of wheels that slip."""
    with_it, without = (run_with_motor(OURS, swinging(0.5, slip_control=told)) for told in (True, False))
    assert {x.estimator.slip for x in with_it[1:]} == {1.0}
    assert {x.swings.count for x in with_it} == {0.0}
    assert {x.trust.cause for x in with_it} == {causes.NONE}
    assert causes.WHEEL_CONTRADICTS in {x.trust.cause for x in without}


def test_frames_that_are_counted_change_nothing_while_they_are_new() -> None:
    inputs = shaken(0.3)
    counted = run(OURS, [u._replace(alive=k) for k, u in enumerate(inputs, 7)])
    for x, y in zip(run(OURS, inputs), counted, strict=True):
        assert x.motor._replace(alive=0.0) == y.motor._replace(alive=0.0)
        assert x._replace(motor=y.motor) == y


def test_a_frame_that_stays_away_is_bridged_and_then_let_go_of() -> None:
    """For t_bad, whatever stands in it; and the damping is back t_proof after new ones."""
    inputs = shaken(0.6)
    gone = range(100, 130)
    counted = [u._replace(alive=min(k, 99) if k in gone else k + 1) for k, u in enumerate(inputs)]
    counted = [u._replace(omega_1_meas=1e3) if k in gone else u for k, u in enumerate(counted)]
    lost = [x.trust.cause == causes.FRAME_LATE for x in run_with_motor(OURS, counted)[1:]]
    p = OURS.Parameters()
    assert lost.index(True) == pytest.approx(100 + p.t_bad / T_S, abs=1)
    assert len(lost) - 1 - lost[::-1].index(True) == pytest.approx(130 + p.t_proof / T_S, abs=2)
