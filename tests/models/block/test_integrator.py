"""The integrator: order 8 where a block is smooth, and no kink stepped over.

tests/fmus/native/test_integrator.py has the same said of the integrator in C.
"""

import math
import random
from collections.abc import Callable
from dataclasses import replace
from typing import Annotated, Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from driveline.models import two_mass_driveline as driveline
from fmublocks.block.declaration import Real
from fmublocks.block.implicit import NotIntegrable
from fmublocks.block.integrator import Integrator, TooMuchWork
from fmublocks.block.operators import maximum, where
from fmublocks.block.types import ContinuousBlock, no_event_indicators
from tests.models.exact_driveline import ExactDriveline

P = driveline.Parameters(recorded_load=True)
CONTACT = driveline.start(driveline.Input(), P)._replace(omega_1=3.0, phi=1.0)
LIVELY = driveline.start(driveline.Input(), P)._replace(omega_1=40.0, omega_2=-3.0)
BINARY_STEP = 2.0**-10
"""About 1 ms; its multiples have no rounding."""


MakeIntegrator = Callable[[ContinuousBlock], Any]


@pytest.fixture(scope="module")
def integrator() -> MakeIntegrator:
    """Makes the integrator of a block."""
    return Integrator


LITTLE_WORK = 20


@pytest.fixture
def hurried(monkeypatch: pytest.MonkeyPatch) -> MakeIntegrator:
    """Makes integrators that are allowed LITTLE_WORK."""
    monkeypatch.setattr("fmublocks.block.integrator.MOST_WORK", LITTLE_WORK)
    return Integrator


class Body(NamedTuple):
    """Height, speed, and what has been collected on the other side of the zero."""

    x: Annotated[float, Real("m", "height")]
    v: Annotated[float, Real("m/s", "speed")]
    beyond: Annotated[float, Real("m.s", "integral of the height beyond the zero")]


class Nothing(NamedTuple):
    pass


def block(
    derivative: Callable[..., Body], *indicators: Callable[[Body], float], step_size: float = 0.1
) -> ContinuousBlock:
    return ContinuousBlock(
        name="Body",
        description="a body and its event indicators",
        module=__name__,
        Parameters=Nothing,
        Input=Nothing,
        State=Body,
        Output=Body,
        start=lambda u, p: Body(0.0, 0.0, 0.0),
        output=lambda x, u, p: x,
        derivative=derivative,
        event_indicators=lambda x, u, p: tuple(indicator(x) for indicator in indicators),
        step_size=step_size,
    )


def thrown(height: float) -> ContinuousBlock:
    """A body under gravity; `beyond` is the integral of its height above `height`."""
    return block(lambda x, u, p: Body(x.v, -9.81, maximum(x.x - height, 0.0)), lambda x: x.x - height)


def error_in_contact(integrator: MakeIntegrator, steps: int) -> float:
    """Error after 0.2 s in contact, in rad/s, under torques that keep the teeth together."""
    u = driveline.Input(T_mot=80.0, T_load_rec=-20.0)
    exact = ExactDriveline(P, CONTACT.omega_1, CONTACT.omega_2, CONTACT.phi, side=1)
    exact.advance(u.T_mot, u.T_load_rec, 0.2)
    assert exact.crossings == 0
    smooth = replace(driveline.BLOCK, event_indicators=no_event_indicators, step_size=0.2 / steps)
    x = integrator(smooth).advance(CONTACT, u, P, 0.2)
    omega = math.sqrt(P.C * (1.0 / P.J_1 + 1.0 / P.J_2))
    return math.hypot(omega * (x.phi - exact.phi), x.omega_1 - exact.omega_1, x.omega_2 - exact.omega_2)


def test_the_order_is_eight_where_the_block_is_smooth(integrator: MakeIntegrator) -> None:
    steps = np.array([40, 48, 56, 64])
    errors = [error_in_contact(integrator, n) for n in steps]
    assert -np.diff(np.log(errors)) / np.diff(np.log(steps)) == pytest.approx(8.0, abs=0.2)


