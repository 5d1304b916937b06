"""The describing function is that of the dead zone, and the loop that swings through the gap is the one it says."""

from dataclasses import astuple, replace
from math import inf, pi, sqrt

import numpy as np
import pytest
from fmutesting.slow import slow

from driveline.fmus.catalogue import EVERY
from driveline.harness.studies.margins import describing_function as backlash
from driveline.harness.studies.margins.describing_function import (
    AMPLITUDES,
    Swinging,
    _mixed_controller,
    describing_function,
    limit_cycles,
    swings,
)
from driveline.harness.studies.margins.linear_controller import LinearController, Sample
from driveline.harness.studies.margins.linear_loop import linear_loop
from driveline.harness.studies.margins.margins import margins
from driveline.harness.studies.margins.modes import drive_train_mode
from driveline.harness.studies.margins.operating_point import Point
from driveline.models import validation_vehicle
from driveline.models.physics.backlash import dead_zone
from fmublocks.block.types import ContinuousBlock
from tests.harness.studies.margins.contact import INTERVAL, growth, torque


@pytest.mark.parametrize("amplitude", [0.5, 1.0, 1.01, 1.5, 4.0, 100.0])
def test_the_describing_function_is_the_first_harmonic_of_the_dead_zone(amplitude: float) -> None:
    angle = np.linspace(0.0, 2.0 * pi, 20001)[:-1]
    torques = [dead_zone(amplitude * sine, 1.0) for sine in np.sin(angle).tolist()]
    assert describing_function(amplitude) == pytest.approx(2.0 * np.mean(torques * np.sin(angle)) / amplitude, abs=1e-6)


def test_what_is_mixed_of_contact_and_gap_goes_by_the_share_of_contact() -> None:
    random = np.random.default_rng(2)

    def of_its_own() -> LinearController:
        quiet, message = (Sample(random.standard_normal((3, 3)), random.standard_normal((3, 2))) for _ in range(2))
        return LinearController(quiet, message, np.ones(3), ("omega_1_meas",), ("x",))

    contact, gap = of_its_own(), of_its_own()
    mixed = _mixed_controller(0.25, contact, gap)
    for name in ("quiet", "message"):
        for found, one, other in zip(*(getattr(each, name) for each in (mixed, contact, gap)), strict=True):
            np.testing.assert_allclose(found, 0.25 * one + 0.75 * other)


def test_further_dead_time_comes_to_that_of_the_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("in_contact_and_gap", "controller_in_contact_and_gap", "_mixed_drive", "_mixed_controller"):
        monkeypatch.setattr(backlash, name, lambda *_: (None, None))
    monkeypatch.setattr(backlash, "assembled", lambda _drive, _controller, _bus, late: late)
    assert Swinging(Point(late=0.003)).loop(0.5, late=0.002) == pytest.approx(0.005)  # type: ignore[comparison-overlap]


def test_without_control_the_drive_train_swings_slower_and_nothing_lasts() -> None:
    loops = Swinging(Point(controller=EVERY["NoDamping"].block))  # type: ignore[arg-type]
    slower, contact = (drive_train_mode(loops.loop(N), 7.43).frequency for N in (0.5, 1.0))
    assert slower == pytest.approx(sqrt(0.5) * contact, rel=0.01)
    point = Point(controller=EVERY["NoDamping"].block)  # type: ignore[arg-type]
    assert limit_cycles(point, swings(point)) == []


@pytest.mark.parametrize(
    "plant", slow([Point().plant, validation_vehicle.BLOCK], but=[Point().plant]), ids=lambda block: block.name
)
def test_in_contact_it_is_the_loop_in_contact(plant: ContinuousBlock) -> None:
    point = Point(plant)
    found, expected = margins(Swinging(point).loop(1.0)), margins(linear_loop(point))
    assert astuple(found) == pytest.approx(astuple(expected), rel=1e-9)


@pytest.mark.slow
def test_our_controller_bears_least_in_contact_and_only_floats_in_the_gap() -> None:
    """Without load the teeth float from flank to flank, in contact for less than 2 % of the swing."""
    point = Point(wheel=False, T=1.0)
    found = swings(point)
    assert [swing.amplitude for swing in found] == [*AMPLITUDES, inf]
    delays = [swing.margins.delay_margin for swing in found if swing.margins]
    assert delays == sorted(delays, reverse=True)
    (floating,) = limit_cycles(point, found)
    assert floating.lasting
    assert (floating.amplitude, floating.frequency) == pytest.approx((1.06, 0.74), rel=0.02)
    assert floating.N < 0.02


@pytest.mark.slow
def test_a_controller_that_is_stable_in_contact_may_swing_for_ever_through_the_gap() -> None:
    """The paper's observer on the vehicle, with a dead time below its margin in contact."""
    gains = {"controller": {"k_T": 2.0, "omega_w": 120.0}}
    point = Point(validation_vehicle.BLOCK, EVERY["PaperObserver"].block, gains, late=0.010, wheel=False)  # type: ignore[arg-type]
    found = swings(point)
    assert found[-1].stable
    smaller, larger = limit_cycles(point, found)
    assert (smaller.lasting, larger.lasting) == (False, True)


def test_where_contact_is_no_longer_stable_a_swing_through_the_gap_still_dies_away() -> None:
    """Without load, at 1.5 phi_B, the loop bears twice the dead time that it bears in contact."""
    point = Point(wheel=False, T=1.0, late=0.022)
    in_contact = margins(linear_loop(replace(point, late=0.0)))
    through_the_gap = margins(Swinging(replace(point, late=0.0)).loop(describing_function(1.5)))
    assert in_contact.delay_margin < point.late < through_the_gap.delay_margin
    assert growth(replace(point, T=40.0), in_contact.delay_frequency) > 1.0
    swing = torque(replace(point, T=10.0), step=-10.0, duration=1.6)
    first, last = swing[: round(0.25 / INTERVAL)], swing[round(1.3 / INTERVAL) :]
    assert np.ptp(last) < 0.1 * np.ptp(first)
