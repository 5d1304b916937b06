"""Signals made up of parts, and what the metrics take a manoeuvre for."""

import numpy as np
import pytest

from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.composed import composed
from driveline.harness.manoeuvres.demand_shape import RISE, plateau_ends, step_of
from driveline.harness.manoeuvres.parts import (
    ManoeuvreError,
    chirp,
    constant,
    points,
    prbs,
    pulse,
    ramp,
    sine,
    step,
    summed,
)
from driveline.harness.manoeuvres.prbs import shift_register
from driveline.harness.manoeuvres.signals import Lines, lines

T = np.arange(6001) * 1e-3


def test_the_parts_are_what_they_are_called_as_far_as_they_are_allowed():
    assert step(1.0, 5.0)([0.0, 0.999, 1.0, 9.0]).tolist() == [0.0, 0.0, 5.0, 5.0]
    assert ramp(1.0, 3.0, 5.0)([0.0, 1.0, 2.0, 3.0, 9.0]).tolist() == [0.0, 0.0, 2.5, 5.0, 5.0]
    assert pulse(1.0, 2.0, 5.0)([0.999, 1.0, 1.999, 2.0]).tolist() == [0.0, 5.0, 5.0, 0.0]
    assert points([(1.0, 2.0), (2.0, 4.0), (2.0, 8.0)])([0.0, 1.5, 2.0, 9.0]).tolist() == [2.0, 3.0, 8.0, 8.0]
    assert constant(3.0)(T).tolist() == [3.0] * len(T)
    for part in (sine(1.0, 250.0), prbs(1.0, clock=0.002), step(0.0, 1.0), step(3600.0, 1.0)):
        assert np.isfinite(part(T)).all()


def test_a_chirp_goes_through_the_frequencies_along_a_line():
    begin, end, first, last = 1.0, 5.0, 2.0, 12.0
    x = chirp(1.0, first, last, begin, end)(T)
    crossings = T[np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))]
    whole = crossings[(crossings > begin + 0.01) & (crossings < end - 0.01)]
    middle, measured = 0.5 * (whole[1:] + whole[:-1]), 1.0 / np.diff(whole)
    np.testing.assert_allclose(measured, first + (last - first) * (middle - begin) / (end - begin), rtol=0.02)
    assert not x[T < begin].any()
    assert not x[T >= end].any()


def test_a_prbs_is_that_of_the_test_drive_and_a_sine_begins_at_zero():
    x = prbs(3.0, clock=0.002, order=5, begin=1.0, end=1.5)(T)
    bits = 3.0 * (2.0 * np.array(shift_register(250, 5)) - 1.0)
    np.testing.assert_array_equal(x[1000:1500:2], bits)
    assert not x[:1000].any()
    assert not x[1500:].any()
    x = sine(2.0, 1.0, begin=1.0, end=3.0)(T)
    assert x[[0, 999, 1000, 3000, 6000]].tolist() == [0.0] * 5
    np.testing.assert_allclose(x[[1250, 1750, 2250]], [2.0, -2.0, 2.0])


def test_a_sum_is_the_sum_at_every_instant_and_of_lines_again_lines():
    drawn = [constant(5.0), step(1.0, 10.0), ramp(0.5, 3.3, 7.0), pulse(2.5, 4.0, -1.0), points([(2, 1), (3, -2)])]
    others = [sine(1.0, 2.0), prbs(2.0)]
    assert isinstance(summed(drawn), Lines)
    np.testing.assert_allclose(summed(drawn)(T), sum(one(T) for one in drawn), atol=1e-12)
    np.testing.assert_allclose(summed([*drawn, *others])(T), sum(one(T) for one in [*drawn, *others]), atol=1e-12)
    assert summed([])(T).tolist() == [0.0] * len(T)


