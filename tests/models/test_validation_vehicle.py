"""The validation vehicle obeys mechanics: power, contact, symmetry, friction."""

from functools import cache
from math import atan, sin, tanh
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from driveline.models import validation_vehicle as vehicle
from driveline.models.physics.backlash import dead_zone
from fmublocks.block.integrator import Integrator

P = vehicle.Parameters()
REST = vehicle.State(*[0.0] * len(vehicle.State._fields))

LIMITS = vehicle.State(
    omega_1=500.0, theta_1=6.3, theta_p=0.02, omega_p=1.0, gamma=0.025, omega_g=60.0, omega_d=2.0,
    x_L=0.1, x_R=0.1, omega_L=60.0, omega_R=60.0, u_L=0.05, u_R=0.05, z_L=P.z_br, z_R=P.z_br,
    s_h=0.005, v_h=15.0, v=15.0, theta_b=0.1, omega_b=0.5,
)  # fmt: skip
"""Range of each state, either sign."""

states = st.tuples(*(st.just(0.0) | st.floats(-limit, limit) for limit in LIMITS)).map(vehicle.State._make)
inputs = st.builds(
    vehicle.Input, T_mot=st.floats(-180.0, 180.0), T_brake=st.floats(0.0, 4000.0), slope=st.floats(-0.2, 0.2)
)


class Power(NamedTuple):
    """W: taken in, stored, and the sum of what flows, as a measure of rounding."""

    supplied: float
    stored: float
    flowing: float


def power(x: vehicle.State, u: vehicle.Input, p: vehicle.Parameters) -> Power:
    """Power taken in and stored at a state.

    Stored are the kinetic energies (that of the rotor with its speed in space), the springs, the
    spring of the gear stage 1/2 k_g y^2, the tyres as springs of their present load, and the brake
    bristles as springs of the present T_brake.

    Taken in are the air-gap torque with ripple at the speed of rotor against housing, gravity on the
    slope, and where the model simplifies: bushing force and brake torque act on the pitch of the body
    without their reaction on wheels and hubs. As tyre load and T_brake stiffen a spring they do work
    on it; leaving their change out of what is stored counts that work as neither.
    """
    dx = vehicle.derivative(x, u, p)
    k = vehicle.wheels(x, u, p)
    F_h = vehicle.bushing_force(x, p)
    friction = p.c_fm * tanh(x.omega_1 / p.omega_fm)
    supplied = [
        (vehicle.air_gap_torque(x, u, p) + friction) * x.omega_1,
        -p.m * p.g * sin(u.slope) * x.v,
        (F_h * (p.h - p.r) - k.T_brL - k.T_brR) * x.omega_b,
    ]
    y = dead_zone(x.gamma, p.phi_B / p.i)
    stored = [
        p.J_1 * (x.omega_1 + x.omega_p) * (dx.omega_1 + dx.omega_p),
        p.J_p * x.omega_p * dx.omega_p,
        p.J_g * x.omega_g * dx.omega_g,
        p.J_d * x.omega_d * dx.omega_d,
        0.5 * p.J_w * (x.omega_L * dx.omega_L + x.omega_R * dx.omega_R),
        p.m_h * x.v_h * dx.v_h,
        (p.m - p.m_h) * x.v * dx.v,
        p.J_y * x.omega_b * dx.omega_b,
        p.k_g * y * dx.gamma,
        p.k_p * (x.theta_p + x.theta_b) * (dx.theta_p + dx.theta_b),
        0.5 * p.k_s * (1.0 - p.asym) * x.x_L * dx.x_L,
        0.5 * p.k_s * (1.0 + p.asym) * x.x_R * dx.x_R,
        p.k_x * x.s_h * dx.s_h,
        p.k_th * x.theta_b * dx.theta_b,
        tyre_spring(x, x.u_L, 1.0 - p.t_asym, p.mu * p.g_muL, p) * dx.u_L,
        tyre_spring(x, x.u_R, 1.0 + p.t_asym, p.mu * p.g_muR, p) * dx.u_R,
        0.5 * u.T_brake * (x.z_L * dx.z_L + x.z_R * dx.z_R) / p.z_br,
    ]
    return Power(sum(supplied), sum(stored), sum(abs(term) for term in supplied + stored))


def tyre_spring(x: vehicle.State, deflection: float, share: float, mu: float, p: vehicle.Parameters) -> float:
    """Force in N of one tyre without its damping."""
    F_z = max(200.0, p.F_z0 - (p.k_th * x.theta_b + p.d_th * x.omega_b) / p.L_w)
    B = share * p.c_slip / (p.C_x * mu * p.F_z0)
    return 0.5 * mu * F_z * sin(p.C_x * atan(B * deflection / p.sigma))


@cache
def manoeuvre() -> list[tuple[vehicle.State, vehicle.Input]]:
    """Tip-in, tip-out and a stop with brakes on a grade, every millisecond."""
    p, integrator = P._replace(v_0=3.0, T_0=-12.0), Integrator(vehicle.BLOCK)
    course = [(100.0, 0.0, 0.0), (-40.0, 0.0, 0.03), (0.0, 2000.0, 0.03)]
    x, run = vehicle.start(vehicle.Input(-12.0), p), []
    for values in course:
        u = vehicle.Input(*values)
        for _ in range(700):
            run.append((x, u))
            x = integrator.advance(x, u, p, 1e-3)
    return run


def dissipation(x: vehicle.State, u: vehicle.Input, p: vehicle.Parameters = P) -> tuple[float, float]:
    """Dissipated power in W, and its rounding."""
    found = power(x, u, p)
    return found.supplied - found.stored, 1e-12 * found.flowing


