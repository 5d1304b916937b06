"""Random calls under the address and undefined-behaviour sanitizers, with every warning an error."""

import subprocess
from pathlib import Path

import fmpy
import pytest

from fmus.catalogue import FMUS
from fmus.native.compiler import host_compiler

HOST = Path(__file__).parent / "native_host.c"
WARNINGS = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-ffp-contract=off")
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g", "-O1")
CALLS = 30_000


@pytest.mark.parametrize("name", FMUS)
def test_random_calls_find_no_fault_and_leave_no_memory(native, tmp_path, name):
    fmpy.extract(str(native / f"{name}.fmu"), str(tmp_path))
    sources = tmp_path / "sources"
    files = [HOST, sources / "all.c"]
    compiler = host_compiler()
    assert compiler
    command = [compiler, *WARNINGS, *SANITIZERS, f"-I{sources}", *files, "-o", tmp_path / "host", "-lm"]
    compiled = subprocess.run(command, capture_output=True, text=True, check=False)
    if "cannot find" in compiled.stderr:
        pytest.skip("the compiler has no sanitizers")
    assert compiled.returncode == 0, compiled.stderr
    guid = str(fmpy.read_model_description(str(native / f"{name}.fmu")).guid)
    for seed in ("1", "2"):
        done = subprocess.run(
            [tmp_path / "host", str(guid), seed, str(CALLS)], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
