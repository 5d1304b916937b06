"""Neither commands nor functions run a stale build silently."""

from dataclasses import replace
from pathlib import Path
from shutil import copytree

import pytest

from driveline.fmus.origin import is_stale
from driveline.harness.commands.cli import main
from driveline.harness.loop import built_fmus, fmu_cache
from driveline.harness.loop.places import BUILDS, PLANTS
from driveline.harness.loop.settings import Settings, loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmublocks import origin
from fmuloop.many_runs import run_many
from toolground.collected_warnings import warn_once

RUN = ["simulate", "--manoeuvre", "prbs15", "--step", "0.002", "--quiet"]


@pytest.fixture
def stale(both_built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of FMUs of both builds whose sources have changed since; what runs them takes little time."""
    monkeypatch.setitem(MANOEUVRES, "prbs15", replace(MANOEUVRES["prbs15"], duration=0.1))
    folder = tmp_path / "stale"
    copytree(both_built, folder)
    monkeypatch.setattr(origin, "sources_digest", lambda _: "others")
    warn_once.cache_clear()
    return folder


def test_stale_fmus_of_a_folder_are_named_and_not_built(stale, tmp_path, caplog) -> None:
    before = {path: path.read_bytes() for path in stale.rglob("*.fmu")}
    assert main([*RUN, "--fmus", str(stale), "--output", str(tmp_path / "results")]) == 0
    assert [text.count("native/") for text in caplog.messages if text.startswith("stale")] == [4]
    assert "stale, not made from the sources that are installed" in caplog.text
    assert {path: path.read_bytes() for path in stale.rglob("*.fmu")} == before


def test_a_stale_file_is_named(both_built, stale, tmp_path, caplog, monkeypatch) -> None:
    monkeypatch.undo()
    plant = tmp_path / "stale" / "TwoMassDriveline.fmu"
    monkeypatch.setattr(built_fmus, "is_stale", lambda path: path == plant)
    assert main([*RUN, "--fmus", str(both_built), "--plant", str(plant), "--output", str(tmp_path / "results")]) == 0
    assert f"stale, not made from the sources that are installed: {plant}" in caplog.text


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's cache."""
    folder = tmp_path / "cache"
    monkeypatch.setattr(fmu_cache, "user_cache", lambda: folder)
    return folder / "fmus"


@pytest.mark.slow
def test_those_of_the_project_are_built_again_in_the_cache_and_it_is_said_once(
    stale: Path, cache: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(built_fmus, "BUILD", stale)
    before = {path: path.read_bytes() for path in stale.rglob("*.fmu")}
    given = [*RUN, "--build", "python", "--fmus", str(stale), "--output", str(tmp_path / "results")]
    for _ in range(2):
        assert main(given) == 0
    (kept,) = cache.iterdir()
    (message,) = [text for text in caplog.messages if text.startswith("built")]
    assert message.startswith("built, as missing or stale: MotorTorqueLoop, ")
    assert message.endswith(f", in {kept}")
    assert not is_stale(kept / "TwoMassDriveline.fmu")
    assert not (kept / "ValidationVehicle.fmu").exists(), "this run does not need it"
    assert {path: path.read_bytes() for path in stale.rglob("*") if path.is_file()} == before


@pytest.mark.slow
def test_a_run_with_an_fmu_of_the_cache_is_the_same_run(stale, cache, tmp_path, monkeypatch) -> None:
    for module in (built_fmus, fmu_cache):
        monkeypatch.setattr(module, "BUILD", stale)
    given = [*RUN, "--build", "python", "--fmus", str(stale), "--output", str(tmp_path / "results")]
    assert main(given) == 0
    built_fmus.build_missing(folder=stale, build="python")
    assert not is_stale(stale / "TwoMassDriveline.fmu")
    assert main(given) == 0
    assert len(list(cache.iterdir())) == 1


def test_loops_of_both_builds_get_one_folder_of_the_cache(both_built, cache, tmp_path, monkeypatch) -> None:
    """Also if FMUs of one build alone are missing."""
    given = tmp_path / "given"
    copytree(both_built, given)
    (given / "native" / "ValidationVehicle.fmu").unlink()
    before = sorted(given.rglob("*"))
    for module in (built_fmus, fmu_cache):
        monkeypatch.setattr(module, "BUILD", given)
    loops = [Settings(plant, folder=given, build=build) for plant in PLANTS for build in BUILDS]
    made = built_fmus.built_together(loops)
    assert {each.folder for each in made} == set(cache.iterdir())
    assert [(each.plant, each.build) for each in made] == [(each.plant, each.build) for each in loops]
    assert all(path.is_file() for each in made for path in loop(each).instances.values())
    assert sorted(given.rglob("*")) == before


def test_loops_run_native_fmus_only_if_all_have_them_and_one_of_ones_own_is_none_of_them(
    both_built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = tmp_path / "given"
    copytree(both_built, given)
    loops = [Settings(plant, folder=given) for plant in PLANTS]
    assert {each.build for each in built_fmus.built_together(loops)} == {"native"}
    (given / "native" / "ValidationVehicle.fmu").unlink()
    assert {each.build for each in built_fmus.built_together(loops)} == {"python"}
    monkeypatch.setattr(built_fmus, "BUILD", both_built)
    plant = both_built / "mine.fmu"
    assert built_fmus.built(str(plant), folder=both_built, build="python").build == "python"


@pytest.mark.slow
def test_without_a_compiler_the_python_builds_run_and_it_is_said_why(
    stale: Path, cache: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(built_fmus, "BUILD", stale)
    monkeypatch.setenv("CC", "no-such-compiler")
    assert main([*RUN, "--fmus", str(stale), "--output", str(tmp_path / "results")]) == 0
    assert "no native FMUs: there is no C compiler 'no-such-compiler'" in caplog.text
    assert main([*RUN, "--build", "native", "--fmus", str(stale), "--output", str(tmp_path / "results")]) == 2


@pytest.mark.parametrize("workers", [1, 2])
def test_runs_from_python_name_them_once(stale: Path, caplog: pytest.LogCaptureFixture, workers: int) -> None:
    def end(k_d: float) -> float:
        from fmublocks import origin  # in a worker everything is imported anew

        origin.sources_digest = lambda _: "others"
        short = replace(MANOEUVRES["tipin15"], duration=0.01)
        return simulate(short, folder=stale, parameters={"controller.k_d": k_d})["time"][-1]

    run_many(end, [1.0, 2.0, 3.0], workers)
    assert [text.count("native/") for text in caplog.messages if text.startswith("stale")] == [4]
