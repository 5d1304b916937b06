"""The motor's torque loop: the lag of the paper's eq. (1), and what motor control reports."""

from dataclasses import replace
from itertools import product
from math import cos, exp, sin, sqrt

import numpy as np
import pytest
from fmutesting.slow import slow
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from driveline.models import motor_torque_loop as motor
from driveline.models.physics import dead_time
from fmublocks.block.integrator import Integrator

P = motor.Parameters()
SILENT = P._replace(sigma_T=0.0, sigma_omega=0.0, q_omega=0.0)


def run(u: motor.Input, p: motor.Parameters, steps: int, h: float) -> np.ndarray:
    """Outputs (steps + 1, 3) every h seconds under a held input, from rest."""
    integrator = Integrator(motor.BLOCK)
    x = motor.start(motor.Input(), p)
    rows = [motor.output(x, u, p)]
    for _ in range(steps):
        x = integrator.advance(x, u, p, h)
        rows.append(motor.output(x, u, p))
    return np.array(rows)


def step_response(t: float, tau: float) -> float:
    """Of 1/(tau^2 s^2 + sqrt(2) tau s + 1)."""
    a = t / (sqrt(2.0) * tau)
    return 1.0 - exp(-a) * (cos(a) + sin(a))


@given(T=st.floats(-180.0, 180.0), tau=st.floats(5e-4, 0.1))
@settings(max_examples=25)
def test_the_step_response_is_that_of_the_paper(T: float, tau: float) -> None:
    """In steps of a third of tau, which is the default step at the default tau."""
    block = replace(motor.BLOCK, step_size=min(motor.BLOCK.step_size, tau / 3.0))
    x, u, p = motor.start(motor.Input(), SILENT), motor.Input(T), SILENT._replace(tau=tau)
    integrator = Integrator(block)
    for k in range(1, 20):
        x = integrator.advance(x, u, p, tau / 2.0)
        assert x.T_mot == pytest.approx(T * step_response(k * tau / 2.0, tau), abs=1e-9 * max(abs(T), 1.0))


@given(T_ref=st.floats(-2000.0, 2000.0))
def test_the_torque_settles_at_the_demand_within_the_limit(T_ref: float) -> None:
    p = SILENT._replace(T_max=150.0)
    settled = run(motor.Input(T_ref), p, 1, 0.1)[-1, 0]
    assert settled == pytest.approx(max(-150.0, min(T_ref, 150.0)), abs=1e-6)
    assert motor.start(motor.Input(T_ref), p).T_mot == max(-150.0, min(T_ref, 150.0))


def test_the_estimate_has_the_given_gain_and_offset_and_the_torque_has_not() -> None:
    p = SILENT._replace(g_T=1.05, o_T=-1.5)
    T_mot, T_mot_est, _ = run(motor.Input(80.0), p, 30, 1e-3).T
    assert T_mot_est == pytest.approx(1.05 * T_mot - 1.5, abs=1e-12)
    assert T_mot[-1] == pytest.approx(80.0, abs=0.5)


def samples(p: motor.Parameters, count: int = 4000, omega_1: float = 123.4) -> np.ndarray:
    """Outputs at each sample of the noise."""
    u, x = motor.Input(50.0, omega_1), motor.start(motor.Input(50.0), p)
    return np.array([motor.output(x._replace(sample=float(k)), u, p) for k in range(count)])


def test_noise_has_the_given_deviation_and_no_mean_and_no_memory() -> None:
    _, T_mot_est, omega_1_meas = samples(P._replace(q_omega=0.0)).T
    for noise, sigma in ((T_mot_est - 50.0, P.sigma_T), (omega_1_meas - 123.4, P.sigma_omega)):
        assert abs(noise.mean()) < 4.0 * sigma / sqrt(len(noise))
        assert noise.std() == pytest.approx(sigma, rel=0.05)
        assert abs(np.corrcoef(noise[1:], noise[:-1])[0, 1]) < 4.0 / sqrt(len(noise))
    assert abs(np.corrcoef(T_mot_est, omega_1_meas)[0, 1]) < 4.0 / sqrt(len(T_mot_est))


@given(omega_1=st.floats(-2000.0, 2000.0))
def test_the_speed_is_rounded_to_its_resolution(omega_1: float) -> None:
    assert motor.output(motor.start(motor.Input(), SILENT), motor.Input(0.0, omega_1), SILENT).omega_1_meas == omega_1
    p = SILENT._replace(q_omega=0.1)
    measured = motor.output(motor.start(motor.Input(), p), motor.Input(0.0, omega_1), p).omega_1_meas
    assert abs(measured - omega_1) <= 0.05 + 1e-9
    assert measured / 0.1 == pytest.approx(round(measured / 0.1), abs=1e-9)


