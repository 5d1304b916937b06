"""The digest of what computes: other where a file of it is other, the same whatever else is."""

import sys
from collections.abc import Iterator
from importlib import invalidate_caches
from pathlib import Path

import pytest

from driveline.harness.simulation import code_behind
from driveline.harness.simulation.code_behind import digest_behind, modules_behind
from driveline.harness.studies.faults import fault_campaign

SOURCES = {
    "__init__.py": "",
    "campaign.py": '"""Runs."""\nfrom .judge import limit\ndef judged():\n from . import late\n return late.of(limit)',
    "judge.py": "limit = 2.0  # of torque\n",
    "late.py": "def of(value):\n    return value\n",
    "figure.py": "colour = 1\n",
    "steps.c": "double x = 1.0; /* one */\n",
}


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    folder = tmp_path / "computing"
    folder.mkdir()
    for name, text in SOURCES.items():
        (folder / name).write_text(text)
    monkeypatch.setattr(code_behind, "PACKAGES", ("computing",))
    monkeypatch.syspath_prepend(str(tmp_path))
    invalidate_caches()
    yield folder
    for name in [name for name in sys.modules if name.partition(".")[0] == "computing"]:
        del sys.modules[name]


@pytest.mark.parametrize(
    ("name", "old", "new", "is_other"),
    [
        ("figure.py", "1", "2", False),
        ("campaign.py", "(limit)", "(2 * limit)", True),
        ("judge.py", "2.0", "2.1", True),
        ("late.py", "return value", "return -value", True),
        ("steps.c", "1.0", "1.1", True),
    ],
)
def test_it_is_another_one_where_what_runs_is(package: Path, name: str, old: str, new: str, is_other: bool) -> None:
    before = digest_behind("computing.campaign")
    (package / name).write_text(SOURCES[name].replace(old, new))
    assert (digest_behind("computing.campaign") != before) == is_other


def test_of_a_campaign_it_has_the_judges_and_not_the_figures() -> None:
    rooms = {name.partition(".harness.")[2] for name in modules_behind(fault_campaign.__name__)}
    assert {"studies.faults.judges", "metrics.oscillation", "loop.places"} <= rooms
    assert "fmuloop.master" in modules_behind(fault_campaign.__name__)
    assert not {room for room in rooms if "figure" in room or "report" in room or room.startswith("commands")}
