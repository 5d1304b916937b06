"""Trust in the motor signals: each cause just long enough and just not, how it heals; and the direction."""

import math

import pytest

from driveline.models.controller import causes, trust
from driveline.models.controller.causes import (
    CLOCKS,
    FAILURES,
    NONE,
    SPEED_JUMP,
    WHEEL_CONTRADICTS,
    WRONG_DIRECTION,
    Cause,
)
from driveline.models.controller.supervision import Input, Parameters
from driveline.models.controller.trust import Found, TrustState

P = Parameters(t_bad=1.0, t_apart=2.0, t_proof=1.0, t_turn=2.0, omega_still=3.0)
T_S = 0.25
U = Input()
TRUSTED = trust.start(150.0, P)

each_cause = pytest.mark.parametrize("row", FAILURES, ids=lambda row: row.word)
each_side = pytest.mark.parametrize("side", [1.0, -1.0])


def after(
    samples: int,
    x: TrustState = TRUSTED,
    found: dict[int, float] | None = None,
    turned: bool = False,
    against: bool = False,
) -> TrustState:
    """The state after samples in which these causes were found for so long."""
    seen = dict.fromkeys(CLOCKS, Found(NONE, 0.0))
    for row in FAILURES:
        if row.number in (found or {}):
            seen[str(row.after)] = Found(row.number, (found or {})[row.number])
    for _ in range(samples):
        x = trust.update(x, seen, against, x.direction, turned, T_S, P)
    return x


def lasting(row: Cause) -> float:
    """Time for which a cause may be found before it counts."""
    return getattr(P, str(row.after))


def test_all_is_trusted_at_the_start_and_stays_so() -> None:
    assert trust.is_trusted(TRUSTED)
    assert trust.is_trusted(after(20))


@each_cause
def test_a_cause_counts_after_its_time(row: Cause) -> None:
    assert after(1, found={row.number: math.nextafter(lasting(row), 9.0)}).cause == row.number
    assert after(1, found={row.number: lasting(row)}).cause == NONE


@each_cause
def test_good_signals_heal_in_t_proof_and_of_another_direction_in_t_turn(row: Cause) -> None:
    lost = TrustState(row.number, 0.0, 1.0)
    assert [trust.is_trusted(after(n, lost)) for n in (3, 4)] == [False, True]
    healed = [trust.is_trusted(after(n, lost, turned=True)) for n in (7, 8)]
    assert healed == [False, row.number != WRONG_DIRECTION], "that of the car is known"


@each_cause
def test_a_bad_sample_is_enough_to_begin_anew(row: Cause) -> None:
    x = after(3, TrustState(SPEED_JUMP, 0.0, 1.0))
    assert after(1, x, found={row.number: T_S}).healing == 0.0


def test_a_motor_that_sets_off_against_its_torque_is_not_trusted_until_it_turns_with_it() -> None:
    x = after(1, after(20), against=True)
    assert (x.cause, x.healing) == (WRONG_DIRECTION, 0.0)
    x = after(20, x, turned=True)
    assert [trust.is_trusted(after(n, x)) for n in (3, 4)] == [False, True]


def test_estimator_and_law_begin_anew_until_signals_have_been_good_for_a_sample() -> None:
    lost = TrustState(SPEED_JUMP, 0.0, 1.0)
    assert [trust.is_healing(after(n, lost), T_S) for n in (0, 1, 2)] == [True, True, False]
    assert not trust.is_healing(TRUSTED, T_S)


def test_the_first_clock_is_the_cause_and_stays_it() -> None:
    both = {SPEED_JUMP: 9.0, WHEEL_CONTRADICTS: 9.0}
    assert after(1, found=both).cause == SPEED_JUMP
    assert after(1, TrustState(WHEEL_CONTRADICTS, 0.0, 1.0), found=both).cause == WHEEL_CONTRADICTS


@each_side
def test_the_direction_is_that_of_a_trusted_motor(side: float) -> None:
    """Which is beyond its noise; a fault takes nothing away."""
    x, lost = TrustState(NONE, 0.0, -side), TrustState(SPEED_JUMP, 0.0, -side)
    for omega_1, good, way in ((3.0, True, -side), (3.1, True, side), (99.0, False, -side)):
        assert trust.direction(x, U, side * omega_1, good, P) == way
        assert trust.direction(lost, U, side * omega_1, good, P) == -side


@each_side
def test_a_bus_that_tells_the_direction_is_believed(side: float) -> None:
    told = U._replace(direction=int(side))
    assert trust.direction(TrustState(NONE, 0.0, -side), told, -side * 99.0, True, P) == side


def test_it_starts_with_the_direction_of_the_motor() -> None:
    for omega_1, way in ((60.0, 1.0), (-3.0, 1.0), (-3.1, -1.0)):
        assert trust.start(omega_1, P) == TrustState(NONE, 0.0, way)


def test_each_cause_is_a_row_with_a_number_a_word_and_a_parameter() -> None:
    """As the output `cause` declares them."""
    rows = (*FAILURES, causes.FEEDING)
    assert [row.number for row in rows] == list(range(2, 2 + len(rows)))
    assert [name for name, _ in causes.OUTPUT.items] == ["none", *(row.word for row in rows)]
    assert set(CLOCKS) <= set(Parameters._fields)
