"""A second estimator and a second law: a file each, and one line that joins them (OTHER, in controllers.py)."""

import math
from typing import Any, NamedTuple

import pytest
from fmutesting.recorded import computed

from driveline.models.comparators import measured_speeds, speed_washout
from driveline.models.comparators.speed_washout import Washout
from driveline.models.controller import T_S, causes, damping_law, supervision, torque_estimator, torque_loop
from driveline.models.controller.interfaces import Addition, Estimator, Law, Motion
from driveline.models.controller.supervised_controller import supervised
from driveline.models.controller.trust import TrustState
from fmublocks.block.declaration import variables
from fmublocks.native.trace import leaves, trace
from tests.models.controller.controllers import OTHER, OURS, ROLLING, run, shaken


def test_the_parameters_are_those_of_the_parts_and_of_the_supervision() -> None:
    parts = measured_speeds.Parameters, Washout.Parameters, supervision.Parameters
    assert variables(speed_washout.BLOCK.Parameters) == tuple(v for part in parts for v in variables(part))


@pytest.mark.parametrize("law", [damping_law, Washout()], ids=["damping_law", "washout"])
@pytest.mark.parametrize("estimator", [torque_estimator, measured_speeds], ids=lambda estimator: estimator.__name__)
def test_every_law_damps_behind_every_estimator(estimator: Estimator, law: Law) -> None:
    """A part declares all that it reads beside the parameters of the supervision."""
    states = run(supervised("Joined", "of any two parts", __name__, estimator, law), shaken(0.5))
    assert 5.0 < max(abs(x.T_damp) for x in states) <= supervision.Parameters().T_max


def test_it_damps_by_its_own_law() -> None:
    inputs = shaken(0.5)
    states, slow, p = run(OTHER, inputs, swing=1.0), inputs[0].omega_1_meas, OTHER.Parameters()
    for x, u in zip(states[1:], inputs, strict=True):
        assert x.T_damp == pytest.approx(-p.k_v * (u.omega_1_meas - slow), abs=1e-9)
        slow += p.omega_v * T_S * (u.omega_1_meas - slow)
    assert max(abs(x.T_damp) for x in states) > 10.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_whatever_a_law_says_its_damping_is_at_most_t_add_max(side: float) -> None:
    """A law of one's own need not limit it."""
    p = OTHER.Parameters(k_v=1e3, T_take_max=100.0, T_add_max=60.0)
    x = OTHER.start(ROLLING, p)
    y = OTHER.update(x, ROLLING._replace(omega_1_meas=ROLLING.omega_1_meas + side * 5.0), p)
    assert y.T_damp == -side * 60.0


class Ahead(NamedTuple):
    """State of a law that adds nothing."""

    change: float


class Nothing(NamedTuple):
    """No parameters."""


class LooksAhead:
    """How much faster (rad/s) the motor will be at the next sample."""

    Parameters = Nothing

    def start(self, motion: Motion, T_driver: Any, p: Any) -> Ahead:
        return Ahead(0.0)

    def update(
        self, x: Ahead, motion: Motion, expected: Motion, T_driver: Any, T_s: Any, p: Any
    ) -> tuple[Ahead, Addition]:
        return Ahead(expected.omega_1 - motion.omega_1), Addition(0.0, 0.0)


def test_what_is_expected_is_the_motion_under_the_torque_that_the_motor_will_have() -> None:
    """In the gap the motor has its inertia alone, and half of what it gains until the next sample acts."""
    block = supervised("Ahead", "looks ahead", __name__, torque_estimator, LooksAhead())
    floating = ROLLING._replace(T_driver=0.0, T_mot_est=0.0)
    before, now = run(block, [floating, floating._replace(T_driver=50.0)])[1:]
    assert (before.law.change, before.T_ref, now.T_ref) == (0.0, 0.0, 50.0)
    p = block.Parameters()
    after = block.update(now, floating._replace(T_driver=50.0), p)
    gained = torque_loop.update(now.motor.loop, 50.0, T_S, p).T_mot
    assert after.law.change == pytest.approx(T_S * 0.5 * gained / p.J_1, rel=1e-9)
    assert gained > 5.0


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("T_driver", [20.0, 60.0, 120.0, 180.0])
def test_a_free_motor_is_compared_with_the_torque_of_the_same_sample(T_driver: float, side: float) -> None:
    """Out of rest, with a step of the demand: the motor's speed follows from the torque that it has."""
    p, standing = OURS.Parameters(), ROLLING._replace(T_driver=0.0, omega_1_meas=0.0, T_mot_est=0.0, valid=False)
    x = OURS.start(standing, p)
    x = x._replace(launch=x.launch._replace(free=0.0))
    omega, T_mot, causes_shown = 0.0, 0.0, set()
    while omega < 6.0:
        x = OURS.update(x, standing._replace(T_driver=T_driver, T_mot_est=T_mot, omega_1_meas=side * omega), p)
        causes_shown.add(x.trust.cause)
        before, T_mot = T_mot, x.motor.loop.T_mot
        omega += 0.5 * T_S * (before + T_mot) / p.J_1
    assert (causes.WRONG_LAUNCH in causes_shown) is (side < 0.0)


def test_a_speed_of_the_other_sign_needs_longer_to_heal() -> None:
    """However steady it is, where no wheel speed contradicts."""
    p, backwards = OURS.Parameters(), ROLLING._replace(T_driver=20.0, T_mot_est=20.0, omega_1_meas=-10.0, valid=False)
    x = OURS.start(backwards, p)
    for direction, needed in ((-1.0, p.t_proof), (1.0, p.t_turn)):
        y = x._replace(trust=TrustState(causes.SPEED_JUMP, 0.0, 0.0, direction))
        statuses = []
        for k in range(round(1.2 / T_S)):
            y = OURS.update(y, backwards._replace(omega_1_meas=-10.0 + 0.3 * (-1) ** k), p)
            statuses.append(y.status)
        proven = statuses.index(supervision.WITHOUT_WHEEL_SPEED) * T_S
        assert proven == pytest.approx(needed, abs=2.0 * T_S)


def test_it_is_traced_for_the_native_build() -> None:
    """And computes with symbols what it computes with numbers, in fallback too."""
    functions = {each.name: each for each in trace(OTHER)}
    p, inputs = OTHER.Parameters(), shaken(0.2)
    inputs = [u._replace(T_mot_est=math.nan) if 40 <= k < 60 else u for k, u in enumerate(inputs)]
    states = run(OTHER, inputs)
    assert supervision.FALLBACK in {x.status for x in states}
    for x, u, after in zip(states, inputs, states[1:], strict=False):
        found = computed(functions["update"], leaves(x), leaves(u), leaves(p))
        assert found == pytest.approx([float(value) for value in leaves(after)], rel=1e-12)
    shown = computed(functions["output"], leaves(states[-1]), leaves(ROLLING), leaves(p))
    assert shown == list(OTHER.output(states[-1], ROLLING, p))
