"""Trust in the motor signals: how they lose it, and how they prove themselves."""

from typing import Any

import pytest

from models.controller import trust
from models.controller.supervision import Parameters
from models.controller.trust import LONGEST, TrustState

P = Parameters(t_bad=1.0, t_apart=2.0, t_proof=1.0)
T_S = 0.25
GOOD = {"bad": 0.0, "apart": 0.0, "lying": False, "confirmed": False, "resting": False}
TRUSTED = trust.start(P)
LOST = TrustState(proof=0.0, needed=1.0, caught=False)
CAUGHT = TrustState(proof=0.0, needed=2.0, caught=True)


def after(samples: int, x: TrustState = TRUSTED, **changes: Any) -> TrustState:
    for _ in range(samples):
        x = trust.update(x, **(GOOD | changes), T_s=T_S, p=P)
    return x


def test_all_is_trusted_at_the_start_and_stays_so() -> None:
    assert TRUSTED == after(5) == TrustState(proof=1.0, needed=1.0, caught=False)
    assert trust.is_trusted(TRUSTED)


def test_signals_fail_that_were_bad_for_longer_than_t_bad() -> None:
    assert after(3, bad=1.0) == TRUSTED
    assert after(1, bad=1.01) == LOST


def test_signals_fail_that_were_contradicted_for_longer_than_t_apart() -> None:
    assert after(3, apart=2.0) == TRUSTED
    assert after(1, apart=2.01) == LOST


def test_signals_fail_that_were_seen_to_lie() -> None:
    assert after(1, lying=True) == CAUGHT
    assert after(1, lying=True, resting=True) == LOST


def test_signals_prove_themselves_by_being_good_for_a_time() -> None:
    assert [after(n, LOST).proof for n in range(6)] == [0.0, 0.25, 0.5, 0.75, 1.0, 1.0]
    assert [trust.is_trusted(after(n, LOST)) for n in (3, 4)] == [False, True]


def test_one_bad_sample_is_enough_to_begin_anew() -> None:
    assert after(1, after(3, LOST), bad=T_S) == after(1, after(3, LOST), apart=T_S) == LOST


def test_trusted_signals_are_not_lost_by_one_bad_sample() -> None:
    assert trust.is_trusted(after(1, bad=T_S, apart=T_S))


def test_who_was_caught_needs_a_confirmation() -> None:
    assert after(20, CAUGHT) == CAUGHT
    assert after(7, CAUGHT, confirmed=True) == TrustState(proof=1.75, needed=2.0, caught=True)
    assert after(8, CAUGHT, confirmed=True) == TrustState(proof=2.0, needed=2.0, caught=False)
    assert after(1, after(3, CAUGHT, confirmed=True)) == CAUGHT


def test_who_is_caught_again_needs_twice_the_time() -> None:
    """Up to a limit."""
    x, needed = TRUSTED, []
    for _ in range(7):
        x = after(1, x._replace(proof=x.needed), lying=True)
        needed.append(x.needed)
    assert needed == [2.0, 4.0, 8.0, 16.0, LONGEST, LONGEST, LONGEST]
    assert trust.is_trusted(after(128, x, confirmed=True))
    assert not trust.is_trusted(after(127, x, confirmed=True))


def test_that_limit_is_a_number_of_proofs() -> None:
    most = LONGEST * 2.0
    x = trust.update(LOST._replace(needed=most), **(GOOD | {"lying": True}), T_s=T_S, p=P._replace(t_proof=2.0))
    assert x.needed == most


@pytest.mark.parametrize("caught", [True, False])
def test_rest_clears_who_was_caught(caught: bool) -> None:
    x = CAUGHT._replace(caught=caught, needed=8.0)
    assert after(1, x, resting=True) == TrustState(proof=0.25, needed=1.0, caught=False)
