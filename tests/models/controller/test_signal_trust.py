"""Trust in the motor signals: how they fail, and how they heal."""

from typing import Any

import pytest

from driveline.models.controller import signal_trust
from driveline.models.controller.signal_trust import LONGEST, TrustState
from driveline.models.controller.supervision import Parameters

P = Parameters(t_bad=1.0, t_apart=2.0, t_proof=1.0)
T_S = 0.25
GOOD = {"bad": 0.0, "mismatch_time": 0.0, "implausible": False, "confirmed": False, "resting": False}
TRUSTED = signal_trust.start(P)
LOST = TrustState(heal_time=0.0, needed=1.0, latched=False)
LATCHED = TrustState(heal_time=0.0, needed=2.0, latched=True)


def after(samples: int, x: TrustState = TRUSTED, **changes: Any) -> TrustState:
    for _ in range(samples):
        x = signal_trust.update(x, **(GOOD | changes), T_s=T_S, p=P)
    return x


def test_all_is_trusted_at_the_start_and_stays_so() -> None:
    assert TRUSTED == after(5) == TrustState(heal_time=1.0, needed=1.0, latched=False)
    assert signal_trust.is_trusted(TRUSTED)


def test_signals_fail_that_were_bad_for_longer_than_t_bad() -> None:
    assert after(3, bad=1.0) == TRUSTED
    assert after(1, bad=1.01) == LOST


def test_signals_fail_that_do_not_match_for_longer_than_t_apart() -> None:
    assert after(3, mismatch_time=2.0) == TRUSTED
    assert after(1, mismatch_time=2.01) == LOST


def test_implausible_signals_fail_and_are_latched() -> None:
    assert after(1, implausible=True) == LATCHED
    assert after(1, implausible=True, resting=True) == LOST


def test_signals_heal_by_being_good_for_the_heal_time() -> None:
    assert [after(n, LOST).heal_time for n in range(6)] == [0.0, 0.25, 0.5, 0.75, 1.0, 1.0]
    assert [signal_trust.is_trusted(after(n, LOST)) for n in (3, 4)] == [False, True]


def test_one_bad_sample_is_enough_to_begin_anew() -> None:
    assert after(1, after(3, LOST), bad=T_S) == after(1, after(3, LOST), mismatch_time=T_S) == LOST


def test_trusted_signals_are_not_lost_by_one_bad_sample() -> None:
    assert signal_trust.is_trusted(after(1, bad=T_S, mismatch_time=T_S))


def test_latched_signals_need_a_confirmation() -> None:
    assert after(20, LATCHED) == LATCHED
    assert after(7, LATCHED, confirmed=True) == TrustState(heal_time=1.75, needed=2.0, latched=True)
    assert after(8, LATCHED, confirmed=True) == TrustState(heal_time=2.0, needed=2.0, latched=False)
    assert after(1, after(3, LATCHED, confirmed=True)) == LATCHED


def test_who_is_latched_again_needs_twice_the_heal_time() -> None:
    """Up to a limit."""
    x, needed = TRUSTED, []
    for _ in range(7):
        x = after(1, x._replace(heal_time=x.needed), implausible=True)
        needed.append(x.needed)
    assert needed == [2.0, 4.0, 8.0, 16.0, LONGEST, LONGEST, LONGEST]
    assert signal_trust.is_trusted(after(128, x, confirmed=True))
    assert not signal_trust.is_trusted(after(127, x, confirmed=True))


def test_that_limit_is_a_number_of_heal_times() -> None:
    most = LONGEST * 2.0
    x = signal_trust.update(
        LOST._replace(needed=most), **(GOOD | {"implausible": True}), T_s=T_S, p=P._replace(t_proof=2.0)
    )
    assert x.needed == most


@pytest.mark.parametrize("latched", [True, False])
def test_rest_clears_what_was_latched(latched: bool) -> None:
    x = LATCHED._replace(latched=latched, needed=8.0)
    assert after(1, x, resting=True) == TrustState(heal_time=0.25, needed=1.0, latched=False)
