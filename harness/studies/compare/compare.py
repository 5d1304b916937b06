"""The main job: every manoeuvre on every plant, without damping and with each controller, side by side.

The runs know nothing of each other and are spread over the cores; what comes back is in the order
of the cases, whatever finishes first.
"""

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from fmuloop.campaign import RunRequest
from fmuloop.results import Results
from toolground.errors import UserError

from ...loop.places import by_name
from ...loop.resolved import ResolvedLoop
from ...loop.topology import DriveUnit, Topology
from ...loop.unit_runs import of_unit
from ...manoeuvres.catalogue import COMPARED, MANOEUVRES
from ...manoeuvres.manoeuvre import Manoeuvre
from ...metrics.evaluate import at_samples, evaluate
from ...metrics.run_metrics import Metrics
from ...simulation.simulate import planned
from ...views.figure_options import PLAIN, FigureOptions
from ...views.metrics_table import DAMPINGS, Row, values, write_markdown, write_metrics
from ...views.signal_lines import WITHOUT
from ...views.signals_file import write_signals

DRAWN = ("tipin15", "tipin50", "tipout", "launch", "drive")
"""Of the manoeuvres that are compared unless others are named, those with a figure."""

RUNS = "runs"
"""The folder of the signals of each run."""

Manoeuvres = Mapping[str, Manoeuvre]
"""By name."""


class Case(NamedTuple):
    """One run: a plant (name or file of an FMU), a manoeuvre by name, and a controller (name or file) or WITHOUT."""

    plant: str
    manoeuvre: str
    controller: str

    def __str__(self) -> str:
        return f"{self.manoeuvre} on {self.plant_name}, {self.controller_name}"

    @property
    def control(self) -> bool:
        return self.controller != WITHOUT

    @property
    def plant_name(self) -> str:
        return Path(self.plant).stem

    @property
    def controller_name(self) -> str:
        return Path(self.controller).stem

    @property
    def file_name(self) -> str:
        return f"{self.plant_name}_{self.manoeuvre}_{self.controller_name if self.control else 'off'}"


Loops = Mapping[tuple[str, str], ResolvedLoop]
"""The loops by plant and controller of the cases."""


class Outcome(NamedTuple):
    """A case that was run, as one of the drive units saw it."""

    case: Case
    metrics: Metrics
    results: Results
    unit: DriveUnit = DriveUnit()

    @property
    def plant_name(self) -> str:
        """In tables, with the drive unit."""
        return self.unit.named(self.case.plant_name)

    def row(self, several: bool = False) -> Row:
        """Of the table; `several` controllers are in it."""
        damping = self.case.controller_name if several else "on"
        return Row(self.plant_name, self.case.manoeuvre, damping if self.case.control else "off", self.metrics)

    @property
    def record(self) -> dict[str, Any]:
        """The run for files: what it was, and all metrics by their keys."""
        return {
            "plant": self.case.plant_name,
            **({"drive_unit": self.unit.name} if self.unit.name else {}),
            "manoeuvre": self.case.manoeuvre,
            "control": self.case.control,
            "controller": self.case.controller_name,
            **values(self.metrics),
        }


def cases(plants: Sequence[str], manoeuvres: Sequence[str], controllers: Sequence[str]) -> list[Case]:
    """All combinations, the run without damping and those with each controller next to each other.

    Raises:
        UserError: two plants or controllers have the same name, by which their files would be told apart; or there
            is no controller.
    """
    by_name(plants, "plant")
    if not by_name(controllers, "controller"):
        raise UserError("there is no controller to compare; NoDamping is one too")
    return [
        Case(plant, manoeuvre, controller)
        for plant in plants
        for manoeuvre in manoeuvres
        for controller in (WITHOUT, *controllers)
    ]


def loops_of(given: Loops) -> Loops:
    """The loops of all cases: those with controllers, and of each plant that whose first one is switched off."""
    off = {(plant, WITHOUT): made.replace(control=False) for (plant, _), made in reversed(list(given.items()))}
    return {**given, **off}


def needed(case: Case, loops: Loops, manoeuvres: Manoeuvres) -> list[RunRequest]:
    """The run of a case."""
    return [planned(manoeuvres[case.manoeuvre], loops[case.plant, case.controller])]


