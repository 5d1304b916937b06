"""Trust in the motor signals: each cause just long enough and just not, and how it heals."""

import math
from typing import Any

import pytest

from driveline.models.controller import causes, trust
from driveline.models.controller.causes import FAILURES, NONE, SPEED_JUMP, WHEEL_CONTRADICTS, WRONG_DIRECTION, Cause
from driveline.models.controller.supervision import Parameters
from driveline.models.controller.trust import Found, TrustState

P = Parameters(t_bad=1.0, t_apart=2.0, t_proof=1.0, t_turn=2.0)
T_S = 0.25
GOOD = {"confirmed": False, "turned": False, "resting": False}
TRUSTED = trust.start()

each_cause = pytest.mark.parametrize("row", FAILURES, ids=lambda row: row.word)


def after(samples: int, x: TrustState = TRUSTED, found: dict[int, float] | None = None, **changes: Any) -> TrustState:
    """The state after samples in which these causes were found for so long."""
    lasting = found or {}
    seen = {row.number: Found(row.number in lasting, lasting.get(row.number, 0.0)) for row in FAILURES}
    for _ in range(samples):
        x = trust.update(x, seen, **(GOOD | changes), T_s=T_S, p=P)
    return x


def lasting(row: Cause) -> float:
    """Time for which a cause may be found before it counts."""
    return 0.0 if row.after is None else getattr(P, row.after)


def test_all_is_trusted_at_the_start_and_stays_so() -> None:
    assert trust.is_trusted(TRUSTED)
    assert trust.is_trusted(after(20))


@each_cause
def test_a_cause_counts_after_its_time(row: Cause) -> None:
    assert after(1, found={row.number: math.nextafter(lasting(row), 9.0)}).cause == row.number
    if row.after is not None:
        assert after(1, found={row.number: lasting(row)}).cause == NONE


@each_cause
def test_good_signals_heal_in_t_proof_what_is_not_latched(row: Cause) -> None:
    lost = TrustState(row.number, 0.0)
    healed = [trust.is_trusted(after(n, lost)) for n in (3, 4, 40)]
    assert healed == ([False] * 3 if row.latched else [False, True, True])
    assert [trust.is_trusted(after(n, lost, confirmed=True)) for n in (3, 4)] == [False, True]
    assert [trust.is_trusted(after(n, lost, resting=True)) for n in (3, 4)] == [False, True]


def test_a_motor_that_has_turned_the_other_way_heals_in_t_turn() -> None:
    lost = TrustState(SPEED_JUMP, 0.0)
    assert [trust.is_trusted(after(n, lost, turned=True)) for n in (7, 8)] == [False, True]


@each_cause
def test_a_bad_sample_is_enough_to_begin_anew(row: Cause) -> None:
    x = after(3, TrustState(SPEED_JUMP, 0.0), confirmed=True)
    assert after(1, x, found={row.number: T_S}).healing == 0.0


def test_the_first_in_the_table_is_the_cause_and_stays_it() -> None:
    both = {SPEED_JUMP: 9.0, WHEEL_CONTRADICTS: 9.0}
    assert after(1, found=both).cause == SPEED_JUMP
    assert after(1, TrustState(WHEEL_CONTRADICTS, 0.0), found=both).cause == WHEEL_CONTRADICTS


def test_a_latched_cause_takes_the_place_of_others() -> None:
    x = after(1, TrustState(SPEED_JUMP, 0.0), found={WRONG_DIRECTION: 0.0})
    assert x.cause == WRONG_DIRECTION
    assert after(1, x, found={SPEED_JUMP: 9.0}).cause == WRONG_DIRECTION


def test_each_cause_is_a_row_with_a_number_a_word_and_a_parameter() -> None:
    """As the output `cause` declares them."""
    rows = (*FAILURES, causes.FEEDING)
    assert [row.number for row in rows] == list(range(2, 2 + len(rows)))
    assert [name for name, _ in causes.OUTPUT.items] == ["none", *(row.word for row in rows)]
    assert {row.after for row in FAILURES} - {None} <= set(Parameters._fields)
