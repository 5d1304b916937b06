"""Panels as the data that kit.js draws."""

from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..panels import Arrow, Axis, Curve, Level, Panel, Part, Points, Spans


@dataclass(frozen=True)
class Figure:
    """Panels below each other.

    Attributes:
        choices: the panels, by the names of what they can show; the first is shown at first.
        x: abscissa of the panels that have none of their own.
        windows: what of it each choice shows at first, if not that of `x`.
        control: title of what chooses; figures with the same title show the same. Empty: there is nothing to choose.
    """

    choices: Mapping[str, Sequence[Panel]]
    x: Axis
    windows: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    control: str = ""


def figure(panels: Sequence[Panel], x: Axis) -> Figure:
    """One that shows nothing else."""
    return Figure({"": panels}, x)


class Arrays:
    """What is drawn, in single precision, which is more than a screen shows; what is the same is there once."""

    def __init__(self) -> None:
        self._places: dict[bytes, int] = {}
        self.texts: list[str] = []

    def place(self, values: np.ndarray) -> int:
        """The number of an array."""
        content = np.asarray(values, dtype="<f4").tobytes()
        if content not in self._places:
            self._places[content] = len(self.texts)
            self.texts.append(b64encode(content).decode())
        return self._places[content]


def figure_data(each: Figure, arrays: Arrays) -> dict[str, Any]:
    """A figure as JSON, whose arrays are numbers of `arrays`."""
    return {
        "control": each.control,
        "x": each.x._asdict(),
        "windows": dict(each.windows),
        "choices": {name: [panel_data(panel, arrays) for panel in panels] for name, panels in each.choices.items()},
    }


def panel_data(panel: Panel, arrays: Arrays) -> dict[str, Any]:
    """A panel; its label is on one line."""
    return {
        "label": panel.label.replace("\n", " "),
        "heading": panel.heading,
        "note": panel.note,
        "bounds": panel.bounds,
        "scale": panel.scale,
        "ticks": {f"{value:g}": word for value, word in panel.ticks.items()},
        "height": panel.height,
        "x": panel.x._asdict() if panel.x else None,
        "parts": [part_data(part, arrays) for part in panel.parts],
    }


def part_data(part: Part, arrays: Arrays) -> dict[str, Any]:
    """A part by its kind, its arrays in an ascending order of the abscissa."""
    look = {name: value for name, value in part._asdict().items() if name not in getattr(part, "ARRAYS", ())}
    if "dashes" in look:
        look["dash"] = look.pop("dashes")
    kind = type(part).__name__.lower()
    if isinstance(part, Level | Arrow):
        return {"kind": kind, **{name: float(v) if isinstance(v, np.floating) else v for name, v in look.items()}}
    return {"kind": kind, **look, **{name: arrays.place(values) for name, values in _ascending(part).items()}}


def _ascending(part: Any) -> dict[str, np.ndarray]:
    x = np.asarray(part.x, dtype=float)
    if isinstance(part, Points | Spans):
        order = np.argsort(x, kind="stable")
        return {name: np.asarray(getattr(part, name))[order] for name in part.ARRAYS}
    arrays = {name: np.asarray(getattr(part, name), dtype=float) for name in part.ARRAYS}
    if isinstance(part, Curve) and not (known := np.isfinite(x)).all():  # a gap stands where the last abscissa was
        arrays["y"] = np.where(known, arrays["y"], np.nan)
        arrays["x"] = x[np.maximum.accumulate(np.where(known, np.arange(len(x)), 0))]
    return arrays
