"""The notebooks run from the first cell to the last, show what they say, and are kept without outputs.

`python -m tests.test_notebooks` brings them into the form in which they are kept: nothing of the editor or kernel that
saved them.
"""

import json
from pathlib import Path
from shutil import copy, copytree, ignore_patterns
from textwrap import dedent
from typing import Any

import pytest

from tests import ROOT

NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))

METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}

SHOWN = {
    "first_run": """
        assert signals.attrs["units"]["plant.T_gear"] == "N.m"
        worth = driveline.frame(runs).settling_time
        assert worth["with damping"] < 0.5 * worth["without damping"]
        assert Path("results/first_run.csv").read_text().startswith("time [s],")
        """,
    "your_vehicle": """
        found = driveline.frame({name: driveline.evaluate(results, tipin) for name, results in runs.items()})
        assert list(found.overshoot) == sorted(found.overshoot, reverse=True)
        assert found.settling_time["with damping"] < 0.2 < 1.0 < found.settling_time["without damping"]
        assert gains["k_d"] > 3.0
        """,
    "your_controller": """
        overshoot = worth.overshoot["tipin15"]
        assert overshoot["ours"] < 0.5 * overshoot["yours"] < overshoot["yours"] < 0.8 * overshoot["none"]
        assert 0.5 < k_b < 4.0, "the best gain is inside"
        """,
    "sweep": """
        assert len(found) == 1000 and found.settling_time.notna().all()
        assert found.index.names == ["k_d", "phi_B"]
        assert 1.5 < worst.idxmin() < 4.5 and worst.min() < 0.1 * worst[0.0]
        assert len(pd.read_csv("results/sweep.csv")) == 1000
        """,
    "from_recording": """
        assert abs(vehicle["phi_B"] / CAR["plant.phi_B"] - 1.0) < 0.15
        overshoot = worth.overshoot.unstack()
        assert (overshoot.redesigned < 0.8 * overshoot.before).all() and (overshoot.before < overshoot.none).all()
        assert {"C", "phi_B", "tau"} <= driveline.read_vehicle(Path("results/car.toml")).keys()
        assert driveline.read_parameters(Path("results/gains.toml"))["k_d"] > 2.0
        """,
}
"""What must hold at the end of each notebook, by the names of its cells."""

IMPORTS = """
    import pandas as pd
    from pathlib import Path
    """

FIGURES = {"first_run": 1, "your_vehicle": 1, "your_controller": 2, "sweep": 2, "from_recording": 2}


def cleared(path: Path) -> str:
    """The text of a notebook in the form in which it is kept."""
    notebook = json.loads(path.read_text(encoding="utf-8"))
    for number, cell in enumerate(notebook["cells"], 1):
        cell |= {"id": f"{path.stem.replace('_', '-')}-{number}", "metadata": {}}
        if cell["cell_type"] == "code":
            cell |= {"outputs": [], "execution_count": None}
    notebook |= {"metadata": METADATA, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(notebook, indent=1, sort_keys=True, ensure_ascii=False) + "\n"


def test_notebooks_are_kept_without_outputs_and_in_one_form() -> None:
    assert {path.stem for path in NOTEBOOKS} == SHOWN.keys() == FIGURES.keys()
    unclear = [path.name for path in NOTEBOOKS if path.read_text(encoding="utf-8") != cleared(path)]
    assert unclear == [], "python -m tests.test_notebooks clears them"


@pytest.fixture
def folder_of_user(native: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of a user who has installed the packages and built the FMUs there."""
    for package in ("models", "fmus", "harness"):
        copytree(ROOT / package, tmp_path / "installed/driveline" / package, ignore=ignore_patterns("__pycache__"))
    for path in (ROOT / "driveline").glob("*.py*"):
        copy(path, tmp_path / "installed/driveline")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "installed"))
    copytree(native, tmp_path / "desk" / "build" / native.name)
    return tmp_path / "desk"


def executed(path: Path, last_cell: str, folder: Path) -> tuple[list[Any], list[dict[str, str]]]:
    """All outputs of a notebook and of one more cell, and all that was displayed meanwhile."""
    reason = "needs the extra `notebook`"
    nbclient = pytest.importorskip("nbclient", reason=reason)
    pytest.importorskip("ipykernel", reason=reason)
    import nbformat

    displayed = []

    class Client(nbclient.NotebookClient):
        def process_message(self, msg: Any, cell: Any, cell_index: int) -> Any:
            if msg["msg_type"] in ("display_data", "update_display_data"):
                displayed.append(msg["content"]["data"])
            return super().process_message(msg, cell, cell_index)

    notebook = nbformat.read(path, as_version=4)
    notebook.cells.append(nbformat.v4.new_code_cell(last_cell))
    Client(notebook, timeout=900, resources={"metadata": {"path": str(folder)}}).execute()
    return [output for cell in notebook.cells for output in cell.get("outputs", ())], displayed


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
@pytest.mark.slow
def test_a_notebook_runs_and_shows_what_it_says(path: Path, folder_of_user: Path) -> None:
    outputs, displayed = executed(path, dedent(IMPORTS) + dedent(SHOWN[path.stem]), folder_of_user)
    assert [output for output in outputs if output.get("name") == "stderr"] == [], "nothing is warned of"
    assert sum("image/png" in output.get("data", {}) for output in outputs) == FIGURES[path.stem]
    assert not list((folder_of_user / "build").glob("*.fmu")), "all FMUs were there"
    if path.stem == "sweep":
        shown = [data["text/plain"] for data in displayed if data["text/plain"].startswith("tip-ins: ")]
        assert shown[-1] == "tip-ins: 1000 of 1000"
        assert len(shown) > 5, "progress shows"


if __name__ == "__main__":
    for path in NOTEBOOKS:
        path.write_text(cleared(path), encoding="utf-8")
