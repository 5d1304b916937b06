"""Figures as data: panels one above the other, and what is in them.

`harness.views.figure_style` draws them in files, `harness/views/page/kit.js` on a page.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from .colours import BLACK, BLUE

Dashes = tuple[float, ...]
"""Lengths of lines and gaps over the width of the line."""

SOLID: Dashes = ()
DASHED: Dashes = (4.0, 1.5)
DOTTED: Dashes = (1.0, 1.2)
DASH_DOT: Dashes = (6.0, 1.5, 1.0, 1.5)


class Curve(NamedTuple):
    """A line, with gaps where a value is NaN.

    Attributes:
        width: in points, like all widths and sizes.
        held: each value until the next one, in steps.
    """

    x: np.ndarray
    y: np.ndarray
    label: str = ""
    color: str = BLACK
    dashes: Dashes = SOLID
    width: float = 1.0
    held: bool = False

    ARRAYS = ("x", "y")


class Points(NamedTuple):
    """Values without a line; `marker` is one of MARKERS."""

    x: np.ndarray
    y: np.ndarray
    label: str = ""
    color: str = BLACK
    size: float = 5.0
    marker: str = "circle"

    ARRAYS = ("x", "y")


MARKERS = {"circle": "o", "square": "s", "right": ">"}
"""As matplotlib has them."""


class Band(NamedTuple):
    """What is between two curves."""

    x: np.ndarray
    low: np.ndarray
    high: np.ndarray
    label: str = ""
    color: str = BLUE
    alpha: float = 0.3

    ARRAYS = ("x", "low", "high")


class Bars(NamedTuple):
    """Bars from zero, `breadth` wide on the abscissa."""

    x: np.ndarray
    y: np.ndarray
    breadth: float
    label: str = ""
    color: str = BLUE
    alpha: float = 1.0

    ARRAYS = ("x", "y")


class Spans(NamedTuple):
    """Shades the whole height from each `x` to its `end`; `outlined` has dashes about it instead."""

    x: np.ndarray
    end: np.ndarray
    label: str = ""
    color: str = "#cccccc"
    alpha: float = 1.0
    outlined: bool = False

    ARRAYS = ("x", "end")

    @classmethod
    def of(cls, windows: Sequence[tuple[float, float]], **how: Any) -> "Spans":
        """From and to where each is, and what else there is."""
        starts, ends = np.reshape(windows, (-1, 2)).astype(float).T
        return cls(starts, ends, **how)


class Level(NamedTuple):
    """A straight line over the whole panel, at a value of the ordinate, or of the abscissa where it is `upright`."""

    at: float
    color: str = BLACK
    dashes: Dashes = SOLID
    width: float = 0.8
    upright: bool = False


class Arrow(NamedTuple):
    """Points up and down, from one value to another."""

    x: float
    low: float
    high: float


Part = Curve | Points | Band | Bars | Spans | Level | Arrow


class Axis(NamedTuple):
    """An abscissa: its label, from where to where it is shown, and "linear" or "log"."""

    label: str
    window: tuple[float, float]
    scale: str = "linear"


@dataclass(frozen=True)
class Panel:
    """Axes and what is in them, the later parts on top.

    Attributes:
        label: of the ordinate, with its unit; on a page its lines become one if there is room.
        heading: above.
        note: a text in the upper right corner.
        bounds: of the ordinate; None: as the values ask for.
        scale: of the ordinate, "linear" or "log".
        ticks: of the ordinate, if they are not the usual ones; some have words.
        height: over that of the others.
        columns: of the legend.
        x: the abscissa, if it is not that of the whole figure.
    """

    label: str
    parts: Sequence[Part]
    heading: str = ""
    note: str = ""
    bounds: tuple[float | None, float | None] = (None, None)
    scale: str = "linear"
    ticks: Mapping[float, str] = field(default_factory=dict)
    height: float = 1.0
    columns: int = 5
    x: Axis | None = None


class Drawing(NamedTuple):
    """A whole figure, see `harness.views.figure_style.plot`."""

    rows: Sequence[Sequence[Panel]]
    x: Axis
    title: str
    size: tuple[float, float] = (7.2, 1.5)
    key: int = 0
    same_y: bool = True


DRAWN = 30_000
"""Values of a part up to which all are drawn."""

PIECES = 3200
"""Of a part with more values, each drawn as its least and its largest: more than a figure has points beside each
other."""

MOST_SPANS = 300
"""Up to which all are drawn; of more those that are nearer to each other than a piece is long are one."""


def seen(part: Part, start: float, end: float) -> Part:
    """What a figure can show of a part of a long run within a window; nothing keeps the whole part in memory."""
    match part:
        case Spans(x, until) if len(x) > MOST_SPANS:
            apart = x[1:] - until[:-1] > (end - start) / PIECES
            return part._replace(x=x[np.append(True, apart)], end=until[np.append(apart, True)])
        case Curve() | Band() if len(part.x) > DRAWN:
            rows = slice(*np.searchsorted(part.x, (start - 1e-9, end + 1e-9)))
            return _drawn(part._replace(**{name: getattr(part, name)[rows] for name in part.ARRAYS}))
    return part


def _drawn(part: Curve | Band) -> Curve | Band:
    if len(part.x) <= DRAWN:
        return part._replace(**{name: getattr(part, name).copy() for name in part.ARRAYS})
    first = np.arange(0, len(part.x), -(-len(part.x) // PIECES))
    if isinstance(part, Band):
        least, most = np.fmin.reduceat(part.low, first), np.fmax.reduceat(part.high, first)
        return part._replace(x=part.x[first], low=least, high=most)
    both = np.fmin.reduceat(part.y, first), np.fmax.reduceat(part.y, first)
    return part._replace(x=part.x[first].repeat(2), y=np.stack(both, axis=1).ravel())


def within(panels: Sequence[Panel], start: float, end: float) -> list[Panel]:
    """The panels less what is outside of a window."""

    def cut(part: Part) -> Part:
        match part:
            case Level() | Arrow():
                return part
            case Spans(x, until):
                seen = (x < end) & (until > start)
                return part._replace(x=np.maximum(x[seen], start), end=np.minimum(until[seen], end))
        seen = ~((part.x < start - 1e-9) | (part.x > end + 1e-9))  # and what is NaN between curves
        return part._replace(**{name: getattr(part, name)[seen] for name in part.ARRAYS})

    return [replace(panel, parts=[cut(part) for part in panel.parts]) for panel in panels]
