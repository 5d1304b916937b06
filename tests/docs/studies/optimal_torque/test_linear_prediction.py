"""The linear car with given contacts moves as the design model does, and its norms are the metrics."""

from pathlib import Path

import numpy as np
import pytest

from docs.studies.optimal_torque.linear_car import linear_car
from docs.studies.optimal_torque.linear_prediction import Predictor, value
from docs.studies.optimal_torque.open_loop_run import open_loop_run
from docs.studies.optimal_torque.task import Task, task
from driveline.harness.loop.places import T_S
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import at_samples, evaluate
from driveline.harness.metrics.spectrum import DRIVE_TRAIN, TO_50_HZ, band_parts, band_rms
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
        parts = band_parts(x, T_S, band, derivative)
        together = band_parts(x @ [1.0, 2.0, -3.0], T_S, band, derivative)
        assert parts @ [1.0, 2.0, -3.0] == pytest.approx(together, rel=1e-9, abs=1e-9 * np.abs(together).max())
        assert np.linalg.norm(parts[:, 0]) == pytest.approx(band_rms(x[:, 0], T_S, band, derivative), rel=1e-12)
