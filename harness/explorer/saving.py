"""What a click saves: the car and the gains as files that other commands take, or a report."""

from collections.abc import Iterator, Mapping
from importlib.metadata import version
from itertools import count
from pathlib import Path
from typing import Any

from ...fmus.building.one_car import updated
from ..base.atomic_files import write_text
from ..simulation.provenance import content
from ..studies.compare.compare_report import report
from ..views.metrics_table import Row
from .request import Request
from .request_runs import Answer, RequestRunner

DIGITS = 6
"""Significant digits of a value in a file."""


def save_files(runner: RequestRunner, request: Request, known: Mapping[str, Any], folder: Path) -> list[Path]:
    """Writes car_N.toml and gains_N.toml with a number that is not taken; returns both.

    Args:
        known: entries of the file of parameters that was given.
    """
    car, gains = free(folder, "car_{}.toml", "gains_{}.toml")
    units = {knob.name: (knob.unit, knob.meaning) for knob in (*runner.car, *runner.gains)}
    by = f"by `driveline explore` (driveline-damping {version('driveline-damping')})"
    write_text(_toml(f"A car, {by}.", updated(runner.of_car, request.car), units), car)
    write_text(_toml(f"Gains of {runner.controllers[0]}, {by}.", {**known, **runner.gains_of(request)}, units), gains)
    return [car, gains]


def save_report(runner: RequestRunner, answer: Answer, inputs: list[Path | None], folder: Path) -> Path:
    """Writes report_N.html of the runs without and with control; returns it.

    Args:
        inputs: files that were read at the start.
    """
    (page,) = free(folder, "report_{}.html")
    request = answer.request
    runs = []
    for name, run in answer.runs.items():
        plant = request.plant if name == runner.controllers[0] else f"{request.plant} with {name}"
        runs += [
            (Row(plant, request.manoeuvre, control, each.metrics), each.results)
            for control, each in ((False, answer.without), (True, run))
        ]
    fits = {name: runner.fit(request.plant, name) for name in answer.runs}
    same = {"request": vars(request), **{name: runner.parameters(request, name) for name in answer.runs}}
    manoeuvres = {request.manoeuvre: runner.manoeuvre(request.manoeuvre, request.plant)}
    report(runs, manoeuvres, answer.runs, content(same, fits, [], inputs), page)
    return page


def free(folder: Path, *names: str) -> list[Path]:
    """Paths with the first number under which none of the names is taken."""
    tried = ([folder / name.format(number) for name in names] for number in count(1))
    return next(paths for paths in tried if not any(path.exists() for path in paths))


def _toml(comment: str, entries: Mapping[str, Any], units: Mapping[str, tuple[str, str]]) -> str:
    return "\n".join([f"# {comment}", "", *_lines(entries, units), ""])


def _lines(entries: Mapping[str, Any], units: Mapping[str, tuple[str, str]]) -> Iterator[str]:
    for name, value in entries.items():
        text = str(value).lower() if isinstance(value, bool) else f"{value!r}"
        if isinstance(value, float):
            text = repr(float(f"{value:.{DIGITS}g}"))
        unit, meaning = units.get(name, ("", ""))
        yield f"{name} = {text}" + (f"  # {', '.join(filter(None, (unit, meaning)))}" if meaning else "")