@pytest.mark.parametrize("h", slow([1e-4, 5e-4, 2e-3, 2e-3 / 3.0], but=[2e-3, 2e-3 / 3.0]))
def test_the_noise_does_not_depend_on_the_communication_step(h: float) -> None:
    """A sample lasts 2 ms; seen at every 2 ms for 4 s, also after many additions of its time."""
    per_sample = round(P.T_s / h)
    seen = run(motor.Input(0.0, 7.0), P, 2000 * per_sample, h)[::per_sample]
    assert (seen[:, 2] == samples(P, 2001, 7.0)[:, 2]).all()


def test_the_noise_is_held_for_a_sample() -> None:
    seen = run(motor.Input(0.0, 7.0), P._replace(q_omega=0.0), 40, 5e-4)[:40, 2].reshape(10, 4)
    assert (np.ptp(seen, axis=1) == 0.0).all()
    assert len(set(seen[:, 0])) == 10


@pytest.mark.parametrize("T_s", [0.002, 0.005])
def test_the_time_in_samples_has_the_rate_of_the_samples(T_s: float) -> None:
    """For a host that integrates the states; co-simulation has the solution."""
    p = P._replace(T_s=T_s)
    rate = motor.BLOCK.derivative(motor.start(motor.Input(), p), motor.Input(), p).sample
    assert rate * T_s == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("t_dead", "stated"), [(0.0, 0.0), (9.9e-5, 0.0), (1e-3, 4e-4), (2e-3, 2e-3), (5e-3, 0.01), (0.01, 0.035)]
)
def test_the_torque_comes_the_dead_time_later_but_for_the_error_that_is_stated(t_dead: float, stated: float) -> None:
    """Seen every 0.1 ms, over the height of the step; none below 0.1 ms."""
    delayed = run(motor.Input(1.0), SILENT._replace(t_dead=t_dead), 400, 1e-4)[:, 0]
    late = int(t_dead / 1e-4 + 1e-6)
    exact = np.array([step_response(max(k - late, 0) * 1e-4, P.tau) for k in range(401)])
    assert np.max(np.abs(delayed - exact)) == pytest.approx(stated, rel=0.2, abs=1e-8)


@pytest.mark.parametrize("t_dead", [1e-4, 1e-3, 5e-3, 0.01])
@pytest.mark.parametrize("frequency", [1.0, 10.0, 20.0])
def test_a_sine_is_late_by_the_dead_time_and_as_high_as_before(t_dead: float, frequency: float) -> None:
    """The frequency response of the line, from its matrices: exp(-s T)."""
    s, eye = 2j * np.pi * frequency, np.eye(4)
    A = np.array([dead_time.rates(dead_time.Line(*column), 0.0, t_dead) for column in eye]).T
    B = np.array(dead_time.rates(dead_time.Line(0.0, 0.0, 0.0, 0.0), 1.0, t_dead))
    C = np.array([dead_time.delayed(dead_time.Line(*column), 0.0, t_dead) for column in eye])
    assert C @ np.linalg.solve(s * eye - A, B) == pytest.approx(np.exp(-s * t_dead), abs=1e-4)


EFFECTS = SILENT._replace(t_dead=5e-3, dT_max=5000.0, omega_base=300.0)
"""All of them at once."""


def test_the_communication_step_changes_nothing_with_all_effects() -> None:
    """1 ms and 0.1 ms, a demand that changes every 2 ms."""
    coarse, fine = (course(EFFECTS, steps) for steps in (2, 20))
    assert coarse == pytest.approx(fine, abs=1e-5)
    assert np.ptp(coarse) > 50.0


def course(p: motor.Parameters, steps: int) -> np.ndarray:
    """The torque every 2 ms of 200 ms, in so many steps each, under a random demand at 400 rad/s."""
    integrator, x, rows = Integrator(motor.BLOCK), motor.start(motor.Input(), p), []
    for T_ref in np.random.default_rng(1).uniform(-200.0, 200.0, 100).tolist():
        for _ in range(steps):
            x = integrator.advance(x, motor.Input(T_ref, 400.0), p, 2e-3 / steps)
        rows.append(x.T_mot)
    return np.array(rows)


LAGS = list(product([1e-3, P.tau, 0.03], [500.0, 10_000.0, 1e5]))


@pytest.mark.parametrize(("tau", "dT_max"), slow(LAGS, but=[(P.tau, 500.0), (0.03, 10_000.0), (P.tau, 1e5)]))
def test_the_torque_changes_at_most_at_its_rate_and_overshoots_no_more_for_it(tau: float, dT_max: float) -> None:
    p = SILENT._replace(tau=tau, dT_max=dT_max)
    T = run(motor.Input(100.0), p, 5000, 1e-4)[:, 0]
    rate, free = np.diff(T).max() / 1e-4, 0.4556 * 100.0 / tau  # exp(-pi/4) of the lag alone
    assert rate == pytest.approx(min(dT_max, free), rel=0.02)
    assert T.max() <= 100.0 * (1.0 + exp(-np.pi)) + 1e-6
    assert T[-1] == pytest.approx(100.0, abs=0.1)


