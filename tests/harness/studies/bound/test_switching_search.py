"""Through the gap: what a programme promises is what the design model does, and better switching times are found."""

from pathlib import Path

import numpy as np
import pytest

from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import at_samples, evaluate
from driveline.harness.simulation.simulate import simulate, start
from driveline.harness.studies.bound.bound_task import task
from driveline.harness.studies.bound.contacts import Contacts
from driveline.harness.studies.bound.linear_car import linear_car
from driveline.harness.studies.bound.linear_prediction import value
from driveline.harness.studies.bound.open_loop_run import open_loop_run
from driveline.harness.studies.bound.switching_search import FINE, Search, holds
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


def test_teeth_that_have_to_meet_too_early_are_proven_to_be_impossible(search: Search) -> None:
    early = search.solve(search.task.contacts._replace(ends=(24,)))
    assert early.ratio == np.inf
    assert early.bound > 1.0


def test_around_contacts_are_those_in_order(search: Search) -> None:
    crossing = Contacts((-1, 0, 1), (10, 11))
    around = {c.ends for c in search.around(crossing, 1)}
    assert around == {(9, 10), (9, 11), (9, 12), (10, 12), (11, 12)}


def test_a_torque_is_held_until_the_next_sample_that_has_one() -> None:
    assert holds(((3, 1), (9, 3), (100, 5)), 14).tolist() == [0, 1, 2, 3, 6, 9]
    assert holds(FINE, 1000)[-1] == 992
