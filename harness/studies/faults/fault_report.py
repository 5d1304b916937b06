"""What a campaign leaves: a table on the terminal, files, figures."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from textwrap import fill

from rich.box import SIMPLE_HEAD
from rich.table import Table

from ...base.atomic_files import write_text
from ...base.csv_file import write_csv
from ...views.markdown import markdown_table
from ...views.terminal import print_table
from .evidence import REFERENCE_AFTER, SHARE, WRONG_SPEED
from .fault_campaign import Outcome, count, coverage, judged, plan_of
from .fault_cases import PLANS, Plan, case
from .fault_catalogue import NOTHING
from .fault_figures import plot_case, plot_matrix, plot_pairs
from .fault_injection import FaultRunner
from .judges import BACK, JUDGES, LEAST_RMS, LEAST_SWING, Judge


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
        limit = f"{round(judge.limit, 6):g}"
        table.add_row(judge.name, f"{outcome.measured[judge.name]:.3g}", limit, judge.unit, verdict, judge.question)
    return table


def write(outcomes: Sequence[Outcome], arguments: str, folder: Path) -> list[Path]:
    """Writes the page, and the matrices as figures; returns the files.

    Args:
        arguments: of the command beside how many cases, for the page.
    """
    text, figures = folder / "faults.md", folder / "figures"
    write_text(page(outcomes, arguments), text)
    files = [text, *plot_matrix(outcomes, "single faults: runs that are not clean", figures / "faults")]
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
    outcome = judged(each, runs, runner.limits(each.plant))
    stem = folder / f"case_{number}"
    files = [stem.with_suffix(".csv")]
    write_csv(runs.faulty, files[0])
    verdict = f"not clean: {', '.join(outcome.failed)}" if outcome.failed else "clean"
    return outcome, [*files, *plot_case(each, runs, verdict, stem, caption)]


PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")


def page(outcomes: Sequence[Outcome], arguments: str) -> str:
    """The page as Markdown.

    Args:
        arguments: of the command, beside how many cases.
    """
    singles = [outcome for outcome in outcomes if len(outcome.kinds) == 1]
    pairs = [outcome for outcome in outcomes if len(outcome.kinds) == 2]
    nothing = sum(NOTHING.name in outcome.kinds for outcome in singles)
    failed = sum(bool(outcome.failed) for outcome in outcomes)
    plan, not_all = plan_of(outcomes), coverage(outcomes)
    durations = sorted({situation.duration for situation in plan.situations.values()})
    return PAGE.format(
        arguments=arguments,
        duration=" to ".join(f"{end:g}" for end in dict.fromkeys((durations[0], durations[-1]))),
        stays=f" Of all faults {100.0 * plan.to_the_end:g} % last to the end of the run." if plan.to_the_end else "",
        cases=len(outcomes),
        clean=len(outcomes) - failed,
        failed=failed,
        nothing=f"{nothing} have no fault, " if nothing else "",
        singles=len(singles) - nothing,
        pairs=len(pairs),
        coverage=not_all and f"\n{not_all}",
        kinds=markdown_table(["kind", "what"], ((kind.name, kind.meaning) for kind in plan.kinds.values()), labels=2),
        situations=markdown_table(
            ["situation", "where", "between, s"],
            ((s.name, s.description, f"{s.first:g} and {s.last:.3g}") for s in plan.situations.values()),
            labels=2,
        ),
        off=WRONG_SPEED,
        share=100.0 * SHARE,
        reference_after=REFERENCE_AFTER,
        back=BACK,
        least_rms=LEAST_RMS,
        least_swing=LEAST_SWING,
        judges=markdown_table(["judge", "what it measures", "unit", "limit"], map(_judge, JUDGES), labels=3),
        matrix=_matrix(singles),
        pair_matrix=_matrix(pairs),
        classes=_classes(singles),
        pair_classes=_classes(pairs),
    )


def _judge(judge: Judge) -> list[str]:
    return [judge.name, judge.question, judge.unit, f"{round(judge.limit, 6):g}"]


HEADINGS = ("kind", *(judge.name for judge in JUDGES), "not clean", "cases")
NOT_CLEAN = HEADINGS.index("not clean")


def matrix_rows(outcomes: Sequence[Outcome]) -> Iterator[list[str]]:
    """For each kind how many cases each judge found not clean, how many any, and how many there are."""
    for kind in plan_of(outcomes).kinds:
        failed, total = count(outcomes, kind)
        yield [kind, *(str(count(outcomes, kind, judge.name)[0] or "") for judge in JUDGES), str(failed), str(total)]


def _matrix(outcomes: Sequence[Outcome]) -> str:
    return markdown_table(HEADINGS, matrix_rows(outcomes), labels=1)


def _classes(outcomes: Sequence[Outcome]) -> str:
    """What is not clean: by kinds, judge, situation and plant, with the worst case."""
    found: dict[tuple[str, ...], list[Outcome]] = {}
    for outcome in outcomes:
        for judge in outcome.failed:
            key = " + ".join(sorted(outcome.kinds)), judge, outcome.case.situation, outcome.plant
            found.setdefault(key, []).append(outcome)
    if not found:
        return f"All {len(outcomes)} cases are clean." if outcomes else "There are no cases."
    units = {judge.name: judge.unit for judge in JUDGES}
    rows = []
    for (kind, judge, situation, plant), cases in sorted(found.items()):
        worst = max(cases, key=lambda each: each.measured[judge])
        value = f"{worst.measured[judge]:.3g}" + ("" if units[judge] == "1" else f" {units[judge]}")
        rows.append([kind, situation, plant, judge, str(len(cases)), value, str(worst.case.number)])
    return markdown_table(["kind", "begin", "plant", "judge", "cases", "worst", "its number"], rows, labels=4)
