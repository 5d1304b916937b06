"""Figure of one run: speeds, torques and the motion of the body, one above the other."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from fmuloop.argument_kinds import require_each
from fmuloop.errors import WiringError
from fmuloop.results import Results
from toolground.errors import UserError
from toolground.plain_text import printed

from ..loop import roles
from ..manoeuvres.manoeuvre import Manoeuvre
from .annotations import AFTER, BEFORE, GAP, gap, in_words, marks_of_step, metrics_of
from .colours import BLACK, GREEN, GREY
from .figure_options import KINDS, PLAIN, FigureOptions
from .figure_style import draw
from .panels import DASH_DOT, SOLID, Axis, Curve, Drawing, Panel, Part, seen
from .signal_lines import (
    ACCELERATION,
    GEAR_TORQUE,
    JERK_UP_TO_50_HZ,
    KMH,
    MOTOR_TORQUE,
    SPEED_LABEL,
    SPEEDS,
    Line,
    Row,
    Runs,
    column,
    envelope_of,
    looks_of,
)

ALL_SPEEDS = Row(
    SPEED_LABEL, (Line(column(roles.BUS_WHEEL_SPEED), r"$i\,\omega_{wheel}$ over CAN", GREEN, DASH_DOT, 0.8), *SPEEDS)
)
ENVELOPES = Row(
    "its envelope,\n5-50 Hz, in rad/s",
    (
        Line(envelope_of(roles.WHEEL_SPEED), r"$i\,\omega_{wheel}$, wheels", GREY, width=1.8),
        Line(envelope_of(roles.MOTOR_SPEED), r"$\omega_1$, motor", width=0.9),
    ),
)
VEHICLE = Row("speed of the\nvehicle in km/h", (Line(column("plant.v", KMH)),))


SHORT = 0.3
"""A change of the demand that takes no longer, in s, is a step."""


def plot(
    results: Results | Mapping[str, Results],
    names: Iterable[str] = (),
    *,
    manoeuvre: Manoeuvre | None = None,
    window: tuple[float, float] | None = None,
    file: str | Path | None = None,
) -> None:
    """Shows a run, or several on top of each other, in panels over time: in a window, or below the cell of a notebook.

        driveline.plot(results)  # or results.plot()
        driveline.plot({"without damping": free, "mine": damped}, ["plant.T_gear", "controller.T_ref"], file="both.png")

    Args:
        results: of `simulate`, or several by the names of what is compared.
        names: of the signals, each a panel; none: torques, speeds and the motion of the body.
        manoeuvre: that it is a run of; the figure has its metrics then.
        window: from and to when in s; None: about the step, if the demand has one, else everything.
        file: that is written instead, .png, .pdf or .svg.

    Raises:
        WiringError: results or names are something else.
        UnknownName: there is no such signal.
        UserError: the file has another ending.
    """
    runs: dict[str, Any] = dict(results) if isinstance(results, Mapping) else {"": results}
    require_each("results", list(runs.values()), np.ndarray, "results of runs, as simulate gives them")
    if not runs:
        raise WiringError("results = {}: there must be a run to show")
    shown = require_each("names", names, str, "names of signals, such as plant.T_gear")
    path = Path("run" if file is None else file)
    kind = path.suffix.lower().removeprefix(".")
    if file is not None and kind not in KINDS:
        raise UserError(f"file = {file}: it must end in .{', .'.join(KINDS)}")
    options = FigureOptions("", window, (kind,) if kind else ())
    one = next(iter(runs.values()))
    title = manoeuvre.description if manoeuvre else f"run of {one['time'][-1] - one['time'][0]:g} s"
    if shown or len(runs) > 1:
        drawing = signals_drawing(runs, shown or COMPARED, title, options)
    else:
        drawing = run_drawing(one, manoeuvre, title, options)
    draw(drawing, path.with_suffix(""), options)


COMPARED = (roles.GEAR_TORQUE, roles.REFERENCE_TORQUE, roles.MOTOR_SPEED, roles.BODY_ACCELERATION)
"""Signals of several runs, unless others are named."""


def signals_drawing(runs: Runs, names: Iterable[str], title: str, options: FigureOptions) -> Drawing:
    """A panel for each signal, with a curve for each run."""
    first, looks = next(iter(runs.values())), looks_of(runs) | {"": (BLACK, SOLID, 1.0)}
    window = options.window or about_the_step(first)
    panels = []
    for name in names:
        curves = [Curve(run["time"], run[name], label, *looks[label]) for label, run in runs.items()]
        unit = getattr(first, "units", {}).get(name, "")
        panels.append(Panel(f"{name}\nin {printed(unit)}" if unit else name, curves))
    return Drawing([[panel] for panel in panels], Axis("time in s", window), title, (7.2, 1.6))


def about_the_step(run: np.ndarray) -> tuple[float, float]:
    """From and to when in s the demand makes its one step, if it makes one, else the whole run."""
    t = run["time"]
    changes = t[1:][np.diff(run[roles.DEMAND]) != 0.0] if roles.DEMAND in (run.dtype.names or ()) else t[:0]
    if not len(changes) or changes[-1] - changes[0] > SHORT:
        return float(t[0]), float(t[-1])
    return max(float(changes[0]) - BEFORE, float(t[0])), min(float(changes[0]) + AFTER, float(t[-1]))


def plot_run(
    results: np.ndarray, manoeuvre: Manoeuvre, title: str, stem: Path, options: FigureOptions = PLAIN
) -> list[Path]:
    """Writes the figure of `run_drawing`.

    Args:
        results: of `driveline.simulate`.
        manoeuvre: that it is of.
        stem: path of the files without their ending.

    Returns:
        The files written.
    """
    return draw(run_drawing(results, manoeuvre, title, options), stem, options)


def run_drawing(
    results: np.ndarray, manoeuvre: Manoeuvre | None, title: str, options: FigureOptions = PLAIN
) -> Drawing:
    """One run of the loop; without its manoeuvre it has no metrics."""
    ends = (float(results["time"][0]), float(results["time"][-1]))
    window = options.clipped(*ends) if options.window else about_the_step(results)
    metrics = metrics_of(results, manoeuvre) if manoeuvre else None
    apart, marks = seen(gap(results), *window), list[Part]()
    if manoeuvre:
        marks += [seen(mark, *window) for mark in marks_of_step(results, manoeuvre, metrics, window)]
    note = in_words(metrics, "overshoot", "settling_time", "gear_torque_rms")
    panels = [
        GEAR_TORQUE.of(results, apart, *marks, window=window, note=note),
        MOTOR_TORQUE.of(results, apart, window=window),
        ALL_SPEEDS.of(results, apart._replace(label=GAP), window=window),
        ENVELOPES.of(results, apart, window=window, bounds=(0.0, None)),
        ACCELERATION.of(results, apart, window=window),
        JERK_UP_TO_50_HZ.of(results, apart, window=window, note=in_words(metrics, "jerk_rms")),
        VEHICLE.of(results, apart, window=window),
    ]
    return Drawing([[panel] for panel in panels], Axis("time in s", window), title, (7.2, 1.35))
