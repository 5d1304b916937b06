"""The page of a tab: knobs and switches on the left, curves and metrics on the right."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from html import escape
from itertools import cycle
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from bokeh.document import Document
from bokeh.events import ButtonClick, DocumentReady
from bokeh.layouts import column, row
from bokeh.models import Button, CheckboxGroup, Div, Select, Slider, Switch, TextInput, Toggle

from ..base.errors import DrivelineError
from ..metrics.evaluate import T_S, at_samples
from ..views.colours import GREEN, ORANGE, PURPLE, SKY, VERMILION
from ..views.html.linked_figures import as_drawn, linked, shown, source_of, stacked, tables
from ..views.html.paired_runs import NEEDED, TIME, pair_panels
from ..views.html.thinning import MOST_ROWS, extremes
from ..views.metrics_table import SHOWN, number
from ..views.panels import Curve, Panel
from .knobs import Knob
from .request import SPORT, Request
from .request_runs import Answer, RequestRunner, Run
from .worker import Worker

BESIDE = (VERMILION, GREEN, ORANGE, PURPLE, SKY, "#999933")
"""Colours of the other controllers, in turn."""

HELD, HELD_COLOR = "held", "#8ab6d6"
"""Name and colour of the run that is held."""

HELD_SIGNALS = ("plant.T_gear", "controller.T_ref", "plant.omega_1", "plant.a_body")
"""Of it, one in each panel."""

RUNNING = "running ..."

WIDTHS = 250, 215
"""Of the columns of controls, in pixels."""

IN_VIEW = {
    "position": "sticky",
    "top": "0",
    "align-self": "flex-start",
    "max-height": "100vh",
    "overflow-y": "auto",
    "overflow-x": "hidden",
}
"""Controls stay beside the curves, whatever is scrolled to, and scroll by themselves where they are too many."""

ON_TOP: dict[str, str | None] = {"position": "sticky", "top": "0", "z-index": "9", "background": "white"}
"""What is said stays above the curves."""

Save = Callable[[Answer], Sequence[Path]]
"""Writes an answer; gives the files."""

Typed = Callable[[str], tuple[str, float]]
"""Name and value of `plant.J_1=0.06`; ValueError says why not."""


class Bound(NamedTuple):
    """A control, its property that a user changes, and what that is for a request."""

    control: Any
    property: str
    of: Callable[[Request], Any]


class View:
    """One tab.

    Args:
        document: of its session.
        worker: runs what it asks for.
        saves: what its buttons do, by what stands on them.
        typed: reads what is typed.
    """

    def __init__(
        self, document: Document, runner: RequestRunner, worker: Worker, saves: dict[str, Save], typed: Typed
    ) -> None:
        self._document, self._runner, self._worker, self._typed = document, runner, worker, typed
        self._request = Request(runner.plants[0], next(iter(runner.manoeuvres)))
        self._bound: list[Bound] = []
        self._sliders: dict[str, Slider] = {}
        self._answer: Answer | None = None
        self._held: tuple[str, Run] | None = None
        self._gone = self._following = False
        self._status = Div(name="status", text="", min_height=18, sizing_mode="stretch_width", styles=ON_TOP)
        self._table = Div(name="metrics", text="", sizing_mode="stretch_width")
        nothing = np.zeros(2, dtype=[(name, float) for name in NEEDED])
        nothing["time"] = 0.0, T_S
        self._panels = self._drawn(nothing, {}, None)
        self._source = source_of(tables(self._panels)[0])
        self._x_range = shown(TIME._replace(window=runner.window(self._request.manoeuvre)))
        document.title = "driveline explore"
        controls = self._controls(saves)
        document.add_root(row(*controls, self._figures(), name="view", sizing_mode="stretch_width"))
        document.on_session_destroyed(self._leave)
        document.on_event(DocumentReady, lambda _: self._ask())  # nothing runs for who never shows the page
        self._follow()

    def _drawn(self, empty: np.ndarray, runs: Mapping[str, np.ndarray], held: np.ndarray | None) -> list[Panel]:
        """The panels of results by the names of the controllers, beside those without control and those that are held;
        NaN where there are none."""
        ours, *others = self._runner.controllers
        empty = empty[NEEDED]
        absent = np.full(len(empty), np.nan, empty.dtype)
        for known in ("time", "controller.T_driver"):
            absent[known] = empty[known]
        t = at_samples(empty)["time"]
        kept = at_samples(absent if held is None else held)
        panels = [
            replace(panel, parts=[Curve(t, kept[name], HELD, HELD_COLOR, width=1.4), *panel.parts])
            for panel, name in zip(pair_panels(empty, runs.get(ours, absent)), HELD_SIGNALS, strict=True)
        ]
        beside = [
            Curve(t, at_samples(runs.get(name, absent))["plant.T_gear"], f"with {name}", color)
            for name, color in zip(others, cycle(BESIDE), strict=False)
        ]
        return [replace(panels[0], parts=[*panels[0].parts, *beside]), *panels[1:]]

    def _controls(self, saves: dict[str, Save]) -> tuple[Any, Any]:
        runner = self._runner
        plant = Select(title="plant", options=list(runner.plants), name="plant", width=WIDTHS[0] - 20)
        manoeuvre = Select(
            title="manoeuvre",
            options=[(name, f"{name}: {what}") for name, what in runner.manoeuvres.items()],
            name="manoeuvre",
            width=WIDTHS[0] - 20,
        )
        control, informed = Switch(name="control"), Switch(name="informed")
        others = CheckboxGroup(labels=runner.controllers[1:], name="others")
        character = Slider(
            title="sport to comfort", start=0.0, end=1.0, step=0.02, value=0.5, name="character", width=WIDTHS[0] - 20
        )
        more = TextInput(title="others, as plant.mu=0.3", name="more", width=WIDTHS[1] - 20)
        self._bind(plant, "value", lambda request: request.plant, lambda value: {"plant": value})
        self._bind(manoeuvre, "value", lambda request: request.manoeuvre, lambda value: {"manoeuvre": value})
        self._bind(control, "active", lambda request: request.control, lambda value: {"control": bool(value)})
        self._bind(informed, "active", lambda request: request.informed, lambda value: {"informed": bool(value)})
        self._bind(others, "active", self._places, lambda value: {"others": self._named(value)})
        self._bind(
            character,
            "value",
            lambda request: request.character,
            lambda value: {"character": self._within(value, 0.0, 1.0)},
        )
        self._bind(more, "value", _as_typed, lambda text: {"typed": self._parsed(text)})
        self._sliders["character"] = character
        # there is nothing to hold before the first answer
        self._hold_button = hold = Toggle(label="hold this run", name="hold", width=WIDTHS[1] - 20, disabled=True)
        hold.on_change("active", lambda _, __, active: self._hold(bool(active)))
        gains = column(
            plant,
            manoeuvre,
            row(control, Div(text=f"control by {escape(runner.controllers[0])}")),
            Div(text="beside it"),
            others,
            Div(text="<b>gains</b>"),
            character,
            *(self._slider(knob, "gains", WIDTHS[0] - 20) for knob in runner.gains),
            width=WIDTHS[0],
            styles=IN_VIEW,
        )
        car = column(
            Div(text="<b>car</b>"),
            *(self._slider(knob, "car", WIDTHS[1] - 20) for knob in runner.car),
            row(informed, Div(text="the controllers know this car", width=WIDTHS[1] - 80)),
            more,
            hold,
            *(self._button(label, save) for label, save in saves.items()),
            width=WIDTHS[1],
            styles=IN_VIEW,
        )
        return gains, car

    def _slider(self, knob: Knob, kind: str, width: int) -> Slider:
        slider = Slider(
            title=f"{knob.name} in {knob.unit}" if knob.unit else knob.name,
            start=knob.low,
            end=knob.high,
            step=knob.step,
            value=knob.value,
            format="0[.]0000",
            name=knob.name,
            width=width,
            margin=(1, 5, 1, 5),
            stylesheets=[_explained(knob.meaning)],
        )

        def changes(value: float) -> dict[str, Any]:
            return {kind: {**getattr(self._request, kind), knob.name: self._within(value, knob.low, knob.high)}}

        self._bind(slider, "value", lambda request: getattr(request, kind).get(knob.name, knob.value), changes)
        self._sliders[knob.name] = slider
        return slider

    def _button(self, label: str, save: Save) -> Button:
        button = Button(label=label, button_type="primary", name=label, width=WIDTHS[1] - 20)
        button.on_event(ButtonClick, lambda: self._save(save))
        return button

    def _figures(self) -> Any:
        figures = linked(self._panels, TIME, self._x_range, [self._source])
        entries: Any = figures[0].legend[0].items
        others = self._runner.controllers[1:]
        beside = dict(zip(others, entries[len(entries) - len(others) :], strict=True))
        self._optional: dict[str, list[Any]] = {name: [entry] for name, entry in beside.items()}
        self._optional[HELD] = [figure.legend[0].items[0] for figure in figures]
        self._show({})
        return column(self._status, self._table, stacked(figures), sizing_mode="stretch_width")

    def _show(self, runs: Mapping[str, Any]) -> None:
        """Only the runs that are there have curves and stand in the legends."""
        for name, entries in self._optional.items():
            for entry in entries:
                if entry.visible != (name in runs):  # else a click in the legend stays
                    entry.visible = entry.renderers[0].visible = name in runs

    def _bind(
        self, control: Any, property: str, of: Callable[[Request], Any], changes: Callable[[Any], dict[str, Any]]
    ) -> None:
        """The control asks for the changes that its value makes to the request, and follows the request."""
        self._bound.append(Bound(control, property, of))
        setattr(control, property, of(self._request))

        def change(_: str, __: Any, value: Any) -> None:
            if self._following:
                return
            try:
                asked = changes(value)
            except (ValueError, DrivelineError) as refusal:
                self._stay(str(refusal))
            else:
                self._ask(**asked)

        control.on_change(property, change)

    def _follow(self) -> None:
        """The controls show the request, and those that change nothing of it are disabled."""
        self._following = True
        try:
            for control, property, of in self._bound:
                if getattr(control, property) != of(self._request):
                    setattr(control, property, of(self._request))
        finally:
            self._following = False
        turnable = self._runner.turnable(self._request)
        if turnable & SPORT.keys():
            turnable.add("character")
        for name, slider in self._sliders.items():
            slider.disabled = name not in turnable

    @staticmethod
    def _within(value: float, low: float, high: float) -> float:
        """The value of a slider, which a page of somebody's own might send otherwise."""
        return float(min(max(value, low), high)) if value == value else low

    def _places(self, request: Request) -> list[int]:
        return [self._runner.controllers[1:].index(name) for name in request.others]

    def _named(self, active: Sequence[int]) -> tuple[str, ...]:
        others = self._runner.controllers[1:]
        return tuple(others[k] for k in active if 0 <= k < len(others))

    def _parsed(self, text: str) -> dict[str, float]:
        """The parameters that are typed, with commas between them.

        Raises:
            ValueError: says why not.
        """
        return dict(self._typed(part) for part in text.split(",")) if text.strip() else {}

    def _ask(self, **changes: Any) -> None:
        """Changes the request and asks for its runs; it remains as it is where that is refused."""
        request = replace(self._request, **changes)
        try:
            self._runner.require(request)
        except DrivelineError as refusal:
            self._stay(str(refusal))
            return
        self._request = request
        self._follow()
        self._status.text = RUNNING
        failed = partial(self._go_back, request)
        self._worker.ask(self, partial(self._do, partial(self._runner.answer, request), self._take, failed))

    def _stay(self, reason: str) -> None:
        """The controls go back to the request, which a refused change has not changed."""
        self._follow()
        self._refuse(f"{reason}; what was set before stays")

    def _go_back(self, request: Request, reason: str) -> None:
        """After a request whose runs have failed the one that is shown counts again."""
        if request is self._request and self._answer is not None:
            self._request = self._answer.request
            self._follow()
            reason += "; what is shown is what was set before"
        self._refuse(reason)

    def _save(self, save: Save) -> None:
        """What the controls say now, whatever is shown yet."""
        self._status.text = "writing ..."
        request = self._request
        job = partial(self._do, lambda: save(self._runner.answer(request)), self._saved, self._refuse)
        self._worker.ask((self, save), job)

    def _do(self, job: Callable[[], Any], then: Callable[[Any], None], failed: Callable[[str], None]) -> None:
        """In the thread of the worker: does a job and has the tab show what came of it."""
        try:
            came = job()
        except DrivelineError as refusal:
            self._later(partial(failed, str(refusal)))
        except Exception as error:
            self._later(partial(failed, f"{type(error).__name__}: {error}"))
        else:
            self._later(partial(then, came))

    def _later(self, show: Callable[[], None]) -> None:
        if not self._gone:
            self._document.add_next_tick_callback(show)

    def _leave(self, _: Any) -> None:
        self._gone = True
        self._worker.forget(self)

    def _refuse(self, reason: str) -> None:
        self._status.text = f'<span style="color:#b00020">{escape(reason)}</span>'

    def _saved(self, files: Sequence[Path]) -> None:
        self._status.text = "written: " + "<br>".join(escape(str(path)) for path in files)

    def _hold(self, active: bool) -> None:
        """Keeps what is shown of the first controller beside what follows, or no longer."""
        self._held = None
        if active and self._answer is not None:
            run = next(iter(self._answer.runs.values()), self._answer.without)
            self._held = self._answer.request.manoeuvre, run
        if self._answer is not None:
            self._draw(self._answer)

    def _take(self, answer: Answer) -> None:
        """Shows an answer."""
        before, self._answer = self._answer, answer
        self._hold_button.disabled = False
        if answer.request is self._request and self._status.text == RUNNING:
            self._status.text = ""
        self._draw(answer)
        if before is None or before.request.manoeuvre != answer.request.manoeuvre:
            start, end = self._runner.window(answer.request.manoeuvre)
            self._x_range.update(start=start, end=end, reset_start=start, reset_end=end)

    def _draw(self, answer: Answer) -> None:
        """Its curves and metrics, and those of the run that is held, if that is one of this manoeuvre."""
        runs = dict(answer.runs)
        if self._held is not None and self._held[0] == answer.request.manoeuvre:
            runs[HELD] = self._held[1]
        signals = {name: run.results for name, run in runs.items()}
        (table,) = tables(self._drawn(answer.without.results, signals, signals.get(HELD)))
        self._source.data = as_drawn(extremes(table, MOST_ROWS))
        self._show(runs)
        self._table.text = metrics_table({"without control": answer.without, **runs})


