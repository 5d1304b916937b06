"""A campaign that was stopped goes on with the same command, and ends with the same bytes as one that was not."""

from collections.abc import Callable
from pathlib import Path
from shutil import copytree
from typing import Any, NamedTuple

import pytest

from driveline.fmus.catalogue import SIGNAL_FAULTS as FMU
from driveline.harness.commands.cli import main
from driveline.harness.design.search import cost_evaluation, pareto_figure
from driveline.harness.design.search.tuning_runs import Run
from driveline.harness.design.uncertainty_box import NOMINAL
from driveline.harness.simulation import many_runs
from driveline.harness.simulation.case_archive import GOES_ON, CaseArchive
from driveline.harness.studies.faults import fault_report
from driveline.harness.studies.robustness import robustness_report
from tests.harness.commands import Capsys

SHORT = (Run("TwoMassDriveline", "tipin15", NOMINAL, 1, 1.0),)


class Kind(NamedTuple):
    """One of the commands that resume: what is given beside the FMUs, where its output goes, and its files."""

    name: str
    given: tuple[str, ...]
    output: str
    files: tuple[str, ...]


ON_ONE = ("--build", "native", "--plant", "TwoMassDriveline")
KINDS = (
    Kind("faults", ("faults", "--cases", "4", "--seed", "2", *ON_ONE), "--output", ("faults.csv",)),
    Kind(
        "robustness",
        ("robustness", "--cases", "2", *ON_ONE, "--controller", "DampingController"),
        "--output",
        ("runs.csv", "draws.csv", "summary.csv"),
    ),
    Kind(
        "design", ("design", "--evaluations", "6", "--build", "native"), "--search", ("evaluations.csv", "gains.toml")
    ),
)


@pytest.fixture(scope="module")
def fmus(native_builder: Any, native: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the native FMUs of the loop and of SignalFaults."""
    folder = tmp_path_factory.mktemp("resuming")
    copytree(native, folder / "native")
    native_builder(FMU, folder)
    return folder


@pytest.fixture
def command(fmus: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[Kind, Path], int]:
    """Runs a command in this process, without figures, into a folder."""
    monkeypatch.setattr(many_runs, "_cores", lambda: 1)
    monkeypatch.setattr(cost_evaluation, "RUNS", SHORT)
    for module, plot in (
        (fault_report, "plot_matrix"),
        (fault_report, "plot_pairs"),
        (pareto_figure, "plot_front"),
        (robustness_report, "plot_distributions"),
        (robustness_report, "plot_draw"),
    ):
        monkeypatch.setattr(module, plot, lambda *args: [])
    return lambda kind, folder: main([*kind.given, "--fmus", str(fmus), kind.output, str(folder), "--quiet"])


@pytest.mark.parametrize("kind", KINDS, ids=[kind.name for kind in KINDS])
@pytest.mark.slow
def test_a_campaign_that_was_stopped_ends_with_the_bytes_of_one_that_was_not(
    command: Callable[[Kind, Path], int], kind: Kind, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capsys
) -> None:
    whole, stopped = tmp_path / "whole", tmp_path / "stopped"
    assert command(kind, whole) == 0
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
    assert command(kind, stopped) == 130
    assert capsys.readouterr().err == f"driveline {kind.name}: stopped; {GOES_ON}\n"
    part = (stopped / kind.files[0]).read_bytes()
    assert part.count(b"\n") == 1 + 3
    (stopped / kind.files[0]).write_bytes(part[:-2])  # as a process that is killed may leave it

    assert command(kind, stopped) == 0
    assert len(asked) == cases + 1  # the torn one was asked for again, and no other
    assert {name: (stopped / name).read_bytes() for name in kind.files} == expected


@pytest.mark.parametrize("kind", KINDS, ids=[kind.name for kind in KINDS])
def test_a_campaign_of_other_settings_is_not_continued(
    command: Callable[[Kind, Path], int], kind: Kind, tmp_path: Path, capsys: Capsys
) -> None:
    words = tuple("1" if word in ("2", "4", "6") else word for word in kind.given)
    few = kind._replace(given=tuple(" ".join(words).replace("--seed 1 ", "").split()))  # it is the usual one
    assert command(few, tmp_path / "results") == 0
    before = (tmp_path / "results" / kind.files[0]).read_bytes()
    assert command(few._replace(given=(*few.given, "--seed", "2")), tmp_path / "results") == 2
    assert f"{kind.files[0]} is of another run (" in capsys.readouterr().err
    assert (tmp_path / "results" / kind.files[0]).read_bytes() == before