@pytest.mark.parametrize(
    ("omega_1", "limit"), [(0.0, 180.0), (299.9, 180.0), (-300.0, 180.0), (400.0, 135.0), (-600.0, 90.0)]
)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_above_the_base_speed_the_power_is_constant(omega_1: float, limit: float, side: float) -> None:
    p, u = SILENT._replace(omega_base=300.0), motor.Input(side * 200.0, omega_1)
    assert motor.start(u, p).T_mot == pytest.approx(side * limit)
    assert run(u, p, 1, 0.1)[-1, 0] == pytest.approx(side * limit, abs=1e-6)


def test_without_their_parameters_the_effects_change_no_bit() -> None:
    """Of the rates that are integrated, at any demand and speed."""
    draw = np.random.default_rng(1)
    for T_ref, omega_1, T_mot, dT_mot in (draw.uniform(-1.0, 1.0, (200, 4)) * (2000.0, 5000.0, 2000.0, 1e6)).tolist():
        x = motor.start(motor.Input(), P)._replace(T_mot=T_mot, dT_mot=dT_mot)
        dx = motor.derivative(x, motor.Input(T_ref, omega_1), P)
        within = max(-P.T_max, min(T_ref, P.T_max))
        assert dx[:2] == (dT_mot, (within - T_mot - motor.SQRT_2 * P.tau * dT_mot) / (P.tau * P.tau))
        assert dx[3:] == (0.0,) * 4


def exact_and_integrated(x: motor.State, u: motor.Input, du: motor.Input, p: motor.Parameters, h: float) -> np.ndarray:
    """Torque and rate after h s by the solution in closed form, and by SciPy with inputs that move."""

    def rates(t: float, values: np.ndarray) -> tuple[float, ...]:
        at = motor.Input(u.T_ref + float(t) * du.T_ref, u.omega_1 + float(t) * du.omega_1)
        T_mot, dT_mot = values.tolist()
        return motor.derivative(x._replace(T_mot=T_mot, dT_mot=dT_mot), at, p)[:2]

    integrated = solve_ivp(rates, (0.0, h), x[:2], method="DOP853", rtol=1e-12, atol=1e-9, max_step=h / 20.0).y[:, -1]
    return np.array([motor.solution(x, u, du, p, h)[1][:2], integrated])


@given(
    state=st.tuples(st.floats(-180.0, 180.0), st.floats(-2e4, 2e4)),
    T_ref=st.floats(-150.0, 150.0),
    rate=st.floats(-3000.0, 3000.0),
    tau=st.floats(1e-3, 0.1),
    h=st.floats(1e-4, 0.01),
)
@settings(max_examples=40)
def test_the_solution_is_that_of_the_equations_with_a_demand_that_moves(
    state: tuple[float, float], T_ref: float, rate: float, tau: float, h: float
) -> None:
    x, p = motor.start(motor.Input(), P)._replace(T_mot=state[0], dT_mot=state[1]), P._replace(tau=tau)
    u, du = motor.Input(T_ref, 100.0), motor.Input(rate, 50.0)
    assert motor.solution(x, u, du, p, h)[0]
    ours, theirs = exact_and_integrated(x, u, du, p, h)
    assert ours == pytest.approx(theirs, rel=1e-8, abs=1e-6)


@pytest.mark.parametrize(
    ("changed", "u", "du", "holds"),
    [
        ({"t_dead": 9.9e-5}, motor.Input(100.0), motor.Input(), True),
        ({"t_dead": 1e-4}, motor.Input(100.0), motor.Input(), False),
        ({}, motor.Input(179.0), motor.Input(990.0), True),
        ({}, motor.Input(179.0), motor.Input(1010.0), False),
        ({}, motor.Input(200.0, 3000.0), motor.Input(0.0, 1.0), True),
        ({"omega_base": 100.0}, motor.Input(200.0, 300.0), motor.Input(), True),
        ({"omega_base": 100.0}, motor.Input(200.0, 300.0), motor.Input(0.0, 1.0), False),
        # 100 N.m away the rate comes to 2 a 100 = 47 140 N.m/s at most
        ({"dT_max": 4.72e4}, motor.Input(100.0), motor.Input(), True),
        ({"dT_max": 4.71e4}, motor.Input(100.0), motor.Input(), False),
    ],
)
def test_the_solution_holds_without_dead_time_and_limits(
    changed: dict[str, float], u: motor.Input, du: motor.Input, holds: bool
) -> None:
    x = motor.start(motor.Input(), P)
    assert motor.solution(x, u, du, P._replace(**changed), 1e-3)[0] is holds


@pytest.mark.parametrize("T_ref", [-300.0, 100.0, 300.0])
@pytest.mark.parametrize("omega_1", [0.0, 400.0])
def test_a_demand_beyond_the_limit_is_solved_like_integrated(T_ref: float, omega_1: float) -> None:
    p, x = SILENT._replace(omega_base=300.0), motor.start(motor.Input(20.0), P)
    ours, theirs = exact_and_integrated(x, motor.Input(T_ref, omega_1), motor.Input(), p, 2e-3)
    assert ours == pytest.approx(theirs, rel=1e-9, abs=1e-7)
