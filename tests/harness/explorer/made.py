"""The module of a page, in Node."""

import json
import subprocess
from collections.abc import Sequence
from pathlib import Path
from shutil import which
from typing import Any

import numpy as np
import pytest

from driveline.harness.explorer.module import standard
from driveline.harness.loop.places import STEP_SIZE, T_S
from driveline.harness.metrics.spectrum import DRIVE_TRAIN
from toolground.errors import UserError

SCRIPTS = Path(standard.__code__.co_filename).parent / "page"


def loops() -> dict[str, Any]:
    """The module; skips the test, and says so, where it cannot be made."""
    try:
        return standard()
    except UserError as reason:
        pytest.skip(str(reason))


def in_node(script: str, folder: Path, asked: Any) -> Any:
    """What a script of this folder answers; skips the test, and says so, where there is no Node."""
    node = which("node")
    if node is None:
        pytest.skip("no Node here: apt-get install nodejs")
    (folder / "asked.json").write_text(json.dumps(asked), encoding="utf-8")
    done = subprocess.run(
        [node, str(Path(__file__).with_name(script)), str(folder), str(SCRIPTS)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads((folder / "answers.json").read_text(encoding="utf-8"))


def runs_and_cars(folder: Path, cases: Sequence[Any] = (), cars: Sequence[Any] = ()) -> Any:
    """What the module makes of runs, whose columns are in files of the folder then, and of cars."""
    asked = {
        "loops": loops(),
        "cases": list(cases),
        "cars": list(cars),
        "T_s": T_S,
        "step": STEP_SIZE,
        "band": DRIVE_TRAIN,
    }
    return in_node("run_loops.js", folder, asked)


def column(folder: Path, number: int, name: str) -> np.ndarray:
    """A column of a run."""
    return np.fromfile(folder / f"{number} {name}")
