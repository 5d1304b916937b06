"""The page that `driveline study bound` writes."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from ...loop.places import T_S
from ...metrics.declaration import Column, declared
from ...metrics.evaluate import WITHHELD
from ...metrics.run_metrics import Metrics
from ...views.markdown import markdown_table
from ...views.metrics_table import number
from .active_constraints import SWING_RESERVE
from .bound_task import BOUNDED
from .bounds import Bounded
from .constraints import RESERVE
from .contacts import PARTS, Contacts
from .switching_search import BORDER

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")

COLUMNS = {metric.name: metric.column for metric in declared(Metrics) if metric.column} | {
    "gear_torque_rms": Column("torque\n5-50 Hz", "N.m", 1.0, 2),
    "jerk_rms_to_50_Hz": Column("jerk\nto 50 Hz", "m/s3", 1.0, 2),
    "overshoot": Column("over-\nshoot", "%", 1e2, 1),
}

SHOWN = (*BOUNDED, "settling_time", "response_delay", "withheld_time")

GRID = 1e3 * T_S / PARTS
"""Of the switching times, in ms."""

SUMMARY = (
    "manoeuvre",
    "controller / optimum",
    "at most",
    "contacts, ms",
    "optimum, ms",
    "looked at",
    "deviation, N.m",
)


def page(found: Sequence[Bounded], controller: str, arguments: str) -> str:
    """The page as Markdown; arguments: of the command beside --output."""
    return PAGE.format(
        controller=controller,
        arguments=arguments,
        withheld=WITHHELD,
        summary=markdown_table(SUMMARY, summary_rows(found), labels=1),
        metrics=", ".join(COLUMNS[name].plain_heading for name in BOUNDED),
        every=markdown_table(["manoeuvre", "", *map(_heading, SHOWN)], _rows(found), labels=2),
        grid=GRID,
        border=BORDER - 1.0,
        reserve=RESERVE,
        swing=SWING_RESERVE,
    )


def summary_rows(found: Sequence[Bounded]) -> Iterator[list[str]]:
    """What is possible in each manoeuvre, beside the controller."""
    for each in found:
        yield [
            each.task.manoeuvre.name,
            f"{1.0 / each.ratio(each.jointly):.3f}",
            f"{1.0 / each.bound:.3f}",
            _times(each.task.contacts),
            _times(each.jointly.contacts),
            str(each.neighbours),
            f"{each.jointly.deviation:.1g}",
        ]


def _times(contacts: Contacts) -> str:
    """Of the changes, in ms after the step."""
    return " / ".join(f"{1e3 * T_S + GRID * end:g}" for end in contacts.ends) or "-"


def _rows(found: Sequence[Bounded]) -> Iterator[list[str]]:
    for each in found:
        runs = {"controller": each.task.reached, "jointly": each.jointly.metrics}
        runs |= {f"{COLUMNS[name].plain_heading} alone": optimum.metrics for name, optimum in each.alone.items()}
        for name, metrics in runs.items():
            cells = (number(getattr(metrics, shown), COLUMNS[shown]) for shown in SHOWN)
            yield [each.task.manoeuvre.name, name, *cells]


def _heading(name: str) -> str:
    column = COLUMNS[name]
    return f"{column.plain_heading}, {column.unit}"
