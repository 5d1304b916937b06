"""A campaign: all draws with every controller, resumed where it was stopped, the same runs on one process or more."""

from dataclasses import replace
from shutil import copytree
from typing import Any

import numpy as np
import pytest

from driveline.fmus.catalogue import EVERY
from driveline.harness.design.uncertainty_box import BOX, DOUBLINGS, LOSS, Deviation, changed, deviating
from driveline.harness.loop.places import PLACES
from driveline.harness.loop.resolved import as_given
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.simulation.case_archive import CaseArchive
from driveline.harness.simulation.simulate import simulate
from driveline.harness.studies.robustness.case_runs import CaseRunner
from driveline.harness.studies.robustness.draws import draw
from driveline.harness.studies.robustness.outcome import ROBUSTNESS_MANOEUVRES, Case
from driveline.harness.studies.robustness.robustness_campaign import RUNS, campaign, cases
from fmuloop.campaign import Outcome as Answered
from fmuloop.campaign import RunResults
from fmuloop.errors import SimulationError, UnpackingError
from fmuloop.many_runs import run_many
from fmuloop.results import Ended, Results
from tests.harness.studies.robustness import outcome
from toolground.errors import UserError

LOOPS = [("TwoMassDriveline", "DampingController"), ("TwoMassDriveline", "NoDamping")]


class Pretended(CaseRunner):
    """A runner that makes up its runs, and fails at one."""

    def __init__(self, fails_at: int | None = None) -> None:
        self.loops: Any = dict.fromkeys(LOOPS)
        self.asked = []
        self._fails_at = fails_at

    def share(self, case):
        return 1.0

    def planned(self, case):
        return []

    def outcome(self, case, runs):
        if len(self.asked) == self._fails_at:
            raise UserError("stopped")
        self.asked.append(case)
        return outcome(case.number, case.controller, case.manoeuvre, settling_time=0.1 * case.number)


@pytest.mark.parametrize("error", [SimulationError, UnpackingError])
def test_what_an_fmu_refuses_is_an_outcome_and_what_the_machine_refuses_is_not(error):
    refused = RunResults([Answered(None, error("no space left"))])
    case = cases(LOOPS, [1])[0]
    if error is UnpackingError:
        with pytest.raises(UnpackingError, match="no space left"):
            CaseRunner.outcome(Pretended(), case, refused)
    else:
        assert CaseRunner.outcome(Pretended(), case, refused).reason == "no space left"


def test_a_run_that_an_fmu_ends_is_neither_bounded_nor_quiet():
    ended = Results(np.zeros(3, [("time", float)]), {})
    ended.ended = Ended("plant (car.fmu)", 2.0)
    found = CaseRunner.outcome(Pretended(), cases(LOOPS, [1])[0], [ended])
    assert (found.reason, found.bounded, found.quiet) == ("plant (car.fmu) ended the run at 2 s", False, False)


def test_every_controller_gets_every_draw_in_every_manoeuvre():
    found = campaign(Pretended(), [1, 2], workers=1)
    expected = {(c, n, m) for _, c in LOOPS for n in (1, 2) for m in ROBUSTNESS_MANOEUVRES}
    assert len(found) == len(expected)
    assert {(each.case.controller, each.case.number, each.case.manoeuvre) for each in found} == expected


@pytest.mark.parametrize("fails_at", [0, 1, 5])
def test_a_campaign_goes_on_where_it_was_stopped(tmp_path, fails_at):
    def archive():
        return CaseArchive(tmp_path / "runs.csv", RUNS)

    first, second = Pretended(fails_at), Pretended()
    with pytest.raises(UserError, match="stopped"):
        campaign(first, [1, 2], archive(), workers=1)
    found = campaign(second, [1, 2], archive(), workers=1)
    assert len(first.asked) == fails_at
    assert first.asked + second.asked == cases(LOOPS, [1, 2]) == [each.case for each in found]
    third = Pretended()
    campaign(third, [1, 2, 3], archive(), workers=1)
    assert {case.number for case in third.asked} == {3}


@pytest.fixture(scope="module")
def controllers(native_builder, native, tmp_path_factory):
    """Folder with the native FMUs of both plants and two controllers."""
    folder = tmp_path_factory.mktemp("controllers")
    copytree(native, folder / "native")
    native_builder(EVERY["SpeedWashout"], folder)
    return folder


def runner(folder, plant="ValidationVehicle", controller="DampingController", parameters=()):
    loop = as_given(plant, controller=controller, parameters=dict(parameters), folder=folder, build="native")
    return CaseRunner({(plant, controller): loop}, seed=1)


