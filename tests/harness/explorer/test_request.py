"""What a tab asks for, and what the loops get for it."""

from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from driveline.fmus.building.one_car import FOLLOW
from driveline.harness.base.errors import DrivelineError
from driveline.harness.cosimulation.runs import kept_loaded
from driveline.harness.explorer.request import COMFORT, SPORT, Request, characterised, parameters
from driveline.harness.explorer.request_runs import RequestRunner
from driveline.harness.explorer.worker import Beside
from driveline.harness.loop.settings import Settings
from driveline.harness.recordings.drive import Drive

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


def test_what_follows_in_the_detailed_car_turns_with_the_stiffness_and_back(runner: RequestRunner) -> None:
    stiffer = runner.parameters(replace(REQUEST, plant="ValidationVehicle", car={"C": 160.0}), "DampingController")
    assert stiffer["controller.C"] == 160.0
    assert stiffer["plant.k_s"] > 25800.0
    names = {"plant": list(FOLLOW), "controller": ["C"]}
    back = parameters(replace(REQUEST, car={"m": 1450.0}), names, {"plant.F_z0": 1.0}, {}, {"m": 2000.0})
    assert back["plant.F_z0"] == 8500.0


def test_a_car_that_cannot_be_is_refused(runner: RequestRunner) -> None:
    with pytest.raises(DrivelineError, match=r"k_s does not follow"):
        runner.parameters(replace(REQUEST, plant="ValidationVehicle", car={"C": 500.0}), "DampingController")


def test_what_is_typed_stands_above_the_slider_and_that_above_the_files() -> None:
    given = {"plant.m": 1000.0, "plant.phi_B": 0.1, "motor.tau": 0.01}
    request = replace(REQUEST, car={"m": 2000.0, "phi_B": 0.2}, informed=False, typed={"plant.phi_B": 0.3})
    assert parameters(request, NAMES, given, {}) == {"plant.m": 2000.0, "plant.phi_B": 0.3, "motor.tau": 0.01}


def test_what_is_typed_may_change_in_the_run(runner: RequestRunner) -> None:
    request = replace(REQUEST, typed={"controller.k_d@1.05": 1.5})
    runner.require(request)
    assert parameters(request, NAMES, {}, {}) == {"controller.k_d@1.05": 1.5}
    with pytest.raises(DrivelineError, match=r"there is no parameter controller\.kd; did you mean controller\.k_d"):
        runner.require(replace(REQUEST, typed={"controller.kd@1.05": 1.5}))


def test_what_is_typed_for_another_plant_is_of_no_account() -> None:
    assert parameters(replace(REQUEST, typed={"plant.k_s": 1.0}), NAMES, {}, {}) == {}


def test_in_the_middle_the_character_changes_nothing_and_at_its_ends_it_makes_the_factors() -> None:
    gains = dict.fromkeys({*SPORT, *COMFORT}, 2.0)
    assert characterised(gains, 0.5) == gains
    assert characterised(gains, 0.0) == {name: 2.0 * SPORT.get(name, 1.0) for name in gains}
    assert characterised(gains, 1.0) == {name: 2.0 * COMFORT.get(name, 1.0) for name in gains}


@pytest.mark.slow
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
    with pytest.raises(DrivelineError, match=r"^plant\.m = 10: TwoMassDriveline\.fmu takes 300 to 40000 kg$"):
        runner.answer(replace(REQUEST, typed={"plant.m": 10.0}))


def test_an_unknown_parameter_is_answered_with_the_nearest(runner: RequestRunner) -> None:
    runner.require(replace(REQUEST, plant="ValidationVehicle", typed={"plant.k_s": 3e4}))
    with pytest.raises(DrivelineError, match=r"no parameter plant\.ks; did you mean .*plant\.k_s"):
        runner.require(replace(REQUEST, plant="ValidationVehicle", typed={"plant.ks": 3e4}))


@pytest.mark.parametrize("change", [{"plant": "Lorry"}, {"manoeuvre": "jump"}])
def test_a_plant_or_manoeuvre_that_is_none_is_refused(runner: RequestRunner, change: dict[str, str]) -> None:
    with pytest.raises(DrivelineError, match=f"there is no .*{next(iter(change.values()))}"):
        runner.require(replace(REQUEST, **change))


