"""What an analysis leaves: a table on the terminal, the page, a table of sensitivities, figures."""

from collections.abc import Iterator
from math import isfinite, isnan
from pathlib import Path

from ...base.atomic_files import write_text
from ...base.csv_file import write_rows
from ...manoeuvres.catalogue import MANOEUVRES
from ...metrics.declaration import declared
from ...metrics.estimate import EstimateMetrics
from ...metrics.run_metrics import Metrics
from ...views.figure_style import draw
from ...views.markdown import markdown_table
from ...views.metrics_table import number
from ...views.terminal import plain_table, print_table
from .describing_function import LimitCycle
from .linear_figures import backlash, bode, plot_nyquist, plot_poles
from .loop_analysis import SPEEDS, TORQUE, Analysis
from .margins import Margins
from .parameter_sweeps import SWEEPS
from .sensitivity import SHOWN, most_important, plot_sensitivity


def announce(found: Analysis) -> None:
    """Prints the margins."""
    print_table(plain_table(f"the loop with {found.controller}", margin_headings(), margin_rows(found), labels=2))


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
        *draw(bode(loops, f"{name}: loop gain"), figures / "analysis_bode"),
        *plot_nyquist(loops, f"{name}: loop gain", figures / "analysis_nyquist"),
        *plot_poles(found.swept, f"{name}: poles of the closed loop", figures / "analysis_poles"),
        *draw(backlash(found.swings, f"{name}: swinging through the gap"), figures / "analysis_backlash"),
        *plot_sensitivity(
            found.sensitivities, f"{found.controller}: sensitivity of the metrics", figures / "analysis_sensitivity"
        ),
    ]


PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")


def page(found: Analysis, arguments: str) -> str:
    """The page as Markdown; arguments: of the command beside --output."""
    return PAGE.format(
        controller=found.controller,
        arguments=arguments,
        torque=TORQUE,
        margins=markdown_table(margin_headings(), margin_rows(found), labels=1),
        swept=markdown_table(["plant", "what", "value", *SWEPT], _swept_rows(found), labels=2),
        excluded=_excluded(found),
        estimates=markdown_table(["plant", "manoeuvre", *_headings(EstimateMetrics)], _estimate_rows(found), labels=2),
        most=MOST,
        sensitivities=markdown_table(
            ["parameter", "plant", "manoeuvre", *_short()], _sensitivity_rows(found), labels=3
        ),
    )


SWEPT = ("drive train, Hz", "damping ratio", "gain margin", "delay margin, ms", "M_s")

SMALLEST = ("gain_margin", "delay_margin")

MOST = 12


def _headings(record: type) -> list[str]:
    return [
        f"{metric.column.plain_heading}{'' if metric.column.unit == '1' else ', ' + metric.column.unit}"
        for metric in declared(record)
        if metric.column
    ]


def margin_headings() -> list[str]:
    """Of the table of margins."""
    return ["plant", "speed, km/h", "drive train, Hz", "damping ratio", *_headings(Margins)]


def margin_rows(found: Analysis) -> Iterator[list[str]]:
    """The margins of each plant at each speed."""
    for at in found.at:
        yield [at.plant, f"{at.speed:g}", *_mode(at.mode), *_cells(at.margins)]


def _mode(mode: tuple[float, float]) -> list[str]:
    return ["-" if isnan(mode[0]) else f"{mode[0]:.1f}", "-" if isnan(mode[0]) else f"{mode[1]:.2f}"]


def _cells(record: object) -> list[str]:
    shown = [(metric.of(record), metric.column) for metric in declared(type(record)) if metric.column]
    return ["any" if value == float("inf") else number(value, column) for value, column in shown]


def _swept_rows(found: Analysis) -> Iterator[list[str]]:
    for plant, sweeps in found.swept.items():
        for sweep in SWEEPS:
            each = sweeps[sweep.name]
            for swept in (each[0], each[len(each) // 2], each[-1]):
                margin = swept.margins
                cells = (
                    ["unstable"] * 3
                    if margin is None
                    else [
                        _finite(margin.gain_margin, 1.0, 1),
                        _finite(margin.delay_margin, 1e3, 1),
                        f"{margin.M_s:.2f}",
                    ]
                )
                yield [plant, f"{sweep.name}, {sweep.unit}", f"{swept.value:.3g}", *_mode(swept.mode), *cells]


def _finite(value: float, factor: float, decimals: int) -> str:
    return f"{factor * value:.{decimals}f}" if isfinite(value) else "any"


def _excluded(found: Analysis) -> str:
    """What the describing function says, a sentence or two for each plant."""
    lines = []
    for plant, cycles in found.limit_cycles.items():
        known = [(swing.amplitude, swing.margins) for swing in found.swings[plant] if swing.margins]
        text = "; ".join(map(_cycle, cycles)) or "none at any amplitude"
        line = f"- `{plant}`: {text}."
        if known:
            gain, delay = (min(known, key=lambda each: getattr(each[1], name)) for name in SMALLEST)
            line += (
                f" Where swings die away the smallest gain margin is {_finite(gain[1].gain_margin, 1.0, 1)} "
                f"({_where(gain[0])}), the smallest delay margin {_finite(delay[1].delay_margin, 1e3, 1)} ms "
                f"({_where(delay[0])})."
            )
        lines.append(line)
    return "\n".join(lines)


def _cycle(cycle: LimitCycle) -> str:
    kind = "one that lasts" if cycle.lasting else "one from which larger swings grow"
    return f"{kind}, {cycle.amplitude:.2f} φ_B at {cycle.frequency:.2g} Hz (N = {cycle.N:.2g})"


def _where(amplitude: float) -> str:
    return f"at {amplitude:.3g} φ_B" if isfinite(amplitude) else "in contact"


def _estimate_rows(found: Analysis) -> Iterator[list[str]]:
    for (plant, manoeuvre), metrics in found.estimates.items():
        yield [plant, f"{manoeuvre}, {MANOEUVRES[manoeuvre].description}", *_cells(metrics)]


def _short() -> list[str]:
    return [metric.column.plain_heading for metric in declared(Metrics) if metric.name in SHOWN and metric.column]


def _sensitivity_rows(found: Analysis) -> Iterator[list[str]]:
    for parameter in most_important(found.sensitivities, MOST):
        for each in found.sensitivities:
            if each.parameter == parameter:
                cells = ["-" if isnan(value) else f"{value:+.2f}" for value in each.changes.values()]
                yield [f"`{parameter}`", each.plant, each.manoeuvre, *cells]