@pytest.mark.parametrize("plant", PLACES["plant"])
@pytest.mark.parametrize("controller", ["DampingController", "SpeedWashout"])
def test_a_case_is_the_drawn_car_with_the_drawn_noise(controllers, plant, controller):
    case, drawn = Case(plant, controller, 3, "tipout"), draw(3, 1)
    settings = {"folder": controllers, "build": "native", "controller": controller, "seed": drawn.noise}
    parameters = deviating({}, plant, controller, drawn.deviation)
    expected = simulate(MANOEUVRES["tipout"], plant, parameters=parameters, **settings)
    made = runner(controllers, plant, controller)
    assert (made.results(case) == expected).all()
    metrics, found = evaluate(expected, MANOEUVRES["tipout"]), made.outcome(case, [expected]).measured
    assert found["settling_time"] == metrics.settling_time
    assert found["gear_torque_peak"] == np.abs(expected["plant.T_gear"]).max() / 180.0


@pytest.mark.parametrize("T_max", [100.0, 1300.0])
def test_a_car_with_another_motor_is_asked_for_its_share_and_may_swing_by_that(controllers, T_max):
    made = runner(controllers, "TwoMassDriveline", parameters={"motor.T_max": T_max, "controller.T_max": T_max})
    case = Case("TwoMassDriveline", "DampingController", 3, "tipin15")
    steps = np.ptp(made.results(case)["controller.T_driver"]), MANOEUVRES["tipin15"].dT
    assert steps[0] == pytest.approx(steps[1] * T_max / 180.0) == made.manoeuvre(case).dT
    assert made.share(case) == T_max / 180.0
    for factor, quiet in ((1.0 - 1e-9, True), (1.0 + 1e-9, False)):
        swings = replace(outcome(end_swing=0.05 * factor * steps[0]), share=made.share(case))
        assert swings.quiet == quiet


def test_a_factor_is_on_what_was_set(controllers):
    made = runner(controllers, parameters={"plant.m": 1000.0, "motor.tau": 0.004})
    blocks = made.loops["ValidationVehicle", "DampingController"].blocks
    found = changed(blocks, Deviation(m=1.2, tau=0.5, J_2=2.0))
    assert (found["plant.m"], found["motor.tau"], found["plant.J_w"]) == (1200.0, 0.002, 2.0 * 1.8)


def test_an_fmu_that_refuses_the_run_is_a_run_without_metrics(controllers):
    case = Case("ValidationVehicle", "DampingController", 1, "tipout")
    made = runner(controllers, parameters={"plant.r": 99.0})
    (found,) = run_many(made.outcome, [case], workers=1, runs=made.planned)
    assert not found.bounded
    assert "plant" in found.reason
    assert "99" in found.reason


def test_an_fmu_that_was_changed_since_is_refused(controllers, tmp_path):
    copytree(controllers, tmp_path / "fmus")
    made = runner(tmp_path / "fmus")
    one = tmp_path / "fmus" / "native" / "WheelSpeedCan.fmu"
    made.results(Case("ValidationVehicle", "DampingController", 1, "tipout"))
    one.write_bytes((tmp_path / "fmus" / "native" / "MotorTorqueLoop.fmu").read_bytes())
    with pytest.raises(UserError, match=r"WheelSpeedCan\.fmu is not the one that the campaign was begun with"):
        made.results(Case("ValidationVehicle", "DampingController", 1, "tipout"))
    one.unlink()
    with pytest.raises(UserError, match="there is no FMU"):
        made.results(Case("ValidationVehicle", "DampingController", 2, "tipout"))


def test_a_draw_follows_from_the_seed_and_its_number_and_says_so():
    assert draw(7, 1) == draw(7, 1)
    others = [draw(number, seed) for seed in (1, 2) for number in range(1, 50)]
    assert len({each.deviation for each in others}) == len({each.noise for each in others}) == len(others)
    text = str(draw(17, 1))
    assert text.startswith("17: J_2 ")
    assert all(f"{name} " in text for name in BOX)


@pytest.fixture(scope="module")
def thousand():
    return [draw(number, 1).deviation for number in range(1, 1001)]


@pytest.mark.parametrize("name", BOX)
def test_the_draws_fill_the_box_evenly(name, thousand):
    low, high = BOX[name]
    values = np.array([getattr(deviation, name) for deviation in thousand])
    assert low <= values.min() < values.max() <= high
    share = np.log2(values / low) / np.log2(high / low) if name in DOUBLINGS else (values - low) / (high - low)
    counts, _ = np.histogram(share, bins=5, range=(0.0, 1.0))
    assert counts.min() > 150  # 200 each; less than 150 has a chance of 1e-5


def test_draws_are_independent_and_lose_a_tenth_of_the_messages(thousand):
    values = np.array([[getattr(deviation, name) for name in BOX] for deviation in thousand])
    correlation = np.corrcoef(values.T) - np.eye(len(BOX))
    assert np.abs(correlation).max() < 0.13  # four standard deviations of 1/sqrt(1000)
    assert {deviation.loss for deviation in thousand} == {LOSS} == {0.1}
