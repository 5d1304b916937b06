"""The search: finds the least cost, always in the same way, and goes on from what is known."""

import sys
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice, pairwise

import pytest

from driveline.harness.design.search.controller_cost import Costs
from driveline.harness.design.search.parameter_search import Evaluated, Search, best, front
from driveline.harness.design.search.search_space import Searched, Space
from toolground.errors import MissingExtra

SPACE = Space((Searched("k", 2.0, 0.2, 10.0), Searched("T", 0.004, 0.0, 0.012)), {"L": 0.3})


class Bowl:
    """Comfort wants a large k, response a small one, and the swing T = 0.006.

    Attributes:
        asked: candidates in the order in which they were evaluated.
    """

    def __init__(self) -> None:
        self.asked: list[Mapping[str, float]] = []

    def __call__(self, candidates: Sequence[Mapping[str, float]]) -> Iterator[Costs]:
        for each in candidates:
            self.asked.append(each)
            k, T, L = each["k"], each["T"], each["L"]
            yield Costs(1.0 + (T / 0.006 - 1.0) ** 2 + L - 0.3, 1.0 + (k / 4.0 - 1.0) ** 2, 1.0 + (k / 1.0 - 1.0) ** 2)


def found(evaluations: int = 240, seed: int = 1) -> list[Evaluated]:
    return Search(SPACE, Bowl(), seed).run(evaluations)


def test_it_finds_what_costs_least_for_every_character() -> None:
    visited, bowl = found(), Bowl()
    grid = [{"k": 0.2 + 0.01 * k, "T": 0.006, "L": 0.3} for k in range(980)]
    gains = []
    for character in (0.0, 0.25, 0.5, 0.75, 1.0):
        chosen = best(visited, character)
        assert chosen.costs.total(character) == pytest.approx(min(c.total(character) for c in bowl(grid)), rel=2e-3)
        gains.append(chosen.values[0])
    assert gains == sorted(gains)
    assert gains[-1] > 1.3 * gains[0]


@pytest.mark.parametrize("evaluations", [1, 2, 7, 100])
def test_it_visits_as_many_candidates_as_asked_for_the_start_first(evaluations: int) -> None:
    visited = found(evaluations)
    assert len(visited) == evaluations
    assert visited[0].values == SPACE.start


def test_the_same_seed_gives_the_same_candidates_within_their_ranges() -> None:
    assert found(60) == found(60)
    assert found(60)[1:] != found(60, seed=2)[1:]
    bowl = Bowl()
    Search(SPACE, bowl).run(240)
    assert all(0.2 <= each["k"] <= 10.0 and 0.0 <= each["T"] <= 0.012 and each["L"] == 0.3 for each in bowl.asked)


def test_a_search_that_was_stopped_goes_on_with_what_it_noted_as_soon_as_it_was_known() -> None:
    whole = found(100)
    known = {each.values: each.costs for each in islice(whole, 37)}
    bowl = Bowl()
    assert Search(SPACE, bowl, known=known).run(100) == whole
    assert len(bowl.asked) == len({each.values for each in whole}) - len({each.values for each in whole[:37]})
    assert known == {each.values: each.costs for each in whole}
    better = {(4.0, 0.006): Costs(0.0, 0.0, 0.0)}
    assert Search(SPACE, Bowl(), known=better).run(60) == found(60)
    known: dict[tuple[float, ...], Costs] = {}
    counts: list[tuple[int, int]] = []
    Search(SPACE, Bowl(), known=known, note=lambda count: counts.append((count, len(known)))).run(20)
    assert [count for count, _ in counts] == list(range(1, 21))
    assert counts[0] == (1, 1)
    assert all(later[1] - sooner[1] <= 1 for sooner, later in pairwise(counts))


def test_the_front_has_what_nothing_beats() -> None:
    visited = found(100)
    kept = front(visited)
    assert len(kept) > 5
    for one in kept:
        assert not any(
            other.costs.comfort <= one.costs.comfort
            and other.costs.response <= one.costs.response
            and other.costs[1:] != one.costs[1:]
            for other in visited
        )
    assert [each.costs.comfort for each in kept] == sorted(each.costs.comfort for each in kept)
    for one in visited:
        assert any(k.costs.comfort <= one.costs.comfort and k.costs.response <= one.costs.response for k in kept)


def test_without_the_optimiser_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cma", None)
    with pytest.raises(MissingExtra, match=r"driveline-damping\[design\]"):
        found(5)
