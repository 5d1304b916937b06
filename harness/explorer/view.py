"""The page of a tab: knobs and switches on the left, curves and metrics on the right."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from html import escape
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
from bokeh.document import Document
from bokeh.events import ButtonClick, DocumentReady
from bokeh.layouts import column, row
from bokeh.models import Button, CheckboxGroup, Div, Select, Slider, Switch, TextInput

from ..base.errors import DrivelineError
from ..manoeuvres.catalogue import MANOEUVRES
from ..metrics.evaluate import T_S, at_samples
from ..metrics.run_metrics import Metrics
from ..views.colours import GREEN, ORANGE, PURPLE, SKY, VERMILION
from ..views.html.linked_figures import as_drawn, linked, shown, source_of, stacked, tables
from ..views.html.paired_runs import NEEDED, TIME, pair_panels, shown_at_first
from ..views.metrics_table import SHOWN, number
from ..views.panels import Curve, Panel
from .knobs import Knob
from .request import Request
from .request_runs import Answer, RequestRunner
from .worker import Worker

BESIDE = (VERMILION, GREEN, ORANGE, PURPLE, SKY, "#999933")
"""Colours of the other controllers, in turn."""

STRIDE = 2
"""Every so many samples of the controller are shown: 4 ms."""

WRAPPED = ".bk-slider-title { white-space: normal; }"

Save = Callable[[Answer], Sequence[Path]]
"""Writes an answer; gives the files."""

Typed = Callable[[str], tuple[str, float]]
"""Name and value of `plant.J_1=0.06`; ValueError says why not."""


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
        self._request = Request(runner.plants[0], next(iter(MANOEUVRES)))
        self._shown = self._request.manoeuvre
        self._gone = False
        self._status, self._table = Div(name="status", text=""), Div(name="metrics", text="")
        nothing = np.zeros(2, dtype=[(name, float) for name in NEEDED])
        nothing["time"] = 0.0, T_S
        self._panels = self._drawn(nothing, {})
        self._source = source_of(tables(self._panels)[0])
        self._x_range = shown(TIME._replace(window=shown_at_first(MANOEUVRES[self._request.manoeuvre])))
        document.title = "driveline explore"
        document.add_root(row(self._controls(saves), self._figures(), name="view", sizing_mode="stretch_width"))
        document.on_session_destroyed(self._leave)
        document.on_event(DocumentReady, lambda _: self._ask())  # nothing runs for who never shows the page

    def _drawn(self, empty: np.ndarray, runs: Mapping[str, np.ndarray]) -> list[Panel]:
        """The panels of results by the names of the controllers, beside those without control; NaN where there are
        none."""
        ours, *others = self._runner.controllers
        empty = empty[NEEDED]
        absent = np.full(len(empty), np.nan, empty.dtype)
        for known in ("time", "controller.T_driver"):
            absent[known] = empty[known]
        torque, *rest = pair_panels(empty, runs.get(ours, absent))
        t = at_samples(empty)["time"]
        beside = [
            Curve(t, at_samples(runs.get(name, absent))["plant.T_gear"], f"with {name}", color)
            for name, color in zip(others, cycle(BESIDE), strict=False)
        ]
        return [replace(torque, parts=[*torque.parts, *beside]), *rest]

    def _controls(self, saves: dict[str, Save]) -> Any:
        runner = self._runner
        plant = Select(title="plant", value=self._request.plant, options=list(runner.plants), name="plant")
        manoeuvre = Select(
            title="manoeuvre",
            value=self._request.manoeuvre,
            options=[(name, f"{name}: {each.description}") for name, each in MANOEUVRES.items()],
            name="manoeuvre",
        )
        control, informed = Switch(active=True, name="control"), Switch(active=True, name="informed")
        others = CheckboxGroup(labels=runner.controllers[1:], active=[], name="others")
        character = Slider(title="sport to comfort", start=0.0, end=1.0, step=0.02, value=0.5, name="character")
        more = TextInput(title="any other parameter, as plant.mu=0.3", name="more")
        plant.on_change("value", lambda _, __, value: self._ask(plant=value))
        manoeuvre.on_change("value", lambda _, __, value: self._ask(manoeuvre=value))
        control.on_change("active", lambda _, __, value: self._ask(control=bool(value)))
        informed.on_change("active", lambda _, __, value: self._ask(informed=bool(value)))
        others.on_change("active", lambda _, __, active: self._ask(others=self._named(active)))
        character.on_change("value", lambda _, __, value: self._ask(character=self._within(value, 0.0, 1.0)))
        more.on_change("value", lambda _, __, text: self._type(text))
        buttons = [self._button(label, save) for label, save in saves.items()]
        return column(
            plant,
            manoeuvre,
            row(control, Div(text=f"control by {escape(runner.controllers[0])}")),
            Div(text="beside it"),
            others,
            Div(text="<b>car</b>"),
            *(self._slider(knob, "car") for knob in runner.car),
            row(informed, Div(text="the controllers know this car")),
            Div(text="<b>gains</b>"),
            character,
            *(self._slider(knob, "gains") for knob in runner.gains),
            more,
            row(*buttons),
            width=330,
        )

    def _slider(self, knob: Knob, kind: str) -> Slider:
        unit = f" in {knob.unit}" if knob.unit else ""
        slider = Slider(
            title=f"{knob.name}{unit}: {knob.meaning}",
            start=knob.low,
            end=knob.high,
            step=knob.step,
            value=knob.value,
            format="0[.]0000",
            name=knob.name,
            width=310,
            stylesheets=[WRAPPED],
        )
        slider.on_change("value", lambda _, __, value: self._turn(kind, knob, value))
        return slider

    def _button(self, label: str, save: Save) -> Button:
        button = Button(label=label, button_type="primary", name=label)
        button.on_event(ButtonClick, lambda: self._save(save))
        return button

    def _figures(self) -> Any:
        figures = linked(self._panels, TIME, self._x_range, [self._source])
        entries: Any = figures[0].legend[0].items[1 - len(self._runner.controllers) :]
        self._beside: dict[str, Any] = dict(zip(self._runner.controllers[1:], entries, strict=True))
        for entry in entries:
            entry.visible = entry.renderers[0].visible = False
        return column(self._status, self._table, stacked(figures), sizing_mode="stretch_width")

    def _turn(self, kind: str, knob: Knob, value: float) -> None:
        value = self._within(value, knob.low, knob.high)
        self._ask(**{kind: {**getattr(self._request, kind), knob.name: value}})

    @staticmethod
    def _within(value: float, low: float, high: float) -> float:
        """The value of a slider, which a page of somebody's own might send otherwise."""
        return float(min(max(value, low), high)) if value == value else low

    def _named(self, active: Sequence[int]) -> tuple[str, ...]:
        others = self._runner.controllers[1:]
        return tuple(others[k] for k in active if 0 <= k < len(others))

    def _type(self, text: str) -> None:
        if not text.strip():
            self._ask(typed={})
            return
        try:
            key, value = self._typed(text)
            self._runner.require_parameter(key)
        except (ValueError, DrivelineError) as refusal:
            self._refuse(str(refusal))
        else:
            self._ask(typed={**self._request.typed, key: value})

    def _ask(self, **changes: Any) -> None:
        """Changes the request and asks for its runs."""
        request = replace(self._request, **changes)
        if request.plant not in self._runner.plants or request.manoeuvre not in MANOEUVRES:
            self._refuse(f"there is no {request.plant} or {request.manoeuvre}")
            return
        self._request = request
        self._worker.ask(self, partial(self._do, partial(self._runner.answer, request), self._take))

    def _save(self, save: Save) -> None:
        """What the controls say now, whatever is shown yet."""
        self._status.text = "writing ..."
        request = self._request
        self._worker.ask((self, save), partial(self._do, lambda: save(self._runner.answer(request)), self._saved))

    def _do(self, job: Callable[[], Any], then: Callable[[Any], None]) -> None:
        """In the thread of the worker: does a job and has the tab show what came of it."""
        try:
            came = job()
        except DrivelineError as refusal:
            self._later(partial(self._refuse, str(refusal)))
        except Exception as error:
            self._later(partial(self._refuse, f"{type(error).__name__}: {error}"))
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

    def _take(self, answer: Answer) -> None:
        """Shows an answer."""
        runs = {name: run.results for name, run in answer.runs.items()}
        (signals,) = tables(self._drawn(answer.without.results, runs))
        self._source.data = as_drawn({name: signal[::STRIDE] for name, signal in signals.items()})
        for name, entry in self._beside.items():
            if entry.visible != (name in answer.runs):  # else a click in the legend stays
                entry.visible = entry.renderers[0].visible = name in answer.runs
        self._table.text = metrics_table(answer)
        self._status.text = ""
        if self._shown != answer.request.manoeuvre:
            self._shown = answer.request.manoeuvre
            start, end = shown_at_first(MANOEUVRES[self._shown])
            self._x_range.update(start=start, end=end, reset_start=start, reset_end=end)


def metrics_table(answer: Answer) -> str:
    """The metrics of all runs as HTML."""
    runs: dict[str, Metrics] = {"without control": answer.without.metrics}
    runs |= {name: run.metrics for name, run in answer.runs.items()}
    pad = "padding:2px 8px"
    head = "".join(
        f'<th title="{escape(metric.description)}" style="{pad}">{escape(c.plain_heading)}<br>{escape(c.unit)}</th>'
        for metric, c in SHOWN
    )
    lines = []
    for name, metrics in runs.items():
        cells = "".join(
            f'<td style="{pad}" title="{escape(metrics.absent.get(metric.name, ""))}">'
            f"{number(metric.of(metrics), c)}</td>"
            for metric, c in SHOWN
        )
        lines.append(f'<tr><td style="text-align:left">{escape(name)}</td>{cells}</tr>')
    style = "border-collapse:collapse;text-align:right;font-variant-numeric:tabular-nums"
    return f'<table style="{style}"><tr><th></th>{head}</tr>{"".join(lines)}</table>'
