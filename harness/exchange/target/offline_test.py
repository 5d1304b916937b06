"""The off-line test of the controller on the target: all cases, and what it writes."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypeVar

import numpy as np

from ....fmus.native.compiler import CompilerError
from ....fmus.target.deviations import findings
from ...base.atomic_files import write_text
from ...base.csv_file import write_csv
from ...base.errors import DrivelineError
from ...base.progress import progress
from ...cosimulation.parameter_changes import require_constant
from ...cosimulation.wiring import fit
from ...loop.places import T_S
from ...loop.settings import Settings, loop
from ...manoeuvres.catalogue import USUAL_MANOEUVRES
from .c_export import with_values
from .comparison import Comparison, compare, responses
from .in_loop import in_loop
from .offline_cases import Case, cases_in_loop, random_inputs, random_states
from .offline_results import TYPICAL, Part, Record, plot_comparison
from .programs import programs
from .sample_timing import schedule
from .size import size_of
from .target_page import page

STEPS = 1 + (len(USUAL_MANOEUVRES) + 1) + (len(USUAL_MANOEUVRES) + 4) + len(USUAL_MANOEUVRES)
"""For the progress: the checks; what the loop gives; these cases and those that are drawn; the target in the loop."""

Piece = TypeVar("Piece")

PARTS = ("NoDamping", "LinearObserver", "PaperObserver")
"""Controllers that have less under the same supervision: nothing, an estimator, and one that knows the gap."""


def record(settings: Settings) -> Record:
    """Runs all cases on the target and on this machine, and every manoeuvre with the target in the loop.

    Args:
        settings: of the loop with the controller, which is one of the project.

    Raises:
        DrivelineError: a compiler or the emulator is missing.
        SimulationError: the target was lost, hung or crashed.
    """
    require_constant(settings.parameters, "the C on the target")
    controller, system = str(settings.controller), loop(settings)
    interfaces = fit(system).interfaces
    own = interfaces["controller"]
    inputs, outputs = ([v.name for v in own.of_causality(kind)] for kind in ("input", "output"))
    values = {v.name: float(v.start or 0.0) for v in own.of_causality("parameter")}
    values |= {name: settings.parameters.get(f"controller.{name}", value) for name, value in values.items()}
    sources = with_values(controller, "float", values)
    with progress(STEPS, "target") as done:
        try:
            found = findings(sources)
        except CompilerError as refusal:
            raise DrivelineError(str(refusal)) from refusal
        with programs(controller, values) as made:
            cases = _counted(cases_in_loop(system, interfaces, inputs, settings), done, 1)
            first = 1 + len(cases)
            cases += random_inputs(cases, settings.seed)
            comparisons = _counted((compare(made, case, outputs) for case in cases), done, first)
            states = np.concatenate([each.states for each in comparisons if not each.case.drawn])
            comparisons.append(compare(made, random_states(cases[-2], states, settings.seed), outputs))
            loops = _counted(in_loop(made, controller, system, inputs, settings), done, first + len(comparisons))
            with made.target() as link:
                size = size_of(made.image, made.name, link)
            typical = next(each for each in comparisons if each.case.name == TYPICAL)
            parts = [_part(name, typical.case) for name in PARTS if name != controller]
            parts.append(Part(controller, typical.instructions[1], size.flash))
            return Record(comparisons, loops, schedule(sources), size, found, parts)


def _counted(pieces: Iterable[Piece], done: Callable[[float], None], first: int) -> list[Piece]:
    """All of them; the progress shows each, from so many on."""
    found: list[Piece] = []
    done(first)
    for piece in pieces:
        found.append(piece)
        done(first + len(found))
    return found


def _part(controller: str, case: Case) -> Part:
    with programs(controller, {}) as made:
        most = max(answer.count for answer in responses(made.target(), case)[1:])
        with made.target() as link:
            return Part(controller, most, size_of(made.image, made.name, link).flash)


def announce(found: Record) -> None:
    """Prints a line for each case, off-line and in the loop."""
    for each in found.comparisons:
        print(
            f"{each.case.name}: {len(each.case.inputs)} samples, {each.differing} with a differing bit, T_ref within "
            f"{each.T_ref:.2g} N.m of double precision, at most {each.instructions[1]} instructions"
        )
    for each in found.loops:
        print(
            f"{each.manoeuvre} in the loop: {each.differing} samples differ from off-line, T_ref within "
            f"{each.T_ref:.2g} N.m of the loop in double precision"
        )


def write(found: Record, controller: str, plant: str, folder: Path) -> list[Path]:
    """Writes page, figure and the cases; returns the files."""
    files = [folder / "target.md"]
    write_text(page(found, controller, plant), files[0])
    title = f"{controller} on the emulated Cortex-M4F"
    files += plot_comparison(found.comparisons, title, folder / "figures" / "target")
    for each in found.comparisons:
        files.append(folder / f"{each.case.name.replace(' ', '_')}.csv")
        write_csv(signals(each), files[-1])
    return files


def signals(comparison: Comparison) -> np.ndarray:
    """Time, inputs, and the torque on the target and in double precision, as columns of a file."""
    case, (target, model) = comparison.case, comparison.traces
    columns = {"time": T_S * np.arange(len(target)), **dict(zip(case.names, case.inputs.T, strict=True))}
    columns |= {"target.T_ref": target, "model.T_ref": model}
    table = np.empty(len(target), dtype=[(name, float) for name in columns])
    for name, column in columns.items():
        table[name] = column
    return table
