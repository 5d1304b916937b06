"""What is shown and written of a campaign: tables on the terminal, the page, figures."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.table import Table

from ...base.atomic_files import write_text
from ...base.csv_file import write_csv, write_rows
from ...base.errors import SimulationError
from ...design.uncertainty_box import BOX, DOUBLINGS, LOSS, SCALED, SHORTEST, SPREAD, Deviation
from ...manoeuvres.catalogue import MANOEUVRES
from ...views.markdown import markdown_table
from ...views.metrics_table import write_metrics
from ...views.terminal import print_table
from .case_runs import CaseRunner
from .draws import draw
from .outcome import ROBUSTNESS_MANOEUVRES, SHOWN, VERDICTS, Outcome
from .robustness_figures import plot_distributions, plot_draw
from .summary import Summary, cells, goal, summaries

BRIEF = ("settling_time", "overshoot", "gear_torque_rms", "jerk_rms_to_50_Hz", "response_delay", "withheld_time")
"""The metrics on the terminal, which is not as wide as a page."""


def announce(outcomes: Sequence[Outcome]) -> None:
    """Prints the tables, one for each plant, and what they say of the first controller."""
    found = summaries(outcomes)
    for plant in dict.fromkeys(summary.plant for summary in found):
        its = [summary for summary in found if summary.plant == plant]
        title = f"{plant}, {len(its[0].outcomes)} draws: half / 95 % of the runs do not exceed"
        table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, padding=0)
        table.add_column("controller", no_wrap=True)
        for heading, unit in (("bounded\nand quiet", "%"), ("\ngood", "%"), *(SHOWN[name][:2] for name in BRIEF)):
            table.add_column(f"{heading}\n{unit}", justify="right", no_wrap=True)
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


def write(outcomes: Sequence[Outcome], runner: CaseRunner, arguments: str, caption: str, folder: Path) -> list[Path]:
    """Writes the draws, the summary and the page, and draws the figures; returns the files.

    Args:
        arguments: of the command beside how many cases, for the page.
        caption: what was set, in small below the figures.
    """
    found, figures = summaries(outcomes), folder / "figures"
    draws, summary, text = folder / "draws.csv", folder / "summary.csv", folder / "robustness.md"
    numbers = sorted({outcome.case.number for outcome in outcomes})
    drawn = [draw(number, runner.seed) for number in numbers]
    write_rows(["number", "noise", *Deviation._fields], ([d.number, d.noise, *d.deviation] for d in drawn), draws)
    write_metrics([each.record for each in found], summary)
    files = [draws, summary, text]
    for plant in dict.fromkeys(each.plant for each in found):
        files += plot_distributions(found, plant, caption, figures / f"robustness_{plant}")
    drawn_figures = []
    for each in found:
        if each.controller == found[0].controller and not each.worst.reason:
            with suppress(SimulationError):  # a car that is not fit to be driven without damping
                files += plot_draw(runner, each.worst.case, caption, figures / figure_name(each))
                drawn_figures.append(each)
    write_text(page(found, runner.seed, arguments, drawn_figures), text)
    return files


def write_draw(outcomes: Sequence[Outcome], runner: CaseRunner, caption: str, folder: Path) -> list[Path]:
    """Runs the cases of a draw with the first controller again, writes their signals and draws them."""
    files: list[Path] = []
    first = outcomes[0].case.controller
    for outcome in outcomes:
        case = outcome.case
        if case.controller == first and not outcome.reason:
            stem = folder / f"draw_{case.number}_{case.plant}_{case.manoeuvre}"
            files.append(stem.with_suffix(".csv"))
            write_csv(runner.results(case), files[-1])
            files += plot_draw(runner, case, caption, stem)
    return files


PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")
PLANT = Path(__file__).with_name("robustness_report_plant.md").read_text(encoding="utf-8")


def page(summaries: Sequence[Summary], seed: int, arguments: str, drawn: Sequence[Summary]) -> str:
    """The page as Markdown.

    Args:
        arguments: of the command, beside how many cases.
        drawn: those of which there is a figure of the worst draw.
    """
    count, controller = len(summaries[0].outcomes), summaries[0].controller
    plants = list(dict.fromkeys(summary.plant for summary in summaries))
    own = [summary for summary in summaries if summary.controller == controller]
    return PAGE.format(
        arguments=arguments,
        cases=count,
        runs=count * len(summaries),
        manoeuvres="\n".join(f"- `{name}`: {MANOEUVRES[name].description}" for name in ROBUSTNESS_MANOEUVRES),
        box=markdown_table(["what", "least", "most", "spread evenly"], _box(), labels=1),
        spread=1e3 * SPREAD,
        shortest=1e3 * SHORTEST,
        loss=100.0 * LOSS,
        scaled="\n".join(f"- {name}: {', '.join(f'`{each}`' for each in names)}" for name, names in SCALED.items()),
        verdicts="\n".join(f"- *{name}*: {meaning}." for name, meaning in VERDICTS.items()),
        three=min(300.0 / count, 100.0),
        results="\n\n".join(_of_plant(plant, summaries, controller) for plant in plants),
        controller=controller,
        worst=markdown_table(["plant", "manoeuvre", "draw"], _worst(own, seed), labels=3),
        figures="\n".join(f"![{s.plant}, {s.manoeuvre}](figures/{figure_name(s)}.png)" for s in drawn),
    )


def figure_name(summary: Summary) -> str:
    """Of the figure of the worst draw of a summary."""
    return f"worst_{summary.plant}_{summary.manoeuvre}"


def _box() -> Iterator[list[str]]:
    units = {"delay": "s", "o_T": "N.m"}
    for name, (low, high) in BOX.items():
        unit = f" in {units[name]}" if name in units else ""
        yield [f"`{name}`{unit}", f"{low:g}", f"{high:g}", "by factors" if name in DOUBLINGS else "by differences"]


def _of_plant(plant: str, summaries: Sequence[Summary], controller: str) -> str:
    its = [summary for summary in summaries if summary.plant == plant]
    metrics = (f"{column.plain_heading}, {column.unit}" for column in SHOWN.values())
    headings = ["controller", "bounded and quiet, %", "good, %", *metrics]
    tables = [
        f"{name}:\n\n"
        + markdown_table(headings, ([s.controller, *cells(s)] for s in its if s.manoeuvre == name), labels=1)
        for name in dict.fromkeys(summary.manoeuvre for summary in its)
    ]
    return PLANT.format(
        plant=plant, tables="\n\n".join(tables), controller=controller, goal=goal(its, plant, controller)
    ).strip()


def _worst(own: Sequence[Summary], seed: int) -> Iterator[list[str]]:
    for summary in own:
        yield [summary.plant, summary.manoeuvre, str(draw(summary.worst.case.number, seed))]
