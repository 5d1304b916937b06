"""The switching times of the contacts on their grid: the best ones, and what is proven about those around them."""

from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from .active_constraints import ActiveConstraints
from .constraints import programme
from .contacts import PARTS, Contacts
from .linear_car import LinearCar
from .linear_prediction import Predictor, value
from .programme import Solution, solve
from .task import Task

STRIDES = (4, 2, 1)
"""Of the descent, in parts of a sample."""

BORDER = 1.003
"""Switching times are looked at until those around are proven to be worse than the best by this factor."""

Holding = tuple[tuple[int, int], ...]
"""Until which sample the torque is held for how many samples."""

COARSE = ((80, 1), (160, 2), (300, 5), (500, 20), (1000, 100))
FINE = ((60, 1), (160, 2), (480, 4), (1000, 8))
"""While searching, and for proofs."""

ROUNDS = 40
"""In each, more samples become active: those where overshoot and swing are too large."""


class Found(NamedTuple):
    """The best torque for some contacts."""

    contacts: Contacts
    solution: Solution


class Search:
    """Of the best switching times for some metrics, along a car that is linear for given ones."""

    def __init__(self, task: Task, car: LinearCar, metrics: Sequence[str]) -> None:
        """See `.constraints.programme`."""
        self.task, self.car, self.metrics = task, car, metrics
        self.predictor = Predictor(car, task.horizon, task.contacts.sides[-1])
        self.active = ActiveConstraints.of(task)
        self.solved: dict[tuple[Contacts, Holding], Solution] = {}

    def solve(self, contacts: Contacts, holding: Holding = COARSE) -> Solution:
        """The best torque for these contacts; known ones are not solved again."""
        key = contacts, holding
        if key not in self.solved:
            self.solved[key] = self._solved(contacts, holding)
        return self.solved[key]

    def _solved(self, contacts: Contacts, holding: Holding) -> Solution:
        p = self.predictor.predict(contacts)
        held = holds(holding, self.task.horizon.free)

        def solved() -> Solution:
            return solve(programme(self.task, p, contacts, self.car.phi_B, self.metrics, self.active), held)

        solution = solved()
        if holding is FINE:
            T_gear = p.T_gear(np.arange(len(self.task.times)))
            for _ in range(ROUNDS):
                if solution.ratio == np.inf or not self.active.violated(self.task, value(T_gear, solution.u)):
                    break
                solution = solved()
        return solution

    def descend(self, contacts: Contacts) -> Contacts:
        """The best contacts that small changes of the switching times lead to."""
        for stride in STRIDES:
            better: Contacts | None = contacts
            while better is not None:
                contacts = better
                cost = self.solve(contacts).cost
                better = next((c for c in self.around(contacts, stride) if self.solve(c).cost < cost), None)
        return contacts

    def surround(self, contacts: Contacts) -> list[Found]:
        """All contacts that are not proven to be worse than these by BORDER, as far as they are connected to them."""
        best = self.solve(contacts, FINE).ratio
        surroundings, seen, waiting = [], {contacts}, [contacts]
        while waiting:
            at = waiting.pop()
            surroundings.append(Found(at, self.solve(at, FINE)))
            best = min(best, surroundings[-1].solution.ratio)
            if surroundings[-1].solution.bound < BORDER * best:
                new = [c for c in self.around(at, 1) if c not in seen]
                seen.update(new)
                waiting += new
        return surroundings

    def around(self, contacts: Contacts, stride: int) -> Iterator[Contacts]:
        """Contacts with switching times that are earlier or later by a stride."""
        last = self.task.horizon.head * PARTS
        for shift in product((0, -stride, stride), repeat=len(contacts.ends)):
            ends = tuple(end + by for end, by in zip(contacts.ends, shift, strict=True))
            if any(shift) and all(a < b for a, b in zip((0, *ends), (*ends, last), strict=True)):
                yield contacts._replace(ends=ends)


def holds(holding: Holding, free: int) -> np.ndarray:
    """The samples from which a torque is held until the next of them."""
    starts, k = [], 0
    for end, length in holding:
        starts += range(k, min(end, free), length)
        k = max(k, min(end, free))
    return np.array(starts)
