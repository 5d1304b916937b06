"""What motor control makes of the demand, and how it is found in a recording."""

from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from fmutesting.slow import slow
from fmutesting.together import together
from scipy.integrate import solve_ivp

from driveline.harness.identification.torque_loop import PARAMETERS, SQRT_2, FittedLoop, TorqueLoop, fitted
from driveline.harness.manoeuvres.prbs import binary_torque, shift_register
from driveline.harness.simulation.simulate import simulate
from driverecords.source import RecordingError

T_S = 0.002
LOOP = TorqueLoop(tau=0.003, gain=1.02, offset=1.5, delay=0.0007)
NOISE = 0.3
DEMAND = 10.0 + 30.0 * (2.0 * np.repeat(np.array(shift_register(250), dtype=float), 20) - 1.0)
"""As of `driveline record` in 10 s."""


def noisy(loop: TorqueLoop, seed: int, T_ref: np.ndarray = DEMAND) -> np.ndarray:
    return loop.torque(T_ref, T_S) + NOISE * np.random.default_rng(seed).standard_normal(len(T_ref))


def require_found(found: FittedLoop, loop: TorqueLoop) -> None:
    """Within four standard deviations, which are small."""
    for name in PARAMETERS:
        assert abs(getattr(found.loop, name) - getattr(loop, name)) < 4.0 * found.deviations[name], name
    assert found.deviations["tau"] < 1.5e-3 * loop.tau
    assert found.deviations["delay"] < 1e-5


def test_the_torque_solves_the_equation() -> None:
    T_ref, x, found = DEMAND[:60], np.array([DEMAND[0], 0.0]), []

    def derivative(_: float, x: np.ndarray, demand: float) -> list[float]:
        T, rate = x
        return [rate, (demand - T - np.sqrt(2.0) * LOOP.tau * rate) / LOOP.tau**2]

    for k in range(len(T_ref)):
        found.append(x[0])
        for demand, length in ((T_ref[max(k - 1, 0)], LOOP.delay), (T_ref[k], T_S - LOOP.delay)):
            x = solve_ivp(derivative, (0.0, length), x, args=(demand,), rtol=1e-11, atol=1e-10).y[:, -1]
    np.testing.assert_allclose(LOOP.torque(T_ref, T_S), LOOP.gain * np.array(found) + LOOP.offset, atol=1e-7)


def test_the_derivatives_are_those_of_the_torque() -> None:
    found = LOOP.derivatives(DEMAND, T_S)
    for k, name in enumerate(PARAMETERS):
        step = 1e-6 * (1e-3 if name in ("tau", "delay") else 1.0)
        ahead, behind = (replace(LOOP, **{name: getattr(LOOP, name) + side * step}) for side in (1.0, -1.0))
        difference = (ahead.torque(DEMAND, T_S) - behind.torque(DEMAND, T_S)) / (2.0 * step)
        np.testing.assert_allclose(found[:, k], difference, atol=1e-5 * np.abs(difference).max(), err_msg=name)


@together("tau, delay", product([0.001, 0.0045, 0.03], [0.0, T_S, 0.0007, -0.03, 0.08]))
def test_lag_and_delay_are_found_apart(tau: float, delay: float) -> None:
    loop = replace(LOOP, tau=tau, delay=delay)
    found = fitted(DEMAND, noisy(loop, 1), T_S)
    for name in PARAMETERS:
        assert abs(getattr(found.loop, name) - getattr(loop, name)) < 4.0 * found.deviations[name], name
    assert found.explained > 0.999


@pytest.mark.slow
def test_the_lag_is_found_to_four_thousandths_and_its_interval_covers() -> None:
    found = [fitted(DEMAND, noisy(LOOP, seed), T_S) for seed in range(100)]
    assert max(abs(one.loop.tau / LOOP.tau - 1.0) for one in found) < 0.004
    for name in PARAMETERS:
        covered = [abs(getattr(f.loop, name) - getattr(LOOP, name)) < 1.96 * f.deviations[name] for f in found]
        assert 0.89 <= np.mean(covered), f"{name}: 95 %, of 100 runs"
    lag = np.array([one.loop.delay + SQRT_2 * one.loop.tau for one in found])
    assert lag.std() == pytest.approx(np.mean([one.lag for one in found]), rel=0.2)
    assert lag.std() < 0.5 * np.std([one.loop.delay for one in found]), "of which less is known of either"
    assert np.mean([one.noise for one in found]) == pytest.approx(NOISE, rel=0.01)


def test_what_was_demanded_before_the_recording_does_not_matter() -> None:
    T_mot = noisy(LOOP, 1)
    require_found(fitted(DEMAND[:-7], T_mot[:-7], T_S), LOOP)
    require_found(fitted(DEMAND[1003:], T_mot[1003:], T_S), LOOP)


def test_steps_of_the_demand_that_are_logged_a_tick_off_move_nothing_and_are_not_met() -> None:
    """Every tenth by a sample, as by a clock that is rounded."""
    T_mot, early = noisy(LOOP, 1), DEMAND.copy()
    steps = np.flatnonzero(np.diff(DEMAND))[::10]
    early[steps] = DEMAND[steps + 1]
    found = fitted(early, T_mot, T_S)
    assert abs(found.loop.tau - LOOP.tau) < 4.0 * found.deviations["tau"]
    assert abs(found.loop.delay - LOOP.delay) < 2e-5
    assert found.noise == pytest.approx(NOISE, rel=0.05)
    assert not any(found.met[step : step + 5].any() for step in steps)
    assert found.met[steps[0] :].mean() > 0.9 * (1.0 - 14 * len(steps) / len(DEMAND))


def test_a_demand_that_does_not_change_is_refused() -> None:
    with pytest.raises(RecordingError, match="the torque demand does not change"):
        fitted(np.full(1000, 20.0), noisy(LOOP, 1, np.full(1000, 20.0)), T_S)


@pytest.mark.parametrize("tau", slow([0.003, 0.0045], but=[0.0045]))
def test_motor_control_of_the_loop_is_found(both_built: Path, tau: float) -> None:
    """From what it reports, in open and closed loop, with a demand that comes a sample late or early."""
    manoeuvre = binary_torque("prbs", 10.0, 30.0, 0.04, 9, 10.0, 15.0 / 3.6)
    true = TorqueLoop(tau, gain=1.03, offset=-1.0)
    given = {"motor.tau": tau, "motor.g_T": true.gain, "motor.o_T": true.offset}
    for control in (False, True):
        results = simulate(manoeuvre, control=control, parameters=given, folder=both_built)[::2]
        T_ref, T_mot = results["controller.T_ref"], results["motor.T_mot_est"]
        for late in (-1, 0, 1):
            found = fitted(np.roll(T_ref, late), T_mot, T_S)
            require_found(found, replace(true, delay=-late * T_S))
            assert found.loop.tau == pytest.approx(tau, rel=0.004)
            assert found.noise == pytest.approx(NOISE, rel=0.05)
