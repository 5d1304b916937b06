"""What GitHub and others read beside the code: citation, workflows, forms of issues."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from driveline.fmus.release import DATE, VERSION
from driveline.harness.commands.cli import parser
from tests import ROOT
from tests.docs.pages import commands

WORKFLOWS = [ROOT / ".github" / "workflows" / "ci.yml", *sorted((ROOT / "examples" / "github").glob("*.yml"))]
FORMS = [path for path in sorted((ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml")) if path.stem != "config"]

KINDS = {
    ROOT / "CITATION.cff": "citation-file-format",
    ROOT / ".github" / "ISSUE_TEMPLATE" / "config.yml": "github-issue-config",
    **dict.fromkeys(WORKFLOWS, "github-workflows"),
    **dict.fromkeys(FORMS, "github-issue-forms"),
}


@pytest.mark.parametrize("path", KINDS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_a_file_keeps_its_schema(path: Path) -> None:
    check = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.{KINDS[path]}", str(path)]
    done = subprocess.run(check, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_the_citation_is_of_this_release() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert (citation["version"], citation["date-released"]) == (VERSION, DATE)


def scripts(workflow: Path) -> list[str]:
    jobs = yaml.safe_load(workflow.read_text(encoding="utf-8"))["jobs"].values()
    return [step["run"] for job in jobs for step in job["steps"] if "run" in step]


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: path.name)
def test_workflows_call_what_there_is(workflow: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M)
    monkeypatch.chdir(tmp_path)
    for script in scripts(workflow):
        assert set(re.findall(r"^make ([a-z-]+)", script, re.M)) <= set(targets)
        for arguments in commands(script):
            parser().parse_args(arguments)


def test_the_workflow_of_the_project_does_what_ci_does() -> None:
    assert "bash .ci/run" in scripts(WORKFLOWS[0])
    assert "make site" in (ROOT / ".ci" / "run").read_text(encoding="utf-8")
