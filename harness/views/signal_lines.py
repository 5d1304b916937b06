"""The lines of figures: which signal of a run, and how it is drawn.

Lines of one panel differ in their dashes or in how light they are, so that they can be told apart in a grey print.
"""

from collections.abc import Callable, Iterable, Mapping
from itertools import cycle
from typing import Any, NamedTuple

import numpy as np

from ..loop import roles
from ..metrics.band_filter import derivative, envelope
from .colours import BLACK, BLUE, GREEN, GREY, OLIVE, ORANGE, PURPLE, SKY, VERMILION, WINE
from .panels import DASH_DOT, DASHED, DOTTED, SOLID, Curve, Dashes, Panel, Part, seen

KMH = 3.6

WITHOUT = "without damping"
"""The run with which others are compared, as figures and tables name it."""

Runs = Mapping[str, np.ndarray]
"""Runs by the names of the controllers, the one without damping first."""

Look = tuple[str, Dashes, float]
"""Colour, dashes and width of the curves of a run, where a figure has those of several."""

UNDAMPED: Look = (GREY, SOLID, 1.8)
CONTROLLERS: tuple[Look, ...] = (
    (BLUE, SOLID, 0.9),
    (VERMILION, DASHED, 0.9),
    (WINE, DASH_DOT, 0.9),
    (ORANGE, DOTTED, 1.2),
    (PURPLE, (8.0, 2.0), 0.9),
    (SKY, (2.0, 2.0), 1.2),
    (OLIVE, DASHED, 1.2),
)
"""Those of the controllers, in turn; a page has the same. Green is what the control adds."""


def looks_of(runs: Iterable[str]) -> dict[str, Look]:
    """How the curves of runs are drawn, by their names."""
    others = [name for name in runs if name != WITHOUT]
    return {WITHOUT: UNDAMPED} | dict(zip(others, cycle(CONTROLLERS), strict=False))


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
    return Signal((name,), lambda run: _times(factor, run[name]))


def envelope_of(name: str, factor: float = 1.0) -> Signal:
    """The envelope of a column from 5 to 50 Hz, or times a factor."""
    return Signal((name,), lambda run: _times(factor, envelope(run[name], interval(run))))


def _times(factor: float, x: np.ndarray) -> np.ndarray:
    return x if factor == 1.0 else factor * x


def interval(run: np.ndarray) -> float:
    """Time between the rows in s."""
    return float(np.diff(run[:2]["time"])[0])


WHEEL = Signal(
    (roles.WHEELS[0], roles.WHEELS[1]),
    lambda run: 0.5 * (run[roles.WHEELS[0]] + run[roles.WHEELS[1]]),
)
"""Mean speed of both driven wheels, wheel side."""

JERK = Signal((roles.BODY_ACCELERATION,), lambda run: derivative(run[roles.BODY_ACCELERATION], interval(run)))
"""Of the body, up to 50 Hz."""


def _over_ratio(run: np.ndarray) -> np.ndarray:
    """The torque at the rims over the motor speed's ratio to that of the wheels, which two measures of them show."""
    wheel = WHEEL.of(run)
    turned = np.dot(wheel, wheel)
    return run[roles.RIM_TORQUE] * (turned / np.dot(run[roles.WHEEL_SPEED], wheel) if turned else np.nan)


T_RIM = Signal((roles.RIM_TORQUE, roles.WHEEL_SPEED, *WHEEL.columns), _over_ratio)
"""The torque at the rims as seen from the motor."""


class Line(NamedTuple):
    """How a signal is drawn."""

    signal: Signal
    label: str = ""
    color: str = BLACK
    dashes: Dashes = SOLID
    width: float = 1.0

    def of(self, run: np.ndarray, window: tuple[float, float] | None = None) -> list[Part]:
        """The curve; none where FMUs of others do not have what it needs.

        Args:
            window: from and to when in s it is drawn in a file; of a long run that alone is kept which can be seen.
        """
        if not set(self.signal.columns) <= set(run.dtype.names or ()):
            return []
        y = self.signal.of(run)
        curve = Curve(run["time"], y, *self[1:])
        return [seen(curve, *window) if window else curve]


class Row(NamedTuple):
    """A panel of any run: its label and its lines, the later ones on top."""

    label: str
    lines: tuple[Line, ...]

    def of(self, run: np.ndarray, *behind: Part, window: tuple[float, float] | None = None, **more: Any) -> Panel:
        """The panel of a run, with what is behind its lines and whatever else `Panel` takes; `window` as of `Line`."""
        return Panel(self.label, [*behind, *(curve for line in self.lines for curve in line.of(run, window))], **more)


DEMAND = Line(column(roles.DEMAND), r"$T_{driver}$, demand", BLACK, DOTTED, 1.1)
T_GEAR = Line(column(roles.GEAR_TORQUE), r"$T_{gear}$", VERMILION, SOLID, 1.6)

T_MOT = Line(column(roles.MOTOR_TORQUE), r"$T_{mot}$, motor", GREY, SOLID, 1.8)

GEAR_TORQUE = Row(
    "gear torque\nin N·m",
    (T_GEAR, Line(column(roles.GEAR_TORQUE_ESTIMATE), r"$\hat T_{gear}$, estimate", BLUE, DASHED, 0.9), DEMAND),
)
SPEEDS = (
    Line(column(roles.WHEEL_SPEED), r"$i\,\omega_{wheel}$, wheels", GREY, SOLID, 1.8),
    Line(column(roles.MOTOR_SPEED), r"$\omega_1$, motor", BLACK, SOLID, 0.9),
)
SPEED_LABEL = "speed in rad/s,\nmotor side"
ACCELERATION = Row("acceleration of\nthe body in m/s²", (Line(column("plant.a_body")),))
JERK_UP_TO_50_HZ = Row("its jerk up to\n50 Hz in m/s³", (Line(JERK, width=0.8),))
MOTOR_TORQUE = Row(
    "motor torque\nin N·m",
    (
        T_MOT,
        Line(column(roles.REFERENCE_TORQUE), r"$T_{ref}$, to the motor", BLUE, SOLID, 0.9),
        Line(column(roles.DAMPING_TORQUE), r"$T_{damp}$, damping", GREEN, DASH_DOT, 1.0),
        DEMAND,
    ),
)
