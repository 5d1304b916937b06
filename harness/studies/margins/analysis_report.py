"""What an analysis leaves: a table on the terminal, margins and sensitivities as CSV, figures."""

from collections.abc import Iterator
from math import isfinite
from pathlib import Path
from textwrap import fill

from toolground.csv_file import write_rows
from toolground.tables import plain_table, print_table

from ...metrics.declaration import declared
from ...views.figure_style import draw
from ...views.metrics_table import number
from .describing_function import LimitCycle
from .linear_figures import backlash, bode, plot_nyquist, plot_poles
from .loop_analysis import SPEEDS, Analysis
from .margins import Margins
from .modes import MEANT
from .sensitivity import SHOWN, plot_sensitivity


def announce(found: Analysis) -> None:
    """Prints the margins, and what the describing function says."""
    print_table(plain_table(f"the loop with {found.controller}", margin_headings(), margin_rows(found), labels=2))
    print(f"drive train: {MEANT}")
    print("limit cycles through the gap, by the describing function:")
    for line in _limit_cycles(found):
        print(fill(line, 78, subsequent_indent="  "))


def write(found: Analysis, folder: Path) -> list[Path]:
    """Writes margins and sensitivities as CSV and the figures; returns the files."""
    margins, sensitivities, figures = folder / "margins.csv", folder / "sensitivity.csv", folder / "figures"
    write_rows(margin_headings(), margin_rows(found), margins)
    cells = ([e.plant, e.manoeuvre, e.parameter, *(f"{e.changes[n]:.4g}" for n in SHOWN)] for e in found.sensitivities)
    write_rows(["plant", "manoeuvre", "parameter", *SHOWN], cells, sensitivities)
    loops = {at.plant: (at.loop, at.margins) for at in found.at if at.speed == SPEEDS[1]}
    name = f"{found.controller} at {SPEEDS[1]:g} km/h"
    return [
        margins,
        sensitivities,
        *draw(bode(loops, f"{name}: loop gain"), figures / "analysis_bode"),
        *plot_nyquist(loops, f"{name}: loop gain", figures / "analysis_nyquist"),
        *plot_poles(found.swept, f"{name}: poles of the closed loop", figures / "analysis_poles"),
        *draw(backlash(found.swings, f"{name}: swinging through the gap"), figures / "analysis_backlash"),
        *plot_sensitivity(
            found.sensitivities, f"{found.controller}: sensitivity of the metrics", figures / "analysis_sensitivity"
        ),
    ]


SMALLEST = ("gain_margin", "delay_margin")


def _headings(record: type) -> list[str]:
    return [metric.column.titled for metric in declared(record) if metric.column]


def margin_headings() -> list[str]:
    """Of the table of margins."""
    return ["plant", "speed, km/h", "drive train, Hz", "damping ratio", *_headings(Margins)]


def margin_rows(found: Analysis) -> Iterator[list[str]]:
    """The margins of each plant at each speed."""
    for at in found.at:
        yield [
            at.plant,
            f"{at.speed:g}",
            f"{at.mode.frequency:.2f}",
            f"{at.mode.damping_ratio:.2f}",
            *_cells(at.margins),
        ]


def _cells(record: object) -> list[str]:
    shown = [(metric.of(record), metric.column) for metric in declared(type(record)) if metric.column]
    return ["any" if value == float("inf") else number(value, column) for value, column in shown]


def _finite(value: float, factor: float, decimals: int) -> str:
    return f"{factor * value:.{decimals}f}" if isfinite(value) else "any"


def _limit_cycles(found: Analysis) -> Iterator[str]:
    """A sentence or two for each plant."""
    for plant, cycles in found.limit_cycles.items():
        known = [(swing.amplitude, swing.margins) for swing in found.swings[plant] if swing.margins]
        line = f"- {plant}: {'; '.join(map(_cycle, cycles)) or 'none at any amplitude'}."
        if known:
            gain, delay = (min(known, key=lambda each: getattr(each[1], name)) for name in SMALLEST)
            line += (
                f" Where swings die away the smallest gain margin is {_finite(gain[1].gain_margin, 1.0, 1)} "
                f"({_where(gain[0])}), the smallest delay margin {_finite(delay[1].delay_margin, 1e3, 1)} ms "
                f"({_where(delay[0])})."
            )
        yield line


def _cycle(cycle: LimitCycle) -> str:
    kind = "one that lasts" if cycle.lasting else "one from which larger swings grow"
    return f"{kind}, {cycle.amplitude:.2f} φ_B at {cycle.frequency:.2g} Hz (N = {cycle.N:.2g})"


def _where(amplitude: float) -> str:
    return f"at {amplitude:.3g} φ_B" if isfinite(amplitude) else "in contact"
