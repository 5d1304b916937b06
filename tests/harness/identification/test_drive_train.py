"""The model that is identified: its equations, and how accurately they are solved."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from driveline.harness.identification import drive_train
from driveline.harness.identification.drive_train import STEPS, Y_D, Parameters

with_numbers: Any = drive_train
"""What is written for symbols takes numbers as well."""

State, gear_torque, sample, step = (getattr(with_numbers, name) for name in ("State", "gear_torque", "sample", "step"))

P = Parameters(J_1=0.055, J_2=0.3, C=117.4, d=0.3, phi_B=0.157, g_T=1.02, g_L=0.98)
T_MOT, T_LOAD = 20.0, -12.0
"""Recorded, in N.m."""

IN_CONTACT = State(130.0, 128.0, 0.35, 0.5, -0.7)
THROUGH_THE_GAP = State(105.0, 128.0, 0.25, 0.5, -0.7)


def torque(phi: float, dphi: float, p: Parameters) -> float:
    """Of the module's equations."""
    y = np.sign(phi) * max(abs(phi) - p.phi_B, 0.0)
    return p.C * y + min(1.0, abs(y) / Y_D) * p.d * dphi


def exact(x: Any, duration: float, p: Parameters) -> np.ndarray:
    """omega_1, omega_2 and phi after a time in s, in steps that the flanks make short."""

    def derivative(_: float, now: np.ndarray) -> list[float]:
        T_gear = torque(now[2], now[0] - now[1], p)
        T_1, T_2 = T_MOT / p.g_T + x.o_T, T_LOAD / p.g_L + x.o_L
        return [(T_1 - T_gear) / p.J_1, (T_2 + T_gear) / p.J_2, now[0] - now[1]]

    solved = solve_ivp(derivative, (0.0, duration), x[:3], "DOP853", rtol=1e-11, atol=1e-11, max_step=1e-3)
    return solved.y[:, -1]


def steps(x: Any, duration: float, count: int, p: Parameters) -> Any:
    for _ in range(count):
        x = State(*map(float, step(x, T_MOT, T_LOAD, duration / count, p)))
    return x


def off(x: Any, duration: float, count: int) -> np.ndarray:
    """What the speeds and the twist are off by."""
    return np.array(steps(x, duration, count, P)[:3]) - exact(x, duration, P)


@pytest.mark.parametrize("x", [IN_CONTACT, THROUGH_THE_GAP])
def test_fine_steps_come_to_the_accurate_solution(x: Any) -> None:
    """The way through the gap meets both flanks, at each of which the damper sets in."""
    np.testing.assert_allclose(off(x, 0.06, 6000), 0.0, atol=3e-6)


def test_the_way_through_the_gap_meets_both_flanks() -> None:
    twists = [steps(THROUGH_THE_GAP, t, 100, P).phi for t in (0.02, 0.03, 0.04)]
    assert THROUGH_THE_GAP.phi > P.phi_B
    assert min(twists) < -P.phi_B - Y_D


@pytest.mark.parametrize("x", [IN_CONTACT, THROUGH_THE_GAP])
def test_the_solution_is_of_second_order_in_the_step(x: Any) -> None:
    coarse, fine = (np.linalg.norm(off(x, 0.06, count)) for count in (100, 400))
    assert coarse / fine == pytest.approx(16.0, rel=0.15 if x is IN_CONTACT else 0.8)


def test_a_sample_at_2_ms_has_the_frequency_to_1e_5() -> None:
    """Phase and amplitude after 1 s, 8 oscillations, without damping and load; the wave of the speeds is 6 rad/s."""
    p = Parameters(0.055, 0.3, 117.4, 0.0, 0.0)
    omega = np.sqrt(p.C * (1.0 / p.J_1 + 1.0 / p.J_2))
    x = State(6.0, 0.0, 0.0, 0.0, 0.0)
    for _ in range(500):
        x = State(*map(float, sample(x, [0.0] * STEPS, [0.0] * STEPS, 0.002, p)))
    complex_wave = (x.omega_1 - x.omega_2) + 1j * omega * x.phi
    wave = complex_wave / (6.0 * np.exp(1j * omega))
    assert abs(wave) == pytest.approx(1.0, abs=1e-4)
    assert 0.0 < np.angle(wave) / omega < 5e-5


def test_a_sample_is_its_steps_each_with_its_torque() -> None:
    T_mot, T_load = [20.0, 25.0, -5.0, 3.0], [-12.0, -8.0, -9.0, 4.0]
    x = IN_CONTACT
    for T_1, T_2 in zip(T_mot, T_load, strict=True):
        x = step(x, T_1, T_2, 0.0005, P)
    assert [float(value) for value in sample(IN_CONTACT, T_mot, T_load, 0.002, P)] == [float(value) for value in x]


def energy(x: Any, p: Parameters) -> float:
    """Of the oscillation, in J: of the speed difference with the reduced inertia, and of the spring."""
    y = max(abs(x.phi) - p.phi_B, 0.0)
    return 0.5 * p.J_1 * p.J_2 / (p.J_1 + p.J_2) * (x.omega_1 - x.omega_2) ** 2 + 0.5 * p.C * y**2


def oscillation(d: float) -> tuple[np.ndarray, np.ndarray]:
    """Energy in J and momentum in N.m.s over 4 s, in and out of the gap, without torques."""
    p = P._replace(d=d)
    x, seen = State(124.0, 128.0, 0.2, 0.0, 0.0), []
    for _ in range(8000):
        x = State(*map(float, step(x, 0.0, 0.0, 0.0005, p)))
        seen.append((energy(x, p), p.J_1 * x.omega_1 + p.J_2 * x.omega_2))
    energies, momenta = np.array(seen).T
    return energies, momenta


def test_without_damping_the_energy_remains() -> None:
    energies, momenta = oscillation(0.0)
    np.testing.assert_allclose(energies, energies[0], rtol=0.01)
    assert energies[-2000:].mean() == pytest.approx(energies[:2000].mean(), rel=1e-3)
    np.testing.assert_allclose(momenta, momenta[0], rtol=1e-12)


def test_with_damping_the_energy_only_falls_and_the_momentum_remains() -> None:
    energies, momenta = oscillation(0.3)
    assert energies[-1] < 0.3 * energies[0]
    assert np.maximum.accumulate(energies[::-1])[::-1].max() < 1.01 * energies[0]
    np.testing.assert_allclose(momenta, momenta[0], rtol=1e-12)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("beyond", [0.0, Y_D])
def test_the_torque_has_no_jump_where_teeth_meet_and_where_the_damper_acts_in_full(side: float, beyond: float) -> None:
    flank = side * (P.phi_B + beyond)
    before, at, after = (float(gear_torque(flank + by, 20.0 * side, P)) for by in (-1e-9, 0.0, 1e-9))
    assert before == pytest.approx(at, abs=1e-5)
    assert after == pytest.approx(at, abs=1e-5)


@pytest.mark.parametrize("phi", [-0.4, -0.16, -0.1, 0.0, 0.1, 0.16, 0.4])
def test_the_torque_is_that_of_spring_and_damper_between_teeth_that_touch(phi: float) -> None:
    assert float(gear_torque(phi, 7.0, P)) == pytest.approx(torque(phi, 7.0, P), rel=1e-12)


def test_the_implicit_torque_solves_its_own_equation() -> None:
    """It slows the twist that it depends on."""
    T_gear = float(gear_torque(0.4, 7.0, P, implicit=0.01))
    assert T_gear == pytest.approx(torque(0.4, 7.0 - 0.01 * T_gear, P), rel=1e-12)
