"""The goals beside what is reached: what misses its goal is bold and counted, with the change that would reach it."""

from docs.studies.goals import GOALS, MET, Reached, most, title
from docs.studies.goals_page import NAMED, page
from docs.studies.one_at_a_time import Change
from driveline.harness.loop.places import PLANTS

KEYS = [(goal, plant) for goal in GOALS for plant in PLANTS]
FIRST = KEYS[0]
K_D, BOUNCE = Change("k_d", 3.0), Change("bounce", 0.5)


def reaching(share: float, **others: float) -> Reached:
    """This share of every goal; of the first so many another one."""
    values = {key: share * most(*key) for key in KEYS}
    return values | {key: other * most(*key) for key, other in zip(KEYS, others.values(), strict=False)}


def test_a_goal_is_missed_by_what_does_not_round_to_it() -> None:
    for share, number in ((0.999 * MET, 0), (1.001 * MET, len(KEYS))):
        assert f"not reached: {number} of {len(KEYS)}." in page(reaching(share), {K_D: reaching(0.5)})


def test_every_goal_has_its_row() -> None:
    text = page(reaching(2.0), {K_D: reaching(0.5)})
    assert all(f"| {title(goal)} | **" in text for goal in GOALS)
    assert "| tipin15: settling time, ms | **150** | 75 | **200** | 100 |" in text


def test_a_change_that_reaches_a_goal_is_named_with_what_is_missed_instead() -> None:
    goal, plant = KEYS[1]
    text = page(reaching(0.5, first=2.0), {K_D: reaching(0.5, first=0.9, second=1.5), BOUNCE: reaching(0.5, first=1.5)})
    assert f"| `k_d` = 3 | {title(goal)} ({plant}): {1.5 * most(*KEYS[1]):.3g} for" in text
    assert f"| {2.0 * most(*FIRST):.3g} | {0.9 * most(*FIRST):.3g} | {most(*FIRST):g} |" in text
    assert "No change reaches more than 0 of the 1 without" in text


def test_where_none_reaches_it_the_closest_one_is_bold() -> None:
    text = page(reaching(0.5, first=2.0), {K_D: reaching(0.5, first=1.6), BOUNCE: reaching(0.5, first=1.5)})
    assert f"| `bounce` = 0.5 | - | {2.0 * most(*FIRST):.3g} | **{1.5 * most(*FIRST):.3g}** |" in text


def test_many_that_are_missed_instead_are_counted() -> None:
    others = {str(k): 2.0 for k in range(NAMED + 1)}
    for instead, counted in ((NAMED, False), (NAMED + 1, True)):
        changed = reaching(0.5, first=0.9, **dict(list(others.items())[:instead]))
        assert (f"| {instead} goals |" in page(reaching(0.5, first=2.0), {K_D: changed})) == counted
