"""The main job: every manoeuvre on every plant, without and with damping, side by side.

The runs know nothing of each other and are spread over the cores; what comes back is in the order
of the cases, whatever finishes first.
"""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from ...base.known_names import require_different
from ...base.progress import progress
from ...cosimulation.results import Results
from ...loop.settings import Settings
from ...manoeuvres.catalogue import COMPARED, MANOEUVRES
from ...manoeuvres.manoeuvre import Manoeuvre
from ...metrics.evaluate import at_samples, evaluate
from ...metrics.run_metrics import Metrics
from ...simulation.many_runs import run_many
from ...simulation.simulate import simulate
from ...views.figure_options import PLAIN, FigureOptions
from ...views.metrics_table import DAMPINGS, Row, values, write_markdown, write_metrics
from ...views.signals_file import write_signals

DRAWN = ("tipin15", "tipin50", "tipout", "launch", "drive")
"""Of the manoeuvres that are compared unless others are named, those with a figure."""

Manoeuvres = Mapping[str, Manoeuvre]
"""By name."""


class Case(NamedTuple):
    """One run: a plant (name or file of an FMU), a manoeuvre by name, damping on or off."""

    plant: str
    manoeuvre: str
    control: bool

    def __str__(self) -> str:
        return f"{self.manoeuvre} on {self.plant_name}, damping {'on' if self.control else 'off'}"

    @property
    def plant_name(self) -> str:
        return Path(self.plant).stem

    @property
    def file_name(self) -> str:
        return f"{self.plant_name}_{self.manoeuvre}_{'on' if self.control else 'off'}"


class Outcome(NamedTuple):
    """A case that was run."""

    case: Case
    metrics: Metrics
    results: Results

    @property
    def row(self) -> Row:
        return Row(self.case.plant_name, self.case.manoeuvre, self.case.control, self.metrics)

    @property
    def record(self) -> dict[str, Any]:
        """The run for files: what it was, and all metrics by their keys."""
        return {
            "plant": self.case.plant_name,
            "manoeuvre": self.case.manoeuvre,
            "control": self.case.control,
            **values(self.metrics),
        }


def cases(plants: Sequence[str], manoeuvres: Sequence[str]) -> list[Case]:
    """All combinations, the runs without and with damping next to each other.

    Raises:
        DrivelineError: two plants have the same name, by which their files would be told apart.
    """
    require_different(plants)
    return [
        Case(plant, manoeuvre, control) for plant in plants for manoeuvre in manoeuvres for control in (False, True)
    ]


def run_case(
    case: Case,
    output: Path,
    settings: Mapping[str, Settings],
    manoeuvres: Manoeuvres = MANOEUVRES,
    format: str = "csv",
) -> Outcome:
    """Simulates a case, writes its signals at the controller's samples to the folder `output` and evaluates it."""
    manoeuvre = manoeuvres[case.manoeuvre]
    results = simulate(manoeuvre, settings[case.plant], control=case.control)
    write_signals(at_samples(results), output / case.file_name, format)
    return Outcome(case, evaluate(results, manoeuvre), results)


def run_cases(
    todo: Sequence[Case],
    output: Path,
    settings: Mapping[str, Settings],
    manoeuvres: Manoeuvres = MANOEUVRES,
    format: str = "csv",
) -> list[Outcome]:
    """Runs the cases in parallel; their outcomes in the order of the cases.

    Args:
        output: folder for the files of signals.
        settings: by the plants of the cases.
        format: of those files, one of `harness.views.signals_file.FORMATS`.
    """
    one = partial(run_case, output=output, settings=settings, manoeuvres=manoeuvres, format=format)
    return run_many(one, todo)


def write_tables(outcomes: Sequence[Outcome], folder: Path, title: str = DAMPINGS) -> list[Path]:
    """Writes the table as Markdown and all metrics as CSV; returns the files."""
    table, metrics = folder / "table.md", folder / "metrics.csv"
    write_markdown([outcome.row for outcome in outcomes], table, title)
    write_metrics([outcome.record for outcome in outcomes], metrics)
    return [table, metrics]


def write_figures(
    outcomes: Sequence[Outcome], folder: Path, options: FigureOptions = PLAIN, manoeuvres: Manoeuvres = MANOEUVRES
) -> list[Path]:
    """Draws steps close up and all else whole, but for the usual manoeuvres that are not `DRAWN`; returns the files."""
    from ...views.drive_figure import plot_drive  # not for the workers, which draw nothing
    from ...views.step_figure import plot_step

    def is_drawn(name: str) -> bool:
        usual = name in COMPARED and manoeuvres[name].description == MANOEUVRES[name].description
        return name in DRAWN or not usual

    pairs = zip(outcomes[::2], outcomes[1::2], strict=True)
    drawn, files = [(off, on) for off, on in pairs if is_drawn(off.case.manoeuvre)], list[Path]()
    with progress(len(drawn), "drawing") as done:
        for k, (off, on) in enumerate(drawn):
            done(k)
            manoeuvre, plant = manoeuvres[off.case.manoeuvre], off.case.plant_name
            plot = plot_drive if manoeuvre.dT is None else plot_step
            files += plot((off.results, on.results), manoeuvre, plant, folder / f"{plant}_{manoeuvre.name}", options)
    return files
