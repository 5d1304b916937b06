"""Robustness, faults and the search for gains: what they write, and that they go on where they were stopped."""

import json
from collections.abc import Callable
from pathlib import Path
from shutil import copytree
from typing import Any, NamedTuple

import pytest

from driveline.fmus.building.parameter_files import read_parameters
from driveline.fmus.catalogue import EVERY, SIGNAL_FAULTS
from driveline.harness.commands.cli import main
from driveline.harness.design.design import design
from driveline.harness.design.search import cost_evaluation, pareto_figure
from driveline.harness.design.search.tuning_runs import Run
from driveline.harness.design.uncertainty_box import NOMINAL
from driveline.harness.simulation.case_archive import GOES_ON, CaseArchive
from driveline.harness.studies.faults import fault_report
from driveline.harness.studies.robustness import robustness_report
from fmuloop import many_runs
from tests.harness.commands import Capsys

SHORT = (Run("TwoMassDriveline", "tipin15", NOMINAL, 1, 1.0),)
FIGURES = (
    (fault_report, "plot_matrix"),
    (fault_report, "plot_pairs"),
    (pareto_figure, "plot_front"),
    (robustness_report, "plot_distributions"),
    (robustness_report, "plot_draw"),
)

Command = Callable[..., int]


class Kind(NamedTuple):
    """One of the commands that resume: what it is given, where its output goes, its files, and what it prints."""

    name: str
    given: tuple[str, ...]
    output: str
    files: tuple[str, ...]
    says: str


PLANT = ("--plant", "TwoMassDriveline")
OURS, ALL = ("--controller", "DampingController"), ("--controller", "DampingController", "--controller", "SpeedWashout")
KINDS = (
    Kind("faults", ("--cases", "4", "--seed", "2", *PLANT), "--output", ("faults.csv",), "clean"),
    Kind(
        "robustness", ("--cases", "2", *PLANT, *OURS), "--output", ("runs.csv", "draws.csv", "summary.csv"), "bounded"
    ),
    Kind("design", ("--evaluations", "6"), "--search", ("evaluations.csv", "gains.toml"), "start    1.000"),
)
every_kind = pytest.mark.parametrize("kind", KINDS, ids=[kind.name for kind in KINDS])


