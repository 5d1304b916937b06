"""What is in a native FMU, and what its binary asks of a machine."""

import os
import re
import shutil
import subprocess
import sys
import zipfile

import fmpy
import pytest
from fmpy.build import build_platform_binary
from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.building.builds import build_fmus
from driveline.fmus.catalogue import FMUS
from fmublocks.builds import NotPossible
from fmublocks.native import compiler
from tests import ROOT

LARGEST = 150 * 1024
every_fmu = together("name", FMUS)
on_linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into an ELF file")


def unpacked(native, tmp_path, name):
    fmpy.extract(str(native / f"{name}.fmu"), str(tmp_path))
    return tmp_path


def symbols(binary, *options):
    done = subprocess.run(["nm", "-D", *options, str(binary)], capture_output=True, text=True, check=True)
    return [line.split()[-1] for line in done.stdout.splitlines()]


@every_fmu
def test_it_is_small(native, name):
    assert (native / f"{name}.fmu").stat().st_size < LARGEST


@on_linux
@every_fmu
def test_it_exports_fmi_functions_and_the_place_of_an_instance_alone_and_asks_for_an_old_libc(native, tmp_path, name):
    binary = unpacked(native, tmp_path, name) / "binaries" / fmpy.platform / f"{name}.so"
    exported = symbols(binary, "--defined-only")
    assert [symbol for symbol in exported if not symbol.startswith("fmi2")] == [f"{name}_instance"]
    assert {"fmi2Instantiate", "fmi2DoStep", "fmi2GetRealOutputDerivatives", "fmi2GetStringStatus"} <= set(exported)
    asked = subprocess.run(["objdump", "-p", str(binary)], capture_output=True, text=True, check=True).stdout
    assert set(re.findall(r"NEEDED\s+(\S+)", asked)) <= {"libc.so.6", "libm.so.6"}
    versions = {tuple(map(int, v.split("."))) for v in re.findall(r"GLIBC_([\d.]+)", asked)}
    assert max(versions) <= (2, 17)


@every_fmu
def test_it_needs_nothing_besides_itself(native, name):
    with zipfile.ZipFile(native / f"{name}.fmu") as archive:
        assert not [entry for entry in archive.namelist() if "externalDependencies" in entry]


@pytest.mark.usefixtures("uncached_compiler")
@every_fmu
@pytest.mark.slow
def test_a_rebuild_gives_the_same_bytes(native, native_builder, tmp_path, name):
    assert native_builder(FMUS[name], tmp_path).read_bytes() == (native / f"{name}.fmu").read_bytes()


@pytest.mark.usefixtures("uncached_compiler")
@pytest.mark.skipif(shutil.which("cmake") is None, reason="there is no cmake")
@pytest.mark.slow
def test_its_sources_compile_with_fmpy(native, tmp_path):
    name = "DampingController"
    folder = unpacked(native, tmp_path, name)
    shutil.rmtree(folder / "binaries")
    build_platform_binary(folder)
    with opened(native / f"{name}.fmu", folder) as host:
        host.initialize()
        host.step(0.0, 0.01)
        assert all(abs(value) < 1e6 for value in host.outputs().values())


@together(
    "said, code, shown",
    [
        ("", 1, "nothing"),
        (
            "In file included from all.c:\nall.c:2:1: error: no such thing\n1 error",
            1,
            "all.c:2:1: error: no such thing",
        ),
        ("", 0, "it ended well and made no MotorTorqueLoop.so"),
    ],
)
@pytest.mark.skipif(sys.platform != "linux", reason="a shell and the name of the library")
def test_a_compiler_that_refuses_is_named_in_one_line_with_what_it_says(monkeypatch, tmp_path, said, code, shown):
    broken = tmp_path / "broken"
    broken.write_text(f"#!/bin/sh\ncat >&2 <<'END'\n{said}\nEND\nexit {code}\n", encoding="utf-8")
    broken.chmod(0o755)
    monkeypatch.setenv("CC", str(broken))
    with pytest.raises(NotPossible) as refused:
        list(build_fmus(["MotorTorqueLoop"], tmp_path / "built", "native"))
    assert str(refused.value) == (
        f"the C compiler {broken} does not compile MotorTorqueLoop; it says: {shown} "
        "(the environment variable CC can name another, `--build python` makes FMUs of the project without one)"
    )
    assert not list(tmp_path.rglob("*.fmu"))


def test_where_there_is_no_compiler_that_of_zig_is_taken(monkeypatch):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr("fmublocks.native.compiler.shutil.which", lambda name: None)
    monkeypatch.setattr("fmublocks.native.compiler.find_spec", lambda name: object())
    assert compiler.host_command() == [sys.executable, "-m", "ziglang", "cc"]
    monkeypatch.setattr("fmublocks.native.compiler.find_spec", lambda name: None)
    with pytest.raises(compiler.CompilerError, match=r"no C compiler 'cc' .*`pip install ziglang` has one"):
        compiler.host_command()


@pytest.mark.slow
def test_both_builds_are_made_where_they_can_be(native_builder, tmp_path):
    done = subprocess.run(
        [sys.executable, "build_fmus.py", "MotorTorqueLoop", "--output", str(tmp_path)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    made = [line.split()[0] for line in done.stdout.splitlines()]
    assert made == [
        os.path.join(tmp_path, "MotorTorqueLoop.fmu"),
        os.path.join(tmp_path, "native", "MotorTorqueLoop.fmu"),
    ]
