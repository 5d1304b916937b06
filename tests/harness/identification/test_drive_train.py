"""The model that is identified: its equations, and how accurately they are solved."""

from typing import Any

import casadi as ca
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from driveline.harness.identification import drive_train
from driveline.harness.identification.drive_train import EDGE, STEPS, Y_D, Parameters, Vehicle

with_numbers: Any = drive_train
"""What is written for symbols takes numbers as well."""

State, derivative, gear_torque, step, tyre_torque = (
    getattr(with_numbers, name) for name in ("State", "derivative", "gear_torque", "step", "tyre_torque")
)

P = Parameters(0.055, 0.3, 117.4, 0.3, 0.157, g_T=1.02, g_L=0.98, c_t=2900.0, sigma_t=1.55)
BEHIND = Vehicle(1.505, 4.15, 15.5)
T_MOT = 20.0
"""Recorded, in N.m."""

IN_CONTACT = State(130.0, 128.0, 127.5, 0.35, 12.0, -11.0, 0.5, -0.7)
THROUGH_THE_GAP = State(105.0, 128.0, 127.5, 0.25, 12.0, -11.0, 0.5, -0.7)


def torque(phi: float, dphi: float, p: Parameters) -> float:
    """Of the gear, with edges that are rounded."""
    driving, braking = phi - p.phi_B, phi + p.phi_B
    y = 0.5 * (driving + np.hypot(driving, EDGE) + braking - np.hypot(braking, EDGE))
    return p.C * y + min(1.0, abs(y) / Y_D) * p.d * dphi


def rates(x: Any, p: Parameters = P) -> list[float]:
    """By the equations of the module."""
    T_gear = torque(x.phi, x.omega_1 - x.omega_2, p)
    slip = x.omega_2 - x.omega_v
    T_tyre = x.T_c + BEHIND.d_low * slip / (1.0 + (x.omega_v / BEHIND.omega_low) ** 2)
    relaxing = max(abs(x.omega_2), abs(x.omega_v)) * x.T_c / p.sigma_t
    return [
        (T_MOT / p.g_T + x.o_T - T_gear) / p.J_1,
        (T_gear - T_tyre) / p.J_2,
        (T_tyre + x.R) / BEHIND.J_v,
        x.omega_1 - x.omega_2,
        p.c_t * slip - relaxing,
        0.0,
        0.0,
        0.0,
    ]


@pytest.mark.parametrize("x", [IN_CONTACT, IN_CONTACT._replace(omega_v=131.0), IN_CONTACT._replace(omega_v=-4.0)])
def test_the_derivatives_are_those_of_the_equations(x: Any) -> None:
    """Driving, braking, and where the tyre's damper acts."""
    np.testing.assert_allclose([float(one) for one in derivative(x, T_MOT, P, BEHIND)], rates(x), rtol=1e-9)


def exact(x: Any, duration: float) -> np.ndarray:
    """The state after a time in s, in steps that the flanks make short."""
    solved = solve_ivp(
        lambda _, now: rates(State(*now)), (0.0, duration), x, "DOP853", rtol=1e-11, atol=1e-11, max_step=1e-3
    )
    return solved.y[:, -1]


def steps(x: Any, duration: float, count: int, p: Parameters = P, behind: Vehicle = BEHIND) -> Any:
    for _ in range(count):
        x = State(*map(float, step(x, T_MOT, duration / count, p, behind)))
    return x


@pytest.mark.parametrize("x", [IN_CONTACT, THROUGH_THE_GAP])
def test_fine_steps_come_to_the_accurate_solution(x: Any) -> None:
    """The way through the gap meets both flanks."""
    off = np.array(steps(x, 0.05, 2000)) - exact(x, 0.05)
    np.testing.assert_allclose(off, 0.0, atol=1e-3)
    assert x is IN_CONTACT or steps(x, 0.03, 100).phi < -P.phi_B - Y_D


def test_the_solution_is_of_second_order_in_the_step() -> None:
    coarse, fine = (np.linalg.norm(np.array(steps(IN_CONTACT, 0.02, n)) - exact(IN_CONTACT, 0.02)) for n in (40, 160))
    assert coarse / fine == pytest.approx(16.0, rel=0.25)


