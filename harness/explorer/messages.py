"""What a page asks for and what it is answered: a request as JSON, an answer as JSON with columns of numbers behind."""

import json
from collections.abc import Callable, Mapping
from itertools import cycle
from typing import Any

import numpy as np

from ..base.errors import DrivelineError
from ..views.colours import GREEN, ORANGE, PURPLE, SKY, VERMILION
from ..views.html.paired_runs import pair_panels
from ..views.html.thinning import MOST_ROWS, extremes
from ..views.metrics_table import SHOWN, number
from ..views.panels import Curve, Panel
from .knobs import Knob
from .request import SPORT, Request
from .request_runs import Answer, RequestRunner, Run

BESIDE = (VERMILION, GREEN, ORANGE, PURPLE, SKY, "#999933")
"""Colours of the other controllers, in turn."""

HELD, HELD_COLOR = "held", "#8ab6d6"
"""Name and colour of the run that is held."""

HELD_SIGNALS = ("plant.T_gear", "controller.T_ref", "plant.omega_1", "plant.a_body")
"""Of it, one in each panel."""

WITHOUT = "without control"

NO_REQUEST = "what the page asks for is no request"

Typed = Callable[[str], tuple[str, float]]
"""Name and value of `plant.J_1=0.06`; ValueError says why not."""


def settings(runner: RequestRunner, saves: list[str]) -> dict[str, Any]:
    """What a page is told when it is opened.

    Args:
        saves: what stands on its buttons.
    """
    ours, *others = runner.controllers
    first = Request(runner.plants[0], next(iter(runner.manoeuvres)))
    return {
        "request": _sendable(first),
        "plants": runner.plants,
        "manoeuvres": [[name, f"{name}: {what}"] for name, what in runner.manoeuvres.items()],
        "ours": ours,
        "others": others,
        "knobs": {kind: [knob._asdict() for knob in getattr(runner, kind)] for kind in ("gains", "car")},
        "columns": [[f"{c.plain_heading}\n{c.unit}", metric.description] for metric, c in SHOWN],
        "panels": len(HELD_SIGNALS),
        "held": {"label": HELD, "color": HELD_COLOR},
        "saves": saves,
    }


def request_of(sent: Any, runner: RequestRunner, typed: Typed) -> Request:
    """The request that a page has sent; what a page of somebody's own sends is kept within the sliders.

    Raises:
        DrivelineError: it is none, or what is typed is nothing to set.
    """
    try:
        return Request(
            plant=str(sent["plant"]),
            manoeuvre=str(sent["manoeuvre"]),
            control=bool(sent["control"]),
            others=tuple(name for name in runner.controllers[1:] if name in sent["others"]),
            car=_turned(sent["car"], runner.car),
            gains=_turned(sent["gains"], runner.gains),
            character=_within(float(sent["character"]), 0.0, 1.0),
            informed=bool(sent["informed"]),
            typed=dict(typed(part) for part in sent["typed"].split(",")) if sent["typed"].strip() else {},
        )
    except (KeyError, TypeError, AttributeError) as error:
        raise DrivelineError(NO_REQUEST) from error
    except ValueError as refusal:
        raise DrivelineError(str(refusal)) from refusal


def _turned(sent: Mapping[str, Any], knobs: list[Knob]) -> dict[str, float]:
    return {knob.name: _within(float(sent[knob.name]), knob.low, knob.high) for knob in knobs if knob.name in sent}


def _within(value: float, low: float, high: float) -> float:
    return min(max(value, low), high) if value == value else low


def _sendable(request: Request) -> dict[str, Any]:
    """The request as a page knows it."""
    return {**vars(request), "typed": ", ".join(f"{name}={value!r}" for name, value in request.typed.items())}


def answer_of(answer: Answer, runner: RequestRunner) -> bytes:
    """The length of the JSON (four bytes, the first the lowest), the JSON, which ends where a number may begin, and
    columns of single precision, which is more than a screen shows: the time, each curve, and of each panel the signal
    that is kept if the run is held."""
    panels = _panels(answer, runner.controllers)
    held = next(iter(answer.runs.values()), answer.without).results
    signals = [curve.y for curves in panels.values() for curve in curves]
    every = [held["time"], *signals, *(held[name] for name in HELD_SIGNALS)]
    columns = {str(place): column for place, column in enumerate(every)}
    table = np.array(list(extremes(columns, MOST_ROWS).values()), dtype="<f4")
    turnable = runner.turnable(answer.request)
    if turnable & SPORT.keys():
        turnable.add("character")
    head = {
        "request": _sendable(answer.request),
        "turnable": sorted(turnable),
        "window": runner.window(answer.request.manoeuvre),
        "rows": table.shape[1],
        "panels": [{"label": label, "curves": list(map(_look, curves))} for label, curves in panels.items()],
        "runs": [[name, _cells(run)] for name, run in {WITHOUT: answer.without, **answer.runs}.items()],
    }
    text = json.dumps(head).encode()
    text += b" " * (-len(text) % 4)
    return len(text).to_bytes(4, "little") + text + table.tobytes()


def _panels(answer: Answer, controllers: list[str]) -> dict[str, list[Curve]]:
    """The curves of runs without and with control, and the torque of the controllers beside ours, by the panel."""
    ours, *others = controllers
    off, runs = answer.without.results, {name: run.results for name, run in answer.runs.items()}
    absent = np.full(len(off), np.nan, off.dtype)
    for known in ("time", "controller.T_driver"):
        absent[known] = off[known]
    panels = {panel.label: _present(panel) for panel in pair_panels(off, runs.get(ours, absent))}
    next(iter(panels.values())).extend(
        Curve(off["time"], runs[name]["plant.T_gear"], f"with {name}", color)
        for name, color in zip(others, cycle(BESIDE), strict=False)
        if name in runs
    )
    return panels


def _present(panel: Panel) -> list[Curve]:
    """Its curves that have a value."""
    return [part for part in panel.parts if isinstance(part, Curve) and not np.isnan(part.y).all()]


def _look(curve: Curve) -> dict[str, Any]:
    return {"label": curve.label, "color": curve.color, "dash": curve.dashes, "width": curve.width}


def _cells(run: Run) -> list[list[str]]:
    """The metrics of a run as a table has them, and why one is missing."""
    return [[number(metric.of(run.metrics), c), run.metrics.absent.get(metric.name, "")] for metric, c in SHOWN]
