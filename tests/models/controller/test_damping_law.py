"""The damping law: what it feeds back, washes out, limits, and how it lets the teeth land."""

import math
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from models import damping_controller
from models.controller import damping_law as law
from models.controller.damping_law import LawState
from models.controller.parts import Addition, Motion

P = damping_controller.BLOCK.Parameters(
    phi_B=0.25, k_d=2.0, k_gap=0.5, k_T=0.125, omega_w=2.0, T_pred=0.5, T_gap=60.0, t_land=1.0
)
T_S = 0.25
STILL = Motion(omega_1=100.0, omega_2=100.0, phi=0.75, T_gear=40.0)
"""In contact, nothing twists."""
AFLOAT = STILL._replace(phi=0.0, T_gear=0.0)
"""The teeth between the flanks."""


def staying(motion: Motion) -> Callable[[float], Motion]:
    return lambda h: motion


def added(motion: Motion, x: LawState, T_driver: float = 50.0, p: Any = P) -> float:
    """Torque in N.m that is added to the demand when the motion stays."""
    return sum(law.update(x, motion, staying(motion), T_driver, T_S, p)[1])


def just_above(limit: float) -> float:
    return math.nextafter(limit, math.inf)


@given(
    omega=st.floats(-1000.0, 1000.0), phi=st.floats(-2.0, 2.0), T_gear=st.floats(-300.0, 300.0), T=st.floats(-50, 50)
)
def test_a_motion_that_stays_is_not_opposed(omega: float, phi: float, T_gear: float, T: float) -> None:
    motion = Motion(omega, omega, phi, T_gear)
    assert added(motion, law.start(motion, T, P), T) == 0.0


def test_speed_difference_and_gear_torque_are_opposed() -> None:
    """By k_d a rad/s and k_T a N.m."""
    x = law.start(STILL, 50.0, P)
    assert added(STILL._replace(omega_1=103.0), x) == -2.0 * 3.0
    assert added(STILL._replace(omega_2=103.0), x) == 2.0 * 3.0
    assert added(STILL._replace(T_gear=56.0), x) == -0.125 * 16.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_speed_difference_counts_by_k_gap_between_the_flanks(side: float) -> None:
    """At half the backlash the teeth touch."""
    turning = AFLOAT._replace(omega_1=103.0, phi=side * 0.25)
    assert added(turning, law.start(AFLOAT, 50.0, P)) == -2.0 * 3.0
    assert added(turning._replace(phi=side * math.nextafter(0.25, 0.0)), law.start(AFLOAT, 50.0, P)) == -0.5 * 2.0 * 3.0


def test_what_will_be_when_the_torque_acts_is_opposed() -> None:
    asked = []

    def later(h: float) -> Motion:
        asked.append(h)
        return STILL._replace(omega_1=104.0)

    x, torque = law.update(law.start(STILL, 50.0, P), STILL, later, 50.0, T_S, P)
    assert asked == [P.T_pred]
    assert torque == (-2.0 * 4.0, 0.0)
    assert x.washout == 5.0 + 0.5 * 8.0


def test_the_washout_forgets_what_stays() -> None:
    """Each sample by the share omega_w T_s of what is left."""
    x, torques = law.start(STILL, 50.0, P), []
    for _ in range(4):
        turning = STILL._replace(omega_1=108.0)
        x, torque = law.update(x, turning, staying(turning), 50.0, T_S, P)
        torques.append(torque.damping)
    assert torques == [-16.0, -8.0, -4.0, -2.0]


@pytest.mark.parametrize(("omega_w", "share"), [(3.5, 0.875), (4.0, 1.0), (4.5, 1.0)])
def test_a_washout_faster_than_the_samples_takes_one(omega_w: float, share: float) -> None:
    assert law.washed_out(10.0, 26.0, omega_w, T_S) == 10.0 + share * 16.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_between_the_flanks_the_demand_is_limited(side: float) -> None:
    x = law.start(AFLOAT, 50.0, P)
    assert added(AFLOAT, x, side * 60.0) == 0.0
    assert added(AFLOAT, x, side * 64.0) == -side * 4.0
    assert added(STILL, law.start(STILL, 50.0, P), side * 64.0) == 0.0


def landing(motions: list[Motion], p: Any = P) -> list[bool]:
    """Whether the demand is limited in each sample."""
    x, limited = law.start(motions[0], 50.0, p), []
    for motion in motions:
        x, torque = law.update(x, motion, staying(motion), 100.0, T_S, p)
        limited.append(torque.landing != 0.0)
    return limited


def test_the_teeth_have_t_land_to_land() -> None:
    assert landing([AFLOAT] * 8) == [True] * 4 + [False] * 4
    assert landing([AFLOAT] * 8, P._replace(t_land=just_above(1.0))) == [True] * 4 + [False] * 4
    assert landing([AFLOAT] * 8, P._replace(t_land=math.nextafter(1.0, 0.0))) == [True] * 3 + [False] * 5
    assert landing([AFLOAT] * 2, P._replace(t_land=0.0)) == [False] * 2


def test_teeth_that_touched_may_land_again() -> None:
    still = STILL._replace(T_gear=0.0)
    assert landing([AFLOAT] * 6 + [still] + [AFLOAT] * 5) == [True] * 4 + [False] * 3 + [True] * 4 + [False]


def test_the_time_afloat_is_counted_no_further_than_needed() -> None:
    x = law.start(AFLOAT, 50.0, P)
    for _ in range(20):
        x, _ = law.update(x, AFLOAT, staying(AFLOAT), 0.0, T_S, P)
    assert x.landing == P.t_land + T_S


def test_the_limit_of_landing_comes_beside_the_damping_torque() -> None:
    motion = AFLOAT._replace(omega_1=104.0)
    _, torque = law.update(law.start(AFLOAT, 50.0, P), motion, staying(motion), 100.0, T_S, P)
    assert torque == Addition(damping=-0.5 * 2.0 * 4.0, landing=-40.0)


def test_nothing_is_softened_while_the_teeth_touch() -> None:
    assert law.soft_landing(100.0, 0.0, P) == 100.0
    assert law.soft_landing(100.0, 0.25, P) == 60.0
