"""The lines of figures: which signal of a run, and how it is drawn.

Lines of one panel differ in their dashes or in how light they are, so that they can be told apart in a grey print.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes

from ..metrics.band_filter import derivative, envelope
from .colours import BLACK, BLUE, GREEN, GREY, VERMILION

Dashes = str | tuple[float, tuple[float, ...]]
"""As matplotlib has them."""

SOLID: Dashes = "-"
DASHED: Dashes = (0.0, (4.0, 1.5))
DOTTED: Dashes = (0.0, (1.0, 1.2))
DASH_DOT: Dashes = (0.0, (6.0, 1.5, 1.0, 1.5))

DASHES = (SOLID, DASHED, DASH_DOT, DOTTED)
"""Of many curves, in turn."""

KMH = 3.6


class Signal(NamedTuple):
    """What is drawn of a run.

    Attributes:
        columns: that it needs; FMUs of others may lack some.
        of: computes it from the run.
    """

    columns: tuple[str, ...]
    of: Callable[[np.ndarray], np.ndarray]


def column(name: str, factor: float = 1.0) -> Signal:
    """A column as it is, or times a factor."""
    return Signal((name,), lambda run: factor * run[name])


def envelope_of(name: str, factor: float = 1.0) -> Signal:
    """The envelope of a column from 5 to 50 Hz, or times a factor."""
    return Signal((name,), lambda run: factor * envelope(run[name], interval(run)))


def interval(run: np.ndarray) -> float:
    """Time between the rows in s."""
    return float(run["time"][1] - run["time"][0])


WHEEL = Signal(
    ("plant.omega_wheel_L", "plant.omega_wheel_R"),
    lambda run: 0.5 * (run["plant.omega_wheel_L"] + run["plant.omega_wheel_R"]),
)
"""Mean speed of both driven wheels, wheel side."""

JERK = Signal(("plant.a_body",), lambda run: derivative(run["plant.a_body"], interval(run)))
"""Of the body, up to 50 Hz."""


def _over_ratio(run: np.ndarray) -> np.ndarray:
    """The torque at the rims over the motor speed's ratio to that of the wheels, which two measures of them show."""
    wheel = WHEEL.of(run)
    turned = np.dot(wheel, wheel)
    return run["plant.T_rim"] * (turned / np.dot(run["plant.omega_2"], wheel) if turned else np.nan)


T_RIM = Signal(("plant.T_rim", "plant.omega_2", *WHEEL.columns), _over_ratio)
"""The torque at the rims as seen from the motor."""


class Line(NamedTuple):
    """How a signal is drawn."""

    signal: Signal
    label: str
    color: str
    dashes: Dashes = SOLID
    width: float = 1.0


class Panel(NamedTuple):
    """One row of axes: its label and its lines, the later ones on top."""

    label: str
    lines: tuple[Line, ...]


DEMAND = Line(column("controller.T_driver"), r"$T_{driver}$, demand", BLACK, DOTTED, 1.1)
T_GEAR = Line(column("plant.T_gear"), r"$T_{gear}$", VERMILION, SOLID, 1.6)

GEAR_TORQUE = Panel(
    "gear torque\nin N·m",
    (T_GEAR, Line(column("controller.T_gear_hat"), r"$\hat T_{gear}$, estimate", BLUE, DASHED, 0.9), DEMAND),
)
SPEEDS = (
    Line(column("plant.omega_2"), r"$i\,\omega_{wheel}$, wheels", GREY, SOLID, 1.8),
    Line(column("plant.omega_1"), r"$\omega_1$, motor", BLACK, SOLID, 0.9),
)
SPEED_LABEL = "speed in rad/s,\nmotor side"
ACCELERATION = Panel("acceleration of\nthe body in m/s²", (Line(column("plant.a_body"), "$a$, body", BLACK),))
JERK_PANEL = Panel("its jerk up to\n50 Hz in m/s³", (Line(JERK, r"$\dot a$, body", BLACK, SOLID, 0.8),))
MOTOR_TORQUE = Panel(
    "motor torque\nin N·m",
    (
        Line(column("motor.T_mot"), r"$T_{mot}$, motor", GREY, SOLID, 1.8),
        Line(column("controller.T_ref"), r"$T_{ref}$, to the motor", BLUE, SOLID, 0.9),
        Line(column("controller.T_damp"), r"$T_{damp}$, damping", GREEN, DASH_DOT, 1.0),
        DEMAND,
    ),
)


def draw(axes: Axes, panel: Panel, run: np.ndarray, window: tuple[float, float]) -> None:
    """The lines of a panel within a window, less those that FMUs of others do not have."""
    shown = within(run, window)
    for line in panel.lines:
        if set(line.signal.columns) <= set(run.dtype.names or ()):
            axes.plot(
                run["time"][shown],
                line.signal.of(run)[shown],
                color=line.color,
                ls=line.dashes,
                lw=line.width,
                label=line.label,
            )


def within(run: np.ndarray, window: tuple[float, float]) -> np.ndarray:
    """Which rows are within a window in s."""
    return (run["time"] >= window[0] - 1e-9) & (run["time"] <= window[1] + 1e-9)
