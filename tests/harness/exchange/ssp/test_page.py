"""The lines of docs/hosts.md for the whole loop run as they stand, where a package has just been written."""

import os
import re
import subprocess
import sys
from pathlib import Path
from shutil import copy

import pytest

from benchmarks.ssp_hosts import PRESENT
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmuloop.system import Scheme
from tests import ROOT

SECTIONS = (ROOT / "docs" / "hosts.md").read_text(encoding="utf-8").split("\n## ")

LINES = {
    section.partition("\n")[0]: codes[1]
    for section in SECTIONS
    if len(codes := re.findall(r"```python\n(.*?)```", section, re.S)) == 2
}
"""Of each tool; the first lines are those for one FMU."""


@pytest.mark.parametrize(
    ("tool", "tolerance"), [("FMPy", 0.1), ("libcosim", 1e-9), ("ecos", 1e-9)], ids=["FMPy", "libcosim", "ecos"]
)
def test_the_lines_for_a_tool_print_the_gear_torque_in_the_end(packaged, fmus, tmp_path, tool, tolerance) -> None:
    if not PRESENT[tool]:
        pytest.skip(f"{tool} is not installed")
    folder = tmp_path / "results" / "ssp"
    folder.mkdir(parents=True)
    copy(packaged(), folder)
    environment = os.environ | {"LD_LIBRARY_PATH": str(Path(sys.prefix) / "lib")}
    command = [sys.executable, "-c", LINES[tool]]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    (printed,) = re.findall(r"([\d.]+)\]?\s*$", done.stdout)
    ours = simulate(MANOEUVRES["tipin15"], scheme=Scheme.JACOBI, folder=fmus, build="native")
    assert float(printed) == pytest.approx(ours["plant.T_gear"][-1], abs=tolerance)
