"""Systems that are kept loaded from one run to the next."""

from pathlib import Path
from shutil import copyfile
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from driveline.harness.base.errors import SimulationError, WiringError
from driveline.harness.cosimulation import runs
from driveline.harness.cosimulation.experiment import Experiment
from driveline.harness.cosimulation.runs import MOST_KEPT, kept_loaded, run
from driveline.harness.cosimulation.system import System
from driveline.harness.cosimulation.unpacked_fmu import UnpackingError, unpacked
from tests.foreign import build_relay


@pytest.fixture(scope="module")
def relay(tmp_path_factory):
    return build_relay(tmp_path_factory.mktemp("relay"))


def files(folder):
    return sorted(path.name for path in folder.iterdir())


def gains(system, *values):
    cases = [Experiment(0.01, inputs={"a.u": 1.0}, parameters={"a.gain": value}) for value in values]
    return [run(system, case)["a.y"][-1] for case in cases]


def test_a_system_is_loaded_once(relay, unpacked):
    system = System({"a": relay})
    with kept_loaded():
        assert gains(system, 2.0) == [2.0]
        first = files(unpacked)
        assert len(first) == 1
        assert gains(System({"a": relay}), 3.0, 4.0) == [3.0, 4.0]
        assert files(unpacked) == first
    assert files(unpacked) == []
    assert gains(system, 5.0) == [5.0]
    assert files(unpacked) == []


def test_results_are_those_of_runs_that_load_anew(native):
    system = System({"can": native / "WheelSpeedCan.fmu"})
    inputs = {"can.omega_wheel_L": lambda t: 20.0 + np.sin(9.0 * t), "can.omega_wheel_R": 20.0}
    cases = [
        Experiment(duration, inputs=inputs, parameters={"can.seed": seed})
        for seed, duration in ((1, 0.3), (2, 0.3), (1, 0.2))
    ]
    anew = [run(system, case) for case in cases]
    with kept_loaded():
        kept = [run(system, case) for case in cases]
    for one, other in zip(anew, kept, strict=True):
        np.testing.assert_array_equal(one, other)
    assert (anew[0]["can.omega_2_can"] != anew[1]["can.omega_2_can"]).any()


def test_a_file_that_has_changed_is_loaded_anew(native, tmp_path):
    block = tmp_path / "block.fmu"
    copyfile(native / "MotorTorqueLoop.fmu", block)
    with kept_loaded():
        assert "block.T_mot" in (run(System({"block": block}), Experiment(0.01)).dtype.names or ())
        copyfile(native / "WheelSpeedCan.fmu", block)
        assert "block.counter" in (run(System({"block": block}), Experiment(0.01)).dtype.names or ())
        block.unlink()
        with pytest.raises(WiringError, match="there is no FMU"):
            run(System({"block": block}), Experiment(0.01))


@pytest.mark.slow
def test_only_the_last_ones_are_kept(relay, unpacked):
    systems = [System({f"a{k}": relay}) for k in range(MOST_KEPT + 1)]
    with kept_loaded():
        for system in systems[:-1]:
            run(system, Experiment(0.01))
        first, *others = unpacked.iterdir()
        first = min((first, *others), key=lambda path: path.stat().st_ctime_ns).name
        assert len(others) == MOST_KEPT - 1
        run(systems[0], Experiment(0.01))
        assert first in files(unpacked)
        run(systems[-1], Experiment(0.01))
        assert len(files(unpacked)) == MOST_KEPT
        assert first in files(unpacked)
    assert files(unpacked) == []


def test_a_loop_that_has_ended_with_fatal_is_loaded_anew(relay, unpacked):
    system = System({"a": relay})
    with kept_loaded():
        gains(system, 1.0)
        with pytest.raises(SimulationError, match="with fatal"):
            run(system, Experiment(0.01, inputs={"a.u": 3.0}, parameters={"a.limit": 2.0}))
        assert gains(system, 7.0) == [7.0]
        assert len(files(unpacked)) == 1
    assert files(unpacked) == []


def test_what_is_wrong_is_told_in_every_run(relay):
    with kept_loaded():
        for _ in range(2):
            with pytest.raises(WiringError, match="no parameter gian; did you mean gain"):
                run(System({"a": relay}), Experiment(0.01, parameters={"a.gian": 1.0}))
            gains(System({"a": relay}), 1.0)


def test_an_error_within_unloads_too(relay, unpacked):
    with pytest.raises(SimulationError), kept_loaded():
        run(System({"a": relay}), Experiment(0.01, inputs={"a.u": 3.0}, parameters={"a.limit": 2.0}))
    assert files(unpacked) == []
    assert runs._here.kept is None


def test_an_fmu_is_not_unpacked_to_where_its_uri_would_need_an_encoding(tmp_path):
    folder, car = tmp_path / "Fahrzeuge für Anfänger", cast(Any, SimpleNamespace(path=Path("car.fmu")))
    folder.mkdir()
    with (
        pytest.raises(UnpackingError, match=r"^car\.fmu cannot be unpacked to .*: FMUs need a plain ASCII folder$"),
        unpacked(car, folder),
    ):
        pass
    assert list(folder.iterdir()) == []