@pytest.mark.parametrize(
    ("part", "message"),
    [
        (lambda: step(float("nan"), 1.0), "at = nan: it must be a finite number"),
        (lambda: step(-0.1, 1.0), "at = -0.1: it must be 0 to 3600 s"),
        (lambda: pulse(2.0, 2.0, 1.0), "end = 2: it must come after begin, 2 s"),
        (lambda: sine(1.0, 250.1), "frequency = 250.1: it must be 0 to 250 Hz"),
        (lambda: prbs(1.0, clock=0.0019), "clock = 0.0019: it must be 0.002 to 3600 s"),
        (lambda: prbs(1.0, order=4), "order = 4: it must be one of 5, 6"),
        (lambda: points([(1.0, 0.0), (0.9, 0.0)]), "the point at 0.9 s comes after that at 1 s"),
        (lambda: points([(0.0, float("inf"))]), "point 1: its value inf must be a finite number"),
    ],
)
def test_a_part_that_cannot_be_is_refused(part, message):
    with pytest.raises(ManoeuvreError, match=message):
        part()


@pytest.mark.parametrize("begin", [1.0 / 3.0, 0.1 + 0.2, 1.0 + 4e-10, 1.0 + 6e-10])
def test_a_sum_jumps_where_its_parts_do_at_instants_that_are_no_whole_nanoseconds(begin: float) -> None:
    end = begin + 2.0 / 3.0
    both = summed([pulse(begin, end, 10.0), pulse(begin, end, -4.0), constant(1.0)])
    assert isinstance(both, Lines)
    instants = [begin - 2e-9, begin + 2e-9, 0.5 * (begin + end), end - 2e-9, end + 2e-9, end + 1.0]
    assert both(instants).tolist() == [1.0, 7.0, 7.0, 7.0, 1.0, 1.0]


def found(T_driver, **others):
    made = composed("made", 6.0, T_driver=T_driver, **others)
    return made.t_0, made.dT


@pytest.mark.parametrize("name", [n for n, m in MANOEUVRES.items() if m.dT is not None])
def test_the_steps_of_the_catalogue_are_recognised(name):
    manoeuvre = MANOEUVRES[name]
    assert isinstance(manoeuvre.T_driver, Lines)
    assert step_of(manoeuvre.T_driver) == (manoeuvre.t_0, manoeuvre.dT)


def test_a_step_on_a_constant_is_one_that_rises_in_half_a_second_under_constant_brakes_and_slope():
    assert found([constant(-12.0), step(1.0, 112.0)]) == (1.0, 112.0)
    assert found([step(1.0, 112.0), constant(-12.0)], slope=0.02, T_brake=10.0) == (1.0, 112.0)
    assert found([constant(100.0), step(2.0, -130.0)]) == (2.0, -130.0)
    assert found(lines((0.0, 0.0), (1.0, 0.0), (1.1, 120.0), (3.0, 120.0), (6.0, 120.0))) == (1.0, 120.0)
    assert found([ramp(1.0, 1.0 + RISE, 50.0)]) == (1.0, 50.0)
    assert found([ramp(1.0, 1.01 + RISE, 50.0)]) == (0.0, None)
    demand = [step(1.0, 50.0)]
    assert found(demand, T_brake=[pulse(4.0, 5.0, 500.0)]) == (0.0, None)
    assert found(demand, slope=[ramp(4.0, 5.0, 0.1)]) == (0.0, None)
    assert found(demand, slope=[sine(0.01, 1.0)]) == (0.0, None)


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


def test_plateaus_lie_between_two_changes_and_last_long_enough():
    def ends(length):
        return plateau_ends(
            lines((0.0, 1.0), (1.0, 1.0), (1.0, 5.0), (1.0 + length, 5.0), (1.0 + length, 2.0), (9.0, 2.0))
        )

    assert ends(0.45) == (1.45,)
    assert ends(0.44) == ()
    assert plateau_ends(Lines([0, 1, 1.2, 1.4, 1.6, 1.8, 2], [0, 0, 5, 5, 5, 5, 0])) == (1.8,)
