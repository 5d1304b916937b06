"""The test of the controller on the target: off-line, in the loop and under a timer; its numbers and files."""

import json
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fmublocks.native.statements import SINGLE
from fmublocks.target.sources import target_sources
from fmuloop.parameter_changes import require_constant
from toolground.atomic_files import write_text
from toolground.csv_file import write_csv
from toolground.progress import progress

from ....fmus.catalogue import CONTROLLERS
from ...loop.places import T_S
from ...loop.resolved import ResolvedLoop
from ...manoeuvres.catalogue import USUAL_MANOEUVRES
from .comparison import Comparison, InLoop, compare, in_loop
from .controllers import programs
from .costs import Schedule, Size, schedule, size_of
from .offline_cases import cases_in_loop, random_inputs, random_states

NUMBERS = "numbers.json"


class Record(NamedTuple):
    """What the target was found to do: off-line, in the loop, under a timer, and what it takes."""

    comparisons: Sequence[Comparison]
    loops: Sequence[InLoop]
    schedule: Schedule
    size: Size

    @property
    def passed(self) -> bool:
        """Whether no bit differs, and the torque of every case that the loop gave is as near to double precision as it
        must."""
        near = all(comparison.margin <= 1.0 or comparison.case.drawn for comparison in self.comparisons)
        same = not any(part.differing for part in (*self.comparisons, *self.loops))
        kept = self.schedule.missed == 0 and all(comparison.finite for comparison in self.comparisons)
        return near and same and kept


STEPS = (len(USUAL_MANOEUVRES) + 1) + (len(USUAL_MANOEUVRES) + 4) + len(USUAL_MANOEUVRES)
"""For the progress: what the loop gives; these cases and those that are drawn; the target in the loop."""


def record(resolved: ResolvedLoop) -> Record:
    """Runs all cases on the target and on this machine, and every manoeuvre with the target in the loop.

    Args:
        resolved: the loop with the controller, which is one of the project.

    Raises:
        CompilerError: a compiler or the emulator is missing.
        SimulationError: the target was lost, hung or crashed.
    """
    settings = resolved.settings
    require_constant(settings.parameters, "the C on the target")
    controller, own = str(settings.controller), resolved.fit.interfaces["controller"]
    inputs, outputs = ([v.name for v in own.of_causality(kind)] for kind in ("input", "output"))
    values = {v.name: float(v.start or 0.0) for v in own.of_causality("parameter")}
    values |= {name: settings.parameters.get(f"controller.{name}", value) for name, value in values.items()}
    fmu = CONTROLLERS[controller].started_with(values)
    sources = target_sources(fmu, SINGLE)
    with progress(STEPS, "target") as done, programs(fmu) as binaries:
        cases = _counted(cases_in_loop(resolved, inputs), done, 0)
        first = len(cases)
        cases += random_inputs(cases, settings.seed)
        comparisons = _counted((compare(binaries, case, outputs) for case in cases), done, first)
        states = np.concatenate([comparison.states for comparison in comparisons if not comparison.case.drawn])
        comparisons.append(compare(binaries, random_states(cases[-2], states, settings.seed), outputs))
        loops = _counted(in_loop(binaries, resolved, inputs), done, first + len(comparisons))
        return Record(comparisons, loops, schedule(sources), size_of(binaries))


def _counted(pieces: Iterable[Any], done: Callable[[float], None], first: int) -> list[Any]:
    """All of them; the progress shows each, from so many on."""
    counted: list[Any] = []
    for count, piece in enumerate(pieces, first):
        done(count)
        counted.append(piece)
    return counted


def announce(record: Record) -> None:
    """Prints a line for each case, off-line and in the loop."""
    for of in record.comparisons:
        print(
            f"{of.case.name}: {of.samples} samples, {of.differing} with a differing bit, T_ref within "
            f"{of.T_ref:.2g} N.m of double precision, at most {of.instructions[1]} instructions"
        )
    for drive in record.loops:
        print(
            f"{drive.manoeuvre} in the loop: {drive.differing} samples differ from off-line, T_ref within "
            f"{drive.T_ref:.2g} N.m of the loop in double precision"
        )


def numbers(record: Record) -> dict[str, dict[str, Any]]:
    """What was found as tables: rows by name, each with a value by column.

    Torques are in N.m, memory in bytes, costs `driven` and `drawn` the most instructions of a sample. For the rest see
    `Comparison`, `InLoop`, `Size` and `Schedule`.
    """
    most = {of.case.name: of.instructions[1] for of in record.comparisons}
    drawn = {of.case.name for of in record.comparisons if of.case.drawn}
    return {
        "cases": {of.case.name: _columns(of, *Comparison._fields[1:8]) for of in record.comparisons},
        "loops": {drive.manoeuvre: _columns(drive, *InLoop._fields[1:]) for drive in record.loops},
        "costs": {
            "driven": max(count for name, count in most.items() if name not in drawn),
            "drawn": max((most[name] for name in drawn), default=0),
            "stack_used": max(of.stack for of in record.comparisons),
            **record.size._asdict(),
        },
        "schedule": record.schedule._asdict(),
    }


def _columns(row: Any, *names: str) -> dict[str, Any]:
    return {name: getattr(row, name) for name in names}


def write(record: Record, folder: Path) -> list[Path]:
    """Writes the numbers and the cases; returns the files."""
    files = [folder / NUMBERS]
    write_text(json.dumps(numbers(record), indent=2) + "\n", files[0])
    for comparison in record.comparisons:
        files.append(folder / f"{comparison.case.name.replace(' ', '_')}.csv")
        write_csv(signals(comparison), files[-1])
    return files


def signals(comparison: Comparison) -> np.ndarray:
    """Time, inputs, and the torque on the target and in double precision, as columns of a file."""
    case, (target, model) = comparison.case, comparison.traces
    columns = {"time": T_S * np.arange(len(target)), **dict(zip(case.names, case.inputs.T, strict=True))}
    columns |= {"target.T_ref": target, "model.T_ref": model}
    return np.rec.fromarrays(list(columns.values()), [(name, float) for name in columns])
