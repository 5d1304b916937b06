"""What a tab asks for, and what the loops get for it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from driveline.harness.base.errors import DrivelineError
from driveline.harness.cosimulation.runs import kept_loaded
from driveline.harness.explorer.request import COMFORT, SPORT, Request, characterised, parameters
from driveline.harness.explorer.request_runs import RequestRunner
from driveline.harness.loop.settings import Settings

NAMES = {"plant": ["phi_B", "m"], "controller": ["phi_B", "k_d"], "motor": ["tau"]}

REQUEST = Request("TwoMassDriveline", "tipin15")


@pytest.fixture
def runner(with_washout: Path) -> RequestRunner:
    """Both plants, our controller and another."""
    return RequestRunner(
        {
            (plant, name): Settings(plant=plant, controller=name, folder=with_washout, build="native")
            for plant in ("TwoMassDriveline", "ValidationVehicle")
            for name in ("DampingController", "SpeedWashout")
        }
    )


def test_the_controllers_know_the_car_only_if_they_are_informed() -> None:
    request = replace(REQUEST, car={"phi_B": 0.3, "m": 2000.0})
    assert parameters(request, NAMES, {}, {}) == {"plant.phi_B": 0.3, "plant.m": 2000.0, "controller.phi_B": 0.3}
    assert parameters(replace(request, informed=False), NAMES, {}, {}) == {"plant.phi_B": 0.3, "plant.m": 2000.0}


def test_what_is_typed_stands_above_the_slider_and_that_above_the_files() -> None:
    given = {"plant.m": 1000.0, "plant.phi_B": 0.1, "motor.tau": 0.01}
    request = replace(REQUEST, car={"m": 2000.0, "phi_B": 0.2}, informed=False, typed={"plant.phi_B": 0.3})
    assert parameters(request, NAMES, given, {}) == {"plant.m": 2000.0, "plant.phi_B": 0.3, "motor.tau": 0.01}


def test_what_is_typed_for_another_plant_is_of_no_account() -> None:
    assert parameters(replace(REQUEST, typed={"plant.k_s": 1.0}), NAMES, {}, {}) == {}


def test_in_the_middle_the_character_changes_nothing_and_at_its_ends_it_makes_the_factors() -> None:
    gains = dict.fromkeys({*SPORT, *COMFORT}, 2.0)
    assert characterised(gains, 0.5) == gains
    assert characterised(gains, 0.0) == {name: 2.0 * SPORT.get(name, 1.0) for name in gains}
    assert characterised(gains, 1.0) == {name: 2.0 * COMFORT.get(name, 1.0) for name in gains}


def test_comfort_swings_and_jerks_less_and_sport_answers_sooner(runner: RequestRunner) -> None:
    """In the mean over the steps on both plants."""

    def worth(character: float) -> np.ndarray:
        found = []
        for plant in runner.plants:
            for manoeuvre in ("tipin15", "tipin50", "tipout", "launch"):
                request = Request(plant, manoeuvre, character=character)
                metrics = runner.answer(request).runs["DampingController"].metrics
                response = metrics.response_delay + metrics.withheld_time
                found.append((metrics.overshoot, metrics.jerk_rms_to_50_Hz, response))
        return np.log(found).mean(axis=0)

    with kept_loaded():
        sport, middle, comfort = map(worth, (0.0, 0.5, 1.0))
    assert (comfort[:2] < middle[:2]).all()
    assert (middle[:2] < sport[:2]).all()
    assert sport[2] < middle[2] < comfort[2]


def test_the_run_without_control_is_made_again_only_where_the_car_or_the_manoeuvre_has_changed(
    runner: RequestRunner,
) -> None:
    with kept_loaded():
        first = runner.answer(REQUEST).without
        assert runner.answer(replace(REQUEST, gains={"k_d": 1.0}, others=("SpeedWashout",))).without is first
        assert runner.answer(replace(REQUEST, control=False)).without is first
        assert runner.answer(replace(REQUEST, car={"phi_B": 0.3})).without is not first


def test_controllers_stand_beside_ours_and_ours_can_be_off(runner: RequestRunner) -> None:
    with kept_loaded():
        assert list(runner.answer(replace(REQUEST, others=("SpeedWashout",))).runs) == [
            "DampingController",
            "SpeedWashout",
        ]
        assert list(runner.answer(replace(REQUEST, control=False, others=("SpeedWashout",))).runs) == ["SpeedWashout"]


def test_a_value_beyond_what_an_fmu_takes_is_refused_by_name(runner: RequestRunner) -> None:
    with pytest.raises(DrivelineError, match=r"^plant\.m = 10: TwoMassDriveline\.fmu takes 300 to 10000 kg$"):
        runner.answer(replace(REQUEST, typed={"plant.m": 10.0}))


def test_an_unknown_parameter_is_answered_with_the_nearest(runner: RequestRunner) -> None:
    runner.require_parameter("plant.k_s")
    with pytest.raises(DrivelineError, match=r"no parameter plant\.ks; did you mean .*plant\.k_s"):
        runner.require_parameter("plant.ks")


@pytest.mark.slow
def test_sliders_end_within_what_every_fmu_takes(runner: RequestRunner) -> None:
    for knob in (*runner.car, *runner.gains):
        assert knob.low <= knob.value <= knob.high, knob.name
        with kept_loaded():
            for end in (knob.low, knob.high):
                turned = {knob.name: end}
                for plant in runner.plants:
                    request = Request(plant, "tipin15")
                    runner.answer(
                        replace(request, car=turned) if knob in runner.car else replace(request, gains=turned)
                    )