def _as_typed(request: Request) -> str:
    return ", ".join(f"{name}={value!r}" for name, value in request.typed.items())


def _explained(meaning: str) -> str:
    """The style of a slider that says what it means while the pointer is on it."""
    return (
        ".bk-slider-title { white-space: nowrap; } .noUi-target[disabled] { opacity: 0.3; } "
        f":host(:hover)::after {{ content: {json.dumps(meaning)}; position: absolute; top: 100%; left: 0; z-index: 9; "
        "background: #ffffe8; border: 1px solid #bbbbbb; padding: 2px 4px; pointer-events: none; }"
    )


def metrics_table(runs: Mapping[str, Run]) -> str:
    """The metrics of runs by their names, as HTML."""
    pad = "padding:1px 6px"
    head = "".join(
        f'<th title="{escape(metric.description)}" style="{pad}">{escape(c.plain_heading)}<br>{escape(c.unit)}</th>'
        for metric, c in SHOWN
    )
    lines = []
    for name, (_, metrics) in runs.items():
        cells = "".join(
            f'<td style="{pad}" title="{escape(metrics.absent.get(metric.name, ""))}">'
            f"{number(metric.of(metrics), c)}</td>"
            for metric, c in SHOWN
        )
        lines.append(f'<tr><td style="text-align:left">{escape(name)}</td>{cells}</tr>')
    style = "border-collapse:collapse;text-align:right;font-variant-numeric:tabular-nums"
    return f'<table style="{style}"><tr><th></th>{head}</tr>{"".join(lines)}</table>'