@pytest.fixture(scope="module")
def fmus(native_builder: Any, native: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the native FMUs of the loop, of SignalFaults and of one comparator."""
    folder = tmp_path_factory.mktemp("campaigns")
    copytree(native, folder / "native")
    for fmu in (SIGNAL_FAULTS, EVERY["SpeedWashout"]):
        native_builder(fmu, folder)
    return folder


@pytest.fixture
def command(fmus: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Command:
    """Runs a command in this process, a search with one short run; without figures, which take seconds."""
    monkeypatch.setattr(many_runs, "cores", lambda: 1)
    monkeypatch.setattr(cost_evaluation, "RUNS", SHORT)
    for module, plot in FIGURES if "figures" not in request.node.name else ():
        monkeypatch.setattr(module, plot, lambda *args: [])
    return lambda name, *given: main([name, *given, "--fmus", str(fmus), "--build", "native"])


@pytest.fixture
def robustness(command: Command, tmp_path: Path) -> Command:
    """Of the design model, into the folder `results`."""
    return lambda *more: command("robustness", *PLANT, "--output", str(tmp_path / "results"), *more)


@pytest.fixture
def search(command: Command, tmp_path: Path) -> Command:
    """Among 25 candidates, in the folder `search`."""
    return lambda *more: command("design", "--search", str(tmp_path / "search"), "--evaluations", "25", *more)


@every_kind
@pytest.mark.slow
def test_a_campaign_that_was_stopped_ends_with_the_bytes_of_one_that_was_not(
    command: Command, kind: Kind, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capsys
) -> None:
    def run(folder: Path) -> int:
        return command(kind.name, *kind.given, kind.output, str(folder), "--quiet")

    whole, stopped = tmp_path / "whole", tmp_path / "stopped"
    assert run(whole) == 0
    expected = {name: (whole / name).read_bytes() for name in kind.files}
    cases = expected[kind.files[0]].count(b"\n") - 1
    assert cases >= 4

    asked: list[object] = []
    add = CaseArchive.__setitem__

    def add_and_stop(archive: Any, case: Any, answer: Any) -> None:
        add(archive, case, answer)
        asked.append(case)
        if len(asked) == 3:
            raise KeyboardInterrupt

    monkeypatch.setattr(CaseArchive, "__setitem__", add_and_stop)
    capsys.readouterr()
    assert run(stopped) == 130
    assert capsys.readouterr().err == f"driveline {kind.name}: stopped; {GOES_ON}\n"
    part = (stopped / kind.files[0]).read_bytes()
    assert part.count(b"\n") == 1 + 3
    (stopped / kind.files[0]).write_bytes(part[:-2])  # as a process that is killed may leave it

    assert run(stopped) == 0
    assert len(asked) == cases + 1  # the torn one was asked for again, and no other
    assert {name: (stopped / name).read_bytes() for name in kind.files} == expected


@pytest.mark.parametrize("kind", [KINDS[0], *(pytest.param(kind, marks=pytest.mark.slow) for kind in KINDS[1:])])
def test_a_campaign_of_other_settings_is_not_continued_unless_it_is_to_be_replaced(
    command: Command, kind: Kind, tmp_path: Path, capsys: Capsys
) -> None:
    few = " ".join(kind.given).replace("--seed 2 ", "").translate(str.maketrans("246", "111")).split()
    given = [kind.name, *few, kind.output, str(tmp_path), "--quiet"]
    assert command(*given) == 0
    before = (tmp_path / kind.files[0]).read_bytes()
    others = [["--seed", "2"]]
    if kind.name == "robustness":
        others += [["--set", "controller.k_d=1"], ["--controller", "SpeedWashout"]]
    for other in others:
        assert command(*given, *other) == 2
        assert f"{kind.files[0]} is of another run (" in capsys.readouterr().err
    assert (tmp_path / kind.files[0]).read_bytes() == before
    assert command(*given[:-1], "--seed", "2", "--replace") == 0
    assert kind.says in capsys.readouterr().out
    after = (tmp_path / kind.files[0]).read_bytes()
    assert after.count(b"\n") == before.count(b"\n")
    assert (after == before) == (kind.name == "design"), "its only candidate is the start"


@pytest.mark.slow
def test_the_folder_of_robustness_gets_the_runs_and_the_figures(robustness, tmp_path, capsys) -> None:
    assert robustness("--cases", "2", *ALL) == 0
    folder, message = tmp_path / "results", capsys.readouterr().out
    names = {"runs.csv", "draws.csv", "summary.csv", "robustness.json", "figures"}
    assert {path.name for path in folder.iterdir()} == names
    pictures = {path.stem for path in (folder / "figures").glob("*.png")}
    worst = {f"worst_TwoMassDriveline_{manoeuvre}" for manoeuvre in ("tipin15", "tipout", "launch")}
    assert pictures == {"robustness_TwoMassDriveline"} | worst
    assert (folder / "runs.csv").read_text().count("\n") == 1 + 2 * 2 * 3
    assert (folder / "draws.csv").read_text().startswith("number,noise,J_2,C,phi_B,tau,m,delay,g_T,o_T,g_w2,loss\n")
    record = json.loads((folder / "robustness.json").read_text())
    assert list(record["files"])[:3] == ["runs.csv", "draws.csv", "summary.csv"]
    assert "TwoMassDriveline, DampingController: bounded" in message


def test_one_draw_again_is_the_one_of_the_campaign(robustness: Command, tmp_path: Path, capsys: Capsys) -> None:
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
def test_a_file_of_parameters_is_for_the_controllers_that_have_them(robustness, tmp_path, capsys) -> None:
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


def test_a_scheduler_that_is_not_there_is_one_line(robustness: Command, capsys: Capsys) -> None:
    assert robustness("--cases", "1", *OURS, "--scheduler", "nowhere") == 2
    assert capsys.readouterr().err == (
        "driveline robustness: no Dask scheduler answers at 'nowhere': missing port number in address 'nowhere'\n"
    )


@pytest.mark.slow
def test_the_folder_of_a_search_gets_gains_candidates_and_figures(search, tmp_path, capsys) -> None:
    folder = tmp_path / "search"
    assert search() == 0
    files = {path.name for path in folder.iterdir()}
    assert files == {"gains.toml", "evaluations.csv", "search.json", "front.png"}
    gains = read_parameters(folder / "gains.toml")
    assert gains.keys() == design().keys()
    assert gains["k_d"] != pytest.approx(design()["k_d"], rel=1e-3)
    text = (folder / "gains.toml").read_text()
    assert "Character 0.5 (0 sport, 1 comfort), the best of 25 candidates, seed 1. Cost 0." in text
    message = capsys.readouterr().out
    assert "start    1.000" in message
    assert f"gains:      {folder / 'gains.toml'} (character 0.5)" in message

    before = {path.name: path.read_bytes() for path in folder.iterdir() if path.name != "search.json"}
    assert search("--quiet") == 0
    assert capsys.readouterr().out == ""
    assert {name: (folder / name).read_bytes() for name in before} == before


@pytest.mark.slow
def test_the_character_chooses_from_the_same_candidates(search: Command, tmp_path: Path) -> None:
    outputs = [tmp_path / f"{name}.toml" for name in ("sport", "comfort")]
    for output, character in zip(outputs, ("0", "1"), strict=True):
        assert search("--character", character, "--output", str(output), "--quiet") == 0
    sport, comfort = map(read_parameters, outputs)
    assert sport != comfort
    assert not (tmp_path / "search" / "gains.toml").exists()
    assert (tmp_path / "search" / "evaluations.csv").read_text().count("\n") == 26
    assert search("--character", "0", "--output", str(outputs[1]), "--quiet") == 2


def test_what_has_nothing_to_search_is_refused(search: Command, tmp_path: Path, capsys: Capsys) -> None:
    assert search("--controller", "NoDamping") == 2
    assert "NoDamping has no parameter that is searched" in capsys.readouterr().err
    assert not (tmp_path / "search").exists()
