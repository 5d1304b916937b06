"""A change of one parameter: which it is for a goal, and what it costs."""

from docs.studies.goals import GOALS, Reached, most
from docs.studies.one_at_a_time import FACTORS, Change, changes, closest, harmless
from driveline.harness.loop.places import PLANTS

KEYS = [(goal, plant) for goal in GOALS for plant in PLANTS]
A, B, C = (Change(name, 1.0) for name in "abc")


def reaching(*shares: float) -> Reached:
    """These shares of the first goals, and half of the others."""
    values = {key: 0.5 * most(*key) for key in KEYS}
    return values | {key: share * most(*key) for key, share in zip(KEYS, shares, strict=False)}


BEFORE = reaching(2.0, 2.0, 0.9)


def test_of_those_that_reach_it_the_one_with_the_fewest_missed_instead_is_taken() -> None:
    changed = {A: reaching(0.5, 2.0, 2.0), B: reaching(0.9, 2.0, 0.9), C: reaching(0.8, 2.0, 2.0, 2.0)}
    assert closest(KEYS[0], BEFORE, changed)[:2] == (B, 0.9 * most(*KEYS[0]))
    assert closest(KEYS[0], BEFORE, {A: changed[A], C: changed[C]}).instead == [KEYS[2]]


def test_what_was_missed_before_is_not_missed_instead() -> None:
    assert closest(KEYS[0], BEFORE, {A: reaching(0.5, 3.0, 0.9)}).instead == []


def test_where_none_reaches_it_the_closest_is_taken() -> None:
    changed = {A: reaching(1.5, 2.0), B: reaching(1.2, 2.0, 2.0, 2.0), C: reaching(1.3)}
    assert closest(KEYS[0], BEFORE, changed).change == B


def test_a_change_is_harmless_that_misses_nothing_instead() -> None:
    one, both, costly = reaching(0.5, 2.0, 0.9), reaching(0.5, 0.5, 0.9), reaching(0.5, 0.5, 2.0)
    assert harmless(BEFORE, {A: one}) == harmless(BEFORE, {A: one, C: costly}) == 1
    assert harmless(BEFORE, {A: one, B: both}) == 2
    assert harmless(BEFORE, {C: costly}) == 0


def test_every_parameter_that_a_search_may_change_is_changed_by_each_factor() -> None:
    found = changes()
    assert len(set(found)) == len(found)
    assert len(found) == len(FACTORS) * len({change.parameter for change in found})
    assert Change("k_d", 2.55 * 1.1) in [change._replace(value=round(change.value, 6)) for change in found]
