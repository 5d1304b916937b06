"""A controller for any car: its own gains are worth more than those of another car, told of the car though it is."""

from functools import partial
from pathlib import Path

import pytest

from driveline.harness.design.design_trials import Gains, Trial, measured, parameters
from driveline.harness.loop.places import NATIVE, PLANTS
from driveline.harness.loop.settings import Settings
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.many_runs import run_many
from tests import ROOT

CARS = {path.stem: path for path in sorted((ROOT / "examples" / "cars").glob("*.toml"))}
TRIED_MANOEUVRES = ("tipin15", "tipin50")
MEASURES = ("settling_time", "overshoot", "gear_torque_rms", "jerk_rms", "jerk_rms_to_50_Hz")

TRIALS = [
    Trial(path, PLANTS[0], manoeuvre, gains)
    for path in CARS.values()
    for manoeuvre in TRIED_MANOEUVRES
    for gains in (Gains.DEFAULT, Gains.OWN)
]


@pytest.fixture(scope="module")
def found(both_built: Path) -> dict[Trial, Metrics]:
    run = partial(measured, settings=Settings(folder=both_built, build=NATIVE))
    return dict(zip(TRIALS, run_many(run, TRIALS, workers=1), strict=True))


@pytest.mark.parametrize("manoeuvre", TRIED_MANOEUVRES)
@pytest.mark.parametrize("car", CARS)
def test_its_own_gains_beat_those_of_the_default_car(car: str, manoeuvre: str, found: dict[Trial, Metrics]) -> None:
    own, default = (found[Trial(CARS[car], PLANTS[0], manoeuvre, gains)] for gains in (Gains.OWN, Gains.DEFAULT))
    for measure in MEASURES:
        assert getattr(own, measure) < getattr(default, measure), measure
    assert own.response_delay < 1.2 * default.response_delay, "and not by being slow"
    assert own.withheld_time < 0.020, "nor by keeping the torque from the driver"


def test_the_true_car_is_told_to_plant_and_controller_with_either_gains() -> None:
    van, plant = CARS["van"], "ValidationVehicle"
    default, own = (parameters(Trial(van, plant, "tipin15", gains)) for gains in (Gains.DEFAULT, Gains.OWN))
    for given in (default, own):
        assert given["plant.phi_B"] == given["controller.phi_B"] == 0.314
        assert given["plant.i"] == given["can.i"] == 12.0
        assert given["motor.T_max"] == given["controller.T_max"] == 250.0
        assert given["plant.k_s"] == pytest.approx(52333.7)
    assert "controller.k_d" not in default
    assert own["controller.k_d"] == pytest.approx(3.469, abs=0.001)
