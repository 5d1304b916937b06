"""How a campaign is on file: its runs by their cases."""

from collections.abc import Sequence
from math import nan

from ...simulation.case_archive import Table
from .outcome import METRICS, Case, Outcome


def _cells(case: Case, outcome: Outcome) -> list[object]:
    values = (outcome.measured[metric.name] for metric in METRICS)
    return [*case, *("" if value != value else repr(value) for value in values), outcome.reason]


def _parsed(cells: Sequence[str]) -> tuple[Case, Outcome]:
    plant, controller, number, manoeuvre, *values, reason = cells
    case = Case(plant, controller, int(number), manoeuvre)
    measured = {m.name: float(value) if value else nan for m, value in zip(METRICS, values, strict=True)}
    return case, Outcome(case, measured, reason)


RUNS = Table([*Case._fields, *(metric.key for metric in METRICS), "reason"], _cells, _parsed)
