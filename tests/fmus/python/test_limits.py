"""What the binary of PythonFMU 0.7.0 does that nothing in Python can mend, as docs/fmus.md tells it.

A newer PythonFMU that does better fails here: then the page is to be changed.
"""

import ctypes
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import fmpy
import pytest

from tests.fmus.host import opened
from tests.together import together

HOST = Path(__file__).parents[1] / "host.py"
OK, CO_SIMULATION, MODEL_EXCHANGE = 0, 1, 0


def instance_of(host):
    return ctypes.c_void_p(host.fmu.component)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the signal is that of Linux")
@together("call", ["fmi2FreeFMUstate(component, None)", "fmi2DoStep(None, zero, zero, 0)"])
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


@together("kind, guid", [(CO_SIMULATION, "{other}"), (MODEL_EXCHANGE, None)])
def test_kind_and_guid_are_not_looked_at(built, tmp_path, kind, guid):
    fmpy.extract(str(built / "MotorTorqueLoop.fmu"), str(tmp_path))
    with opened(built / "MotorTorqueLoop.fmu", tmp_path) as host:
        binary = ctypes.CDLL(host.fmu.dll._name)
        binary.fmi2Instantiate.restype = ctypes.c_void_p
        asked = (guid or str(host.description.guid)).encode()
        where = (tmp_path / "resources").as_uri().encode()
        made = binary.fmi2Instantiate(b"one", kind, asked, where, ctypes.byref(host._callbacks), 0, 0)
        assert made
        binary.fmi2FreeInstance(ctypes.c_void_p(made))


def test_a_state_is_cut_to_the_buffer_and_refused_when_it_is_read(built, tmp_path):
    with opened(built / "MotorTorqueLoop.fmu", tmp_path) as host:
        state = host.fmu.getFMUstate()
        whole = bytes(host.fmu.serializeFMUstate(state))
        binary = ctypes.CDLL(host.fmu.dll._name)
        room = ctypes.create_string_buffer(len(whole))
        less = len(whole) - 10
        status = binary.fmi2SerializeFMUstate(instance_of(host), state, room, ctypes.c_size_t(less))
        assert (status, room.raw[:less]) == (OK, whole[:less])
        assert "its bytes are damaged" in host.refuses(host.fmu.deSerializeFMUstate, room.raw[:less])
