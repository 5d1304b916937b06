"""A result is made again from its record: the same, or what differs is named."""

import json
import re
import sys
from collections.abc import Callable
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

from driveline.harness.commands import again
from driveline.harness.commands.cli import main
from driveline.harness.commands.same_results import different_files, further_cases
from driveline.harness.simulation.case_archive import GOES_ON
from tests.harness.commands import Capsys, answer
from toolground.digest import digest

NAME = "TwoMassDriveline_tipin0_DampingController"


@pytest.fixture(scope="module")
def made(native: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a result."""
    folder = tmp_path_factory.mktemp("again")
    gains = folder / "gains.toml"
    gains.write_text("k_d = 2.5\n", encoding="utf-8")
    words = ["simulate", "--manoeuvre", "tipin0", "--build", "native", "--fmus", str(native.parent)]
    assert main([*words, "--parameters", str(gains), "--output", str(folder / "results"), "--quiet"]) == 0
    return folder


def with_record(made: Path, folder: Path, change: Callable[[Any], object]) -> Path:
    """A copy of the result with another record."""
    path = copytree(made / "results", folder / "copy") / f"{NAME}.json"
    record = json.loads(path.read_text())
    change(record)
    path.write_text(json.dumps(record))
    return path


def test_a_result_is_made_again_and_is_the_same(made: Path, capsys: Capsys) -> None:
    before = {path: path.read_bytes() for path in made.rglob("*.*")}
    record = made / "results" / f"{NAME}.json"
    assert answer(capsys, "again", str(record)) == (0, f"the same, to the last bit: {NAME}.csv\n", "")
    assert {path: path.read_bytes() for path in made.rglob("*.*")} == before


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (lambda record: record["versions"].update(numpy="1.0"), "versions numpy: 1.0 there, "),
        (lambda record: record.update(commit="abc"), "commit: abc there, "),
        (
            lambda record: record["inputs"].update(dict.fromkeys(record["inputs"], "sha256:1")),
            "gains.toml: sha256:1 there",
        ),
        (lambda record: record["fmus"]["TwoMassDriveline"]["plant"].update(digest="2"), "plant: 2 there, "),
        (lambda record: record["run"].update(seed=7), "run seed: 7 there, 1 here"),
    ],
)
def test_what_made_it_is_named_where_it_was_something_else(
    made: Path, tmp_path: Path, capsys: Capsys, change: Callable[[Any], object], named: str
) -> None:
    code, out, _ = answer(capsys, "again", str(with_record(made, tmp_path, change)))
    (line, same) = out.splitlines()
    assert line.startswith("made differently: ")
    assert named in line
    assert (code, same) == (0, f"the same, to the last bit: {NAME}.csv")


def test_of_a_record_that_was_renamed_that_is_said(made: Path, tmp_path: Path, capsys: Capsys) -> None:
    renamed = with_record(made, tmp_path, lambda _: None).rename(tmp_path / "copy" / "mine.json")
    code, out, err = answer(capsys, "again", str(renamed))
    assert (code, out) == (2, "")
    assert f"its command made no mine.json, but {NAME}.json; was it renamed?" in err


@pytest.mark.parametrize("in_record", [False, True])
def test_a_number_that_is_another_one_is_named(made: Path, tmp_path: Path, capsys: Capsys, in_record: bool) -> None:
    record = with_record(made, tmp_path, lambda _: None)
    signals = record.with_suffix(".csv")
    lines = signals.read_text().splitlines()
    lines[9] = lines[9].replace("0.008,", "0.0080000001,", 1)
    signals.write_text("\n".join(lines) + "\n")
    if in_record:
        content = json.loads(record.read_text())
        content["files"][signals.name] = digest(signals)
        record.write_text(json.dumps(content))
    code, out, _ = answer(capsys, "again", str(record))
    assert code == 1
    where = "line 10, time: 0.0080000001 there, 0.008 here"
    told = f"{NAME}.csv: {where}" if in_record else f"{NAME}.csv was changed after it was written: {where}"
    assert out == f"other numbers: {told}\n"


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (lambda record: record.pop("versions"), "is no record of a result, or one of an earlier version"),
        *(
            (lambda record, wrong=wrong: record.update(wrong), "is no record of a result, or one of an earlier version")
            for wrong in (
                {"files": ["x.csv"]},
                {"folder": 7},
                *({"command_line": words} for words in (5, "", "driveline 'x")),
                {"fmus": ["x"]},
            )
        ),
        (lambda record: record.update(command_line="driveline --help"), "makes no result of runs: driveline --help$"),
        (lambda record: record.update(command_line="python mine.py"), "made by another program, .*: python mine.py$"),
        (
            lambda record: record.update(command_line="driveline build x.py"),
            "makes no result of runs: driveline build x.py",
        ),
        (lambda record: record.update(folder="/nowhere"), "made in the folder /nowhere, which is not there"),
    ],
)
def test_what_cannot_be_made_again_is_refused(
    made: Path, tmp_path: Path, capsys: Capsys, change: Callable[[Any], object], named: str
) -> None:
    code, out, err = answer(capsys, "again", str(with_record(made, tmp_path, change)))
    assert (code, out) == (2, "")
    (line,) = err.splitlines()
    assert re.search(named, line)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("", "{0} is a folder; did you mean {0}/NAME.json?"),
        ("NAME.jsn", "there is no file {0}/NAME.jsn; did you mean {0}/NAME.json?"),
        ("NAME.csv", "{0}/NAME.csv is no record of a result: it is not JSON"),
        *([("/proc/kmsg", "/proc/kmsg is no record of a result: it is not JSON")] if sys.platform == "linux" else []),
    ],
)
def test_what_is_no_record_is_refused(made: Path, capsys: Capsys, given: str, expected: str) -> None:
    path = made / "results" / given.replace("NAME", NAME)
    told = expected.format(made / "results").replace("NAME", NAME)
    assert answer(capsys, "again", str(path)) == (2, "", f"driveline again: {told}\n")


def test_what_was_deleted_or_changed_is_named(made: Path, tmp_path: Path, capsys: Capsys) -> None:
    (empty := tmp_path / "empty").touch()
    record = with_record(made, tmp_path, lambda r: r["files"].update({"a.png": "sha256:0", "b.png": digest(empty)}))
    for name in ("a.png", "b.png"):
        (record.parent / name).touch()
    record.with_suffix(".csv").unlink()
    told = f"{NAME}.csv is gone\na.png was changed after it was written\n"
    assert answer(capsys, "again", str(record)) == (1, told, "")


CASES = [f"{plant},Ours,{k},tipin15,0.{k}" for plant in "ab" for k in range(4)]


@pytest.mark.parametrize(
    ("made_again", "different", "more"),
    [
        (CASES, [], []),
        ([CASES[1], CASES[5]], [], ["runs.csv: 6 cases beside those of its command are not compared"]),
        ([CASES[1], f"{CASES[5]}1"], ["runs.csv: line 7, kick: 0.1 there, 0.11 here"], None),
        ([CASES[1], "c,Ours,1,tipin15,0.1"], ["runs.csv: the case c, Ours, 1, tipin15 is not in it"], None),
    ],
)
def test_of_a_campaign_the_cases_of_its_command_are_compared(
    tmp_path: Path, made_again: list[str], different: list[str], more: list[str] | None
) -> None:
    records: list[dict[str, Any]] = []
    for folder, rows in (("there", CASES), ("here", made_again)):
        path = tmp_path / folder / "runs.csv"
        path.parent.mkdir()
        path.write_text("\n".join(["plant,controller,number,manoeuvre,kick", *rows]) + "\n")
        records.append({"run": {"code": "1"}, "files": {path.name: digest(path)}})
    there, here = tmp_path / "there", tmp_path / "here"
    assert list(different_files(records[0], there, records[1], here)) == different
    assert more is None or list(further_cases(records[0], there, here)) == more
    if more:  # what is no campaign has all its rows
        del records[0]["run"]["code"]
        assert list(different_files(records[0], there, records[1], here)) != []


def test_one_that_is_stopped_begins_anew(made: Path, capsys: Capsys, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*_: object) -> int:
        stop = KeyboardInterrupt()
        stop.add_note(GOES_ON)
        raise stop

    monkeypatch.setattr(again, "_run", stopped)
    expected = "driveline again: stopped; nothing of it is left, and the same command begins anew\n"
    assert answer(capsys, "again", str(made / "results" / f"{NAME}.json")) == (130, "", expected)
