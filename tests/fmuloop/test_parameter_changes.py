"""Tunable parameters that a run changes: when, which, and what is refused."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from docs.studies.bound import bounded
from driveline.harness.commands.cli import main
from driveline.harness.loop.resolved import resolve
from driveline.harness.loop.settings import Settings
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from driveline.harness.studies.margins.loop_analysis import analyse
from fmuloop.compiled_steps import LIBRARY, CompiledSteps
from fmuloop.errors import SimulationError, WiringError
from fmuloop.experiment import Experiment, instants
from fmuloop.loading import loaded
from fmuloop.parameter_changes import Change, changes, initial, parted, require_constant
from fmuloop.runs import run
from fmuloop.steps import interpreted
from fmuloop.system import Scheme, System

TIPIN = replace(MANOEUVRES["tipin15"], duration=1.3)
TIME = instants(1.0, 0.1)


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("controller.k_d", ("controller.k_d", None)),
        ("controller.k_d@2", ("controller.k_d", 2.0)),
        ("controller.k_d@.5", ("controller.k_d", 0.5)),
        ("controller.k_d@1e-3", ("controller.k_d", 0.001)),
        ("controller.'k@soon'", ("controller.'k@soon'", None)),
    ],
)
def test_the_time_stands_behind_the_name(name: str, found: object) -> None:
    assert parted(name) == found


@pytest.mark.parametrize(
    ("instant", "step"),
    [
        ("0", 0),
        ("1e-7", 0),
        ("1.1e-7", 1),
        ("0.3", 3),
        ("0.30000000000000004", 3),
        (" 0.3 ", 3),
        ("0.29", 3),
        ("0.301", 4),
        ("0.9", 9),
    ],
)
def test_a_change_is_made_before_the_first_step_that_begins_at_its_time(instant: str, step: int) -> None:
    assert changes({f"a.gain@{instant}": 2.0}, TIME) == [Change(step, "a", "gain", 2.0)]


@pytest.mark.parametrize("instant", ["0.90001", "1", "-1e-9", "inf"])
def test_a_change_at_which_no_step_begins_any_more_is_refused(instant: str) -> None:
    with pytest.raises(WiringError, match=rf"^a\.gain@{instant}: the steps of the run begin at 0 to 0\.9 s$"):
        changes({f"a.gain@{instant}": 2.0}, TIME)


def test_changes_come_in_the_order_of_time_and_others_are_set_before_the_start() -> None:
    given = {"a.gain@0.5": 3.0, "a.gain": 1.0, "a.gain@0.2": 2.0}
    assert [change.value for change in changes(given, TIME)] == [2.0, 3.0]
    assert initial(given) == {"a.gain": 1.0}


def test_nothing_is_different_before_the_sample_after_the_change_which_may_be_the_start(native: Path) -> None:
    usual = simulate(TIPIN, folder=native.parent, build="native")
    turned = simulate(TIPIN, folder=native.parent, build="native", parameters={"controller.k_d@1.05": 1.5})
    differs = np.flatnonzero(turned["controller.T_ref"] != usual["controller.T_ref"])
    assert usual["time"][differs[0]] == pytest.approx(1.052)
    assert np.array_equal(turned[: differs[0]], usual[: differs[0]])
    assert 20.0 < abs(turned["controller.T_ref"] - usual["controller.T_ref"])[differs[0]] < 25.0
    # The controller is stationary at the start, whatever its gain.
    at_start, given = (
        simulate(TIPIN, folder=native.parent, build="native", parameters={name: 1.5})
        for name in ("controller.k_d@0", "controller.k_d")
    )
    assert np.array_equal(at_start, given)


CHANGES = {
    "controller.k_d@1.03": 1.5,
    "controller.k_d@1.1": 4.0,
    "controller.L_phi@1.1": 0.0,
    "plant.m@0.7": 2000.0,
    "plant.mu@1.02": 0.3,
    "motor.g_T@0.9": 1.05,
    "motor.T_max@1.05": 60.0,
    "can.loss@0.2": 0.5,
}


@pytest.mark.parametrize("scheme", [Scheme.PROPAGATED, Scheme.JACOBI])
def test_compiled_steps_and_those_in_python_make_the_same_changes(both_built: Path, scheme: Scheme) -> None:
    if LIBRARY is None:
        pytest.skip("the project was installed without a C compiler")
    system = System({"plant": both_built / "native" / "TwoMassDriveline.fmu"}, own=frozenset({"plant"}))
    given = {"plant.v_0": 8.0, "plant.T_0": 30.0, "plant.m@0.05": 2000.0, "plant.c_rr@0.02": 0.1, "plant.c_rr@0.2": 0.0}
    results = []
    for make in (CompiledSteps, interpreted):
        with loaded(system, make_steps=make) as running:
            results.append(running.run(Experiment(0.3, inputs={"plant.T_mot": 30.0}, parameters=given, scheme=scheme)))
    assert results[0].tobytes() == results[1].tobytes()
    gained = np.diff(results[0]["plant.v"])
    assert gained[15] > 0.0 > gained[40]
    assert gained[220] > gained[40]


def test_both_builds_and_fmi_3_are_back_to_back_at_zero_with_turned_parameters(both_built, fmi3_as_native) -> None:
    """Sampled and continuous blocks; inputs are held, as the Python build does it."""
    runs = [
        simulate(
            TIPIN, "ValidationVehicle", folder=folder, build=build, parameters=CHANGES, scheme="jacobi", step_size=0.002
        )
        for folder, build in ((both_built, "native"), (both_built, "python"), (fmi3_as_native, "native"))
    ]
    assert runs[0].tobytes() == runs[1].tobytes() == runs[2].tobytes()
    usual = simulate(TIPIN, "ValidationVehicle", folder=both_built, build="native", scheme="jacobi", step_size=0.002)
    assert not np.array_equal(runs[0]["plant.T_gear"], usual["plant.T_gear"])


def test_in_a_process_of_its_own_the_run_is_the_same(native: Path) -> None:
    given, path = {"plant.v_0": 8.0, "plant.m@0.01": 2000.0}, native / "TwoMassDriveline.fmu"
    here, isolated = (
        run(System({"plant": path}, own=own), Experiment(0.03, inputs={"plant.T_mot": 30.0}, parameters=given))
        for own in (frozenset({"plant"}), frozenset[str]())
    )
    assert here.tobytes() == isolated.tobytes()


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        (
            {"controller.C@1": 100.0},
            r"controller\.C@1: in DampingController\.fmu C is fixed .* tunable are L_omega_1, ",
        ),
        ({"controller.kd@1": 1.0}, r"controller\.kd: DampingController\.fmu has no parameter kd; did you mean k_d\?"),
        ({"controller.k_d@later": 1.0}, r"controller\.k_d@later: 'later' is no time in s, as 2\.0 in"),
        ({"controller.k_d@nan": 1.0}, r"controller\.k_d@nan: 'nan' is no time in s"),
        ({"controller.k_d@": 1.0}, r"controller\.k_d@: '' is no time in s"),
        ({"controller.k_d@2@3": 1.0}, r"controller\.k_d@2@3: '2@3' is no time in s"),
        ({"controller.k_d@1": 1.0, "controller.k_d@1.0": 2.0}, r"k_d@1\.0: controller\.k_d is set twice at that step"),
        ({"controller.k_d@1.3": 1.0}, r"controller\.k_d@1\.3: the steps of the run begin at 0 to 1\.299 s"),
        ({"can.seed@1": 2}, r"can\.seed@1: in WheelSpeedCan\.fmu seed is fixed"),
    ],
)
def test_what_cannot_be_changed_is_named_before_the_run(native, parameters, message) -> None:
    with pytest.raises(WiringError, match=message):
        simulate(TIPIN, folder=native.parent, build="native", parameters=parameters)


def test_a_value_that_the_fmu_refuses_in_the_run_ends_it_with_its_message(native: Path) -> None:
    with pytest.raises(SimulationError, match=r"k_d = 201\.0 N\.m\.s/rad is refused; allowed is 0 to 200 N\.m\.s/rad"):
        simulate(TIPIN, folder=native.parent, build="native", parameters={"controller.k_d@1": 201.0})


def test_where_nothing_runs_in_time_a_change_is_refused(native: Path) -> None:
    require_constant({"controller.k_d": 1.0}, "an SSP")
    changing = Settings(folder=native.parent).with_parameters({"controller.k_d@1": 1.0})
    with pytest.raises(WiringError, match=r"controller\.k_d@1: the parameters of a linear loop have one value"):
        analyse({"TwoMassDriveline": resolve(changing)})
    with pytest.raises(WiringError, match=r"controller\.k_d@1: the parameters of a bound have one value"):
        bounded("tipin15", changing)


def test_the_command_takes_it_several_times_and_records_it(native: Path, tmp_path: Path, capsys: Any) -> None:
    command = ["simulate", "--fmus", str(native.parent), "--output", str(tmp_path), "--quiet"]
    assert main([*command, "--set", "controller.k_d@1.0=1.5", "--set", "controller.k_d@1.5=2.0"]) == 0
    record = (tmp_path / "TwoMassDriveline_tipin15_DampingController.json").read_text()
    assert '"controller.k_d@1.0": 1.5' in record
    assert '"controller.k_d@1.5": 2.0' in record
    assert main([*command, "--set", "controller.k_d@1.0=201"]) != 0
    assert "controller.k_d@1.0 = 201: DampingController.fmu takes 0 to 200 N.m.s/rad" in capsys.readouterr().err