@pytest.mark.parametrize("p", [P, P._replace(g_muL=0.1)], ids=["equal grip", "split grip"])
@given(x=states, u=inputs)
@settings(max_examples=250)
def test_dissipation_is_never_negative(p: vehicle.Parameters, x: vehicle.State, u: vehicle.Input) -> None:
    dissipated, rounding = dissipation(x, u, p)
    assert dissipated >= -rounding


def test_dissipation_is_never_negative_while_driving() -> None:
    powers = [dissipation(x, u) for x, u in manoeuvre()]
    assert all(dissipated >= -rounding for dissipated, rounding in powers)
    assert max(dissipated for dissipated, _ in powers) > 1000.0


def test_the_manoeuvre_ends_at_rest_and_rattles_before() -> None:
    contact = [np.sign(dead_zone(x.gamma, P.phi_B / P.i)) for x, _ in manoeuvre()]
    assert set(contact) == {-1.0, 0.0, 1.0}
    assert abs(manoeuvre()[-1][0].v) < 0.1


@given(x=states)
def test_teeth_never_pull(x: vehicle.State) -> None:
    y = dead_zone(x.gamma, P.phi_B / P.i)
    assert vehicle.gear_torque(x, P) * y >= 0.0
    if y == 0.0:
        assert vehicle.gear_torque(x, P) == 0.0


@pytest.mark.parametrize(("v_0", "T_0"), [(15 / 3.6, -12.0), (15 / 3.6, 20.0), (50 / 3.6, 30.0)])
def test_a_rolling_start_is_almost_stationary(v_0: float, T_0: float) -> None:
    p, u = P._replace(v_0=v_0, T_0=T_0), vehicle.Input(T_0)
    integrator, x, torques, speeds = Integrator(vehicle.BLOCK), vehicle.start(u, p), [], []
    for _ in range(500):
        x = integrator.advance(x, u, p, 1e-3)
        y = vehicle.output(x, u, p)
        torques.append(y.T_gear)
        speeds.append(y.omega_1 - y.omega_2)
    assert np.ptp(torques) < 0.02 * abs(T_0)
    assert max(np.abs(speeds)) < 0.2


@given(u=st.floats(-1.0, 1.0), mu=st.floats(0.05, 2.0), omega=st.floats(-300.0, 300.0), v_h=st.floats(-40.0, 40.0))
def test_a_tyre_transmits_at_most_what_the_road_gives_under_it(u: float, mu: float, omega: float, v_h: float) -> None:
    """Each of them, also where its wheel spins while the car stands; with equal grip all that it is today."""
    x = REST._replace(u_L=u, u_R=u, omega_L=omega, omega_R=omega, v_h=v_h)
    p, q = P._replace(mu=mu, g_muL=0.3, g_muR=1.2), P._replace(mu=0.5, g_muL=2.0, g_muR=2.0)
    found = vehicle.wheels(x, vehicle.Input(), p)
    assert abs(found.F_L) <= 0.5 * 0.3 * mu * P.F_z0 * (1.0 + 1e-12)
    assert abs(found.F_R) <= 0.5 * 1.2 * mu * P.F_z0 * (1.0 + 1e-12)
    assert vehicle.wheels(x, vehicle.Input(), P) == vehicle.wheels(x, vehicle.Input(), q)


def test_on_split_grip_the_wheel_on_ice_spins_and_the_other_pulls_little_more_than_it() -> None:
    """The open differential gives both half shafts the same torque, but for the friction of its side gears."""
    p, u, integrator = P._replace(g_muL=0.1), vehicle.Input(120.0), Integrator(vehicle.BLOCK)
    x = vehicle.start(vehicle.Input(), p)
    for _ in range(1000):
        x = integrator.advance(x, u, p, 1e-3)
    k = vehicle.wheels(x, u, p)
    assert x.omega_L > 5.0 * x.omega_R
    assert 0.0 < P.r * (k.F_R - k.F_L) < 1.5 * P.d_d * x.omega_d
    assert k.F_R < 0.5 * 0.5 * P.mu * P.F_z0


def test_the_twist_follows_the_speed_difference() -> None:
    """dphi/dt = omega_1 - omega_2, through gear stage, shafts and mounts."""
    for (before, u), (x, v), (after, _) in zip(manoeuvre(), manoeuvre()[1:], manoeuvre()[2:], strict=False):
        if u == v:
            rate = (vehicle.output(after, v, P).phi - vehicle.output(before, u, P).phi) / 2e-3
            y = vehicle.output(x, v, P)
            assert rate == pytest.approx(y.omega_1 - y.omega_2, rel=0.02, abs=0.1)


@pytest.mark.parametrize(("rate", "share"), [(0.0, 1.0), (5000.0, 1.0), (7500.0, 0.5), (10000.0, 0.0), (3e4, 0.0)])
def test_ripple_that_turns_too_fast_for_the_steps_fades_out(rate: float, share: float) -> None:
    assert vehicle.slow(rate) == pytest.approx(share)


def test_a_step_at_speed_takes_one_stretch_as_at_walking_pace(monkeypatch: pytest.MonkeyPatch) -> None:
    """In 50 steps of 1 ms with 150 N.m, which is what they cost."""

    def trials(v: float) -> int:
        integrator = Integrator(vehicle.BLOCK)
        once, count = integrator.trial, 0

        def counted(*arguments: object) -> tuple[vehicle.State, float]:
            nonlocal count
            count += 1
            return once(*arguments)  # pyright: ignore[reportArgumentType]

        monkeypatch.setattr(integrator, "trial", counted)
        u, p = vehicle.Input(150.0), P._replace(v_0=v, T_0=150.0)
        x = vehicle.start(u, p)
        for _ in range(50):
            x = integrator.advance(x, u, p, 1e-3)
        return count

    assert trials(40.0) == 50
    assert trials(4.0) <= 60
