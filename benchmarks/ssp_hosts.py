"""What tools that we did not write make of the package of `driveline ssp`, beside our master.

Each runs the same manoeuvre of the same package in a process of its own, in steps of 1 ms. The differences are those
of the gear torque at the ends of the steps, from our master under Jacobi, whose loop is not read from the package and
is given the manoeuvre from outside; the last row is our master under its default scheme. MasterSim and OMSimulator take
part where their programs `mastersim` and `OMSimulator` are on the path.
"""

import argparse
import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from importlib.util import find_spec
from multiprocessing import get_context
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from typing import Any
from zipfile import ZipFile

import numpy as np
from rich.console import Console
from rich.table import Table

from driveline.harness.commands.cli import main as driveline
from driveline.harness.loop.places import PLANTS, STEP_SIZE
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmuloop.system import Scheme
from toolground.interruption import script

DEFAULT = "SystemStructure.ssd"

Signals = dict[str, np.ndarray]
"""`instance.output` -> its values at the ends of the steps."""

Host = Callable[[Path, str, int], Signals]
"""Runs a variant of a package, the default one or that of an SSD of its own, for so many steps."""

EXAMPLES = """\
examples:
  python -m benchmarks.ssp_hosts
  python -m benchmarks.ssp_hosts --manoeuvre launch --plant TwoMassDriveline
"""


def fmpy(ssp: Path, variant: str, steps: int) -> Signals:
    from fmpy.ssp.simulation import simulate_ssp
    from fmpy.ssp.ssd import read_ssv

    with TemporaryDirectory() as folder:
        archive = _with_default(ssp, variant, Path(folder))
        parameters = read_ssv(archive, f"resources/{variant}.ssv")
        stop_time = (steps - 0.5) * STEP_SIZE  # it adds the steps up
        rows = simulate_ssp(archive, stop_time=stop_time, step_size=STEP_SIZE, parameter_set=parameters)
    return {name: rows[name] for name in rows.dtype.names or () if name != "time"}


def libcosim(ssp: Path, variant: str, steps: int) -> Signals:
    from libcosimpy.CosimEnums import CosimVariableCausality, CosimVariableType
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.ERROR)
    with TemporaryDirectory() as folder:
        ZipFile(ssp).extractall(folder)
        own = Path(folder, f"{variant}.ssd")
        execution = CosimExecution.from_ssp_file(str(own if own.is_file() else ssp))  # the step is in the package
        observer = CosimObserver.create_last_value()
        execution.add_observer(observer)
        real_output = CosimVariableCausality.OUTPUT.value, CosimVariableType.REAL.value
        names: list[str] = []
        wanted: list[tuple[int, list[int]]] = []
        for slave in execution.slave_infos():
            instance = slave.name.decode()
            reals = [v for v in execution.slave_variables(slave.index) if (v.causality, v.type) == real_output]
            names += [f"{instance}.{v.name.decode()}" for v in reals]
            wanted.append((slave.index, [v.reference for v in reals]))
        rows = []
        for _ in range(steps):
            execution.step()
            rows.append([x for slave, references in wanted for x in observer.last_real_values(slave, references)])
    return dict(zip(names, np.array(rows).T, strict=True))


def ecos(ssp: Path, variant: str, steps: int) -> Signals:
    from ecospy import EcosSimulation

    with TemporaryDirectory() as folder:
        archive = _with_default(ssp, variant, Path(folder))
        names = [name for name in _outputs(archive) if name.partition(".")[2] not in ("valid", "counter", "enable")]
        with EcosSimulation(STEP_SIZE, ssp_path=str(archive)) as simulation:
            simulation.init(parameter_set="start")
            rows = []
            for _ in range(steps):
                simulation.step()
                rows.append([simulation.get_real(name.replace(".", "::")) for name in names])
            simulation.terminate()
    return dict(zip(names, np.array(rows).T, strict=True))


def mastersim(ssp: Path, variant: str, steps: int) -> Signals:
    """Its file lacks a row here and there, which then is NaN."""
    with TemporaryDirectory() as folder:
        ZipFile(ssp).extractall(folder)
        project = next(Path(folder).rglob(f"{variant}.msim"))
        subprocess.run(["mastersim", project.name], cwd=project.parent, capture_output=True, check=True)
        lines = (project.with_suffix("") / "results" / "values.csv").read_text().splitlines()
    names = [heading.strip().partition(" ")[0] for heading in lines[0].split("\t")]
    rows = np.array([[float(value) for value in line.split("\t") if value.strip()] for line in lines[1:]])
    found = np.full((steps + 1, len(names)), np.nan)
    at = np.round(rows[:, 0] / STEP_SIZE).astype(int)
    found[at[at <= steps]] = rows[at <= steps]
    return {name: found[1:, column] for column, name in enumerate(names) if column > 0}


