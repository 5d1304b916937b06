"""What GitHub and others read beside the code: citation, workflows, forms of issues."""

import re
import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest
import yaml

from driveline.harness.commands.cli import parser
from fmublocks.release import DATE
from tests import ROOT
from tests.docs.pages import commands

WORKFLOWS = [*sorted((ROOT / ".github" / "workflows").glob("*.yml")), *(ROOT / "examples" / "github").glob("*.yml")]
IN_PAGE = re.findall(r"^```yaml\n(.*?)^```", (ROOT / "docs" / "fmus.md").read_text(encoding="utf-8"), re.M | re.S)[0]
"""That can be copied from the page on FMUs."""

FORMS = [path for path in (ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml") if path.stem != "config"]

SCHEMAS = {
    "citation-file-format": [ROOT / "CITATION.cff"],
    "github-issue-config": [ROOT / ".github" / "ISSUE_TEMPLATE" / "config.yml"],
    "github-workflows": WORKFLOWS,
    "github-issue-forms": FORMS,
}


def test_files_and_the_workflow_of_a_page_keep_their_schemas(tmp_path: Path) -> None:
    (tmp_path / "check.yml").write_text(IN_PAGE, encoding="utf-8")
    for schema, paths in [*SCHEMAS.items(), ("github-workflows", [tmp_path / "check.yml"])]:
        check = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.{schema}", *map(str, paths)]
        done = subprocess.run(check, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout


def test_the_citation_and_the_changelog_are_of_this_release() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    release = version("driveline-damping")
    assert (citation["version"], citation["date-released"]) == (release, DATE)
    headings = re.findall(r"^## (.+)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.M)
    assert next(heading for heading in headings if heading != "Unreleased") == f"{release} ({DATE})"


def test_all_packages_are_of_this_release_and_need_each_other_of_it() -> None:
    folders = [path for path in (ROOT / "packages").glob("*") if not path.name.startswith(".")]
    for file in (ROOT / "pyproject.toml", *(folder / "pyproject.toml" for folder in folders)):
        project = tomllib.loads(file.read_text(encoding="utf-8"))["project"]
        assert project["version"] == version("driveline-damping"), file
        for needed in project["dependencies"]:
            name, _, release = needed.partition("==")
            if name.partition("[")[0] in {folder.name for folder in folders}:
                assert release == project["version"], (file, needed)


def test_workflows_call_what_there_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M)
    monkeypatch.chdir(tmp_path)
    for workflow in (*(each.read_text(encoding="utf-8") for each in WORKFLOWS), IN_PAGE):
        jobs = yaml.safe_load(workflow)["jobs"].values()
        for script in (step["run"] for job in jobs for step in job["steps"] if "run" in step):
            assert set(re.findall(r"^make ([a-z-]+)", script, re.M)) <= set(targets), workflow
            for arguments in commands(script):
                parser().parse_args(arguments)