def test_teeth_that_part_and_meet_again_within_one_step_are_seen(integrator: MakeIntegrator) -> None:
    """At a period of 1.6 ms, steps of 1 ms: what the stages make of the flank must not look accurate by chance."""
    p = P._replace(J_1=0.0064, J_2=10.0, C=1e5, phi_B=2.5)
    u = driveline.Input(T_mot=2000.0, T_load_rec=-690.0)
    advance, crossings, errors = integrator(driveline.BLOCK).advance, 0, []
    for penetration in np.linspace(0.0380, 0.0405, 50):
        x = driveline.start(u, p)._replace(omega_1=32.0, omega_2=6.7, phi=2.5 + float(penetration))
        exact = ExactDriveline(p, x.omega_1, x.omega_2, x.phi, side=1)
        exact.advance(u.T_mot, u.T_load_rec, 1e-3)
        crossings += exact.crossings
        errors.append(abs(advance(x, u, p, 1e-3).omega_1 - exact.omega_1))
    assert crossings > 0
    assert max(errors) < 0.01


def test_a_crossing_is_located_to_a_tenth_of_a_picosecond(integrator: MakeIntegrator) -> None:
    """An indicator that tells no more than its sign is bisected; the worst of many is not much better."""
    draw, seen, distances = random.Random(1), [], []

    def side(x: Body) -> float:
        seen.append(x.x)
        return math.copysign(1.0, x.x - at)

    rising = integrator(block(lambda x, u, p: Body(1.0, 0.0, 0.0), side))
    for _ in range(100):
        at = draw.uniform(0.01, 0.09)
        seen.clear()
        rising.advance(Body(0.0, 0.0, 0.0), Nothing(), Nothing(), 0.1)
        distances.append(min(x for x in seen if x > at) - max(x for x in seen if x <= at))
    assert 0.6e-13 < max(distances) < 1.001e-13


def test_the_slope_of_an_indicator_is_taken_over_a_tenth_of_a_microsecond(integrator: MakeIntegrator) -> None:
    """Far below what moves in a drive train, far above the rounding of its state."""
    seen = []

    def height(x: Body) -> float:
        seen.append(x.x)
        return x.x - 0.01

    falling = block(lambda x, u, p: Body(x.v, -9.81, 0.0), height)
    integrator(falling).advance(Body(0.0, 0.5, 0.0), Nothing(), Nothing(), 0.1)
    assert min(x for x in seen if x > 0.0) == pytest.approx(0.5e-7, rel=1e-6)


@given(t=st.floats(0.011, 0.049), share=st.floats(1e-4, 0.99))
def test_an_excursion_within_one_step_is_found(integrator: MakeIntegrator, t: float, share: float) -> None:
    """A body thrown up at t = 0 is highest at t; it is above zero for 2 share t."""
    speed, up = 9.81 * t, share * t
    height = 0.5 * 9.81 * (t * t - up * up)
    x = integrator(thrown(height)).advance(Body(0.0, speed, 0.0), Nothing(), Nothing(), 0.1)
    exact = 2.0 * 9.81 / 3.0 * up**3
    assert x.beyond == pytest.approx(exact, rel=1e-6, abs=1e-15)
    assert x.x == pytest.approx(speed * 0.1 - 0.5 * 9.81 * 0.01, rel=1e-12)


@given(
    steps=st.lists(st.integers(1, 40), min_size=1, max_size=6),
    T_mot=st.floats(-100.0, 100.0),
    T_load=st.floats(-100.0, 100.0),
)
@settings(max_examples=30)
def test_one_long_advance_is_its_parts(
    integrator: MakeIntegrator, steps: list[int], T_mot: float, T_load: float
) -> None:
    """Bit by bit, where the parts are whole steps; flanks are crossed on the way."""
    binary = integrator(replace(driveline.BLOCK, step_size=BINARY_STEP))
    u, x = driveline.Input(T_mot=T_mot, T_load_rec=T_load), LIVELY
    for n in steps:
        x = binary.advance(x, u, P, n * BINARY_STEP)
    assert x == binary.advance(LIVELY, u, P, sum(steps) * BINARY_STEP)


@given(parts=st.lists(st.floats(1e-5, 0.02), min_size=1, max_size=8))
@settings(max_examples=30)
def test_any_duration_can_be_split_anywhere(integrator: MakeIntegrator, parts: list[float]) -> None:
    """Motor, wheels and twist, whose only kinks are the flanks; the unused vehicle has others."""
    driven, u, x = integrator(driveline.BLOCK), driveline.Input(T_mot=20.0), LIVELY
    for part in parts:
        x = driven.advance(x, u, P, part)
    whole = driven.advance(LIVELY, u, P, sum(parts))
    assert list(x[:3]) == pytest.approx(list(whole[:3]), rel=1e-10, abs=1e-10)


