"""The damping controller: always finite and limited, no stationary effect, no bump, and a fallback."""

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from models.backlash import dead_zone
from models.controller import supervision as controller
from models.controller import torque_estimator as estimator
from models.controller.supervision import T_S
from models.damping_controller import BLOCK

P = BLOCK.Parameters()
ROLLING = controller.Input(T_driver=50.0, omega_1_meas=150.0, T_mot_est=50.0, omega_2_can=150.0, valid=True, counter=0)
ABSURD = [math.nan, math.inf, -math.inf, 1e308, -1e308, 1e9, -3e3]

any_signal = st.one_of(st.floats(allow_nan=True, allow_infinity=True), st.floats(-300.0, 300.0))
any_input = st.builds(
    controller.Input,
    T_driver=any_signal,
    omega_1_meas=any_signal,
    T_mot_est=any_signal,
    omega_2_can=any_signal,
    valid=st.booleans(),
    counter=st.integers(-(2**31), 2**31 - 1),
    enable=st.booleans(),
)


def run(inputs: Iterable[controller.Input], p: Any = P, x: controller.State | None = None) -> list[controller.State]:
    """States: that of the start, and after each input."""
    inputs = list(inputs)
    states = [BLOCK.start(inputs[0], p) if x is None else x]
    for u in inputs:
        states.append(BLOCK.update(states[-1], u, p))
    return states


def driven(seconds: float, **changes: Any) -> list[controller.Input]:
    """A vehicle that speeds up evenly, a message every 20 ms; the motor signals are never the same twice."""
    inputs = []
    for k in range(round(seconds / T_S)):
        omega = 150.0 + 2.0 * k * T_S + 0.05 * (-1.0) ** k
        age = P.T_age + k % 10 * T_S
        wheels = 150.0 + 2.0 * (k * T_S - age)
        u = ROLLING._replace(
            omega_1_meas=omega, T_mot_est=50.0 + 0.1 * (-1.0) ** k, omega_2_can=wheels, counter=k // 10
        )
        inputs.append(u._replace(**changes))
    return inputs


def last(states: list[controller.State], p: Any = P) -> controller.Output:
    return controller.output(states[-1], None, p)  # pyright: ignore[reportArgumentType]


def bump(states: list[controller.State]) -> float:
    """Largest change of T_ref in N.m from one sample to the next."""
    return max(abs(b.T_ref - a.T_ref) for a, b in pairwise(states))


@given(inputs=st.lists(any_input, min_size=1, max_size=40), T_max=st.floats(1.0, 500.0))
@settings(max_examples=150)
def test_the_torque_is_finite_and_limited_whatever_comes_in(inputs: list[controller.Input], T_max: float) -> None:
    p = P._replace(T_max=T_max)
    for x in run(inputs, p):
        y = controller.output(x, inputs[0], p)
        assert all(math.isfinite(value) for value in y)
        assert abs(y.T_ref) <= T_max
        assert y.status in (1, 2, 3, 4)


@given(inputs=st.lists(any_input, min_size=1, max_size=20))
@settings(max_examples=40)
def test_it_recovers_from_whatever_came_in(inputs: list[controller.Input]) -> None:
    """Within a second all states are those of a controller that never saw it."""
    states = run([*inputs, *driven(1.5)])
    assert last(states).status == controller.WITH_WHEEL_SPEED
    assert last(states).T_ref == pytest.approx(last(run(driven(1.5))).T_ref, abs=3.0)


