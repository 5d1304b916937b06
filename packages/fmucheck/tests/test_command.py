"""`fmucheck` finds nothing in a good FMU, says what is wrong with a bad one, and tells CI by its exit code."""

import json
from pathlib import Path
from typing import Any

import pytest
from fmutesting.blocks import build
from fmutesting.foreign import tampered

from fmucheck.cli import main


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory, native_builder: object) -> Path:
    return build(tmp_path_factory.mktemp("good"), "pi_controller")["PiController"]


def test_a_good_fmu_has_no_findings(good: Path, capsys) -> None:
    assert main([str(good), "--strict"]) == 0
    assert capsys.readouterr().out.endswith("no findings in 1 FMU(s)\n")


@pytest.mark.parametrize(
    ("before", "after", "rule"),
    [
        ('causality="output"', 'causality="outputs"', "schema"),
        ('valueReference="1"', 'valueReference="0"', "aliases"),
        ('modelIdentifier="PiController"', 'modelIdentifier="Other"', "binary"),
    ],
)
def test_a_bad_fmu_has_errors_that_name_the_rule(
    good: Path, tmp_path: Path, capsys, before: str, after: str, rule: str
) -> None:
    bad = tampered(good, tmp_path / "bad.fmu", lambda text: text.replace(before, after))
    assert main([str(bad), "--json", "--quick"]) == 1
    (fmu,) = json.loads(capsys.readouterr().out)["fmus"]
    broken = {verdict["rule"] for verdict in fmu["verdicts"] if verdict["problems"] and verdict["severity"] == "error"}
    assert any(rule in name for name in broken), broken


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (["none.fmu"], "fmucheck: there is no FMU none.fmu"),
        (["none.fmu", "--ignore", "archive-page"], "there is no rule 'archive-page'; did you mean archive-pages"),
        (["none.fmu", "--strikt"], "unknown option --strikt; did you mean --strict?"),
        ([], "FILE.fmu"),
    ],
)
def test_a_mistake_is_answered_in_one_line(capsys, words: list[str], error: str) -> None:
    try:
        code: Any = main(words)
    except SystemExit as end:
        code = end.code
    said = capsys.readouterr().err.splitlines()
    assert code == 2
    assert error in said[0]
