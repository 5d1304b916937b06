"""What a host must not do, and a host that is no Python program."""

import ctypes
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import fmpy
import pytest
from fmutesting import host
from fmutesting.libpython import with_libpython
from fmutesting.skipping import skipped_if_impossible
from fmutesting.together import together

from fmublocks.native.compiler import host_compiler

HOST = Path(host.__file__)
OK = 0


def instance_of(host):
    return ctypes.c_void_p(host.fmu.component)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the signal is that of Linux")
@together(
    "call",
    [
        "fmi2FreeFMUstate(component, None)",
        "fmi2DoStep(None, zero, zero, 0)",
    ],
)
def test_a_null_pointer_ends_the_host(built, tmp_path, call):
    shutil.copy(HOST, tmp_path / "fmu_host.py")
    program = f"""
import ctypes
from pathlib import Path
import fmu_host
with fmu_host.opened({str(built / "MotorTorqueLoop.fmu")!r}, Path("unpacked")) as host:
    binary = ctypes.CDLL(host.fmu.dll._name)
    component, zero = ctypes.c_void_p(host.fmu.component), ctypes.c_double()
    binary.{call}
"""
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, env=environment, check=False)
    assert done.returncode == -signal.SIGSEGV


def test_a_state_is_cut_to_the_buffer_and_refused_when_it_is_read(motor):
    state = motor.fmu.getFMUstate()
    whole = bytes(motor.fmu.serializeFMUstate(state))
    binary = ctypes.CDLL(motor.fmu.dll._name)
    room = ctypes.create_string_buffer(len(whole))
    less = len(whole) - 10
    status = binary.fmi2SerializeFMUstate(instance_of(motor), state, room, ctypes.c_size_t(less))
    assert (status, room.raw[:less]) == (OK, whole[:less])
    assert "its bytes are damaged" in motor.refuses(motor.fmu.deSerializeFMUstate, room.raw[:less])


SOURCE = Path(__file__).parents[1] / "native" / "host.c"
FMI_HEADERS = Path(fmpy.__file__).parent / "c-code"
FLAGS = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-g")
FAULT = 99
"""Exit code for a use of memory that was given back."""


@pytest.fixture(scope="module")
def command(built, tmp_path_factory) -> list[str]:
    """The host with one FMU."""
    folder = tmp_path_factory.mktemp("host")
    fmpy.extract(str(built / "MotorTorqueLoop.fmu"), str(folder))
    with skipped_if_impossible():
        compiler = host_compiler()
    subprocess.run([compiler, *FLAGS, f"-I{FMI_HEADERS}", SOURCE, "-o", folder / "host", "-ldl"], check=True)
    library = folder / "binaries" / "linux64" / "MotorTorqueLoop.so"
    guid = str(fmpy.read_model_description(str(folder)).guid)
    return [str(folder / "host"), str(library), guid, (folder / "resources").as_uri(), "3", "1e-3", "0", "2"]


@pytest.fixture(scope="module")
def environment() -> dict[str, str]:
    return {**os.environ, **with_libpython(), "PYTHONMALLOC": "malloc"}


def test_it_runs_and_the_process_ends_with_0(command, environment):
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    first, _, second = done.stdout.partition("again\n")
    assert (done.returncode, done.stderr, first) == (0, "", second)
    assert first


@pytest.mark.skipif(shutil.which("valgrind") is None, reason="valgrind is not installed")
@pytest.mark.slow
def test_at_the_end_nothing_is_used_that_was_given_back(command, environment):
    valgrind = ["valgrind", "-q", "--undef-value-errors=no", "--leak-check=no", f"--error-exitcode={FAULT}"]
    done = subprocess.run([*valgrind, *command], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