def test_a_road_that_a_plant_cannot_have_is_refused_before_it_runs(runner: RequestRunner) -> None:
    runner.require(replace(REQUEST, plant="ValidationVehicle", manoeuvre="launch_ice"))
    with pytest.raises(DrivelineError, match="launch_ice is for plants with a parameter mu"):
        runner.require(replace(REQUEST, manoeuvre="launch_ice"))


@pytest.mark.slow
def test_the_knobs_that_can_be_turned_are_those_that_change_a_run(runner: RequestRunner) -> None:
    """Each is turned, and what the loops of the shown runs get is compared."""

    def loops(request: Request) -> list[dict[str, float]]:
        without = runner.parameters(request, "DampingController")
        shown = [runner.parameters(request, name) for name in runner.answer(request).runs]
        return [{k: v for k, v in without.items() if not k.startswith("controller.")}, *shown]

    with kept_loaded():
        for plant, control, informed in product(runner.plants, (True, False), (True, False)):
            request = Request(plant, "prbs15", control=control, informed=informed)
            before, turnable = loops(request), runner.turnable(request)
            for kind, knobs in (("car", runner.car), ("gains", runner.gains)):
                for knob in knobs:
                    turned = replace(request, **{kind: {knob.name: 0.5 * (knob.value + knob.high)}})
                    assert (loops(turned) != before) == (knob.name in turnable), (plant, knob.name)
    assert "k_d" not in runner.turnable(replace(REQUEST, control=False))


def test_a_recorded_drive_keeps_its_speed_on_every_plant(with_washout: Path) -> None:
    t = np.arange(0.0, 6.0, 0.05)
    drive = Drive("mine", t, 5.0 + np.sin(t), None, 20.0 + 10.0 * np.sin(2.0 * t), {})
    given = {
        (plant, "DampingController"): Settings(plant=plant, folder=with_washout, build="native")
        for plant in ("TwoMassDriveline", "ValidationVehicle")
    }
    runner = RequestRunner(given, recording=drive)
    assert next(iter(runner.manoeuvres)) == "mine"
    assert runner.window("mine") == pytest.approx((0.0, t[-1]))
    with kept_loaded():
        for plant in runner.plants:
            run = runner.answer(Request(plant, "mine")).without.results
            error = run["plant.omega_2"] / run["plant.omega_2"][0] - np.interp(run["time"], t, drive.v) / drive.v[0]
            assert np.abs(error).max() < 0.1
    with pytest.raises(DrivelineError, match="two manoeuvres are called creep"):
        RequestRunner(given, recording=replace(drive, name="creep"))


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


def test_two_runs_beside_each_other_are_those_one_after_the_other(runner: RequestRunner) -> None:
    request = replace(REQUEST, plant="ValidationVehicle", car={"m": 1600.0})
    expected = runner.answer(request)
    runner.answer(REQUEST)
    runner.beside = Beside()
    try:
        found = runner.answer(request)
        assert np.array_equal(found.without.results, expected.without.results)
        assert np.array_equal(found.runs["DampingController"].results, expected.runs["DampingController"].results)
        with pytest.raises(DrivelineError):
            runner.answer(replace(request, typed={"plant.m": 0.0}))
        assert runner.answer(request).without is found.without
    finally:
        runner.beside.close()


@pytest.mark.parametrize(
    ("t_return", "sport", "comfort"), [(0.0035, 0.002, 0.007), (0.012, 0.006, 0.0175), (0.03, 0.015, 0.03)]
)
def test_the_character_turns_a_gain_as_far_as_its_slider_goes(
    runner: RequestRunner, t_return: float, sport: float, comfort: float
) -> None:
    """From 2 ms, the least that the FMU takes, to five times the value at the start; what is typed beyond stays."""
    for character, value in ((0.0, sport), (0.5, t_return), (1.0, comfort)):
        request = replace(REQUEST, gains={"t_return": t_return}, character=character)
        assert runner.gains_of(request)["t_return"] == pytest.approx(value)
