"""The design model: exact between its flanks, lossless without load, at rest when it should be."""

import numpy as np
import pytest
from fmutesting.slow import slow
from hypothesis import given, settings
from hypothesis import strategies as st

from driveline.models import two_mass_driveline as driveline
from fmublocks.block.integrator import Integrator
from tests.models.exact_driveline import ExactDriveline

RECORDED = driveline.Parameters(recorded_load=True)


def rattling(h: float, duration: float, seed: int) -> tuple[list[float], list[float]]:
    """Motor and load torque that drive the teeth from flank to flank, held over steps of h."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(duration / h)) * h

    def sines(amplitude: float, low: float, high: float) -> list[float]:
        waves = zip(rng.uniform(low, high, 6), rng.uniform(0.0, 6.0, 6), strict=True)
        return np.sum([amplitude * np.sin(2.0 * np.pi * f * t + angle) for f, angle in waves], axis=0).tolist()

    return sines(12.0, 1.0, 9.0), sines(6.0, 0.3, 3.0)


@pytest.mark.parametrize("h", slow([1e-4, 5e-4, 1e-3, 3.3e-3, 1e-2], but=(3.3e-3,)))
def test_agrees_with_the_exact_solution_through_hundreds_of_flanks(h: float) -> None:
    T_mot, T_load = rattling(h, 10.0, seed=2)
    integrator, exact = Integrator(driveline.BLOCK), ExactDriveline(RECORDED)
    x = driveline.start(driveline.Input(), RECORDED)
    ours, theirs = [], []
    for T_m, T_l in zip(T_mot, T_load, strict=True):
        x = integrator.advance(x, driveline.Input(T_mot=T_m, T_load_rec=T_l), RECORDED, h)
        exact.advance(T_m, T_l, h)
        ours.append((x.omega_1, x.omega_2, x.phi))
        theirs.append((exact.omega_1, exact.omega_2, exact.phi))
    error = np.abs(np.array(ours) - np.array(theirs)).max(axis=0) / np.ptp(np.array(theirs), axis=0)
    assert exact.crossings > 200
    assert error.max() < 1e-8, "requirement of the specification: 1e-8 of each signal's range over 10 s"


def energy(x: driveline.State, p: driveline.Parameters) -> float:
    elastic = driveline.gear_torque(x, p) ** 2 / (2.0 * p.C)
    return 0.5 * p.J_1 * x.omega_1**2 + 0.5 * p.J_2 * x.omega_2**2 + elastic


def test_energy_is_kept_without_load() -> None:
    integrator, u = Integrator(driveline.BLOCK), driveline.Input()
    x = driveline.start(u, RECORDED)._replace(omega_1=40.0, omega_2=-3.0)
    first = energy(x, RECORDED)
    for _ in range(10_000):
        x = integrator.advance(x, u, RECORDED, 1e-3)
        assert energy(x, RECORDED) == pytest.approx(first, rel=1e-9)


@given(phi=st.floats(-0.157, 0.157), omega_1=st.floats(-500.0, 500.0), omega_2=st.floats(-500.0, 500.0))
def test_no_torque_inside_the_gap(phi: float, omega_1: float, omega_2: float) -> None:
    x = driveline.State(omega_1, omega_2, phi, 0.0, 0.0, 0.0)
    assert driveline.gear_torque(x, driveline.Parameters()) == 0.0


@given(phi=st.floats(-3.0, 3.0), step=st.floats(1e-9, 1e-3))
def test_gear_torque_is_continuous_odd_and_rises_with_the_stiffness(phi: float, step: float) -> None:
    p = driveline.Parameters()
    x = driveline.State(0.0, 0.0, phi, 0.0, 0.0, 0.0)
    rise = driveline.gear_torque(x._replace(phi=phi + step), p) - driveline.gear_torque(x, p)
    assert -1e-9 <= rise <= p.C * step + 1e-9
    assert driveline.gear_torque(x._replace(phi=-phi), p) == -driveline.gear_torque(x, p)


@settings(max_examples=20)
@given(T=st.floats(-150.0, 150.0), v_0=st.floats(1.0, 30.0))
def test_a_rolling_start_is_stationary(T: float, v_0: float) -> None:
    p = driveline.Parameters(v_0=v_0, T_0=T)
    u = driveline.Input(T_mot=T)
    dx = driveline.derivative(driveline.start(u, p), u, p)
    assert dx.omega_1 == pytest.approx(p.i * dx.v / p.r, abs=2e-2 + 0.02 * abs(dx.omega_1))
    assert dx.phi == 0.0
    assert dx.z == pytest.approx(0.0, abs=1e-12)


def test_with_a_recorded_load_the_vehicle_follows_the_wheels_without_slip() -> None:
    p = RECORDED._replace(v_0=5.0, T_0=30.0)
    u = driveline.Input(T_mot=30.0, T_load_rec=-30.0)
    x = driveline.start(u, p)
    assert x.phi == pytest.approx(30.0 / p.C + p.phi_B)
    assert x.omega_1 == x.omega_2 == pytest.approx(p.i * 5.0 / p.r)
    y = driveline.output(Integrator(driveline.BLOCK).advance(x, u._replace(T_mot=60.0), p, 0.3), u, p)
    assert y.v == pytest.approx(p.r * y.omega_2 / p.i, rel=1e-12)
    assert y.T_load == -30.0


def test_natural_frequency_is_that_of_the_specification() -> None:
    p = driveline.Parameters()
    assert np.sqrt(p.C * (1.0 / p.J_1 + 1.0 / p.J_2)) / (2.0 * np.pi) == pytest.approx(7.999, abs=5e-4)
