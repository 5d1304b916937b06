"""Answers on file: whole at any time, continued where a campaign was stopped, and never mixed with those of another."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from driveline.harness.simulation import case_archive
from driveline.harness.simulation.case_archive import GOES_ON, Campaign, CaseArchive, Table, resumable
from toolground.errors import UserError

TABLE: Table[str, float] = Table(
    ["case", "answer"], lambda case, answer: [case, answer], lambda row: (row[0], float(row[1])), "a case and a number"
)
RUN = {"seed": 1, "fmus": {"plant": "sha256:12"}}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "results" / "answers.csv"


@contextmanager
def begun(path: Path, run: dict[str, Any] = RUN, replace: bool = False) -> Iterator[Campaign[str, float]]:
    with resumable(path, TABLE, path.with_suffix(".json"), run, {}, [], replace=replace) as made:
        yield made


def test_an_answer_is_on_file_as_soon_as_it_is_known(path: Path) -> None:
    archive = CaseArchive(path, TABLE)
    archive["a, b"] = 0.1 + 0.2
    assert path.read_bytes() == b'case,answer\n"a, b",0.30000000000000004\n'
    assert CaseArchive(path, TABLE) == {"a, b": 0.1 + 0.2}


@pytest.mark.parametrize("torn", [b"b", b"b,2", b"\xc3", b'"b', b"b,2.5\r"])
def test_a_line_that_was_torn_is_forgotten_and_what_follows_is_whole(path: Path, torn: bytes) -> None:
    CaseArchive(path, TABLE)["a"] = 1.0
    whole = path.read_bytes()
    path.write_bytes(whole + torn)
    archive = CaseArchive(path, TABLE)
    assert archive == {"a": 1.0}
    assert path.read_bytes() == whole
    archive["c"] = 3.0
    assert CaseArchive(path, TABLE) == {"a": 1.0, "c": 3.0}


def test_answers_of_other_code_are_not_gone_on_with(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with begun(path) as made:
        made.archive["a"] = 1.0
    monkeypatch.setattr(case_archive, "digest_behind", lambda module: f"sha256:another of {module}")
    with pytest.raises(UserError, match=rf"code: sha256:\w+ there, sha256:another of {__name__} here\); give"):
        begun(path).__enter__()
    assert CaseArchive(path, TABLE) == {"a": 1.0}
    with begun(path, replace=True) as made:
        assert made.archive == {}


def test_lines_can_be_ordered_by_their_cases(path: Path) -> None:
    archive = CaseArchive(path, TABLE)
    for case, answer in (("c", 3.0), ("a", 1.0), ("b", 2.0)):
        archive[case] = answer
    archive.sort(lambda case: case)
    assert list(archive) == ["a", "b", "c"]
    assert path.read_text() == "case,answer\na,1.0\nb,2.0\nc,3.0\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "its first line must be case,answer"),
        ("other,answer\n", "its first line must be case,answer"),
        ("case,answer\na,1\nb\n", "line 3: it must have a case and a number"),
        ("case,answer\na,x\n", "line 2: it must have a case and a number"),
        (f"case,answer\n{'a' * 200_000},1\n", "line 2: it must have a case and a number"),
        (f"{'a' * 200_000}\n", "its first line must be case,answer"),
    ],
)
def test_a_file_of_something_else_is_refused_and_kept(path: Path, text: str, message: str) -> None:
    path.parent.mkdir()
    path.write_text(text)
    with pytest.raises(UserError, match=message):
        CaseArchive(path, TABLE)
    assert path.read_text() == text


def test_a_campaign_that_was_stopped_goes_on_and_says_so(path: Path) -> None:
    def stopped() -> None:
        with begun(path) as made:
            made.archive["a"] = 1.0
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as stop:
        stopped()
    assert stop.value.__notes__ == [GOES_ON]
    with begun(path) as made:
        assert made.archive == {"a": 1.0}
        made.archive["b"] = 2.0
        made.files.append(path.with_suffix(".md"))
    record = json.loads(path.with_suffix(".json").read_text())
    assert list(record["files"]) == ["answers.csv", "answers.md"]
    assert record["run"].items() >= RUN.items()
    with begun(path) as made:
        assert made.archive == {"a": 1.0, "b": 2.0}


def test_one_that_was_killed_before_its_first_answer_goes_on_too(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(case_archive, "CaseArchive", lambda *_: exit(1))
        with pytest.raises(SystemExit), begun(path):
            pass
    assert not path.exists()
    with begun(path) as made:
        assert made.archive == {}


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (RUN | {"seed": 2}, "seed: 1 there, 2 here"),
        (RUN | {"fmus": {"plant": "sha256:34"}}, "fmus plant: sha256:12 there, sha256:34 here"),
    ],
)
def test_another_campaign_is_refused_and_replaced_only_if_asked(
    path: Path, other: dict[str, Any], message: str
) -> None:
    with begun(path) as made:
        made.archive["a"] = 1.0
    before = {file.name: file.read_bytes() for file in path.parent.iterdir()}
    with pytest.raises(UserError, match=rf"answers\.csv is of another run \({message}\)"), begun(path, other):
        pass
    assert {file.name: file.read_bytes() for file in path.parent.iterdir()} == before
    with begun(path, other, replace=True) as made:
        assert made.archive == {}


def test_answers_of_another_version_are_not_continued(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with begun(path) as made:
        made.archive["a"] = 1.0
    monkeypatch.setattr(case_archive, "version", lambda name: "9.9" if name == "numpy" else "1.0")
    with pytest.raises(UserError, match=r"is of another run \(versions .* there, .* here\)"), begun(path):
        pass


def test_a_folder_in_the_place_of_the_archive_is_named(path: Path) -> None:
    path.mkdir(parents=True)
    with pytest.raises(UserError, match=r"answers\.csv is a folder"), begun(path):
        pass
