"""What is shown and written of a campaign: tables on the terminal, tables as CSV, figures."""

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.table import Table

from fmuloop.errors import SimulationError
from toolground.csv_file import write_csv, write_rows
from toolground.plain_text import printed
from toolground.tables import print_table

from ...design.uncertainty_box import Deviation
from ...views.metrics_table import write_metrics
from .case_runs import CaseRunner
from .draws import draw
from .outcome import SHOWN, Outcome
from .robustness_figures import plot_distributions, plot_draw
from .summary import Summary, cells, goal, summaries

BRIEF = ("settling_time", "overshoot", "gear_torque_rms", "jerk_rms_to_50_Hz", "response_delay", "withheld_time")
"""The metrics on the terminal, which is not wide."""


def announce(outcomes: Sequence[Outcome]) -> None:
    """Prints the tables, one for each plant, and what they say of the first controller."""
    found = summaries(outcomes)
    for plant in dict.fromkeys(summary.plant for summary in found):
        its = [summary for summary in found if summary.plant == plant]
        title = f"{plant}, {len(its[0].outcomes)} draws: half / 95 % of the runs do not exceed"
        table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, padding=0)
        table.add_column("controller", no_wrap=True)
        for heading, unit in (("bounded\nand quiet", "%"), ("\ngood", "%"), *(SHOWN[name][:2] for name in BRIEF)):
            table.add_column(f"{heading}\n{printed(unit)}", justify="right", no_wrap=True)
        for k, summary in enumerate(its):
            if k == 0 or summary.manoeuvre != its[k - 1].manoeuvre:
                table.add_section()
                table.add_row(f"[bold]{summary.manoeuvre}[/bold]")
            table.add_row(summary.controller, *cells(summary, BRIEF))
        print_table(table)
        first = its[0].controller
        goals = goal(its, plant, first)
        print(f"{plant}, {first}: bounded and quiet; 95 % of settling of tip-in / launch: {goals}\n")
    for reason in dict.fromkeys(outcome.reason for outcome in outcomes if outcome.reason):
        cases = [str(outcome.case) for outcome in outcomes if outcome.reason == reason]
        print(f"- no metrics of {len(cases)} runs, the first {cases[0]}: {reason}")


def write(outcomes: Sequence[Outcome], runner: CaseRunner, caption: str, folder: Path) -> list[Path]:
    """Writes the draws and the summary, and draws the figures; returns the files.

    Args:
        caption: what was set, in small below the figures.
    """
    found, figures = summaries(outcomes), folder / "figures"
    draws, summary = folder / "draws.csv", folder / "summary.csv"
    numbers = sorted({outcome.case.number for outcome in outcomes})
    drawn = [draw(number, runner.seed) for number in numbers]
    write_rows(["number", "noise", *Deviation._fields], ([d.number, d.noise, *d.deviation] for d in drawn), draws)
    write_metrics([each.record for each in found], summary)
    files = [draws, summary]
    for plant in dict.fromkeys(each.plant for each in found):
        files += plot_distributions(found, plant, caption, figures / f"robustness_{plant}".replace(" ", "_"))
    for each in found:
        if each.controller == found[0].controller and not each.worst.reason:
            with suppress(SimulationError):  # a car that is not fit to be driven without damping
                files += plot_draw(runner, each.worst.case, caption, figures / figure_name(each))
    return files


def write_draw(outcomes: Sequence[Outcome], runner: CaseRunner, caption: str, folder: Path) -> list[Path]:
    """Runs the cases of a draw with the first controller again, writes their signals and draws them."""
    files: list[Path] = []
    first = outcomes[0].case.controller
    for outcome in outcomes:
        case = outcome.case
        if case.controller == first and not outcome.reason:
            stem = folder / f"draw_{case.number}_{case.plant}_{case.manoeuvre}".replace(" ", "_")
            files.append(stem.with_suffix(".csv"))
            write_csv(runner.results(case), files[-1])
            files += plot_draw(runner, case, caption, stem)
    return files


def figure_name(summary: Summary) -> str:
    """Of the figure of the worst draw of a summary."""
    return f"worst_{summary.plant}_{summary.manoeuvre}".replace(" ", "_")
