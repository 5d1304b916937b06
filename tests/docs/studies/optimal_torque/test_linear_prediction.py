"""The linear car with given contacts moves as the design model does, its norms are the metrics, and bounds hold."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from docs.studies.optimal_torque.linear_car import linear_car
from docs.studies.optimal_torque.linear_prediction import Predictor, value
from docs.studies.optimal_torque.open_loop_run import open_loop_run
from docs.studies.optimal_torque.programme import Cone, Programme, Rows, bound, joined, reached, solve
from docs.studies.optimal_torque.task import Task, task
from driveline.harness.loop.places import T_S
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import at_samples, evaluate
from driveline.harness.metrics.spectrum import DRIVE_TRAIN, TO_50_HZ, BandSpectrum, band_rms
from driveline.harness.simulation.simulate import simulate, start
from driveline.harness.studies.margins.linear_plant import NOISELESS

QUIET = {f"motor.{name}": value for name, value in NOISELESS.items()}


def of_ours(name: str, native: Path) -> Task:
    return task(MANOEUVRES[name], simulate(MANOEUVRES[name], parameters=QUIET, folder=native.parent, build="native"))


@pytest.fixture(scope="module")
def tipin(native: Path) -> Task:
    """With the teeth in contact, by our controller."""
    return of_ours("tipin0", native)


def test_a_run_is_driven_by_the_torque_that_is_given(tipin: Task, native: Path) -> None:
    given = at_samples(tipin.results)["controller.T_ref"]
    results = open_loop_run(tipin.manoeuvre, given, Settings(folder=native.parent, build="native", parameters=QUIET))
    assert np.array_equal(at_samples(results)["controller.T_ref"][2:], given[2:])
    moving = results["time"] > tipin.manoeuvre.t_0
    assert results["plant.T_gear"][moving] == pytest.approx(tipin.results["plant.T_gear"][moving], abs=2e-3)
    assert evaluate(results, tipin.manoeuvre).withheld_time == pytest.approx(tipin.reached.withheld_time, abs=1e-9)


@pytest.mark.slow
def test_the_linear_car_moves_as_the_design_model_and_its_norms_are_the_metrics(tipin: Task, native: Path) -> None:
    """Linear along the run itself nothing is left out but what changes between two samples."""
    u = at_samples(tipin.results)["controller.T_ref"][tipin.first :][: len(tipin.lower)]
    settings = Settings(folder=native.parent, build="native", parameters=QUIET)
    results = open_loop_run(tipin.manoeuvre, tipin.reference(u), settings)
    car = linear_car(results, start(tipin.manoeuvre), tipin.first)
    prediction = Predictor(car, tipin.horizon, 1).predict(tipin.contacts)
    T_gear = value(prediction.T_gear(np.arange(len(tipin.times))), u)
    assert T_gear == pytest.approx(at_samples(results)["plant.T_gear"][tipin.first :], abs=2e-3)
    metrics = evaluate(results, tipin.manoeuvre)
    assert np.linalg.norm(value(prediction.T_gear_parts(), u)) == pytest.approx(metrics.gear_torque_rms, rel=1e-4)
    assert np.linalg.norm(value(prediction.jerk_parts(), u)) == pytest.approx(metrics.jerk_rms_to_50_Hz, rel=1e-4)


@pytest.mark.parametrize("name", ["tipin15", "tipout", "launch"])
def test_the_contacts_of_a_run_are_those_of_its_gear_torque(name: str, native: Path) -> None:
    of = of_ours(name, native)
    T_gear, t = of.results["plant.T_gear"], of.results["time"] - of.manoeuvre.t_0
    closes = T_S + of.contacts.ends[-1] * T_S / 4
    meets = t[(t > 0.0) & (np.sign(T_gear) == of.contacts.sides[-1])][0]
    assert closes == pytest.approx(meets, abs=1e-3)
    assert of.contacts.sides[-1] == of.sign
    assert len(of.contacts.sides) == (2 if name == "launch" else 3)


@pytest.mark.parametrize("name", ["tipin0", "tipout"])
def test_the_torque_of_the_controller_is_within_the_limits_of_the_bound(name: str, native: Path) -> None:
    of = of_ours(name, native)
    u = at_samples(of.results)["controller.T_ref"][of.first :][: len(of.lower)]
    assert (of.lower <= u + 1e-9).all()
    assert (u - 1e-9 <= of.upper).all()
    assert of.reference(u)[-1] == pytest.approx(at_samples(of.results)["controller.T_driver"][-1])


def test_parts_of_a_band_are_linear_and_their_norm_is_the_rms() -> None:
    x = np.random.default_rng(1).standard_normal((800, 3)).cumsum(axis=0)
    for band, derivative in ((DRIVE_TRAIN, False), (TO_50_HZ, True)):
        parts = BandSpectrum(x, T_S).parts(band, derivative)
        together = BandSpectrum(x @ [1.0, 2.0, -3.0], T_S).parts(band, derivative)
        assert parts @ [1.0, 2.0, -3.0] == pytest.approx(together, rel=1e-9, abs=1e-9 * np.abs(together).max())
        assert np.linalg.norm(parts[:, 0]) == pytest.approx(band_rms(x[:, 0], T_S, band, derivative), rel=1e-12)


EACH = np.arange(3)
"""Every sample has a torque of its own."""


def programme(least: float = 1.0, counts: bool = True) -> Programme:
    """|u_k| <= 2, u_0 + u_1 + u_2 >= 3 least, u_2 <= rho, ||u||/sqrt(3) <= rho (or, where it does not count, 1)."""
    rows = joined(
        [
            Rows(np.array([[3.0 * least, -1.0, -1.0, -1.0]]), np.zeros(1), np.ones(1)),
            Rows(np.array([[0.0, 0.0, 0.0, 1.0]]), np.ones(1), np.ones(1)),
        ]
    )
    cone = Cone(np.eye(3, 4, 1) / np.sqrt(3.0), counts)
    return Programme(rows, [cone], np.full(3, -2.0), np.full(3, 2.0))


def test_norms_that_count_are_the_smallest_and_others_are_kept() -> None:
    found = solve(programme(), EACH)
    assert found.u == pytest.approx([1.0, 1.0, 1.0], abs=1e-2)
    assert found.ratio == pytest.approx(1.0, abs=1e-4)
    assert found.bound == pytest.approx(1.0, abs=1e-4)
    # u_0 = u_1 = 1.2, u_2 = 0 keeps it with rho = 0.
    found = solve(programme(0.8, counts=False), EACH)
    assert found.ratio == pytest.approx(0.0, abs=1e-4)
    assert np.linalg.norm(found.u) <= np.sqrt(3.0) + 1e-3
    found = solve(programme(3.0), EACH)
    assert found.ratio == np.inf
    assert found.bound > 2.0


@given(st.lists(st.floats(0.0, 3.0), min_size=2, max_size=2), st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3))
def test_no_multipliers_prove_too_much(y: list[float], v: list[float]) -> None:
    assert bound(programme(), np.array(y), [np.array(v)]) <= 1.0 + 1e-9


def test_ratio_violation_and_bound_are_those_of_the_torque_itself_held_or_free() -> None:
    assert reached(programme(), np.array([1.0, 1.0, 1.0])) == pytest.approx((1.0, 0.0))
    assert reached(programme(), np.array([0.0, 0.0, 1.5])) == pytest.approx((1.5, 1.5))
    assert reached(programme(counts=False), np.array([2.0, 2.0, 0.5])) == pytest.approx(
        (0.5, np.sqrt(8.25 / 3.0) - 1.0)
    )
    one = Rows(np.array([[1.0, -1.0, 0.0, 0.0]]), np.zeros(1), np.ones(1))
    favouring = programme()._replace(rows=joined([one]))
    held, free = solve(favouring, np.array([0])), solve(favouring, EACH)
    assert held.ratio == pytest.approx(1.0, abs=1e-4)
    assert free.ratio == pytest.approx(1.0 / np.sqrt(3.0), abs=1e-4)
    assert held.bound <= free.ratio + 1e-6