@given(T=st.floats(-120.0, 120.0), omega=st.floats(10.0, 900.0))
@settings(max_examples=10)
def test_a_stationary_torque_is_unchanged(T: float, omega: float) -> None:
    """The signals change in their last digits only, so that they are not frozen."""
    u = ROLLING._replace(T_driver=T, T_mot_est=T, omega_1_meas=omega, omega_2_can=omega)
    states = run(
        u._replace(omega_1_meas=omega + 1e-6 * (k % 2), T_mot_est=T + 1e-6 * (k % 2), counter=k // 10)
        for k in range(2500)
    )
    assert last(states).T_ref == pytest.approx(T, abs=0.02)
    assert last(states).status == controller.WITH_WHEEL_SPEED


def test_the_demand_of_the_driver_is_passed_through_when_off() -> None:
    states = run(driven(0.5, enable=False))
    assert {x.T_ref for x in states} == {50.0}
    assert last(states).status == controller.OFF


@given(T=any_signal)
def test_a_demand_is_limited_and_one_that_is_no_number_is_none(T: float) -> None:
    u = ROLLING._replace(T_driver=T, enable=False)
    wanted = max(-P.T_max, min(T, P.T_max)) if math.isfinite(T) else 0.0
    assert last(run([u, u])).T_ref == wanted


def shaken(seconds: float, **changes: Any) -> list[controller.Input]:
    """The drive train swings at 8 Hz, so that the damping torque is large."""
    swing = [6.0 * math.sin(2.0 * math.pi * 8.0 * k * T_S) for k in range(round(seconds / T_S))]
    pairs = zip(driven(seconds, **changes), swing, strict=True)
    return [u._replace(omega_1_meas=u.omega_1_meas + a) for u, a in pairs]


def test_the_damping_torque_is_limited() -> None:
    damped = [x.T_damp for x in run(shaken(1.0), P._replace(T_damp_max=5.0, T_land=2000.0))]
    assert max(damped) == pytest.approx(5.0)
    assert min(damped) == pytest.approx(-5.0)


def test_it_is_switched_on_and_off_without_a_bump() -> None:
    """The change per sample is at most that of the damping torque itself and of its fading."""
    steady, p = shaken(1.5), P._replace(T_land=2000.0)
    switched = [u._replace(enable=100 < k < 400) for k, u in enumerate(steady)]
    states = run(switched, p)
    assert states[100].T_damp == states[-1].T_damp == 0.0
    assert max(abs(x.T_damp) for x in states) > 10.0
    assert bump(states) <= bump(run(steady, p)) + P.T_damp_max * T_S / P.t_fade


def test_the_estimator_changes_its_mode_without_a_bump() -> None:
    inputs = shaken(2.0)
    changed = [u._replace(valid=not 300 <= k < 600) for k, u in enumerate(inputs)]
    states = run(changed)
    statuses = [x.status for x in states]
    assert statuses[299] == statuses[-1] == controller.WITH_WHEEL_SPEED
    assert statuses[599] == controller.WITHOUT_WHEEL_SPEED
    assert bump(states) <= 1.1 * bump(run(inputs))
    assert max(abs(b.estimator.share - a.estimator.share) for a, b in pairwise(states)) <= 1.001 * T_S / P.t_fade


FAULTS = {
    "speed is no number": {"omega_1_meas": math.nan},
    "speed infinite": {"omega_1_meas": math.inf},
    "speed absurd": {"omega_1_meas": 1e7},
    "speed frozen": {"omega_1_meas": 151.0},
    "torque is no number": {"T_mot_est": math.nan},
    "torque infinite": {"T_mot_est": -math.inf},
    "torque absurd": {"T_mot_est": 1e5},
    "torque frozen elsewhere": {"T_mot_est": 20.0},
}


@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
def test_bad_motor_signals_lead_to_the_demand_of_the_driver_and_back(fault: dict[str, float]) -> None:
    good = shaken(4.0)
    onset, end = round(1.0 / T_S), round(2.0 / T_S)
    inputs = [u._replace(**fault) if onset <= k < end else u for k, u in enumerate(good)]
    states = run(inputs, P._replace(T_land=2000.0))
    latest = onset + round((P.t_bad + P.t_frozen + P.t_fade) / T_S) + 3
    assert states[onset].status == controller.WITH_WHEEL_SPEED
    assert {(x.T_ref, x.status) for x in states[latest : end + 1]} == {(50.0, controller.FALLBACK)}
    assert max(abs(x.T_damp) for x in states[-500:]) > 5.0, "damping again"
    assert states[-1].status == controller.WITH_WHEEL_SPEED
    # a torque 30 N.m off moves the estimated speed by T_S 30/J_1 a sample until it is found frozen
    assert bump(states[onset:]) < 2.0 * P.k_d * T_S * 30.0 / P.J_1 + 0.5


def test_a_single_bad_sample_changes_nothing_much() -> None:
    good = shaken(1.0)
    for bad in ABSURD:
        inputs = [u._replace(omega_1_meas=bad) if k == 300 else u for k, u in enumerate(good)]
        states = run(inputs)
        assert controller.FALLBACK not in {x.status for x in states}
        for a, b in zip(states[301:], run(good)[301:], strict=True):
            assert a.T_ref == pytest.approx(b.T_ref, abs=2.0)


@pytest.mark.parametrize("bad", [*ABSURD, 150.0 + 2.0 * P.e_max])
def test_an_absurd_wheel_speed_only_ends_its_mode(bad: float) -> None:
    inputs = [u._replace(omega_2_can=bad) if k >= 300 else u for k, u in enumerate(driven(1.5))]
    states = run(inputs)
    assert states[300].status == controller.WITH_WHEEL_SPEED
    assert {x.status for x in states[300 + round(P.t_stale / T_S) + 10 :]} == {controller.WITHOUT_WHEEL_SPEED}
    assert states[-1].T_ref == pytest.approx(50.0, abs=3.0)


def test_a_stale_wheel_speed_only_ends_its_mode() -> None:
    inputs = [u._replace(counter=min(u.counter, 30)) for u in driven(1.5)]
    states = run(inputs)
    assert states[305].status == controller.WITH_WHEEL_SPEED
    assert states[-1].status == controller.WITHOUT_WHEEL_SPEED


@pytest.mark.parametrize(("t_rest", "t_fade"), [(0.3, 0.1), (0.7, 0.1), (0.1, 0.7), (0.0, 0.3)])
def test_at_rest_the_estimator_is_held_whatever_the_times(t_rest: float, t_fade: float) -> None:
    p = P._replace(t_rest=t_rest, t_fade=t_fade)
    at_rest = controller.Input(T_mot_est=1.0, enable=True)
    states = run([at_rest] * round((t_rest + t_fade) / T_S + 2), p)
    assert states[-1].estimator.estimate == (0.0, 0.0, 0.0, 0.0)


def test_a_change_of_input_appears_one_sample_later() -> None:
    """What is computed from the inputs at k T_s appears at (k+1) T_s, not before."""
    states = run(driven(0.2, enable=False))
    jump = ROLLING._replace(T_driver=90.0, enable=False)
    assert controller.output(states[-1], jump, P).T_ref == 50.0
    assert controller.output(BLOCK.update(states[-1], jump, P), ROLLING, P).T_ref == 90.0


def test_the_estimate_shown_is_that_of_the_instant_at_which_it_appears() -> None:
    x = run(driven(0.1))[-1]
    ahead = estimator.integrated(x.estimator.estimate, x.monitor.T_mot, T_S, P)
    y = controller.output(x, ROLLING, P)
    assert (y.phi_hat, y.omega_2_hat) == (ahead.phi, ahead.omega_2)
    assert y.T_gear_hat == P.C * dead_zone(ahead.phi, P.phi_B)


@pytest.mark.parametrize("late", [0, 1])
def test_a_message_as_old_as_assumed_corrects_a_perfect_model_by_nothing(late: int) -> None:
    """The innovation is that of the message's own age, 11.5 samples; a sample more shows."""
    p, x = P._replace(T_age=0.023), BLOCK.start(ROLLING, P)
    true = [x.estimator.estimate]
    for k in range(1, 400):
        true.append(estimator.integrated(true[-1], 50.0, T_S, p))
        u = ROLLING._replace(omega_1_meas=true[k].omega_1)
        if k > 40:
            message = 0.5 * (true[k - 11 - late].omega_2 + true[k - 12 - late].omega_2)
            u = u._replace(omega_2_can=message, counter=k // 10)
        x = BLOCK.update(x, u, p)
    assert x.status == controller.WITH_WHEEL_SPEED
    e = x.estimator.estimate
    error = max(abs(e.omega_2 - true[-1].omega_2), abs(e.phi - true[-1].phi))
    assert error > 1e-6 if late else error < 1e-9


LITERAL = P._replace(
    lambda_v=0.0,
    k_d=0.0,
    T_pred=0.0,
    L_T_l=0.0,
    Lw_T_l=0.0,
    L_can_T_l=0.0,
    T_land=P.T_max,
    k_gap=1.0,
    k_T=0.6,
    omega_w=60.0,
)
"""The paper's controller: observer without load, imperfect derivative of the estimated gear torque."""


def test_the_literal_form_of_the_paper_is_an_imperfect_derivative_of_the_gear_torque() -> None:
    states = run(shaken(1.0), LITERAL)
    gear = [LITERAL.C * dead_zone(x.estimator.estimate.phi, LITERAL.phi_B) for x in states]
    low_passed = gear[0]
    for x, T_gear in zip(states[1:], gear[1:], strict=True):
        expected = -LITERAL.k_T * (T_gear - low_passed)
        low_passed += LITERAL.omega_w * T_S * (T_gear - low_passed)
        assert x.T_damp == pytest.approx(max(-P.T_damp_max, min(expected, P.T_damp_max)), abs=1e-9)
        assert x.estimator.estimate.T_l == 0.0
    assert max(abs(x.T_damp) for x in states) > 5.0


def test_the_estimate_follows_a_perfect_model() -> None:
    """The estimator fed with its own model, started wrong, finds its twist again without wheel speed."""
    true = estimator.Estimate(150.0, 150.0, P.phi_B + 60.0 / P.C, -40.0)
    x = BLOCK.start(ROLLING._replace(valid=False), P)
    for k in range(3000):
        T_mot = 50.0 + 20.0 * math.sin(0.02 * k)
        true = estimator.integrated(true, T_mot, T_S, P)
        u = ROLLING._replace(omega_1_meas=true.omega_1, T_mot_est=T_mot, valid=False)
        x = BLOCK.update(x, u, P)
    assert x.estimator.estimate.phi == pytest.approx(true.phi, abs=0.02)
    assert x.estimator.estimate.omega_2 == pytest.approx(true.omega_2, abs=0.5)
