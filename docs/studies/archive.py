"""Makes the archive for whoever has no Python: FMUs for all platforms, the loop as SSP, reference results, a page.

    python -m docs.studies.archive dist

The reference results are in the form of the FMI cross-check (rules 4.1): inputs, outputs and how they were made, of
each FMU for itself with its start values. The inputs are what the loop gives the block in a launch; the outputs are
those of FMPy with both FMUs of a block, which must be the same to the last bit.
"""

import sys
from importlib.metadata import version
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy
import numpy as np

from driveline.fmus.building.builds import build_fmus
from driveline.fmus.catalogue import FMUS, MANOEUVRE
from driveline.harness.commands.cli import main as driveline
from driveline.harness.loop.places import CONNECTIONS, PLACES, PLANTS, STEP_SIZE
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmublocks.archive import write_archive
from fmublocks.builds import FMI3_FOLDER, NATIVE_FOLDER
from fmuloop.interface import Interface
from fmuloop.results import Results
from fmuloop.system import Scheme
from toolground.errors import UserError
from toolground.interruption import script

from .data_file import ROOT

VERSION = version("driveline-damping")

NAME = f"driveline-damping-{VERSION}-fmus"
PAGE = Path(__file__).with_name("archive_page.md")
FOLDERS = {"fmi2": NATIVE_FOLDER, "fmi3": FMI3_FOLDER}
"""Of the archive, and of the builds."""

STOP_TIME = 2.0
LARGEST = 1_000_000
"""Bytes of a file of the cross-check."""

OPTIONS = {
    "StartTime": 0.0,
    "StopTime": STOP_TIME,
    "StepSize": STEP_SIZE,
    "RelTol": 1e-4,
    "SolverType": "FixedStep",
    "OutputIntervalLength": STEP_SIZE,
}
"""How the reference results were made."""


def archive(folder: Path, platform: str = "all") -> Path:
    """Makes the archive in a folder, with FMUs for `all` platforms or that of the `host`."""
    with TemporaryDirectory() as temporary:
        content = _content(Path(temporary), platform)
    target = folder / f"{NAME}.zip"
    write_archive({f"{NAME}/{path}": file for path, file in content.items()}, target)
    return target


def _content(folder: Path, platform: str) -> dict[str, bytes]:
    for fmi, names in ((2, [*FMUS, MANOEUVRE]), (3, list(FMUS))):
        list(build_fmus(names, folder, "native", platform, fmi=fmi))
    if driveline(["ssp", "--fmus", str(folder), "--build", "native", "--output", str(folder), "--quiet"]):
        raise UserError("driveline ssp failed")
    files = {"ssp/driveline.ssp": folder / "driveline.ssp", "LICENSE.txt": ROOT / "LICENSE"}
    files |= {f"{into}/{name}.fmu": folder / build / f"{name}.fmu" for into, build in FOLDERS.items() for name in FMUS}
    content = {path: file.read_bytes() for path, file in files.items()}
    for name in FMUS:
        content |= {f"reference/{name}/{file}": text.encode() for file, text in _reference(name, folder).items()}
    page = PAGE.read_text(encoding="utf-8").replace("VERSION", VERSION).replace("FMPY", fmpy.__version__)
    return content | {"README.md": page.encode()}


def _reference(name: str, folder: Path) -> dict[str, str]:
    inputs = _inputs(name, folder)
    interface = Interface(folder / NATIVE_FOLDER / f"{name}.fmu")
    outputs = [variable.name for variable in interface.of_causality("output")]
    both = [
        fmpy.simulate_fmu(
            str(path),
            fmi_type="CoSimulation",
            stop_time=STOP_TIME,
            output_interval=STEP_SIZE,
            input=_completed(inputs, Interface(path)),
            output=outputs,
        )
        for path in (folder / build / f"{name}.fmu" for build in FOLDERS.values())
    ]
    if any(not np.array_equal(both[0][column], both[1][column]) for column in ("time", *outputs)):
        raise UserError(f"{name}: its FMUs of FMI 2.0 and FMI 3.0 give different results")
    options = "".join(f"{option}, {value}\n" for option, value in OPTIONS.items())
    return {f"{name}_in.csv": _csv(inputs), f"{name}_ref.csv": _csv(both[0]), f"{name}_ref.opt": options}


def _inputs(name: str, folder: Path) -> np.ndarray:
    """What the loop gives an FMU in a launch: a structured array with `time` and its inputs."""
    (place,) = (place for place, names in PLACES.items() if name in names)
    plant = name if name in PLANTS else PLANTS[0]
    run = simulate(MANOEUVRES["launch"], plant, scheme=Scheme.JACOBI, folder=folder, build="native")
    sources = {c.target: c.source for c in CONNECTIONS}
    columns = {
        variable.name: run[sources.get(full, full)]
        for variable in Interface(folder / NATIVE_FOLDER / f"{name}.fmu").of_causality("input")
        if (full := f"{place}.{variable.name}") in sources or full in (run.dtype.names or ())
    }
    return _table(run, columns)


def _completed(inputs: np.ndarray, interface: Interface) -> np.ndarray:
    """With the other inputs, which keep their start values; FMPy warns of an input that it is not given."""
    names = inputs.dtype.names or ()
    starts = {v.name: v.start or "0" for v in interface.of_causality("input") if v.name not in names}
    others = {name: float({"false": "0", "true": "1"}.get(start, start)) for name, start in starts.items()}
    completed = np.empty(len(inputs), [*inputs.dtype.descr, *((name, np.float64) for name in others)])
    for name in completed.dtype.names or ():
        completed[name] = others[name] if name in others else inputs[name]
    return completed


def _table(run: Results, columns: dict[str, np.ndarray]) -> np.ndarray:
    rows = round(STOP_TIME / STEP_SIZE) + 1
    types = {"f": np.float64, "i": np.int32, "b": np.bool_}
    table = np.zeros(
        rows, [("time", np.float64), *((name, types[column.dtype.kind]) for name, column in columns.items())]
    )
    table["time"] = run["time"][:rows]
    for name, column in columns.items():
        table[name] = column[:rows]
    return table


def _csv(table: np.ndarray) -> str:
    """By the rules of the cross-check: names in quotes, truth values as 0 and 1, not too large."""
    text = StringIO()
    text.write(",".join(f'"{name}"' for name in table.dtype.names or ()) + "\n")
    for row in table:
        text.write(",".join(_number(value) for value in row) + "\n")
    if text.tell() > LARGEST:
        raise UserError(f"a file of {text.tell()} bytes; the cross-check allows {LARGEST}")
    return text.getvalue()


def _number(value: np.generic) -> str:
    return repr(float(value)) if isinstance(value, np.floating) else str(int(value))


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit("which folder? such as python -m docs.studies.archive dist")
    path = archive(Path(sys.argv[1]))
    print(f"{path}: {path.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    script(main)
