"""What a campaign leaves: a table on the terminal, signals of a case, figures."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from textwrap import fill

from rich.box import SIMPLE_HEAD
from rich.table import Table

from toolground.csv_file import write_csv
from toolground.plain_text import printed
from toolground.tables import print_table

from .fault_campaign import Outcome, count, coverage, judged, plan_of
from .fault_cases import PLANS, Plan, case
from .fault_figures import plot_case, plot_matrix, plot_pairs
from .fault_injection import FaultRunner
from .judges import JUDGES


def announce(outcomes: Sequence[Outcome]) -> None:
    """Prints the rows of the matrix that are not clean, if there are any, a summary, and the kinds that no case has
    alone; of a single case, what each judge measured."""
    if len(outcomes) == 1:
        print_table(_verdicts(outcomes[0]))
        print("not clean is what is above its limit; what is below 0 stays within by so much")
        return
    table = Table(title="cases that are not clean", title_justify="left", box=SIMPLE_HEAD, padding=0)
    for heading in HEADINGS:
        table.add_column(heading, justify="left" if heading == "kind" else "right", no_wrap=heading == "kind")
    failed = sum(bool(outcome.failed) for outcome in outcomes)
    for row in matrix_rows(outcomes):
        if row[NOT_CLEAN] != "0":
            table.add_row(*row)
    if failed:
        print_table(table)
    print(f"{len(outcomes)} cases, {len(outcomes) - failed} clean, {failed} not clean")
    if not_all := coverage(outcomes):
        print(fill(not_all, 78))


def _verdicts(outcome: Outcome) -> Table:
    table = Table(box=SIMPLE_HEAD)
    for heading in ("judge", "measured", "limit", "unit", "", "what it measures"):
        table.add_column(heading, justify="right" if heading in ("measured", "limit") else "left")
    for judge in JUDGES:
        verdict = "[red]not clean[/red]" if judge.name in outcome.failed else "clean"
        limit, unit = f"{round(judge.limit, 6):g}", printed(judge.unit)
        table.add_row(judge.name, f"{outcome.measured[judge.name]:.3g}", limit, unit, verdict, judge.question)
    return table


def write(outcomes: Sequence[Outcome], folder: Path) -> list[Path]:
    """Draws the matrices; returns the files."""
    figures = folder / "figures"
    files = plot_matrix(outcomes, "single faults: runs that are not clean", figures / "faults")
    return [*files, *plot_pairs(outcomes, "pairs of faults: runs that are not clean", figures / "fault_pairs")]


def write_case(
    number: int, seed: int, runner: FaultRunner, folder: Path, caption: str = "", plan: Plan = PLANS["dry"]
) -> tuple[Outcome, list[Path]]:
    """Runs one case again, writes its signals and draws them.

    Args:
        seed, plan: of the campaign.
        caption: what was set, in small below the figure.
    """
    each = case(number, seed, runner.plants, plan)
    runs = runner.runs(each)
    outcome = judged(runner, each, runs)
    stem = folder / f"case_{number}"
    files = [stem.with_suffix(".csv")]
    write_csv(runs.faulty, files[0])
    verdict = f"not clean: {', '.join(outcome.failed)}" if outcome.failed else "clean"
    return outcome, [*files, *plot_case(each, runs, verdict, stem, caption)]


HEADINGS = ("kind", *(judge.name for judge in JUDGES), "not clean", "cases")
NOT_CLEAN = HEADINGS.index("not clean")


def matrix_rows(outcomes: Sequence[Outcome]) -> Iterator[list[str]]:
    """For each kind how many cases each judge found not clean, how many any, and how many there are."""
    for kind in plan_of(outcomes).kinds:
        failed, total = count(outcomes, kind)
        yield [kind, *(str(count(outcomes, kind, judge.name)[0] or "") for judge in JUDGES), str(failed), str(total)]
