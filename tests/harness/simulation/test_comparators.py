"""The controllers that ours is compared with are FMUs like any other, and stand in the loop by their names."""

import logging
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmutesting.slow import slow

from driveline.fmus.building.builds import build_fmus
from driveline.fmus.building.parameter_files import read_parameters
from driveline.fmus.catalogue import EVERY, FMUS
from driveline.fmus.names import COMPARATORS
from driveline.harness.commands.cli import main
from driveline.harness.loop import built_fmus, fmu_cache, places
from driveline.harness.loop.places import NATIVE
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.simulation.simulate import simulate
from driveline.models.controller import supervision
from fmublocks.block.declaration import variables
from fmublocks.python.packaging import build
from fmuloop.errors import WiringError
from tests.back_to_back import compare_block, random_inputs
from toolground.collected_warnings import warn_once

TIPIN = MANOEUVRES["tipin15"]

OURS = {v.name: v.start for v in variables(EVERY["DampingController"].block.Parameters)}


@pytest.fixture
def folder(both_built: Path, tmp_path: Path) -> Path:
    """Folder of the FMUs, to which a comparator comes."""
    for path in both_built.rglob("*.fmu"):
        link = tmp_path / path.relative_to(both_built)
        link.parent.mkdir(exist_ok=True)
        link.symlink_to(path)
    return tmp_path


def test_they_are_no_part_of_the_product() -> None:
    assert tuple(EVERY) == (*FMUS, *COMPARATORS)
    assert EVERY.keys() == {name for names in places.PLACES.values() for name in names}


@pytest.mark.parametrize("name", slow(COMPARATORS, but=["NoDamping", "TrueMotion"]))
def test_both_builds_are_alike_and_damp(name: str, folder: Path, native_builder: Any) -> None:
    """One test, since each native build takes a while."""
    native_builder(EVERY[name], folder)
    build(EVERY[name], folder)
    assert max(compare_block(name, random_inputs(EVERY[name].block, 1000), folder)) <= 1e-12
    on, off = (simulate(TIPIN, controller=name, folder=folder, control=control) for control in (True, False))
    assert set(on["controller.status"][10:]) <= {supervision.WITH_WHEEL_SPEED, supervision.WITHOUT_WHEEL_SPEED}
    if name == "NoDamping":
        np.testing.assert_array_equal(on["plant.T_gear"], off["plant.T_gear"])
    else:
        damped, undamped = evaluate(on, TIPIN), evaluate(off, TIPIN)
        assert damped.settling_time < 0.25 * undamped.settling_time
        assert damped.gear_torque_rms < 0.4 * undamped.gear_torque_rms


def test_only_perfect_signals_come_from_the_plant() -> None:
    for name in COMPARATORS:
        fed = {c.target for c in loop(controller=name).connections} - {c.target for c in loop().connections}
        inputs = {v.name for v in variables(EVERY[name].block.Input)} - {v.name for v in variables(supervision.Input)}
        assert fed == {f"controller.{variable}" for variable in inputs}
        assert bool(fed) == (name == "TrueMotion")
    by_path = loop(controller=Path("elsewhere") / "TrueMotion.fmu")
    assert by_path.connections == loop(controller="TrueMotion").connections
    with pytest.raises(WiringError, match="unknown controller PerfectState; it is called TrueMotion now"):
        loop(controller="PerfectState")


def test_what_is_told_is_the_plant_s_motion(folder: Path) -> None:
    build(EVERY["TrueMotion"], folder)
    short = replace(TIPIN, duration=0.1)
    results = simulate(short, controller="TrueMotion", folder=folder, build="python")
    assert results["controller.T_gear_hat"][50:] == pytest.approx(results["plant.T_gear"][50:], abs=1.0)


@pytest.mark.slow
def test_all_fmus_are_those_of_the_product_and_a_comparator_is_built_by_its_name(tmp_path: Path) -> None:
    assert [path.stem for path in build_fmus((), tmp_path, "python")] == list(FMUS)
    assert [path.name for path in build_fmus(["SpeedWashout"], tmp_path, "python")] == ["SpeedWashout.fmu"]


def test_one_that_is_missing_is_built_when_it_runs(
    folder: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(built_fmus, "BUILD", folder)
    monkeypatch.setattr(fmu_cache, "user_cache", lambda: folder / "cache")
    monkeypatch.setitem(MANOEUVRES, "tipin15", replace(TIPIN, duration=0.1))
    warn_once.cache_clear()
    with caplog.at_level(logging.WARNING):
        given = ["--controller", "SpeedWashout", "--build", "python", "--fmus", str(folder), "--quiet"]
        assert main(["simulate", *given, "--output", str(folder / "results")]) == 0
    (made,) = (folder / "cache").rglob("SpeedWashout.fmu")
    assert [text for text in caplog.messages if text.startswith("built")] == [
        f"built, as missing or stale: SpeedWashout, in {made.parent}"
    ]
    assert not (folder / "SpeedWashout.fmu").exists()


def test_what_makes_a_missing_one_elsewhere_is_said(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = ["--controller", "LinearObserver", "--build", "native", "--fmus", str(folder)]
    assert main(["simulate", *given, "--output", str(folder / "results")]) != 0
    made_by = f"`driveline build LinearObserver --build native --output {folder}` makes it"
    assert f"there is no FMU {folder / NATIVE / 'LinearObserver.fmu'}; {made_by}" in capsys.readouterr().err


def test_a_file_of_parameters_sets_theirs(tmp_path: Path) -> None:
    path = tmp_path / "washout.toml"
    path.write_text("k_v = 3.0\nomega_v = 40\nomega_delta = 2.0\nk_delta = 1.5\n")
    assert read_parameters(path) == {"k_v": 3.0, "omega_v": 40.0, "omega_delta": 2.0, "k_delta": 1.5}
