"""What an analysis leaves: a table on the terminal, the page, a table of sensitivities, figures."""

from pathlib import Path

from ...base.atomic_files import write_text
from ...base.csv_file import write_rows
from ...views.terminal import plain_table, print_table
from .analysis_page import margin_headings, margin_rows, page
from .linear_figures import plot_backlash, plot_bode, plot_nyquist, plot_poles
from .loop_analysis import SPEEDS, Analysis
from .sensitivity import SHOWN
from .sensitivity_figure import plot_sensitivity


def announce(found: Analysis) -> None:
    """Prints the margins."""
    print_table(plain_table(f"the loop with {found.controller}", margin_headings(), margin_rows(found)))


def write(found: Analysis, arguments: str, folder: Path) -> list[Path]:
    """Writes the page, the sensitivities as CSV and the figures; returns the files.

    Args:
        arguments: of the command beside --output, for the page.
    """
    text, table, figures = folder / "analysis.md", folder / "sensitivity.csv", folder / "figures"
    write_text(page(found, arguments), text)
    cells = ([e.plant, e.manoeuvre, e.parameter, *(f"{e.changes[n]:.4g}" for n in SHOWN)] for e in found.sensitivities)
    write_rows(["plant", "manoeuvre", "parameter", *SHOWN], cells, table)
    loops = {at.plant: (at.loop, at.margins) for at in found.at if at.speed == SPEEDS[1]}
    name = f"{found.controller} at {SPEEDS[1]:g} km/h"
    return [
        text,
        table,
        *plot_bode(loops, f"{name}: loop gain", figures / "analysis_bode"),
        *plot_nyquist(loops, f"{name}: loop gain", figures / "analysis_nyquist"),
        *plot_poles(found.swept, f"{name}: poles of the closed loop", figures / "analysis_poles"),
        *plot_backlash(found.swings, f"{name}: swinging through the gap", figures / "analysis_backlash"),
        *plot_sensitivity(
            found.sensitivities, f"{found.controller}: sensitivity of the metrics", figures / "analysis_sensitivity"
        ),
    ]