def omsimulator(ssp: Path, variant: str, steps: int) -> Signals:
    """Its command line; of the rows of an instant the last one counts."""
    with TemporaryDirectory() as folder:
        archive = _with_default(ssp, variant, Path(folder)).absolute()
        options = [f"--stopTime={steps * STEP_SIZE!r}", "--resultFile=values.csv"]
        subprocess.run(["OMSimulator", *options, archive], cwd=folder, capture_output=True, check=True)
        lines = Path(folder, "values.csv").read_text().splitlines()
    names = [name.strip('"').partition(".loop.")[2] for name in lines[0].split(",")]
    rows = {round(float(line.partition(",")[0]) / STEP_SIZE): line for line in lines[1:]}
    values = np.array([[float(value) for value in rows[k].split(",")] for k in range(1, steps + 1)])
    return {name: values[:, column] for column, name in enumerate(names) if name}


HOSTS: Mapping[str, Host] = {
    "FMPy": fmpy,
    "libcosim": libcosim,
    "ecos": ecos,
    "MasterSim": mastersim,
    "OMSimulator": omsimulator,
}

PRESENT = {
    "FMPy": True,
    "libcosim": find_spec("libcosimpy") is not None,
    "ecos": find_spec("ecospy") is not None,
    "MasterSim": which("mastersim") is not None,
    "OMSimulator": which("OMSimulator") is not None,
}


def run_in(host: str, ssp: Path, variant: str, steps: int) -> Signals:
    """What a host makes of a package, in a process of its own."""
    # where the package tbb puts the library that ecos needs; it is looked for when a process starts
    os.environ["LD_LIBRARY_PATH"] = str(Path(sys.prefix) / "lib")
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(HOSTS[host], ssp, variant, steps).result()


def _with_default(ssp: Path, variant: str, folder: Path) -> Path:
    """The package, or a copy whose default is that variant."""
    with ZipFile(ssp) as source:
        if f"{variant}.ssd" not in source.namelist():
            return ssp
        copy = folder / ssp.name
        with ZipFile(copy, "w") as target:
            for name in source.namelist():
                if name != DEFAULT:
                    target.writestr(DEFAULT if name == f"{variant}.ssd" else name, source.read(name))
    return copy


def _outputs(ssp: Path) -> list[str]:
    from fmpy.ssp.ssd import read_ssd

    system: Any = read_ssd(ssp).system
    return [f"{one.name}.{c.name}" for one in system.elements for c in one.connectors if c.kind == "output"]


def table(ssp: Path, manoeuvre: str, plant: str) -> Table:
    ours, usual = (
        simulate(MANOEUVRES[manoeuvre], plant=plant, scheme=scheme)["plant.T_gear"][1:]
        for scheme in (Scheme.JACOBI, Scheme.PROPAGATED)
    )
    found = {host: run_in(host, ssp, plant, len(ours))["plant.T_gear"] for host, there in PRESENT.items() if there}
    result = Table("host", "largest, N.m", "from 0.5 s on", "at the end", title=f"{manoeuvre}, {plant}")
    for host, theirs in (found | {"our default scheme": usual}).items():
        d = np.abs(theirs - ours)
        figures = (np.nanmax(d), np.nanmax(d[round(0.5 / STEP_SIZE) :]), d[-1])
        result.add_row(host, *(f"{x:.2g}" for x in figures))
    return result


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--manoeuvre", choices=MANOEUVRES, default="tipin15", help="(default: %(default)s)")
    parser.add_argument("--plant", choices=PLANTS, action="append", help="only this one (repeatable)")
    args = parser.parse_args()
    console = Console()
    with TemporaryDirectory() as folder:
        if driveline(["ssp", "--manoeuvre", args.manoeuvre, "--output", folder, "--quiet"]):
            sys.exit(1)
        for plant in args.plant or PLANTS:
            console.print(table(Path(folder, "driveline.ssp"), args.manoeuvre, plant))


if __name__ == "__main__":
    script(main)
