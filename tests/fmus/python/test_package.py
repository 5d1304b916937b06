"""What is in an FMU: the same bytes for the same content, and names that nobody else has."""

import os
import subprocess
import sys
import zipfile
from itertools import combinations
from pathlib import Path

import pytest
from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks.python.bundle import bundle, package_name
from fmublocks.python.packaging import build
from fmublocks.release import DATE
from tests import ROOT, copied_sources


def run(arguments, folder, **environment):
    """Runs Python in that folder; its exit code and what it wrote."""
    done = subprocess.run(
        [sys.executable, *map(str, arguments)],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": "", **environment},
        capture_output=True,
        text=True,
    )
    return done.returncode, done.stdout + done.stderr


@pytest.fixture
def copied_project(tmp_path):
    """A copy of the sources that build the FMUs, somewhere else."""
    return copied_sources(tmp_path / "elsewhere", "models", "fmus", "harness")


@pytest.mark.slow
def test_a_rebuild_elsewhere_gives_the_same_bytes(built, copied_project):
    code, message = run(["build_fmus.py", "--build", "python", "--output", "out"], copied_project, PYTHONHASHSEED="7")
    assert code == 0, message
    for name in FMUS:
        assert (copied_project / "out" / f"{name}.fmu").read_bytes() == (built / f"{name}.fmu").read_bytes()


def test_an_unknown_name_is_answered_with_the_nearest():
    code, message = run(["build_fmus.py", "TwoMasDriveline"], ROOT)
    assert code == 2
    assert "unknown FMU TwoMasDriveline; did you mean TwoMassDriveline?" in message


def test_a_vehicle_file_in_the_place_of_an_fmu_is_answered_with_its_option():
    code, message = run(["build_fmus.py", "car.toml"], ROOT)
    assert code == 2
    assert "car.toml is no FMU; a car is given as --vehicle car.toml" in message


def test_the_builder_leaves_no_trace_even_while_the_fmu_is_loaded(built, tmp_path):
    def ours():
        return {name: module for name, module in sys.modules.items() if name.startswith("driveline_")}

    name = "MotorTorqueLoop"
    with opened(built / f"{name}.fmu", tmp_path / "unpacked") as host:
        before = list(sys.path), ours()
        path = build(FMUS[name], tmp_path / "built")
        assert (list(sys.path), ours()) == before
        host.initialize(T_ref=50.0)
        assert host.get("T_mot") == 50.0
    assert list((tmp_path / "built").iterdir()) == [path]
    assert path.read_bytes() == (built / path.name).read_bytes()


@together("name", FMUS)
def test_the_archive_holds_what_runs_and_nothing_else(built, name):
    with zipfile.ZipFile(built / f"{name}.fmu") as archive:
        infos = archive.infolist()
    names = [info.filename for info in infos]
    assert names == sorted(names)
    assert {info.date_time for info in infos} == {(*map(int, DATE.split("-")), 0, 0, 0)}
    assert {info.compress_type for info in infos} == {zipfile.ZIP_DEFLATED}
    assert {f"binaries/linux64/{name}.so", f"binaries/win64/{name}.dll"} <= set(names)
    assert "documentation/externalDependencies.txt" in names
    assert not [n for n in names if "builder" in n or "deploy" in n or "__pycache__" in n or n.endswith(".pyc")]
    carried = {Path(n).stem for n in names if "/models/" in n}
    blocks = {fmu.module.split(".")[-1] for fmu in FMUS.values()}
    assert carried & blocks == {FMUS[name].module.split(".")[-1]}


@together("name", FMUS)
def test_top_level_modules_carry_the_name_of_the_build(built, name):
    with zipfile.ZipFile(built / f"{name}.fmu") as archive:
        resources = {n.split("/")[1] for n in archive.namelist() if n.startswith("resources/")}
    short = FMUS[name].module.split(".")[-1]
    assert all(n == "slavemodule.txt" or n.startswith(f"fmublocks_{short}_") for n in resources)


@together("fmu", [*FMUS.values()])
def test_what_runs_inside_an_fmu_imports_the_standard_library_alone(tmp_path, fmu):
    files = bundle(fmu)
    for place, content in files.items():
        path = tmp_path / "carried" / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    modules = (place.removesuffix(".py").replace("/", ".") for place in files if place.endswith(".py"))
    code, message = run(["-S", "-c", "; ".join(f"import carried.{name}" for name in modules)], tmp_path)
    assert code == 0, message


def test_packages_with_other_files_have_other_names() -> None:
    """Wherever one file ends and the next begins."""
    fmu = FMUS["DampingController"]
    contents = [
        {},
        {"a.py": b"1"},
        {"a.py": b"2"},
        {"b.py": b"1"},
        {"a.py": b"1", "b.py": b""},
        {"a.py": b"1\0b.py\x000\0"},
    ]
    names = [package_name(fmu, content) for content in contents]
    assert all(one != other for one, other in combinations(names, 2))
    assert package_name(fmu, {"b.py": b"2", "a.py": b"1"}) == package_name(fmu, {"a.py": b"1", "b.py": b"2"})
