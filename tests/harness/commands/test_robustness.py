"""`driveline robustness`: one command from the draws to the page, resumed in its folder."""

import json
from collections.abc import Callable
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

from driveline.fmus.catalogue import EVERY
from driveline.harness.commands.cli import main
from driveline.harness.simulation import many_runs
from driveline.harness.studies.robustness import robustness_report
from tests.harness.commands import Capsys


@pytest.fixture(scope="module")
def fmus(native_builder: Any, native: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the native FMUs of the loop and of one comparator."""
    folder = tmp_path_factory.mktemp("comparator")
    copytree(native, folder / "native")
    native_builder(EVERY["SpeedWashout"], folder)
    return folder


@pytest.fixture
def robustness(
    fmus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> Callable[..., int]:
    """Runs the command in this process, on the design model, into the folder `results`."""
    monkeypatch.setattr(many_runs, "_cores", lambda: 1)
    if "figures" not in request.node.name:  # figures take seconds
        for plot in ("plot_distributions", "plot_draw"):
            monkeypatch.setattr(robustness_report, plot, lambda *args: [])
    given = ["robustness", "--fmus", str(fmus), "--build", "native", "--plant", "TwoMassDriveline"]
    given += ["--output", str(tmp_path / "results")]
    return lambda *more: main([*given, *more])


OURS, ALL = ("--controller", "DampingController"), ("--controller", "DampingController", "--controller", "SpeedWashout")


@pytest.mark.slow
def test_the_folder_gets_the_runs_and_the_figures(
    robustness: Callable[..., int], tmp_path: Path, capsys: Capsys
) -> None:
    assert robustness("--cases", "2", *ALL) == 0
    folder, message = tmp_path / "results", capsys.readouterr().out
    names = {"runs.csv", "draws.csv", "summary.csv", "robustness.json", "figures"}
    assert {path.name for path in folder.iterdir()} == names
    pictures = {path.stem for path in (folder / "figures").glob("*.png")}
    worst = {f"worst_TwoMassDriveline_{manoeuvre}" for manoeuvre in ("tipin15", "tipout", "launch")}
    assert pictures == {"robustness_TwoMassDriveline"} | worst
    assert (folder / "runs.csv").read_text().count("\n") == 1 + 2 * 2 * 3
    assert (folder / "draws.csv").read_text().splitlines()[
        0
    ] == "number,noise,J_2,C,phi_B,tau,m,delay,g_T,o_T,g_w2,loss"
    record = json.loads((folder / "robustness.json").read_text())
    assert record["files"][:3] == ["runs.csv", "draws.csv", "summary.csv"]
    assert "TwoMassDriveline, DampingController: bounded" in message


def test_runs_of_other_settings_are_not_mixed(robustness: Callable[..., int], tmp_path: Path, capsys: Capsys) -> None:
    runs = tmp_path / "results" / "runs.csv"
    assert robustness("--cases", "1", *OURS, "--quiet") == 0
    first = runs.read_bytes()
    for other in (("--seed", "2"), ("--set", "controller.k_d=1"), ("--controller", "SpeedWashout")):
        assert robustness("--cases", "1", *OURS, *other) == 2
        assert "runs.csv is of another run" in capsys.readouterr().err
    assert runs.read_bytes() == first
    assert robustness("--cases", "1", *OURS, "--seed", "2", "--replace", "--quiet") == 0
    assert runs.read_bytes().count(b"\n") == first.count(b"\n")
    assert runs.read_bytes() != first


def test_one_draw_again_is_the_one_of_the_campaign(
    robustness: Callable[..., int], tmp_path: Path, capsys: Capsys
) -> None:
    assert robustness("--case", "2", *OURS, "--json") == 0
    alone = json.loads(capsys.readouterr().out)
    names = {Path(file).name for file in alone["files"]}
    assert names == {f"draw_2_TwoMassDriveline_{manoeuvre}.csv" for manoeuvre in ("tipin15", "tipout", "launch")}
    assert robustness("--cases", "2", *OURS, "--quiet") == 0
    rows = [line.split(",") for line in (tmp_path / "results" / "runs.csv").read_text().splitlines()]
    for summary in alone["summaries"]:
        row = next(row for row in rows if row[2:4] == ["2", summary["manoeuvre"]])
        assert float(row[rows[0].index("settling_time_s")]) == summary["settling_time_s_50_percent"]


@pytest.mark.slow
def test_a_file_of_parameters_is_for_the_controllers_that_have_them(
    robustness: Callable[..., int], tmp_path: Path, capsys: Capsys
) -> None:
    def settling(*more: str) -> dict[str, float]:
        assert robustness("--case", "1", *ALL, "--json", "--replace", *more) == 0
        found = json.loads(capsys.readouterr().out)["summaries"]
        return {each["controller"]: each["gear_torque_rms_N_m_50_percent"] for each in found[:2]}

    gains = tmp_path / "gains.toml"
    gains.write_text("k_v = 0.5\n")
    before, after = settling(), settling("--parameters", str(gains))
    assert before["DampingController"] == after["DampingController"]
    assert before["SpeedWashout"] != after["SpeedWashout"]
    gains.write_text("k_v = 0.5\nk_d = 2.0\n")
    assert robustness("--case", "1", *ALL, "--parameters", str(gains)) == 2
    assert "DampingController.fmu has no parameter k_v" in capsys.readouterr().err


def test_a_scheduler_that_is_not_there_is_one_line(robustness: Callable[..., int], capsys: Capsys) -> None:
    assert robustness("--cases", "1", *OURS, "--scheduler", "nowhere") == 2
    assert capsys.readouterr().err == (
        "driveline robustness: no Dask scheduler answers at 'nowhere': missing port number in address 'nowhere'\n"
    )
