"""What a run is given from Python: odd values and starts that disagree get a sentence of ours."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.signals import lines
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.simulation.simulate import simulate
from fmuloop import experiment
from fmuloop.errors import WiringError
from toolground.collected_warnings import warn_once

SHORT = replace(MANOEUVRES["tipin15"], duration=0.01)


@pytest.mark.parametrize("value", [None, "1.0", 1j, math.nan, math.inf, [1.0], 10**400])
def test_a_parameter_is_a_finite_number(value: Any) -> None:
    with pytest.raises(WiringError, match=r"plant\.J_1 = .*: a parameter is a finite number"):
        simulate(SHORT, parameters={"plant.J_1": value})


@pytest.mark.parametrize("value", [None, 0.5, "on", 1j])
def test_damping_is_on_or_off(value: Any) -> None:
    with pytest.raises(WiringError, match="it must be True or False"):
        simulate(SHORT, control=value)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"manoeuvre": "tipin0"}, r"manoeuvre = 'tipin0': it must be a Manoeuvre, such as MANOEUVRES\['tipin15'\]"),
        ({"plant": 3}, "plant = 3: it must be the name of a block, or the path of an FMU"),
        ({"controller": []}, r"controller = \[\]: it must be the name of a block"),
        ({"parameters": [1]}, r"parameters = \[1\]: it must be a dictionary"),
        ({"parameters": {1: 2.0}}, r"parameters = \{1: 2.0\}: it must be a dictionary"),
        ({"step_size": "1e-3"}, "step_size = '1e-3': it must be a number of seconds above 0"),
        ({"scheme": 3}, "scheme = 3: it must be a Scheme or its name"),
        ({"scheme": "gauss"}, "unknown scheme gauss; known are"),
        ({"control": np.ones(2)}, "control = .*: it must be True or False"),
        ({"seed": 1.5}, "seed = 1.5: it must be a whole number"),
        ({"folder": 3}, "folder = 3: it must be the path of a folder"),
        ({"build": 3}, "build = 3: it must be 'native', 'python' or None"),
        ({"mapping": ["plant.T_gear=tau"]}, r"mapping = \['plant.T_gear=tau'\]: it must be a dictionary"),
        ({"mapping": {"plant.T_gear": 1}}, "mapping = .*: it must be a dictionary"),
        ({"limits": 1e9}, "limits = 1000000000.0: it must be Limits"),
    ],
)
def test_an_argument_of_another_kind_is_named(built: Path, given: dict[str, Any], message: str) -> None:
    with pytest.raises(WiringError, match=message):
        simulate(**({"manoeuvre": SHORT, "folder": str(built)} | given))


@pytest.mark.parametrize(("step_size", "named"), [(0.002, False), (0.0021, True)])
def test_a_step_longer_than_the_sample_of_the_controller_is_named_once(
    built: Path, caplog: pytest.LogCaptureFixture, step_size: float, named: bool
) -> None:
    warn_once.cache_clear()
    for _ in range(2):
        simulate(SHORT, folder=built, step_size=step_size)
    assert caplog.text.count("is longer than the 2 ms between samples of the damping control") == named


def test_a_step_longer_than_the_run_is_refused_without_another_word(caplog: pytest.LogCaptureFixture) -> None:
    warn_once.cache_clear()
    with pytest.raises(WiringError, match=r"a step of 7 s in a run of 0\.01 s"):
        simulate(SHORT, step_size=7.0)
    assert caplog.text == ""


def test_a_start_that_disagrees_with_the_demand_is_named(built: Path, caplog: pytest.LogCaptureFixture) -> None:
    simulate(SHORT, folder=built, parameters={"plant.T_0": -12.0})
    assert caplog.text == ""
    simulate(SHORT, folder=built, parameters={"plant.T_0": 100.0, "plant.v_0": 0.0})
    assert caplog.text == "", "a car that stands starts without torque, whatever T_0 is"
    simulate(SHORT, folder=built, parameters={"plant.T_0": 100.0})
    assert "plant.T_0 = 100 N.m: the drive train starts with another torque than the -12 N.m" in caplog.text


def test_a_run_for_which_there_is_no_memory_is_refused_before_it_is_allocated(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(experiment, "memory", lambda: 1001.0 * experiment.BYTES_OF_A_ROW)
    assert len(experiment.instants(1.0, 1e-3)) == 1001
    with pytest.raises(MemoryError, match=r"a step of 0\.001 s in a run of 1\.01 s needs about"):
        experiment.instants(1.01, 1e-3)


def test_the_plant_holds_over_a_step_what_its_inputs_are_in_the_middle_of_it(native: Path) -> None:
    """The controller samples at the instants."""
    ramps = replace(SHORT, T_driver=lines((0.0, 0.0), (1.0, 1.0)), T_brake=lines((0.0, 0.0), (1.0, 1e3)))
    results = simulate(ramps, step_size=2e-3, folder=native.parent)
    assert results["controller.T_driver"] == pytest.approx(results["time"], abs=1e-12)
    assert results["plant.T_brake"] == pytest.approx(1e3 * (results["time"] + 1e-3), abs=1e-9)


@pytest.mark.parametrize("plant", ["TwoMassDriveline", "ValidationVehicle"])
def test_how_a_car_comes_to_rest_does_not_depend_on_the_communication_step(native: Path, plant: str) -> None:
    """The teeth go to and fro in the gap until the car is off again: half a step of the brake shows fourfold there.

    Without control: one decision of the controller, whether wheels slip as they stop, falls otherwise: see ROUNDED of
    test_coupling.
    """
    stop = MANOEUVRES["launch_brake"]
    coarse, fine = (
        evaluate(simulate(stop, plant, control=False, step_size=step_size, folder=native.parent), stop)
        for step_size in (1e-3, 5e-4)
    )
    assert coarse.end_swing == pytest.approx(fine.end_swing, rel=0.01)
    assert coarse.gear_torque_rms == pytest.approx(fine.gear_torque_rms, rel=1e-3)


@pytest.mark.parametrize(("i", "said"), [(5.0, True), (9.0, False)])
def test_a_damping_that_does_not_act_is_said_with_its_cause(
    native: Path, caplog: pytest.LogCaptureFixture, i: float, said: bool
) -> None:
    """The gear ratio of the car is another one than the controller knows."""
    where = {"folder": native.parent, "build": "native"}
    simulate(MANOEUVRES["tipin15"], parameters={"plant.i": i}, **where)
    simulate(MANOEUVRES["tipin15"], parameters={"plant.i": 5.0}, control=False, **where)
    lines = [text for text in caplog.messages if "the damping did not act in" in text]
    assert len(lines) == said
    assert all(text.endswith("(status fallback, cause wheel_contradicts)") for text in lines)
