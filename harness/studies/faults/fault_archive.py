"""How a campaign is on file: its cases with what was measured."""

from collections.abc import Sequence

from ...simulation.case_archive import Table
from .fault_campaign import Outcome
from .fault_cases import Case, case
from .judges import JUDGES


def table(seed: int, plants: Sequence[str]) -> Table[Case, Outcome]:
    """Of the campaign with this seed on these plants: a line has all of a case, which must be that of its number."""

    def parsed(cells: Sequence[str]) -> tuple[Case, Outcome]:
        measured = (float(cell) for cell in cells[-1 - len(JUDGES) : -1])
        each = case(int(cells[0]), seed, plants)
        outcome = Outcome(each, {judge.name: value for judge, value in zip(JUDGES, measured, strict=True)})
        if _cells(each, outcome) != list(cells):
            raise ValueError
        return each, outcome

    first = Outcome(case(1, seed, plants), {judge.name: 0.0 for judge in JUDGES})
    return Table([*first.record], _cells, parsed, "the case of its number and what was measured")


def _cells(_: Case, outcome: Outcome) -> list[str]:
    """With all digits, and what is not finite too."""
    measured = {name.replace(" ", "_"): value for name, value in outcome.measured.items()}
    return [_text(value) for value in (outcome.record | measured).values()]


def _text(value: object) -> str:
    return "" if value is None else str(int(value)) if isinstance(value, bool) else str(value)
