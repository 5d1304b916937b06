"""What bounds leave: a table on the terminal, the page, the figure, a record for tools."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...base.atomic_files import write_text
from ...loop.places import T_S
from ...views.metrics_table import values
from ...views.terminal import plain_table, print_table
from .bound_figure import plot_bounds
from .bound_page import SUMMARY, page, summary_rows
from .bounds import Bounded, Optimum
from .contacts import PARTS, Contacts


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
