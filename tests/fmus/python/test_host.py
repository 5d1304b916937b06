"""FMUs in the process of a host: they share nothing, leave nothing behind, and let it end in order."""

import ctypes
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from fmutesting import host
from fmutesting.host import opened
from fmutesting.slow import slow

from driveline.fmus.catalogue import FMUS
from tests import copied_sources

every_fmu = pytest.mark.parametrize("name", slow(FMUS, but=("MotorTorqueLoop",)))

HOST = Path(host.__file__)


def run_host(program, folder):
    """Runs a program in a process of its own, which has the test host as `fmu_host` but none of our packages."""
    (folder / "host").mkdir()
    shutil.copy(HOST, folder / "host" / "fmu_host.py")
    return subprocess.run(
        [sys.executable, "-X", "faulthandler", "-c", program],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(folder / "host")},
        capture_output=True,
        text=True,
    )


def ends_in_order(done):
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout


@pytest.fixture
def other_build(tmp_path):
    """The motor torque loop built from sources in which the motor gives twice the torque."""
    project = copied_sources(tmp_path / "changed", "models", "fmus", "harness")
    model = project / "models" / "motor_torque_loop.py"
    text = model.read_text(encoding="utf-8")
    changed = text.replace(
        "    return Output(\n        T_mot=x.T_mot,", "    return Output(\n        T_mot=2.0 * x.T_mot,"
    )
    assert changed != text
    model.write_text(changed, encoding="utf-8")
    subprocess.run([sys.executable, "build_fmus.py", "MotorTorqueLoop"], cwd=project, check=True)
    return project / "build" / "MotorTorqueLoop.fmu"


def test_two_builds_of_one_fmu_each_run_their_own_code(built, other_build, tmp_path):
    with (
        opened(built / "MotorTorqueLoop.fmu", tmp_path / "one") as one,
        opened(other_build, tmp_path / "other") as other,
    ):
        for host in (one, other):
            host.initialize(T_ref=50.0)
        assert (one.get("T_mot"), other.get("T_mot")) == (50.0, 100.0)


def test_what_the_host_calls_models_fmus_or_pythonfmu_is_not_touched(built, tmp_path):
    for name in ("models", "fmus", "pythonfmu"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "__init__.py").write_text("MINE = True\n")
    program = f"""
import sys
from pathlib import Path
import fmpy, fmu_host
sys.path.insert(0, "")
before = list(sys.path)
import models
with fmu_host.opened({str(built / "MotorTorqueLoop.fmu")!r}, Path("unpacked")) as host:
    host.initialize(T_ref=50.0)
    host.step(0.0, 0.01)
    print(host.get("T_mot"))
assert sys.path == before
import fmus, pythonfmu
assert models.MINE and fmus.MINE and pythonfmu.MINE
"""
    assert ends_in_order(run_host(program, tmp_path)) == "50.0\n"


@every_fmu
def test_the_process_ends_with_0_after_simulating_resetting_freeing_and_loading_again(built, tmp_path, name):
    program = f"""
from pathlib import Path
import fmu_host
for unpacked in ("first", "second", "second"):
    with fmu_host.opened({str(built / f"{name}.fmu")!r}, Path(unpacked)) as host:
        for _ in range(3):
            host.initialize()
            for k in range(20):
                host.step(k * 0.001, 0.001)
            first = host.outputs()
            host.fmu.terminate()
            host.fmu.reset()
print("done")
"""
    assert ends_in_order(run_host(program, tmp_path)) == "done\n"


@every_fmu
def test_the_process_goes_on_and_ends_with_0_after_many_refusals(built, tmp_path, name):
    program = f"""
import gc
from pathlib import Path
import fmu_host
from fmpy.fmi1 import FMICallException
with fmu_host.opened({str(built / f"{name}.fmu")!r}, Path("unpacked")) as host:
    parameter = next(n for n in host.names("parameter") if host.variables[n].type == "Real")
    def refused(call, *arguments, **named):
        try:
            call(*arguments, **named)
        except FMICallException:
            return
        raise AssertionError(call)
    host.initialize()
    for k in range(200):
        refused(host.set, **{{parameter: float("nan")}})
        refused(host.fmu.getReal, [9999])
        refused(host.step, -1.0, 0.001)
        refused(host.fmu.exitInitializationMode)
        refused(host.fmu.deSerializeFMUstate, b"nothing")
        gc.collect(0)
        host.step(k * 0.001, 0.001)
    host.fmu.reset()
    host.initialize()
print("done")
"""
    assert ends_in_order(run_host(program, tmp_path)) == "done\n"


def test_nothing_is_kept_of_freed_instances_but_their_code(built, tmp_path):
    program = f"""
import gc, sys
from pathlib import Path
import fmu_host
def run(times):
    for _ in range(times):
        with fmu_host.opened({str(built / "MotorTorqueLoop.fmu")!r}, Path("unpacked")) as host:
            host.initialize()
            host.step(0.0, 0.001)
            host.fmu.freeFMUstate(host.fmu.getFMUstate())
    gc.collect()
    return sum(type(o).__name__ == "MotorTorqueLoop" for o in gc.get_objects())
run(30)
print(run(30), [name for name in sys.modules if name.split(".")[0] in ("models", "fmus", "pythonfmu")])
"""
    assert ends_in_order(run_host(program, tmp_path)) == "0 []\n"


def test_the_binary_still_has_the_guard_that_is_dismissed(built, tmp_path):
    with opened(built / "MotorTorqueLoop.fmu", tmp_path / "unpacked"):
        folder = tmp_path / "unpacked" / "binaries" / "linux64"
        binary = next(file for file in sorted(folder.iterdir()))  # PythonFMU's, before the entry by its name
        assert ctypes.CDLL(str(binary))["finalizePythonInterpreter"], "repairs.dismiss_guard relies on it"
