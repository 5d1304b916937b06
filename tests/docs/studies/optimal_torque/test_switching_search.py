"""Through the gap: what a programme promises is what the design model does, and better switching times are found."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from docs.studies.optimal_torque.contacts import Contacts
from docs.studies.optimal_torque.linear_car import linear_car
from docs.studies.optimal_torque.linear_prediction import value
from docs.studies.optimal_torque.open_loop_run import open_loop_run
from docs.studies.optimal_torque.programme import Solution
from docs.studies.optimal_torque.switching_search import BORDER, COARSE, FINE, Holding, Search, holds
from docs.studies.optimal_torque.task import task
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import at_samples, evaluate
from driveline.harness.simulation.simulate import simulate, start
from driveline.harness.studies.margins.linear_plant import NOISELESS

NATIVE = Settings(build="native", parameters={f"motor.{name}": value for name, value in NOISELESS.items()})


@pytest.fixture(scope="module")
def search(native: Path) -> Search:
    """Of the pull away, for all metrics."""
    manoeuvre = MANOEUVRES["launch"]
    given = task(manoeuvre, simulate(manoeuvre, NATIVE, folder=native.parent))
    return Search(given, linear_car(given.results, start(manoeuvre), given.first), given.metrics)


def test_the_design_model_does_what_the_programme_promises(search: Search, native: Path) -> None:
    of, contacts = search.task, search.task.contacts._replace(ends=(48,))
    found = search.solve(contacts)
    run = open_loop_run(of.manoeuvre, of.reference(found.u), NATIVE.replace(folder=native.parent))
    promised = value(search.predictor.predict(contacts).T_gear(np.arange(len(of.times))), found.u)
    assert promised == pytest.approx(at_samples(run)["plant.T_gear"][of.first :], abs=0.05)
    metrics = evaluate(run, of.manoeuvre)
    worst = max(getattr(metrics, name) / getattr(of.reached, name) for name in of.metrics)
    assert worst == pytest.approx(found.ratio, abs=0.003)
    assert metrics.response_delay == of.reached.response_delay
    assert (of.lower - 1e-9 <= found.u).all()
    assert (found.u <= of.upper + 1e-9).all()
    gap = run["plant.T_gear"][(run["time"] > of.manoeuvre.t_0) & (run["time"] < of.manoeuvre.t_0 + 0.0255)]
    assert not gap.any()


ROUGH = ((40, 4), (1000, 100))
"""How long a torque is held: what is proven holds for any."""


def test_teeth_that_have_to_meet_too_early_are_proven_to_be_impossible(search: Search) -> None:
    early = search.solve(search.task.contacts._replace(ends=(24,)), ROUGH)
    assert early.ratio == np.inf
    assert early.bound > 1.0


def test_contacts_and_torques_are_searched_in_order(search: Search) -> None:
    crossing = Contacts((-1, 0, 1), (10, 11))
    around = {c.ends for c in search.around(crossing, 1)}
    assert around == {(9, 10), (9, 11), (9, 12), (10, 12), (11, 12)}
    assert holds(((3, 1), (9, 3), (100, 5)), 14).tolist() == [0, 1, 2, 3, 6, 9]
    assert holds(FINE, 1000)[-1] == 992


class Known(Search):
    """Ratios that are known for a switching time, and what is proven about them."""

    def __init__(self, ratio: Callable[[int], float], bound: Callable[[int], float]) -> None:
        task: Any = SimpleNamespace(horizon=SimpleNamespace(head=10))
        self.task, self.ratio, self.bound = task, ratio, bound

    def solve(self, contacts: Contacts, holding: Holding = COARSE) -> Solution:
        (end,) = contacts.ends
        assert holding is FINE, "a proof"
        return Solution(np.zeros(1), self.ratio(end), self.ratio(end), self.bound(end))


def looked_at(search: Search, end: int) -> list[int]:
    return sorted(found.contacts.ends[0] for found in search.surround(Contacts((0, 1), (end,))))


def test_neighbours_are_looked_at_until_all_around_are_proven_to_be_worse() -> None:
    # By the factor 1.003; those that are proven to be are not gone beyond.
    for at_border, reach in ((1.0029, 4), (1.0031, 3)):
        bounds = {10: 1.0, 11: 1.002, 12: 1.001, 13: at_border, 14: 2.0, 9: 1.2}
        search = Known(lambda end: 1.0 if end == 10 else 1.5, lambda end: bounds.get(end, 0.0))  # noqa: B023
        assert looked_at(search, 10) == list(range(9, 10 + reach + 1))
    # What was not proven to be worse before is, beside it.
    bounds = {10: 0.9, 11: 1.5, 9: 0.49, 8: 0.5, 7: 0.9}
    search = Known(lambda end: 0.5 if end == 9 else 1.0, lambda end: bounds.get(end, 0.0))
    assert looked_at(search, 10) == [7, 8, 9, 10, 11]
    assert looked_at(Known(lambda end: 1.0, lambda end: BORDER - 1e-6), 10) == list(range(1, 40))
    assert looked_at(Known(lambda end: 1.0, lambda end: BORDER + 1e-6), 10) == [10]
