"""Results tell what made them, and are not replaced by those of another run."""

import hashlib
import json
import os
import threading
import time
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from shutil import copytree
from typing import Any
from zipfile import ZipFile

import pytest
from fmpy.util import read_csv

from driveline.harness.commands.cli import main
from driveline.harness.commands.jobs import distinguishing
from driveline.harness.loop.resolved import as_given
from driveline.harness.simulation import provenance
from driveline.harness.simulation.provenance import require_same_run
from fmublocks.origin import ENTRY
from fmuloop import campaign
from fmuloop.interface import Interface
from toolground.atomic_files import alone
from toolground.errors import UserError

RUN = ["simulate", "--manoeuvre", "prbs15", "--step", "0.002", "--quiet"]
NAME = "TwoMassDriveline_prbs15_DampingController"


@pytest.fixture(scope="module")
def made(both_built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the results of a run."""
    folder = tmp_path_factory.mktemp("results")
    gains = folder / "gains.toml"
    gains.write_text("k_d = 2.5\n", encoding="utf-8")
    given = ["--parameters", str(gains), "--set", "plant.J_1=0.07", "--seed", "5"]
    assert main([*RUN, *given, "--fmus", str(both_built), "--output", str(folder)]) == 0
    return folder


def test_a_record_tells_what_made_the_signals(made: Path, both_built: Path) -> None:
    record = json.loads((made / f"{NAME}.json").read_text(encoding="utf-8"))
    assert record["program"].startswith("driveline-damping ")
    assert list(record["files"]) == [f"{NAME}.csv"]
    assert (record["run"]["seed"], record["run"]["parameters"]["motor.seed"]) == (5, 5)
    assert record["run"]["parameters"].items() >= {"plant.J_1": 0.07, "controller.k_d": 2.5}.items()
    plant = both_built / "native" / "TwoMassDriveline.fmu"
    entry = {"file": str(plant), "digest": f"sha256:{hashlib.sha256(plant.read_bytes()).hexdigest()}"}
    assert record["fmus"]["TwoMassDriveline"]["plant"] == entry
    assert list(record["inputs"]) == [str(made / "gains.toml")]


def test_every_real_column_has_its_unit(made: Path, both_built: Path) -> None:
    units = json.loads((made / f"{NAME}.json").read_text(encoding="utf-8"))["units"]
    columns = read_csv(made / f"{NAME}.csv").dtype.names
    assert units.keys() <= set(columns or ())
    assert (units["time"], units["plant.T_gear"], units["controller.T_driver"]) == ("s", "N.m", "N.m")
    reals = [v.name for v in Interface(both_built / "TwoMassDriveline.fmu").of_causality("output") if v.type == "Real"]
    assert all(f"plant.{name}" in units for name in reals)


@pytest.mark.parametrize(
    ("word", "others", "named"),
    [
        ("5", ["6"], "seed: 5 there, 6 here"),
        ("plant.J_1=0.07", ["plant.J_1=0.08"], "parameters plant.J_1: 0.07 there, 0.08 here"),
        ("--set", ["--set", "plant.J_2=0.08", "--set"], "parameters plant.J_2: not set there, 0.08 here"),
        ("0.002", ["0.001"], "step_size: 0.002 there, 0.001 here"),
        ("--set", ["--build", "python", "--set"], "fmus"),
    ],
)
def test_another_run_does_not_replace_it(
    made: Path, both_built: Path, capsys: pytest.CaptureFixture[str], word: str, others: list[str], named: str
) -> None:
    before = {path: path.read_bytes() for path in made.iterdir()}
    words = [*RUN, "--parameters", str(made / "gains.toml"), "--set", "plant.J_1=0.07", "--seed", "5"]
    words[words.index(word) : words.index(word) + 1] = others
    assert main([*words, "--fmus", str(both_built), "--output", str(made)]) == 2
    message = capsys.readouterr().err
    assert f"{made / NAME}.csv is of another run (" in message
    assert named in message
    assert {path: path.read_bytes() for path in made.iterdir()} == before


@pytest.mark.parametrize("ending", [".csv", ".json"])
def test_a_folder_in_the_place_of_a_result_is_found_before_anything_runs(
    both_built: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, ending: str
) -> None:
    monkeypatch.setattr("fmuloop.campaign.run", lambda *_: pytest.fail("it has run"))
    (tmp_path / f"{NAME}{ending}").mkdir()
    assert main([*RUN, "--replace", "--fmus", str(both_built), "--output", str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"driveline simulate: {tmp_path / NAME}{ending} is a folder; a file is needed\n"


def test_the_same_run_replaces_its_own_and_another_if_that_is_wanted(
    both_built: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = [*RUN, "--fmus", str(both_built), "--output", str(tmp_path)]
    assert [main(given), main(given)] == [0, 0]
    assert main([*given, "--seed", "2"]) == 2
    assert main([*given, "--seed", "2", "--replace"]) == 0
    for content in ("", 100_000 * "["):
        (tmp_path / f"{NAME}.json").write_text(content)
        assert main([*given, "--seed", "2"]) == 2
        assert "does not tell of which run it is" in capsys.readouterr().err


@pytest.mark.parametrize("there", [True, False])
@pytest.mark.parametrize("replaced", [["--seed", "2", "--replace"], []])
def test_a_run_that_stops_while_it_writes_leaves_all_as_it_was_and_the_same_command_begins_anew(
    both_built: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    replaced: list[str],
    there: bool,
) -> None:
    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    given = [*RUN, "--fmus", str(both_built), "--output", str(tmp_path)]
    if there:
        assert main(given) == 0
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    with monkeypatch.context() as patched:
        patched.setattr(provenance, "write_record", stopped)
        assert main([*given, *replaced]) == 130
    assert capsys.readouterr().err.endswith(f"stopped; {provenance.BEGINS_ANEW}\n")
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before
    assert main([*given, *replaced]) == 0
    assert {path.suffix for path in tmp_path.iterdir()} == {".csv", ".json"}


def test_a_run_that_stops_before_it_writes_leaves_all_as_it_was(
    made: Path, both_built: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    before = {path: path.read_bytes() for path in made.iterdir()}
    monkeypatch.setattr(campaign, "run", stopped)
    assert main([*RUN, "--replace", "--fmus", str(both_built), "--output", str(made)]) != 0
    assert {path: path.read_bytes() for path in made.iterdir()} == before


def test_of_two_runs_into_one_folder_at_once_the_later_is_refused(
    made: Path, both_built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def run_while_another_ends(*arguments: Any) -> Any:
        copytree(made, tmp_path, dirs_exist_ok=True)
        return run(*arguments)

    run = campaign.run
    monkeypatch.setattr(campaign, "run", run_while_another_ends)
    assert main([*RUN, "--seed", "6", "--fmus", str(both_built), "--output", str(tmp_path)]) == 2
    assert f"{NAME}.csv is of another run" in capsys.readouterr().err
    for path in made.iterdir():
        assert (tmp_path / path.name).read_bytes() == path.read_bytes()


@pytest.mark.skipif(os.name != "posix", reason="folders of Windows cannot be locked")
def test_runs_write_into_a_folder_one_after_the_other(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    done: list[str] = []

    def second() -> None:
        with alone(tmp_path):
            done.append("second")

    waiting = threading.Thread(target=second)
    with alone(tmp_path):
        waiting.start()
        deadline = time.monotonic() + 60.0
        while not caplog.messages and time.monotonic() < deadline:
            time.sleep(0.01)
        done.append("first")
    waiting.join()
    assert done == ["first", "second"]
    assert caplog.messages == [f"another run writes to {tmp_path}; this one waits for it"]
    assert list(tmp_path.iterdir()) == []


def test_a_record_that_is_a_link_stays_one(both_built: Path, tmp_path: Path) -> None:
    given = [*RUN, "--fmus", str(both_built), "--output", str(tmp_path)]
    elsewhere, link = tmp_path / "elsewhere.json", tmp_path / f"{NAME}.json"
    link.symlink_to(elsewhere)
    assert main(given) == 0
    assert main([*given, "--seed", "2", "--replace"]) == 0
    assert link.is_symlink()
    assert json.loads(elsewhere.read_text(encoding="utf-8"))["run"]["seed"] == 2


def test_an_unknown_parameter_is_named_although_there_are_results_of_another_run(
    made: Path, both_built: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*RUN, "--set", "plant.J1=0.07", "--fmus", str(both_built), "--output", str(made)]) == 2
    assert "did you mean J_1" in capsys.readouterr().err


def told_apart(**settings: Any) -> dict[str, Any]:
    return distinguishing(as_given(**settings))


def test_an_fmu_that_was_built_for_another_car_makes_another_run(both_built: Path, tmp_path: Path) -> None:
    folder = tmp_path / "fmus"
    copytree(both_built, folder)
    before = told_apart(folder=folder, build="python")
    assert told_apart(folder=folder, build="python") == before
    path = folder / "TwoMassDriveline.fmu"
    with ZipFile(path) as archive:
        entry = json.loads(archive.read(ENTRY))
    with ZipFile(path, "w") as archive:
        archive.writestr(ENTRY, json.dumps(entry | {"start_values": {"m": 1200.0}}))
    assert told_apart(folder=folder, build="python") != before


def test_an_fmu_of_ones_own_that_was_built_again_makes_another_run(both_built: Path, tmp_path: Path) -> None:
    plant = tmp_path / "mine.fmu"
    plant.write_bytes(b"one")
    before = told_apart(plant=plant, folder=both_built)
    assert told_apart(plant=plant, folder=both_built) == before
    plant.write_bytes(b"another")
    assert told_apart(plant=plant, folder=both_built) != before
    assert before["digests"].keys() == {"plant"}


def test_there_are_no_digests_of_fmus_of_ones_own_where_there_are_none(both_built: Path, tmp_path: Path) -> None:
    same = told_apart(folder=both_built)
    assert "digests" not in same
    (tmp_path / "table.md").touch()
    for before, refused in ((same | {"digests": {}}, False), (same | {"digests": {"plant": "sha256:0"}}, True)):
        (tmp_path / "compare.json").write_text(json.dumps({"run": before}), encoding="utf-8")
        with pytest.raises(UserError, match="digests") if refused else nullcontext():
            require_same_run(tmp_path / "compare.json", same, [tmp_path / "table.md"])


@pytest.mark.parametrize("error", [KeyboardInterrupt, UserError])
def test_a_run_that_comes_to_nothing_leaves_no_folder_of_its_own(error: type[BaseException], tmp_path: Path) -> None:
    here, new = tmp_path / "here", tmp_path / "here" / "new"
    here.mkdir()

    def fail(also: Callable[[], object]) -> None:
        with provenance.recorded(new / "compare.json", {}, {}, []) as made:
            made.begin(new / "runs" / "a.csv")
            also()
            raise error

    with pytest.raises(error):
        fail((new / "runs").mkdir)
    assert list(here.iterdir()) == []
    with pytest.raises(error):
        fail((new / "notes.txt").touch)
    assert [path.name for path in new.iterdir()] == ["notes.txt"]


def test_a_comparison_is_not_replaced_by_another(tmp_path: Path) -> None:
    record, table = tmp_path / "compare.json", tmp_path / "table.md"
    require_same_run(record, {"seed": 1}, [table])
    table.touch()
    with pytest.raises(UserError, match="does not tell"):
        require_same_run(record, {"seed": 1}, [table])
    record.write_text('{"run": {"seed": 1}}', encoding="utf-8")
    require_same_run(record, {"seed": 1}, [table])
    with pytest.raises(UserError, match=r"table\.md is of another run \(seed: 1 there, 2 here\)"):
        require_same_run(record, {"seed": 2}, [table])


@pytest.mark.parametrize(
    ("before", "now", "message"),
    [(2, 1, "van is in that run, not in this one"), (1, 2, "van is in this run, not in that one")],
)
def test_a_whole_car_that_is_new_or_gone_is_named_without_all_that_it_has(
    before: int, now: int, message: str, tmp_path: Path
) -> None:
    cars = {"default": {"C": 117.4}, "van": {"C": 80.0, "m": 2500.0}}
    runs = [dict(list(cars.items())[:number]) for number in (before, now)]
    record, table = tmp_path / "compare.json", tmp_path / "table.md"
    table.touch()
    record.write_text(json.dumps({"run": runs[0]}), encoding="utf-8")
    with pytest.raises(UserError, match=rf"another run \({message}\)"):
        require_same_run(record, runs[1], [table])
