"""Figure of a whole drive: speeds and torques as in Figs. 7 and 8 of the paper, and what is too fast to show there."""

from pathlib import Path

import numpy as np

from ..loop import roles
from ..manoeuvres.manoeuvre import Manoeuvre
from ..metrics.band_filter import envelope
from .annotations import GAP, gap, in_words, metrics_of
from .colours import VERMILION
from .figure_options import PLAIN, FigureOptions
from .figure_style import draw
from .panels import DASHED, Axis, Drawing, Panel, Part, Spans
from .signal_lines import DEMAND, T_GEAR, T_MOT, T_RIM, WHEEL, Line, Row, Runs, column, envelope_of, interval, looks_of
from .step_figure import size_of

THIN_T_MOT = T_MOT._replace(dashes=DASHED, width=0.9)

MOTOR_SPEED = Row("motor speed\n" r"$\omega_1$ in rad/s", (Line(column("plant.omega_1")),))
WHEEL_SPEED = Row("wheel speed in\nrad/s, wheel side", (Line(WHEEL),))
TORQUE = Row("torque in N·m,\nmotor side", (Line(T_RIM, r"$T_{rim}/i$, wheel torque", VERMILION), THIN_T_MOT, DEMAND))
CLOSE_UP = Row("torque in N·m,\nclose-up", (T_GEAR, THIN_T_MOT, DEMAND))

AROUND = (-0.3, 0.9)
"""From and to when in s, after the demand has changed its sign, the close-up is."""


def plot_drive(runs: Runs, manoeuvre: Manoeuvre, plant: str, stem: Path, options: FigureOptions = PLAIN) -> list[Path]:
    """Writes the figure of `drive_drawing`; arguments and result are those of `harness.views.step_figure.plot_step`."""
    return draw(drive_drawing(runs, manoeuvre, plant, options), stem, options)


def drive_drawing(runs: Runs, manoeuvre: Manoeuvre, plant: str, options: FigureOptions = PLAIN) -> Drawing:
    """Speeds and torques, a close-up of one reversal of the torque, and the envelope of the gear torque."""
    window = options.clipped(0.0, manoeuvre.duration)
    closer = reversal(next(iter(runs.values())), window)
    columns = [_panels(run, name, closer) for name, run in runs.items()]
    rows = [*zip(*columns, strict=True), [_envelopes(runs, manoeuvre)]]
    return Drawing(rows, Axis("time in s", window), f"{plant}, {manoeuvre.description}", size_of(runs))


def _panels(run: np.ndarray, heading: str, closer: tuple[float, float] | None) -> list[Panel]:
    apart, around = gap(run), Spans.of([closer] if closer else [], outlined=True)
    panels = [MOTOR_SPEED.of(run, heading=heading), WHEEL_SPEED.of(run), TORQUE.of(run, apart, around)]
    if closer:
        panels.append(CLOSE_UP.of(run, apart._replace(label=GAP), x=Axis("time in s", closer)))
    return panels


def _envelopes(runs: Runs, manoeuvre: Manoeuvre) -> Panel:
    """The gear torque of all runs from 5 to 50 Hz, where the curves themselves would only cover each other."""
    curves, looks = list[Part](), looks_of(runs)
    for name, run in runs.items():
        label = ", ".join(filter(None, (name, in_words(metrics_of(run, manoeuvre), "gear_torque_rms"))))
        curves += Line(envelope_of(roles.GEAR_TORQUE), label, *looks[name]).of(run)
    return Panel("gear torque, 5-50 Hz\nenvelope in N·m", curves, bounds=(0.0, None), columns=2)


def reversal(undamped: np.ndarray, window: tuple[float, float]) -> tuple[float, float] | None:
    """About the change of the sign of the demand, within a window, after which the gear torque swings most; None if
    there is none."""
    t, side = undamped["time"], np.sign(undamped[roles.DEMAND])
    loaded = np.flatnonzero(side)
    turns = loaded[1:][np.diff(side[loaded]) != 0]
    turns = turns[(t[turns] >= window[0] - 1e-9) & (t[turns] <= window[1] + 1e-9)]
    if not len(turns):
        return None
    T_s = interval(undamped)
    swing = envelope(undamped[roles.GEAR_TORQUE], T_s)
    after = round(AROUND[1] / T_s)
    turn = max(turns, key=lambda k: float(swing[k : k + after].max()))
    return max(float(t[turn]) + AROUND[0], window[0]), min(float(t[turn]) + AROUND[1], window[1])
