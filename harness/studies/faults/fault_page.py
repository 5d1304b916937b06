"""The documentation page that `driveline faults` writes."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from ...views.markdown import markdown_table
from .evidence import REFERENCE_AFTER, SHARE, WRONG_SPEED
from .fault_campaign import Outcome, count
from .fault_cases import DURATION, SITUATIONS
from .fault_catalogue import KINDS
from .judges import BACK, JUDGES, LEAST_RMS, LEAST_SWING, Judge

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")


def page(outcomes: Sequence[Outcome], arguments: str) -> str:
    """The page as Markdown.

    Args:
        arguments: of the command, beside how many cases.
    """
    singles = [outcome for outcome in outcomes if len(outcome.kinds) == 1]
    pairs = [outcome for outcome in outcomes if len(outcome.kinds) == 2]
    failed = sum(bool(outcome.failed) for outcome in outcomes)
    return PAGE.format(
        arguments=arguments,
        duration=DURATION,
        cases=len(outcomes),
        clean=len(outcomes) - failed,
        failed=failed,
        singles=len(singles),
        pairs=len(pairs),
        kinds=markdown_table(["kind", "what"], ((kind.name, kind.meaning) for kind in KINDS.values()), labels=2),
        situations=markdown_table(
            ["situation", "where", "between, s"],
            ((s.name, s.description, f"{s.first:g} and {s.last:g}") for s in SITUATIONS.values()),
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
    for kind in KINDS:
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