def test_a_sample_at_2_ms_has_the_frequency_to_1e_5() -> None:
    """Phase and amplitude after 1 s, 8 oscillations, without damping and tyre; the wave of the speeds is 6 rad/s."""
    p = P._replace(d=0.0, phi_B=0.0, c_t=0.0, g_T=1.0)
    omega = np.sqrt(p.C * (1.0 / p.J_1 + 1.0 / p.J_2))
    x = State(6.0, 0.0, 0.0, 0.0, 0.0, 0.0, -T_MOT, 0.0)
    x = steps(x, 1.0, 500 * STEPS, p, Vehicle(1.505))
    wave = ((x.omega_1 - x.omega_2) + 1j * omega * x.phi) / (6.0 * np.exp(1j * omega))
    assert abs(wave) == pytest.approx(1.0, abs=1e-4)
    assert 0.0 < np.angle(wave) / omega < 5e-5


def test_without_damping_the_energy_of_the_oscillation_remains_and_with_it_only_falls() -> None:
    """In and out of the gap, without torques, 2 s."""

    def energies(d: float) -> np.ndarray:
        p, x, seen = P._replace(d=d, c_t=0.0), State(124.0, 128.0, 0.0, 0.2, 0.0, 0.0, -T_MOT / P.g_T, 0.0), []
        for _ in range(4000):
            x = State(*map(float, step(x, T_MOT, 0.0005, p, BEHIND._replace(d_low=0.0))))
            y = max(abs(x.phi) - p.phi_B, 0.0)
            inertia = p.J_1 * p.J_2 / (p.J_1 + p.J_2)
            seen.append(0.5 * inertia * (x.omega_1 - x.omega_2) ** 2 + 0.5 * p.C * y**2)
        return np.array(seen)

    free, damped = energies(0.0), energies(0.3)
    np.testing.assert_allclose(free, free[0], rtol=0.03)
    assert damped[-1] < 0.5 * damped[0]
    assert damped.max() < 1.02 * damped[0]


@pytest.mark.parametrize("phi", [-0.4, -0.1, 0.0, 0.1, 0.4])
def test_the_gear_torque_is_that_of_spring_and_damper_but_at_the_edge(phi: float) -> None:
    """There it is off by half of EDGE, and has no kink."""
    y = np.sign(phi) * max(abs(phi) - P.phi_B, 0.0)
    sharp = P.C * y + min(1.0, abs(y) / Y_D) * P.d * 7.0
    assert float(gear_torque(phi, 7.0, P)) == pytest.approx(sharp, abs=2e-3)
    at = np.linspace(P.phi_B - EDGE, P.phi_B + EDGE, 21)
    slopes = np.diff([float(gear_torque(phi, 0.0, P)) for phi in at]) / np.diff(at)
    assert float(gear_torque(P.phi_B, 0.0, P)) == pytest.approx(0.5 * EDGE * P.C, rel=1e-2)
    assert np.abs(np.diff(slopes)).max() < 0.15 * P.C


def test_the_implicit_torque_solves_its_own_equation() -> None:
    T_gear = float(gear_torque(0.4, 7.0, P, implicit=0.01))
    assert T_gear == pytest.approx(torque(0.4, 7.0 - 0.01 * T_gear, P), rel=1e-9)


@pytest.mark.parametrize("late", [0.0, 0.001, -0.002])
def test_a_load_torque_that_is_late_is_that_of_before(late: float) -> None:
    """To the third order in the delay; with gain and offset."""
    x, T = ca.SX.sym("x", len(State._fields)), ca.SX.sym("T")
    p = P._replace(late_L=late)
    recorded = ca.Function("load", [x, T], [drive_train.recorded_load(State._make(ca.vertsplit(x)), T, p, BEHIND)])
    before = State(*exact(IN_CONTACT, 0.01 - late))
    found = float(recorded(exact(IN_CONTACT, 0.01), T_MOT))  # pyright: ignore[reportArgumentType]
    assert found == pytest.approx(-P.g_L * float(tyre_torque(before, BEHIND)) + IN_CONTACT.o_L, abs=0.05)
