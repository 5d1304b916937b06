"""The gap that is learned: what a crossing tells, which crossings tell nothing, and how far it goes."""

import pytest

from driveline.models import damping_controller
from driveline.models.controller import learned_gap
from driveline.models.controller.learned_gap import GapState
from tests.models.controller.controllers import above, each_side

T_S = 0.25
P = damping_controller.BLOCK.Parameters(L_phi_B=0.125, gap_bias=0.0, gap_torque=0.125, t_cross=1.0)._replace(
    J_1=0.25, C=64.0, phi_B=0.5, T_max=16.0
)
"""A crossing tells from 2 N.m on, and all with 4; it ends with the fifth sample on the other flank."""
DEEP = 0.0625
"""Twist beyond a flank that makes 4 N.m, rad."""


def crossing(
    side: float = 1.0,
    innovation: float = 0.25,
    depth: float = DEEP,
    before: float = 0.0,
    slip: float = 0.0,
    hold: bool = False,
    p: object = P,
) -> GapState:
    """From the other flank to that on this side, with the same innovation in each of the last four samples."""
    x = GapState(0.5, flank=-side, innovations=0.0, before=before)
    for k in range(6):
        phi = side * (x.phi_B + depth if k else 0.0)
        x, _ = learned_gap.update(x, innovation if k > 1 else 0.0, phi, slip, hold, T_S, p)  # type: ignore[arg-type]
    return x


SUM = 0.25 * (1.0 + 0.75 + 0.75**2 + 0.75**3)
"""Of these innovations, a quarter being forgotten with each sample."""


@each_side
def test_a_motor_that_is_faster_than_expected_towards_a_flank_tells_of_a_wider_gap(side: float) -> None:
    for innovation in (0.25, -0.25):
        x = crossing(side, side * innovation)
        assert x.phi_B == pytest.approx(0.5 + 0.125 * innovation / 0.25 * SUM)
        assert (x.flank, x.innovations, x.before) == (side, 0.0, pytest.approx(side * innovation / 0.25 * SUM))


@each_side
def test_what_the_model_lacks_to_and_fro_tells_nothing(side: float) -> None:
    """And what a crossing of the right gap adds is gap_bias times T_max T_s/J_1, here 16 rad/s."""
    assert crossing(side, before=SUM).phi_B == pytest.approx(0.5)
    bias = P._replace(gap_bias=SUM / 16.0)
    assert crossing(side, side * 0.25, p=bias).phi_B == pytest.approx(0.5)


@pytest.mark.parametrize(("depth", "share"), [(0.5 * DEEP, 0.0), (0.75 * DEEP, 0.5), (DEEP, 1.0), (2.0 * DEEP, 1.0)])
def test_the_firmer_the_teeth_meet_the_more_a_crossing_tells(depth: float, share: float) -> None:
    x = crossing(depth=depth)
    assert x.phi_B == pytest.approx(0.5 + share * 0.125 * SUM)
    assert x.before == pytest.approx(share * SUM)


@pytest.mark.parametrize(("slip", "share"), [(0.0, 1.0), (0.5, 0.5), (1.0, 0.0)])
def test_nothing_is_learned_while_the_wheels_slip_or_it_is_held(slip: float, share: float) -> None:
    assert crossing(slip=slip).phi_B == pytest.approx(0.5 + share * 0.125 * SUM)
    assert crossing(slip=slip, hold=True).phi_B == 0.5


def test_it_is_learned_when_the_other_flank_has_been_touched_for_t_cross() -> None:
    """Not in the gap, however long, and not before."""
    x = GapState(0.5, flank=-1.0, innovations=0.0, before=0.0)
    for phi in [0.0] * 20 + [0.5625] * 2 + [0.0] * 20 + [0.5625] * 2:
        x, moved = learned_gap.update(x, 0.25, phi, 0.0, False, T_S, P)
        assert (x.phi_B, moved) == (0.5, 0.0)
    x, moved = learned_gap.update(x, 0.25, 0.5625, 0.0, False, T_S, P)
    assert x.phi_B > 0.5
    assert moved == x.phi_B - 0.5


def test_teeth_that_come_back_to_their_flank_or_from_an_unknown_one_tell_nothing() -> None:
    for flank, side in ((1.0, 1.0), (0.0, 1.0), (0.0, -1.0)):
        x = GapState(0.5, flank, innovations=3.0, before=0.0)
        for _ in range(20):
            x, _ = learned_gap.update(x, 0.25, side * 0.5625, 0.0, False, T_S, P)
        assert x == GapState(0.5, side, 0.0, 0.0)
    assert learned_gap.forget_crossing(x._replace(flank=3.0)).flank == 0.0


@pytest.mark.parametrize(("innovation", "phi_B"), [(4.0, 0.65), (-4.0, 0.35)])
def test_a_crossing_changes_the_gap_by_at_most_three_tenths(innovation: float, phi_B: float) -> None:
    assert crossing(innovation=innovation).phi_B == pytest.approx(phi_B)


@pytest.mark.parametrize(("declared", "phi_B"), [(0.1, 0.5), (0.125, 0.625), (3.0, 0.6), (2.5, 0.5)])
def test_the_learned_gap_stays_within_a_fifth_and_five_times_the_declared_one(declared: float, phi_B: float) -> None:
    assert crossing(innovation=2.0 if phi_B == 0.625 else 0.0, p=P._replace(phi_B=declared)).phi_B == pytest.approx(
        phi_B
    )


def test_it_starts_with_what_was_learned_before_if_that_is_known() -> None:
    for phi_B_0, phi_B in ((0.0, 0.5), (0.6, 0.6), (0.1, 0.1), (0.0625, 0.1), (2.5, 2.5), (above(2.5), 2.5)):
        assert learned_gap.start(P._replace(phi_B_0=phi_B_0)).phi_B == pytest.approx(phi_B)


def test_without_a_gain_nothing_is_learned() -> None:
    assert crossing(p=P._replace(L_phi_B=0.0)).phi_B == 0.5
