"""Trust in the motor signals: each cause just long enough and just not, how it heals; and the direction."""

import math
from collections.abc import Collection
from itertools import product

import pytest

from driveline.models.controller import causes, trust
from driveline.models.controller.causes import (
    CLOCKS,
    FAILURES,
    NONE,
    SPEED_JUMP,
    SPEED_RANGE,
    WHEEL_CONTRADICTS,
    WRONG_DIRECTION,
    WRONG_LAUNCH,
    Cause,
)
from driveline.models.controller.supervision import Input, Parameters
from driveline.models.controller.trust import TrustState
from tests.models.controller.controllers import each_side

P = Parameters(t_bad=1.0, t_apart=2.0, t_proof=1.0, t_turn=2.0, omega_still=3.0)
T_S = 0.25
U = Input()
TRUSTED = trust.start()._replace(direction=1.0)

each_cause = pytest.mark.parametrize("row", FAILURES, ids=lambda row: row.word)


def lost(cause: int, clock: float = 0.0) -> TrustState:
    """Without trust, and the signals good for so long."""
    return TrustState(cause, clock, apart=0.0, direction=1.0)


def after(
    samples: int, x: TrustState = TRUSTED, found: Collection[int] = (), turned: bool = False, p: Parameters = P
) -> TrustState:
    """The state after samples in which these causes were found."""
    for _ in range(samples):
        x = trust.update(x, {row.number: row.number in found for row in FAILURES}, turned, T_S, p)
    return x


def lasting(row: Cause) -> float:
    """Time for which a cause may be found before it counts."""
    return getattr(P, row.after) if row.after else 0.0


def test_all_is_trusted_at_the_start_and_stays_so() -> None:
    assert trust.is_trusted(TRUSTED)
    assert after(20) == TRUSTED


@each_cause
def test_a_cause_counts_after_its_time(row: Cause) -> None:
    """What counts at once does with its first sample."""
    samples = round(lasting(row) / T_S)
    assert [after(n, found=[row.number]).cause for n in (samples, samples + 1)] == [NONE, row.number]
    if row.after:
        shorter = P._replace(**{row.after: math.nextafter(lasting(row), 0.0)})
        assert after(samples, found=[row.number], p=shorter).cause == row.number


@each_cause
def test_a_good_sample_is_enough_to_begin_anew(row: Cause) -> None:
    samples = round(lasting(row) / T_S)
    x = after(1, after(samples, found=[row.number]))
    assert x == TRUSTED
    assert trust.is_trusted(after(samples, x, found=[row.number]))


@each_cause
def test_a_time_to_heal_is_met_to_half_a_sample(row: Cause) -> None:
    for turned, samples in ((False, 3.5), (True, 7.5)):
        for clock, healed in ((samples * T_S, True), (math.nextafter(samples * T_S, 0.0), False)):
            assert trust.is_trusted(after(1, lost(row.number, clock - T_S), turned=turned)) is healed


@each_cause
@pytest.mark.parametrize("turned", [True, False])
def test_what_is_found_on_and_on_never_heals(row: Cause, turned: bool) -> None:
    """A wrong direction, too, for as long as the bus tells another."""
    assert after(20, lost(row.number), found=[row.number], turned=turned) == lost(row.number)


@each_cause
def test_a_bad_sample_is_enough_to_begin_the_healing_anew(row: Cause) -> None:
    x = after(3, lost(SPEED_JUMP))
    assert x == lost(SPEED_JUMP, 0.75)
    assert after(1, x, found=[row.number]) == lost(SPEED_JUMP)


def test_the_clock_starts_anew_when_trust_is_lost() -> None:
    """The time for which signals were bad is none for which they are good."""
    x = after(4, found=[SPEED_JUMP])
    assert x == TRUSTED._replace(clock=1.0)
    assert after(1, x, found=[SPEED_JUMP]) == lost(SPEED_JUMP)
    x = after(3, found=[SPEED_JUMP])
    assert x.clock == 0.75
    assert after(1, x, found=[SPEED_JUMP, WRONG_LAUNCH]) == lost(WRONG_LAUNCH), "nor where another cause counts"
    x = after(1, after(7, found=[WHEEL_CONTRADICTS]), found=[SPEED_JUMP, WHEEL_CONTRADICTS])
    assert (x.clock, x.apart) == (0.25, 2.0)
    x = after(1, x, found=[SPEED_JUMP, WHEEL_CONTRADICTS])
    assert x == lost(WHEEL_CONTRADICTS)
    assert after(1, x, found=[SPEED_JUMP, WHEEL_CONTRADICTS]) == lost(WHEEL_CONTRADICTS)
    assert after(1, x) == lost(WHEEL_CONTRADICTS, T_S)


def test_time_apart_runs_only_while_there_is_trust() -> None:
    x = after(20, lost(SPEED_JUMP), found=[WHEEL_CONTRADICTS])
    assert x == lost(SPEED_JUMP)
    x = after(4, x)
    assert [trust.is_trusted(after(n, x, found=[WHEEL_CONTRADICTS])) for n in (8, 9)] == [True, False]


def test_causes_with_the_same_time_have_the_same_clock() -> None:
    """The cause is that which is found in the end."""
    for first, second, samples in ((SPEED_RANGE, SPEED_JUMP, 4), (WHEEL_CONTRADICTS, WRONG_DIRECTION, 8)):
        assert after(1, after(samples, found=[first]), found=[second]).cause == second
        assert after(1, after(samples, found=[second]), found=[first]).cause == first