def test_nothing_is_kept_between_calls(integrator: MakeIntegrator) -> None:
    used, u = integrator(driveline.BLOCK), driveline.Input(T_mot=50.0)
    for k in range(20):
        used.advance(CONTACT._replace(omega_1=10.0 * k), u, P, 0.003)
    assert used.advance(LIVELY, u, P, 0.05) == integrator(driveline.BLOCK).advance(LIVELY, u, P, 0.05)


def test_no_time_changes_nothing(integrator: MakeIntegrator) -> None:
    assert integrator(driveline.BLOCK).advance(LIVELY, driveline.Input(), P, 0.0) == LIVELY


def evaluations(integrator: MakeIntegrator, body: ContinuousBlock, x: Body, duration: float) -> tuple[Body, int]:
    """State after the duration, and how often the derivative was evaluated."""
    count = 0

    def counted(x: Any, u: Any, p: Any) -> Any:
        nonlocal count
        count += 1
        return body.derivative(x, u, p)

    x = integrator(replace(body, derivative=counted)).advance(x, Nothing(), Nothing(), duration)
    return x, count


@pytest.mark.parametrize(("steps", "made"), [(1e-3, 1), (1.0 + 0.99e-9, 1), (1.0 + 1.01e-9, 2), (7.0, 7), (7.5, 8)])
def test_a_step_begun_by_rounding_alone_is_not_made(integrator: MakeIntegrator, steps: float, made: int) -> None:
    moving = block(lambda x, u, p: Body(1.0, 0.0, 0.0))
    assert evaluations(integrator, moving, Body(0.0, 0.0, 0.0), steps * moving.step_size)[1] == 12 * made


def test_what_is_left_of_a_step_behind_a_crossing_is_made_down_to_a_tenth_of_a_picosecond(
    integrator: MakeIntegrator,
) -> None:
    draw, missing = random.Random(1), []
    passing = integrator(block(lambda x, u, p: Body(1.0, 0.0, 0.0), lambda x: math.copysign(1.0, x.x - at)))
    for _ in range(100):
        at = 0.1 - draw.uniform(0.0, 4e-13)
        missing.append(0.1 - passing.advance(Body(0.0, 0.0, 0.0), Nothing(), Nothing(), 0.1).x)
    assert 0.6e-13 < max(missing) < 1.001e-13


@pytest.mark.parametrize(("kinks", "exact"), [(16, True), (17, False)])
def test_sixteen_crossings_are_located_in_one_step(integrator: MakeIntegrator, kinks: int, exact: bool) -> None:
    """`beyond` is the integral of the height above the last of them."""
    heights = [0.005 * (k + 1) for k in range(kinks)]
    moving = block(
        lambda x, u, p: Body(1.0, 0.0, maximum(x.x - heights[-1], 0.0)),
        *(lambda x, height=height: x.x - height for height in heights),
    )
    x = integrator(moving).advance(Body(0.0, 0.0, 0.0), Nothing(), Nothing(), 0.1)
    assert (x.beyond == pytest.approx(0.5 * (0.1 - heights[-1]) ** 2, rel=1e-9)) is exact


def test_chatter_about_a_jump_is_refused_in_bounded_work(integrator: MakeIntegrator) -> None:
    """Pushed to the zero from both sides, the body would cross it without end; a kink is none."""
    count = 0

    def pushed(x: Body, u: Any, p: Any) -> Body:
        nonlocal count
        count += 1
        return Body(where(x.x > 0.0, -1.0, 0.5), 0.0, 0.0)

    with pytest.raises(NotIntegrable, match="x"):
        integrator(block(pushed, lambda x: x.x)).advance(Body(0.03, 0.0, 0.0), Nothing(), Nothing(), 0.1)
    assert count < 40_000


