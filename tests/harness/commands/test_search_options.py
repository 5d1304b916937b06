"""`driveline design --search`: parameters by a search, in a folder."""

from collections.abc import Callable
from pathlib import Path

import pytest

from driveline.fmus.building.parameter_files import read_parameters
from driveline.harness.commands.cli import main
from driveline.harness.design.design import design
from driveline.harness.design.search import cost_evaluation
from driveline.harness.design.search.tuning_runs import Run
from driveline.harness.design.uncertainty_box import NOMINAL
from driveline.harness.simulation import many_runs
from tests.harness.commands import Capsys

SHORT = (Run("TwoMassDriveline", "tipin15", NOMINAL, 1, 1.0),)


@pytest.fixture
def search(native: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """Searches in the folder `search` with one short run, in this process."""
    monkeypatch.setattr(cost_evaluation, "RUNS", SHORT)
    monkeypatch.setattr(many_runs, "_cores", lambda: 1)
    given = ["design", "--search", str(tmp_path / "search"), "--evaluations", "25"]
    return lambda *more: main([*given, "--fmus", str(native.parent), "--build", "native", *more])


@pytest.mark.slow
def test_the_folder_gets_the_gains_the_candidates_and_the_front(
    search: Callable[..., int], tmp_path: Path, capsys: Capsys
) -> None:
    folder = tmp_path / "search"
    assert search() == 0
    files = {path.name for path in folder.iterdir()}
    assert files == {"gains.toml", "evaluations.csv", "search.json", "front.png", "front.pdf"}
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
def test_the_character_chooses_from_the_same_candidates(search: Callable[..., int], tmp_path: Path) -> None:
    outputs = [tmp_path / f"{name}.toml" for name in ("sport", "comfort")]
    for output, character in zip(outputs, ("0", "1"), strict=True):
        assert search("--character", character, "--output", str(output), "--quiet") == 0
    sport, comfort = map(read_parameters, outputs)
    assert sport != comfort
    assert not (tmp_path / "search" / "gains.toml").exists()
    assert (tmp_path / "search" / "evaluations.csv").read_text().count("\n") == 26
    assert search("--character", "0", "--output", str(outputs[1]), "--quiet") == 2


def test_what_has_nothing_to_search_is_refused(search: Callable[..., int], tmp_path: Path, capsys: Capsys) -> None:
    assert search("--controller", "NoDamping") == 2
    assert "NoDamping has no parameter that is searched" in capsys.readouterr().err
    assert not (tmp_path / "search").exists()
