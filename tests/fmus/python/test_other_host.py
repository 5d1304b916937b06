"""The Python build in a host that is not Python, with libpython loaded before it."""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import fmpy
import pytest

from driveline.fmus.native.compiler import host_compiler
from tests.skipping import skipped_if_impossible

SOURCE = Path(__file__).parent / "exit_host.c"
FMI_HEADERS = Path(fmpy.__file__).parent / "c-code"
FLAGS = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-g")
FAULT = 99
"""Exit code for a use of memory that was given back."""

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there LD_PRELOAD loads libpython")


@pytest.fixture(scope="module")
def libpython() -> Path:
    name = sysconfig.get_config_var("INSTSONAME") or ""
    path = Path(sysconfig.get_config_var("LIBDIR")) / name
    found = path if path.is_file() else Path(sysconfig.get_config_var("LIBDIR")) / sysconfig.get_config_var("MULTIARCH")
    found = found if found.is_file() else found / name
    if ".so" not in name or not found.is_file():
        pytest.skip("this Python has no shared library")
    return found


@pytest.fixture(scope="module")
def command(built, tmp_path_factory) -> list[str]:
    """The host with one FMU."""
    folder = tmp_path_factory.mktemp("host")
    fmpy.extract(str(built / "MotorTorqueLoop.fmu"), str(folder))
    with skipped_if_impossible():
        compiler = host_compiler()
    subprocess.run([compiler, *FLAGS, f"-I{FMI_HEADERS}", SOURCE, "-o", folder / "host", "-ldl"], check=True)
    library = folder / "binaries" / "linux64" / "MotorTorqueLoop.so"
    return [str(folder / "host"), str(library), (folder / "resources").as_uri()]


def environment(libpython: Path) -> dict[str, str]:
    return {**os.environ, "LD_PRELOAD": str(libpython), "PYTHONHOME": sys.base_prefix, "PYTHONMALLOC": "malloc"}


def test_it_runs_and_the_process_ends_with_0(command, libpython):
    done = subprocess.run(command, env=environment(libpython), capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "done\n", "")


@pytest.mark.skipif(shutil.which("valgrind") is None, reason="valgrind is not installed")
@pytest.mark.slow
def test_at_the_end_nothing_is_used_that_was_given_back(command, libpython):
    valgrind = ["valgrind", "-q", "--undef-value-errors=no", "--leak-check=no", f"--error-exitcode={FAULT}"]
    done = subprocess.run(
        [*valgrind, *command], env=environment(libpython), capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
