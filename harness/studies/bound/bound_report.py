"""What bounds leave: a table on the terminal, the page, the figure, a record for tools."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...base.atomic_files import write_text
from ...loop.places import T_S
from ...metrics.declaration import Column, declared
from ...metrics.evaluate import WITHHELD, at_samples
from ...metrics.run_metrics import Metrics
from ...views.colours import BLACK, BLUE, GREY, VERMILION
from ...views.figure_style import plot
from ...views.markdown import markdown_table
from ...views.metrics_table import number, values
from ...views.panels import DASHED, Axis, Curve, Panel
from ...views.terminal import plain_table, print_table
from .active_constraints import SWING_RESERVE
from .bound_task import BOUNDED
from .bounds import Bounded, Optimum
from .constraints import RESERVE
from .contacts import PARTS, Contacts
from .switching_search import BORDER


def announce(found: Sequence[Bounded], controller: str) -> None:
    """Prints what is possible in each manoeuvre."""
    print_table(plain_table(f"{controller} and what is possible", SUMMARY, summary_rows(found)))


def write(found: Sequence[Bounded], controller: str, arguments: str, folder: Path) -> list[Path]:
    """Writes the page and the figure; returns the files.

    Args:
        arguments: of the command beside --output, for the page.
    """
    text = folder / "bound.md"
    write_text(page(found, controller, arguments), text)
    title = f"{controller} and the best that is possible, design model"
    return [text, *plot_bounds(found, controller, title, folder / "figures" / "bound")]


def record(found: Bounded) -> dict[str, Any]:
    """All that was found for a manoeuvre, in SI units."""
    return {
        "manoeuvre": found.task.manoeuvre.name,
        "controller": _run(found.task.contacts) | values(found.task.reached),
        "jointly": _optimum(found.jointly) | {"ratio": found.ratio(found.jointly), "bound": found.bound},
        "neighbours": found.neighbours,
        "alone": {name: _optimum(optimum) for name, optimum in found.alone.items()},
    }


def _run(contacts: Contacts) -> dict[str, Any]:
    return {"contacts_s": [T_S * (1.0 + end / PARTS) for end in contacts.ends]}


def _optimum(optimum: Optimum) -> dict[str, Any]:
    return _run(optimum.contacts) | {"deviation_N_m": optimum.deviation} | values(optimum.metrics)


AFTER = Axis("time after the step in ms", (-10.0, 250.0))


def plot_bounds(found: Sequence[Bounded], controller: str, title: str, stem: Path) -> list[Path]:
    """A column for each manoeuvre; returns the files."""
    rows = list(zip(*(_panels(each, controller) for each in found), strict=True))
    size = 2.2 * len(found) + 1.2, 1.9
    return plot(rows, AFTER, title, stem, size=size, key=min(5, 2 * len(found)), same_y=False)


def _panels(found: Bounded, controller: str) -> list[Panel]:
    task, t_0 = found.task, found.task.manoeuvre.t_0
    runs = ((task.results, controller, BLUE), (found.jointly.results, "best possible", VERMILION))
    t = at_samples(task.results, T_S)["time"]
    demand = Curve(1e3 * (t - t_0), np.asarray(task.manoeuvre.T_driver(t), float), "demand", BLACK, DASHED, 0.8, True)
    limited = 1e3 * (task.times[: len(task.lower)] - t_0)
    limits = [Curve(limited, limit, "limits", GREY, width=0.8, held=True) for limit in (task.lower, task.upper)]

    def curves(column: str, held: bool) -> list[Curve]:
        sampled = ((at_samples(results, T_S), name, color) for results, name, color in runs)
        return [Curve(1e3 * (of["time"] - t_0), of[column], name, color, held=held) for of, name, color in sampled]

    heading = f"{task.manoeuvre.name}\n{1.0 / found.ratio(found.jointly):.2f} times the optimum"
    return [
        Panel("torque reference\nin N·m", [*limits, *curves("controller.T_ref", True), demand], heading),
        Panel("gear torque\nin N·m", [*curves("plant.T_gear", False), demand]),
    ]


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
