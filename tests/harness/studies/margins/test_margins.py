"""The margins are those of the true loop: just below them its swing dies away in contact, just above it grows."""

from collections.abc import Callable
from dataclasses import replace
from math import ceil, floor, inf, isnan, pi
from typing import Any, NamedTuple

import numpy as np
import pytest
from fmutesting.slow import slow

from driveline.fmus.catalogue import EVERY
from driveline.harness.studies.margins.averaged_messages import messages
from driveline.harness.studies.margins.jacobians import NotLinear, like, names, numbers, rates
from driveline.harness.studies.margins.linear_controller import settled
from driveline.harness.studies.margins.linear_loop import linear_loop
from driveline.harness.studies.margins.linear_plant import in_contact_and_gap
from driveline.harness.studies.margins.margins import FREQUENCIES, margins
from driveline.harness.studies.margins.operating_point import Point
from driveline.models import validation_vehicle
from driveline.models.controller import T_S
from fmublocks.block.operators import clip, sqrt
from fmublocks.block.types import SampledBlock
from tests.harness.studies.margins.contact import INTERVAL, growth, torque

CONTROLLERS = {name: fmu.block for name, fmu in EVERY.items() if isinstance(fmu.block, SampledBlock)}

FEEDING_BACK = ("DampingController", "SpeedWashout", "SpeedDifference", "PaperObserver", "TrueMotion")
"""The linear observer is ours as long as the teeth are in contact."""

POINTS = {name: Point(controller=CONTROLLERS[name]) for name in FEEDING_BACK}
POINTS["PaperObserver"] = POINTS["PaperObserver"].with_parameters(controller={"k_T": 2.0, "omega_w": 120.0})
"""With its own gains it swings at half the rate of the messages, where two frequencies beat and no growth is seen."""
POINTS["on the vehicle"] = Point(plant=validation_vehicle.BLOCK)

QUICK = "DampingController", "on the vehicle"

every_loop = pytest.mark.parametrize("name", slow(POINTS, but=QUICK))


class Known:
    """A loop of which L is known at each frequency in Hz."""

    def __init__(self, L: Callable[[np.ndarray], np.ndarray]) -> None:
        self.gain = L


def test_the_margins_of_a_dead_time_and_of_a_lag_are_those_of_the_textbook() -> None:
    # L = exp(-2 pi i f 0.02 s)/2 is -1/2 at 25 Hz, and nearest to -1 there; it is never as large as 1.
    loop: Any = Known(lambda f: 0.5 * np.exp(-2j * pi * 0.02 * f))
    found = margins(loop)
    assert (found.gain_margin, found.gain_frequency) == pytest.approx((2.0, 25.0))
    assert found.M_s == pytest.approx(2.0, rel=1e-3)
    assert found.phase_margin == found.delay_margin == inf
    assert isnan(found.phase_frequency)
    # L = 2/(1 + i f/10 Hz) has the magnitude 1 at sqrt(3) 10 Hz, 120 degrees from -1, and is nowhere negative.
    lag: Any = Known(lambda f: 2.0 / (1.0 + 0.1j * f))
    found = margins(lag)
    f = 10.0 * sqrt(3.0)
    assert (found.phase_margin, found.phase_frequency) == pytest.approx((2.0 * pi / 3.0, f))
    assert (found.delay_margin, found.delay_frequency) == pytest.approx((1.0 / (3.0 * f), f))
    assert found.gain_margin == inf
    assert found.M_s == pytest.approx(1.0, abs=0.01)


@every_loop
@pytest.mark.slow
def test_a_delay_just_below_the_margin_is_borne_and_one_just_above_is_not(name: str) -> None:
    """At least half an interval off, for at the margin itself the swing neither dies away nor grows."""
    point = POINTS[name]
    found = margins(linear_loop(point))
    samples = found.delay_margin / INTERVAL
    below, above = (replace(point, late=INTERVAL * k) for k in (floor(samples - 0.5), ceil(samples + 0.5)))
    assert growth(below, found.delay_frequency) < 1.0 < growth(above, found.delay_frequency)


@pytest.mark.parametrize("name", slow(FEEDING_BACK, but=QUICK))
def test_a_gain_just_below_the_margin_is_borne_and_one_just_above_is_not(name: str) -> None:
    """Between teeth the wheel speed is known only as well as that of their messages is a mean over a cycle."""
    point = POINTS[name]
    loop = linear_loop(point)
    found, near = margins(loop), 0.05 if loop.cycle > 1 else 0.03
    below, above = (
        growth(point, found.gain_frequency, share * found.gain_margin) for share in (1.0 - near, 1.0 + near)
    )
    assert below < 1.0 < above


@pytest.mark.parametrize("name", slow([name for name in POINTS if name != "SpeedDifference"], but=QUICK))
def test_the_poles_leave_the_unit_circle_at_the_same_gain_and_delay(name: str) -> None:
    """Exactly, where the wheel speed is not used."""
    point = replace(POINTS[name], wheel=False)
    loop = linear_loop(point)
    found = margins(loop)
    for share, stable in ((0.9999, True), (1.0001, False)):
        assert bool(np.abs(np.linalg.eigvals(loop.closed(share * found.gain_margin))).max() < 1.0) is stable
    late = linear_loop(replace(point, late=2.0 * T_S))
    assert margins(late).delay_margin == pytest.approx(found.delay_margin - 2.0 * T_S, rel=1e-6), "whole samples"


