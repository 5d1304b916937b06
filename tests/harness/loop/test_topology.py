"""Loops of several drive units: what they repeat, what they share, and a run as each of them sees it."""

from pathlib import Path

import numpy as np
import pytest

import driveline
from driveline.harness.loop import roles
from driveline.harness.loop.places import CONNECTIONS, INPUTS, OUTPUTS, PARAMETERS
from driveline.harness.loop.resolved import ResolvedLoop, resolve
from driveline.harness.loop.settings import Settings
from driveline.harness.loop.topology import ONE_UNIT, DriveUnit, Topology, read_topology
from driveline.harness.loop.unit_runs import of_unit
from driveline.harness.studies.compare.compare import Case, outcomes_of
from driveline.harness.studies.robustness.case_runs import CaseRunner
from driveline.harness.studies.robustness.outcome import Case as Draw
from fmuloop.errors import WiringError
from fmuloop.results import Results
from tests import ROOT

DECLARED = ROOT / "examples" / "two_axles" / "two_axles.toml"
BLOCK = ROOT / "examples" / "two_axles" / "two_axles.py"
TIPIN = driveline.MANOEUVRES["tipin15"]


@pytest.fixture(scope="module")
def two_axles(native: Path, tmp_path_factory: pytest.TempPathFactory) -> ResolvedLoop:
    """The loop of the example."""
    (plant,) = driveline.build_fmus([str(BLOCK)], tmp_path_factory.mktemp("two_axles"), "native")
    return resolve(plant, folder=native.parent, build="native", topology=DECLARED)


def test_one_unit_is_the_loop_as_it_is_declared() -> None:
    declared = ONE_UNIT.connections, ONE_UNIT.inputs, ONE_UNIT.parameters, ONE_UNIT.outputs
    assert declared == (CONNECTIONS, INPUTS, PARAMETERS, OUTPUTS)
    results = Results(np.zeros(3, [("time", float), (roles.GEAR_TORQUE, float)]), {})
    assert of_unit(results, DriveUnit()) is results


def test_two_units_repeat_all_but_the_body_and_are_declared_in_few_lines() -> None:
    topology = read_topology(DECLARED)
    assert len(DECLARED.read_text(encoding="utf-8").splitlines()) <= 40
    assert len(topology.connections) == 2 * len(CONNECTIONS)
    assert list(topology.places).count("plant") == 1
    assert len(topology.places) == 7
    assert [port.name for port in topology.inputs if port.variable in ("T_driver", "slope")] == [
        "controller_front.T_driver",
        "plant.slope",
        "controller_rear.T_driver",
    ]
    assert {c.source for c in topology.connections if c.target == "motor_rear.omega_1"} == {"plant.omega_1_rear"}


def test_a_run_is_read_as_each_unit_sees_it() -> None:
    units = DriveUnit("l", (("T_gear", "T_left"), ("omega_2", "w"))), DriveUnit("r", (("T_gear", "T_right"),))
    names = ["time", "controller_l.T_ref", "controller_r.T_ref", "plant.T_left", "plant.w", "plant.T_right", "plant.v"]
    table = np.array([tuple(range(len(names)))], [(name, float) for name in names])
    left, right = (of_unit(Results(table, {"plant.T_left": "N.m"}), unit) for unit in units)
    assert [left[name][0] for name in ("time", "controller.T_ref", "plant.T_gear", "plant.omega_2")] == [0, 1, 3, 4]
    assert [right[name][0] for name in ("time", "controller.T_ref", "plant.T_gear", "plant.v")] == [0, 2, 5, 6]
    assert left.units == {"plant.T_gear": "N.m"}
    assert roles.WHEEL_SPEED not in right


@pytest.mark.parametrize(
    "text",
    ["", "[unit.front]\n", "units = 3\n", "[units.front]\nT_mot = 3\n", '[units."a b"]\n', "[units.a]\n[more]\n"],
)
def test_a_file_without_drive_units_is_refused(text: str, tmp_path: Path) -> None:
    file = tmp_path / "loop.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(WiringError, match=r"loop\.toml: it must have tables such as \[units\.front\]"):
        Settings(topology=file)  # type: ignore[arg-type]
    with pytest.raises(WiringError, match=r"nowhere\.toml: there is no such file"):
        read_topology(tmp_path / "nowhere.toml")


def test_axles_that_are_alike_do_the_same_and_others_have_metrics_of_their_own(two_axles: ResolvedLoop) -> None:
    alike = two_axles.with_parameters({"plant.C_front": 140.0, "plant.C_rear": 140.0})
    results = driveline.simulate(TIPIN, alike)
    front, rear = (of_unit(results, unit) for unit in alike.settings.topology.units)
    assert np.array_equal(front[roles.GEAR_TORQUE], rear[roles.GEAR_TORQUE])
    outcomes = outcomes_of(
        Case("a", "tipin15", "b"), TIPIN, driveline.simulate(TIPIN, two_axles), two_axles.settings.topology
    )
    assert [outcome.plant_name for outcome in outcomes] == ["a front", "a rear"]
    soft, stiff = (outcome.metrics.gear_torque_rms for outcome in outcomes)
    assert soft < stiff
    assert outcomes[0].metrics.jerk_rms == outcomes[1].metrics.jerk_rms, "there is one body"


def test_a_campaign_judges_each_axle(two_axles: ResolvedLoop) -> None:
    runner = CaseRunner({("TwoAxles", "ours"): two_axles}, seed=1)
    assert list(runner.loops) == [("TwoAxles front", "ours"), ("TwoAxles rear", "ours")]
    cases = [Draw(plant, "ours", 1, "tipin15") for plant, _ in runner.loops]
    runs = ([request.results() for request in runner.planned(case)] for case in cases)
    rms = [runner.outcome(case, results).measured["gear_torque_rms"] for case, results in zip(cases, runs, strict=True)]
    assert rms[0] != rms[1]


def test_an_input_that_nobody_feeds_is_said_by_name(two_axles: ResolvedLoop, caplog: pytest.LogCaptureFixture) -> None:
    assert "nothing in the loop feeds" not in caplog.text
    front = dict(two_axles.settings.topology.units[0].of_plant)
    mapping = {f"plant.{name}": theirs for name, theirs in front.items()}
    resolve(two_axles.settings, topology=ONE_UNIT, mapping=mapping)
    assert "TwoAxles.fmu: nothing in the loop feeds T_mot_rear; it stays as it starts" in caplog.text


def test_a_loop_that_is_resolved_is_read_again_only_where_its_fmus_are_others(two_axles: ResolvedLoop) -> None:
    assert two_axles.replace(control=False, seed=3).fit is two_axles.fit
    other = two_axles.replace(controller="SpeedWashout")
    assert "fit" not in vars(other)
    assert Topology() == ONE_UNIT
