"""What tools that we did not write make of the FMU TwoMassDriveline: the lines of docs/hosts.md are run for each of its
kinds, and a table is printed of what they give: the relative difference from our master.

A tool takes part where its package can be imported; for OMSimulator PYTHONPATH may name the folder of a build of one's
own. fmusim takes part where it is on the path. The FMUs are those of `build`, made by `driveline build` and
`driveline build --fmi 3`.
"""

import os
import re
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory

from docs.studies.data_file import ROOT
from driveline.harness.loop.places import BUILD, NATIVE
from fmuloop.experiment import Experiment
from fmuloop.runs import run
from fmuloop.system import Port, Scheme, System
from toolground.interruption import script

PAGE = ROOT / "docs" / "hosts.md"

LINES: dict[str, str] = dict(
    re.findall(r"^## (\w+)\n[^#]*?```(?:python|sh)\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S | re.M)
)
"""Of each tool."""

PACKAGES = {
    "FMPy": "fmpy",
    "libcosim": "libcosimpy",
    "ecos": "ecospy",
    "OMSimulator": "OMSimulator",
    "pathsim": "pathsim_fmi",
    "PyFMI": "pyfmi",
    "FMUContainer": "fmu_manipulation_toolbox",
}

PROGRAM = "fmusim"
"""A program, whose lines are those of a shell."""

BUILT = "built from source"

INTEGRATED = {
    '"CoSimulation"': '"ModelExchange"',
    '"CS"': '"ME"',
    "CoSimulationFMU": "ModelExchangeFMU",
    "--interface-type cs": "--interface-type me",
}
OF_FMI3 = {"build/native": "build/fmi3"}

KINDS: dict[str, tuple[dict[str, str], ...]] = {
    "co-simulation 2.0": (),
    "model exchange 2.0": (INTEGRATED,),
    "co-simulation 3.0": (OF_FMI3,),
    "model exchange 3.0": (INTEGRATED, OF_FMI3),
}
"""Of FMUs, with what is put in the place of what in the lines of a tool that knows that kind."""


def ours() -> float:
    """The speed in the end of the run of the page, in our master."""
    system = System(
        instances={"plant": BUILD / NATIVE / "TwoMassDriveline.fmu"},
        inputs=(Port("plant.T_mot", "N.m"),),
        outputs=(Port("plant.v", "m/s"),),
    )
    start = {"plant.v_0": 10.0, "plant.T_0": 40.0}
    return float(run(system, Experiment(2.0, 1e-3, {"plant.T_mot": 100.0}, start, Scheme.JACOBI))["plant.v"][-1])


def cell(host: str, kind: str, right: float) -> str:
    """What comes of the lines of a host with FMUs of a kind."""
    lines = LINES[host]
    for changes in KINDS[kind]:
        old = next((old for old in changes if old in lines), None)
        if old is None:
            return ""
        lines = lines.replace(old, changes[old])
    environment = os.environ | {"LD_LIBRARY_PATH": str(Path(sys.prefix) / "lib")}
    with TemporaryDirectory() as folder:
        Path(folder, "build").symlink_to(BUILD)
        command = ["sh" if host == PROGRAM else sys.executable, "-c", lines]
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode < 0:
        return "ends the process"
    printed = re.findall(r"([\d.]+)\]?\s*$", done.stdout)
    return f"{abs(float(printed[-1]) / right - 1.0):.1g}" if printed and not done.returncode else "refused"


def version_of(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return BUILT


def table() -> str:
    right = ours()
    rows = ["| tool | " + " | ".join(KINDS) + " |", "|---|" + "---:|" * len(KINDS)]
    present = {host: version_of(package) for host, package in PACKAGES.items() if find_spec(package)}
    if which(PROGRAM):
        present[PROGRAM] = BUILT
    for host, made in present.items():
        cells = [cell(host, kind, right) for kind in KINDS]
        rows.append(f"| {host}, {made} | {' | '.join(cells)} |")
    return "\n".join(rows)


def main() -> None:
    print(table())


if __name__ == "__main__":
    script(main)