@every_loop
def test_the_linear_loop_moves_as_the_true_one(name: str) -> None:
    """What a step of the demand adds to the gear torque, over 0.3 s."""
    point = POINTS[name]
    step, samples = 2.0, 150
    stepped, kept = (torque(point, height, duration=samples * T_S) for height in (step, 0.0))
    true = (stepped - kept)[:: round(T_S / INTERVAL)]
    loop = linear_loop(point)
    z, linear = np.zeros(len(loop.C)), []
    for k in range(samples):
        linear.append(loop.T_gear @ z)
        A = loop.message if k % loop.cycle == 0 else loop.quiet
        z = A @ z + loop.B * (loop.C @ z + (step if k >= 1 else 0.0))
    assert np.abs(true - linear).max() < (0.03 if loop.cycle > 1 else 0.003) * np.ptp(true)


def test_a_loop_that_feeds_nothing_back_bears_everything_and_dead_time_takes_from_the_margin() -> None:
    found = margins(linear_loop(Point(controller=CONTROLLERS["NoDamping"])))
    assert (found.gain_margin, found.phase_margin, found.delay_margin, found.M_s) == (inf, inf, inf, 1.0)
    assert isnan(found.gain_frequency)
    # A dead time of whole samples turns the loop gain and does nothing else.
    prompt, late = (linear_loop(Point(late=late, wheel=False)).gain(FREQUENCIES) for late in (0.0, 3.0 * T_S))
    np.testing.assert_allclose(late, prompt * np.exp(-2j * pi * FREQUENCIES * 3.0 * T_S), rtol=1e-6, atol=1e-9)
    margin = [margins(linear_loop(Point(late=late, wheel=False))).delay_margin for late in (0.0, 0.5 * T_S, T_S)]
    assert margin[1] == pytest.approx(0.5 * (margin[0] + margin[2]), rel=1e-3)


def test_a_controller_at_its_limit_or_in_fallback_is_not_linear() -> None:
    # What the damping is in the sample in which it is differentiated; a limit a little above leaves it alone.
    damping = Point().controller.update(*settled(Point(), in_contact_and_gap(Point())[0])).T_damp
    point = Point().with_parameters(controller={"T_add_max": abs(damping)})
    with pytest.raises(NotLinear, match=r"DampingController is not linear in contact at 4\.16667 m/s and 40 N\.m: "):
        linear_loop(point)
    linear_loop(point.with_parameters(controller={"T_add_max": 1.1 * abs(damping)}))
    point = Point(plant=validation_vehicle.BLOCK).with_parameters(controller={"omega_max": 50.0})
    with pytest.raises(NotLinear, match=r"does not damp at 4\.16667 m/s and 40 N\.m: it is in fallback"):
        linear_loop(point)


class Inner(NamedTuple):
    a: float
    b: tuple[float, ...]


class Outer(NamedTuple):
    inner: Inner
    c: float


RECORD = Outer(Inner(1.0, (2.0, 3.0)), 4.0)


def test_a_record_is_its_numbers_with_their_names_and_messages_count_in_samples() -> None:
    assert names(RECORD) == ["inner.a", "inner.b.0", "inner.b.1", "c"]
    assert numbers(RECORD) == [1.0, 2.0, 3.0, 4.0]
    assert like(RECORD, [5.0, 6.0, 7.0, 8.0]) == Outer(Inner(5.0, (6.0, 7.0)), 8.0)
    # Between two and four milliseconds they come half a sample later on average.
    found = messages(Point().with_parameters(can={"T_cyc": 0.02, "d_min": 0.002, "d_max": 0.004}))
    assert found == (10, 2)


def test_the_rates_of_a_straight_function_are_its_factors_and_a_bend_is_no_kink() -> None:
    found = rates(lambda x: [3.0 * x[0] - x[1], 0.5 * x[1]], [130.0, -20.0], [0, 1])
    np.testing.assert_allclose(found.mean, [[3.0, -1.0], [0.0, 0.5]], atol=1e-8)
    assert not found.has_kink.any()
    found = rates(lambda x: [sqrt(x[0]), abs(x[0] - 0.25)], [0.25], [0])
    assert found.mean.tolist() == [[pytest.approx(1.0, rel=1e-6)], [pytest.approx(0.0, abs=1e-9)]]
    assert found.has_kink.tolist() == [[False], [True]]


@pytest.mark.parametrize(("limit", "has_kink"), [(1.0, True), (1.0 + 2e-4, False)])
def test_a_kink_is_seen_at_its_place_and_not_beside_it(limit: float, has_kink: bool) -> None:
    assert bool(rates(lambda x: [clip(x[0], -limit, limit)], [1.0], [0]).has_kink.any()) is has_kink