def _outcomes(
    case: Case, runs: Sequence[Results], output: Path, loops: Loops, manoeuvres: Manoeuvres, format: str
) -> list[Outcome]:
    """Writes the signals of a case at the controller's samples to the folder `output` and evaluates its run."""
    write_signals(at_samples(runs[0]), output / case.file_name, format)
    topology = loops[case.plant, case.controller].settings.topology
    return outcomes_of(case, manoeuvres[case.manoeuvre], runs[0], topology)


def outcomes_of(case: Case, manoeuvre: Manoeuvre, results: Results, topology: Topology) -> list[Outcome]:
    """What a run is worth, of each drive unit."""
    runs = ((of_unit(results, unit), unit) for unit in topology.units)
    return [Outcome(case, evaluate(run, manoeuvre), run, unit) for run, unit in runs]


def run_cases(
    todo: Sequence[Case],
    output: Path,
    loops: Loops,
    manoeuvres: Manoeuvres = MANOEUVRES,
    format: str = "csv",
    options: FigureOptions = PLAIN,
) -> tuple[list[Outcome], list[Path]]:
    """Runs the cases in parallel, then draws their figures in parallel; gives their outcomes in the order of the cases,
    and the files of figures.

    Args:
        output: folder for the figures, and in it that for the files of signals, `RUNS`.
        format: of those files, one of `harness.views.signals_file.FORMATS`.
        options: of the figures, which are files.
    """
    from fmuloop.many_runs import run_many  # one run does without

    plan = partial(needed, loops=loops, manoeuvres=manoeuvres)
    judge = partial(_outcomes, output=output / RUNS, loops=loops, manoeuvres=manoeuvres, format=format)
    outcomes = [outcome for of_case in run_many(judge, todo, runs=plan) for outcome in of_case]
    draw = partial(_figure, folder=output, options=options, manoeuvres=manoeuvres)
    figures = run_many(draw, drawn(outcomes, manoeuvres), label="drawing")
    return outcomes, [file for files in figures for file in files]


class Together(list[Outcome]):
    """What is of one manoeuvre on one plant, and one drive unit: the run without damping, then those with each
    controller."""

    def __str__(self) -> str:
        return f"{self[0].case.manoeuvre} on {self[0].plant_name}"


def together(outcomes: Iterable[Outcome]) -> list[Together]:
    """By manoeuvre, plant and drive unit, in the order of the outcomes."""
    groups: dict[tuple[str, str, str], Together] = {}
    for outcome in outcomes:
        key = outcome.case.plant, outcome.case.manoeuvre, outcome.unit.name
        groups.setdefault(key, Together()).append(outcome)
    return list(groups.values())


def drawn(outcomes: Iterable[Outcome], manoeuvres: Manoeuvres = MANOEUVRES) -> list[Together]:
    """What has a figure: what is `together`, but of the usual manoeuvres those that are `DRAWN`."""

    def usual(name: str) -> bool:
        return name in COMPARED and manoeuvres[name].description == MANOEUVRES[name].description

    names = [name for name in manoeuvres if name in DRAWN or not usual(name)]
    return [each for each in together(outcomes) if each[0].case.manoeuvre in names]


def rows_of(outcomes: Sequence[Outcome]) -> list[Row]:
    """Of the table of all runs."""
    several = len({outcome.case.controller for outcome in outcomes}) > 2
    plants = list(dict.fromkeys(outcome.plant_name for outcome in outcomes))
    return [outcome.row(several) for plant in plants for outcome in outcomes if outcome.plant_name == plant]


def write_tables(outcomes: Sequence[Outcome], folder: Path, title: str = DAMPINGS) -> list[Path]:
    """Writes the table as Markdown and all metrics as CSV; returns the files."""
    table, metrics = folder / "table.md", folder / "metrics.csv"
    write_markdown(rows_of(outcomes), table, title)
    write_metrics([outcome.record for outcome in outcomes], metrics)
    return [table, metrics]


def _figure(outcomes: Together, folder: Path, options: FigureOptions, manoeuvres: Manoeuvres) -> list[Path]:
    """Draws the runs of one manoeuvre on one plant, a step close up and all else whole; returns the files."""
    case = outcomes[0].case
    manoeuvre, plant = manoeuvres[case.manoeuvre], outcomes[0].plant_name
    from ...views.drive_figure import plot_drive  # not for those who draw nothing
    from ...views.step_figure import plot_step

    plot = plot_drive if manoeuvre.dT is None else plot_step
    runs = {outcome.case.controller_name: outcome.results for outcome in outcomes}
    return plot(runs, manoeuvre, plant, folder / f"{plant.replace(' ', '_')}_{manoeuvre.name}", options)