def test_estimator_and_law_begin_anew_until_signals_have_been_good_for_a_sample() -> None:
    assert [trust.is_healing(after(n, lost(SPEED_JUMP)), T_S) for n in (0, 1, 2)] == [True, True, False]
    assert not trust.is_healing(TRUSTED, T_S)
    assert not trust.is_healing(after(1, found=[SPEED_JUMP]), T_S), "nor where they are bad, and trusted yet"


def test_the_first_of_those_that_count_is_the_cause_and_stays_it() -> None:
    every = [row.number for row in FAILURES]
    late = TRUSTED._replace(clock=1.0, apart=2.0)
    for x, cause in (
        (TRUSTED, WRONG_LAUNCH),
        (late._replace(clock=0.75), WHEEL_CONTRADICTS),
        (late._replace(apart=1.75), SPEED_RANGE),
        (late, SPEED_RANGE),
    ):
        assert after(1, x, found=every).cause == cause
    assert after(1, late, found=[WRONG_LAUNCH, WRONG_DIRECTION]).cause == WRONG_DIRECTION
    assert after(9, lost(WHEEL_CONTRADICTS), found=every).cause == WHEEL_CONTRADICTS


def turning(samples: int, x: TrustState, omega_1: float, good: bool = True, u: Input = U) -> float:
    """The direction after samples with this motor speed (rad/s)."""
    for _ in range(samples):
        x = x._replace(direction=trust.direction(x, u, False, False, omega_1, good, T_S, P))
    return x.direction


@each_side
def test_the_direction_is_that_in_which_a_trusted_motor_has_turned_for_t_apart(side: float) -> None:
    """Beyond its noise; a fault takes nothing away, and wheels that lock throw the motor back for less."""
    x, samples, beyond = TRUSTED._replace(direction=-side), round(P.t_apart / T_S), math.nextafter(3.0, 9.0)
    assert [trust.sign_of(turning(n, x, side * beyond)) for n in (samples - 1, samples)] == [-side, side]
    assert turning(9 * samples, x, side * beyond) == side
    for omega_1, good in ((3.0, True), (99.0, False)):
        assert turning(9 * samples, x, side * omega_1, good) == -side
    assert turning(9 * samples, x._replace(cause=SPEED_JUMP), side * 99.0) == -side
    begun = x._replace(cause=SPEED_JUMP, direction=turning(1, x, side * 99.0))
    assert turning(9 * samples, begun, side * 99.0) == side, "what has begun goes on where trust is lost"
    assert turning(samples, x._replace(direction=turning(samples - 1, x, side * 99.0)), -side * 99.0) == -side


@each_side
def test_a_demand_that_pushes_the_car_tells_its_direction(side: float) -> None:
    """At once, whatever the motor does; a motor that turns the other way is believed, unless it has set off so."""
    u = U._replace(T_driver=side * 50.0)
    for x in (TRUSTED, lost(SPEED_JUMP)):
        x = x._replace(direction=-side)
        assert trust.direction(x, u, False, False, -side * 99.0, True, T_S, P) == -side
        pushed, against = (
            trust.direction(x, u, *how, -side * 99.0, True, T_S, P) for how in ((False, True), (True, False))
        )
        assert (trust.sign_of(pushed), against) == (side, side)
        x = lost(SPEED_JUMP)
        assert trust.sign_of(turning(2, x._replace(direction=pushed), -side * 99.0)) == -side
        assert turning(99, x._replace(direction=against), -side * 99.0) == side


@each_side
def test_a_bus_that_tells_the_direction_is_believed(side: float) -> None:
    """By its sign, whatever number it has."""
    for x, number in product((TRUSTED, lost(SPEED_JUMP)), (1, 4)):
        told = U._replace(direction=number * int(side))
        for how in ((False, False), (False, True), (True, False)):
            x = x._replace(direction=-side)
            assert trust.direction(x, told, *how, -side * 99.0, True, T_S, P) == side


@each_side
def test_nothing_is_known_at_the_start_and_after_t_apart_of_motion_it_is_sure(side: float) -> None:
    """Until then a motor that turns the other way turns it round without trust too."""
    x, samples = trust.start(), round(P.t_apart / T_S)
    assert (x.direction, trust.sign_of(x.direction)) == (0.0, 1.0)
    for n, sure in ((1, False), (samples - 1, False), (samples, True)):
        there = lost(SPEED_JUMP)._replace(direction=turning(n, x, side * 99.0))
        assert (trust.sign_of(there.direction), abs(there.direction) == 1.0) == (side, sure)
        assert trust.sign_of(turning(2 * samples, there, -side * 99.0)) == (side if sure else -side)


def test_each_cause_is_a_row_with_a_number_a_word_and_a_parameter() -> None:
    """As the output `cause` declares them; a row without a parameter counts at once."""
    rows = sorted((*FAILURES, causes.FEEDING))
    assert [row.number for row in rows] == list(range(2, 2 + len(rows)))
    assert [name for name, _ in causes.OUTPUT.items] == ["none", *(row.word for row in rows)]
    assert list(CLOCKS) == ["t_bad", "t_apart", ""]
    assert [number for rows in CLOCKS.values() for number in rows] == [row.number for row in FAILURES]
    assert set(CLOCKS) - {""} <= set(Parameters._fields)


def test_the_first_row_of_which_something_is_found() -> None:
    for found, first in (((False, True, True), SPEED_JUMP), ((True, False, True), SPEED_RANGE), ((False,) * 3, NONE)):
        numbers = (SPEED_RANGE, SPEED_JUMP, WHEEL_CONTRADICTS)
        assert causes.first_of(dict(zip(numbers, found, strict=True))) == first
    assert causes.first_of({}) == NONE