@pytest.mark.parametrize(("rate", "implicit"), [(19.9, False), (20.1, True)])
def test_a_stretch_with_a_fastest_rate_of_twenty_is_left_to_the_implicit_method(
    integrator: MakeIntegrator, rate: float, implicit: bool
) -> None:
    """Which alone moves a state that rests, to learn what it does to the derivative."""
    moved = False

    def fading(x: Body, u: Any, p: Any) -> Body:
        nonlocal moved
        moved = moved or x.v != 0.0
        return Body(-10.0 * rate * x.x, 0.0, 0.0)

    integrator(block(fading)).advance(Body(1.0, 0.0, 0.0), Nothing(), Nothing(), 0.1)
    assert moved is implicit


def test_what_fades_fast_costs_little_beside_what_moves_slowly_and_far(integrator: MakeIntegrator) -> None:
    """A brake that holds: bristles hardly move, but at once; nor is its zero looked for in steps that fail."""
    fading = block(lambda x, u, p: Body(-400.0 * x.x, 0.0, 1000.0 + 0.1 * x.beyond), lambda x: x.x)
    x, count = evaluations(integrator, fading, Body(1e-5, 0.0, 0.0), 0.1)
    assert abs(x.x) < 1e-10
    assert count < 15 * 12, "explicit steps would be 7 for stability alone, and 40 with those that fail"


@pytest.mark.parametrize(("stretches", "too_many"), [(LITTLE_WORK + 1, False), (LITTLE_WORK + 2, True)])
def test_no_stretch_is_begun_beyond_the_work_that_is_allowed(
    hurried: MakeIntegrator, stretches: int, too_many: bool
) -> None:
    moving = hurried(block(lambda x, u, p: Body(1.0, 7.0, 0.0)))
    if too_many:
        with pytest.raises(TooMuchWork, match="v"):
            moving.advance(Body(-10.0, 0.0, 0.0), Nothing(), Nothing(), 0.1 * stretches)
    else:
        x = moving.advance(Body(-10.0, 0.0, 0.0), Nothing(), Nothing(), 0.1 * stretches)
        assert x.x == pytest.approx(0.1 * stretches - 10.0, rel=1e-12)


def test_locating_zeros_and_implicit_steps_are_work_too(hurried: MakeIntegrator) -> None:
    nowhere = Body(1.0, 0.0, 0.0)
    swinging = block(lambda x, u, p: Body(-60.0 * x.v, 60.0 * x.x, 0.0), lambda x: x.x)
    stiff = block(lambda x, u, p: Body(math.sin(x.v) - 1e4 * x.x, 1.0, 0.0))
    for costly in (swinging, stiff):
        with pytest.raises(TooMuchWork):
            hurried(costly).advance(nowhere, Nothing(), Nothing(), 0.1 * LITTLE_WORK / 4)


@pytest.mark.parametrize("power", [1, 3, 9])
def test_a_flat_crossing_is_located_in_bounded_work(integrator: MakeIntegrator, power: int) -> None:
    """An indicator with a root of high order, as a state coming to rest on it sees."""
    passing = block(lambda x, u, p: Body(1.0, 0.0, 0.0), lambda x: (x.x - 0.07) ** power)
    x, count = evaluations(integrator, passing, Body(0.0, 0.0, 0.0), 0.1)
    assert x.x == pytest.approx(0.1, rel=1e-12)
    assert count < (20 if power == 1 else 150) * 12


@pytest.mark.parametrize(("beyond", "crossed"), [(1e-12, False), (1.01e-12, True)])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_less_than_the_resolution_behind_a_zero_is_no_crossing(
    integrator: MakeIntegrator, side: float, beyond: float, crossed: bool
) -> None:
    stepping = block(lambda x, u, p: Body(1.0, 0.0, 0.0), lambda x: side * (1.0 if x.x < 0.03 else -beyond))
    _, count = evaluations(integrator, stepping, Body(0.0, 0.0, 0.0), 0.1)
    assert (count > 20 * 12) is crossed


@pytest.mark.parametrize("side", [-1e-17, 0.0, 1e-17])
def test_lying_on_a_zero_costs_no_more_than_crossing_it(integrator: MakeIntegrator, side: float) -> None:
    resting = block(lambda x, u, p: Body(x.v, 0.0, 0.0), lambda x: x.x, lambda x: -x.x)
    x, count = evaluations(integrator, resting, Body(side, 0.0, 0.0), 0.1)
    assert x.x == side
    assert count <= 3 * 12
