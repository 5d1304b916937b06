"""The search for the parameters that cost least: CMA-ES (Hansen and Ostermeier 2001), by the package cma.

Half of the evaluations look for the balanced choice, and from the best of them a quarter each goes towards comfort and
sport, so that the front between them is seen. A strategy that has converged is begun again with twice the population
(Auger and Hansen 2005). What a candidate costs is asked for only once; so a search that was stopped goes on where it
was, by what is known of its candidates, and ends with the same bytes.
"""

from collections.abc import Callable, Iterator, Mapping, MutableMapping, Sequence
from math import log, nan
from typing import Any, NamedTuple

import numpy as np

from toolground.optional_packages import required

from .controller_cost import Costs
from .search_space import Space


class Leg(NamedTuple):
    """Of the search: the character that it looks for, the share of the evaluations after which it ends, and its first
    step, in the coordinates of `Searched`."""

    character: float
    until: float
    step: float


LEGS = (Leg(0.5, 0.5, 0.3), Leg(1.0, 0.75, 0.15), Leg(0.0, 1.0, 0.15))

TOLERANCE = 1e-4
"""Spread of coordinates and costs at which a strategy has converged."""

Values = tuple[float, ...]
"""Of the searched parameters, in the order of the space."""

CostsOf = Callable[[Sequence[Mapping[str, float]]], Iterator[Costs]]


class Evaluated(NamedTuple):
    """A candidate and what it costs."""

    values: Values
    costs: Costs


class Search:
    """A search, which is the same for the same seed and costs.

    Attributes:
        visited: all candidates in the order in which they were asked for, the start first.

    Args:
        space: what is searched.
        costs_of: gives the costs of candidates, see `harness.design.search.cost_evaluation.CostEvaluation.opened`.
        seed: of all that is random.
        known: costs by candidates; those that are missing are added, one after the other.
        note: called with the number of candidates whenever there is one more.
    """

    def __init__(
        self,
        space: Space,
        costs_of: CostsOf,
        seed: int = 1,
        known: MutableMapping[Values, Costs] | None = None,
        note: Callable[[int], None] = lambda count: None,
    ) -> None:
        self.visited: list[Evaluated] = []
        self._space = space
        self._costs_of = costs_of
        self._random = np.random.default_rng(seed)
        self._known = {} if known is None else known
        self._note = note

    def run(self, evaluations: int) -> list[Evaluated]:
        """The candidates, so many as asked for.

        Raises:
            MissingExtra: the package cma is not installed.
        """
        self._evaluated([self._space.start])
        for leg in LEGS:
            begin = self._space.coordinates(best(self.visited, leg.character).values)
            self._descend(leg, begin, round(leg.until * evaluations))
        return self.visited

    def _descend(self, leg: Leg, begin: list[float], limit: int) -> None:
        """One leg, until so many candidates have been visited."""
        population = 4 + int(3.0 * log(len(begin)))
        while len(self.visited) < limit:
            strategy = self._strategy(begin, leg.step, population)
            while len(self.visited) < limit and not strategy.stop():
                candidates_of_leg = strategy.ask()
                room = limit - len(self.visited)
                evaluated = self._evaluated([self._space.values(x) for x in candidates_of_leg[:room]])
                if len(evaluated) == len(candidates_of_leg):
                    strategy.tell(candidates_of_leg, [candidate.costs.total(leg.character) for candidate in evaluated])
            population *= 2

    def _evaluated(self, candidates: Sequence[Values]) -> list[Evaluated]:
        new = [values for values in dict.fromkeys(candidates) if values not in self._known]
        answers = self._costs_of([self._space.parameters(values) for values in new])
        for values in candidates:
            if values not in self._known:
                self._known[values] = next(answers)
            self.visited.append(Evaluated(values, self._known[values]))
            self._note(len(self.visited))
        return self.visited[-len(candidates) :]

    def _strategy(self, begin: list[float], step: float, population: int) -> Any:
        searched = self._space.searched
        options = {
            "bounds": [
                [parameter.coordinate(parameter.low) for parameter in searched],
                [parameter.coordinate(parameter.high) for parameter in searched],
            ],
            "popsize": population,
            "randn": lambda *shape: self._random.standard_normal(shape),
            "seed": nan,  # nothing is random but that
            "tolx": TOLERANCE,
            "tolfun": TOLERANCE,
            "verbose": -10,
        }
        return required("cma", "searching", "driveline-damping[design]").CMAEvolutionStrategy(begin, step, options)


def best(visited: Sequence[Evaluated], character: float) -> Evaluated:
    """The candidate that costs least, for a driver's choice from 0, sport, to 1, comfort."""
    return min(visited, key=lambda candidate: candidate.costs.total(character))


def front(visited: Sequence[Evaluated]) -> list[Evaluated]:
    """The candidates than which none is better in both comfort and response, from the best in comfort on."""
    kept: list[Evaluated] = []
    for candidate in sorted(visited, key=lambda candidate: (candidate.costs.comfort, candidate.costs.response)):
        if not kept or candidate.costs.response < kept[-1].costs.response:
            kept.append(candidate)
    return kept
