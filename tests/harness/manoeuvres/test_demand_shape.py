"""What the metrics take a manoeuvre for."""

import pytest

from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.composed import composed
from driveline.harness.manoeuvres.demand_shape import RISE, plateau_ends, step_of
from driveline.harness.manoeuvres.parts import constant, pulse, ramp, sine, step
from driveline.harness.manoeuvres.signals import Lines, lines


def found(T_driver, **others):
    made = composed("made", 6.0, T_driver=T_driver, **others)
    return made.t_0, made.dT


@pytest.mark.parametrize("name", [n for n, m in MANOEUVRES.items() if m.dT is not None])
def test_the_steps_of_the_catalogue_are_recognised(name):
    manoeuvre = MANOEUVRES[name]
    assert isinstance(manoeuvre.T_driver, Lines)
    assert step_of(manoeuvre.T_driver) == (manoeuvre.t_0, manoeuvre.dT)


def test_a_step_on_a_constant_is_one_whatever_its_sign_and_way_of_writing():
    assert found([constant(-12.0), step(1.0, 112.0)]) == (1.0, 112.0)
    assert found([step(1.0, 112.0), constant(-12.0)], slope=0.02, T_brake=10.0) == (1.0, 112.0)
    assert found([constant(100.0), step(2.0, -130.0)]) == (2.0, -130.0)
    assert found(lines((0.0, 0.0), (1.0, 0.0), (1.1, 120.0), (3.0, 120.0), (6.0, 120.0))) == (1.0, 120.0)


def test_a_step_rises_within_half_a_second():
    assert found([ramp(1.0, 1.0 + RISE, 50.0)]) == (1.0, 50.0)
    assert found([ramp(1.0, 1.01 + RISE, 50.0)]) == (0.0, None)


@pytest.mark.parametrize(
    "demand",
    [
        [pulse(1.0, 2.0, 50.0)],
        [step(1.0, 50.0), step(3.0, 50.0)],
        [step(1.0, 50.0), step(1.2, -20.0)],
        [step(1.0, 50.0), sine(1.0, 5.0)],
        30.0,
        [],
    ],
)
def test_what_is_no_step_is_taken_for_none(demand):
    assert found(demand) == (0.0, None)


def test_a_step_under_changing_brakes_or_slope_is_none():
    demand = [step(1.0, 50.0)]
    assert found(demand, T_brake=[pulse(4.0, 5.0, 500.0)]) == (0.0, None)
    assert found(demand, slope=[ramp(4.0, 5.0, 0.1)]) == (0.0, None)
    assert found(demand, slope=[sine(0.01, 1.0)]) == (0.0, None)


def test_plateaus_lie_between_two_changes_and_last_long_enough():
    def ends(length):
        return plateau_ends(
            lines((0.0, 1.0), (1.0, 1.0), (1.0, 5.0), (1.0 + length, 5.0), (1.0 + length, 2.0), (9.0, 2.0))
        )

    assert ends(0.45) == (1.45,)
    assert ends(0.44) == ()


def test_a_plateau_of_many_samples_is_one():
    assert plateau_ends(Lines([0, 1, 1.2, 1.4, 1.6, 1.8, 2], [0, 0, 5, 5, 5, 5, 0])) == (1.8,)
