"""What a page of `driveline explore` has in it, and the page."""

from collections.abc import Iterable, Mapping
from importlib.metadata import version
from itertools import cycle
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from driverecords.drive import Drive
from fmuloop.wiring import Fit
from toolground.atomic_files import complete
from toolground.errors import UserError
from toolground.written_numbers import REAL

from ...fmus.building.one_car import DEFAULT_CAR, with_estimates
from ..loop.parameter_words import FORMS, WORDS
from ..loop.places import PARAMETERS, PLACES, STEP_SIZE, T_S
from ..loop.resolved import ResolvedLoop, frequency_of_plant
from ..manoeuvres.catalogue import MANOEUVRES
from ..manoeuvres.drivable import require_road
from ..manoeuvres.for_car import share_of
from ..manoeuvres.manoeuvre import Manoeuvre
from ..manoeuvres.road_load import Track
from ..studies.drives.replay import car_of, followed
from ..views.annotations import shown_at_first
from ..views.metrics_table import SHOWN
from ..views.page.compared_runs import PANELS
from ..views.page.document import document
from ..views.signal_lines import CONTROLLERS
from .follow import following
from .knobs import CAR, COMFORT, GAINS, ROAD, SPORT, knobs
from .module import KINDS, loops_of, named, number
from .signal_data import manoeuvre_data

HERE = Path(__file__).parent / "page"

WORTH = ("settling_time", "overshoot", "gear_torque_rms", "jerk_rms", "impact_speed", "withheld_time")
"""The metrics of a page."""

BESIDE = tuple(color for color, *_ in CONTROLLERS[1:])
"""Colours of the other controllers, in turn."""

HELD = ("#8ab6d6", "#c3a5cf", "#d8b365")
"""Colours of the runs that are held, which are so many at most."""

FREE: Mapping[str, Any] = {
    "T_driver": [[0.0, -12.0], [1.0, -12.0], [1.0, 100.0]],
    "T_brake": [[0.0, 0.0]],
    "v_0": 5.0,
    "duration": 6.0,
}
"""The manoeuvre that is drawn by hand, at first, with the default car."""

MOST = 150.0
"""N.m up and down to which a demand is drawn by hand with the default car."""

Given = Mapping[tuple[str, str], ResolvedLoop]
"""The loops by the names of plant and controller."""


def content(
    resolved_of: Given,
    of_car: Mapping[str, Any] | None = None,
    gains: Mapping[str, Any] | None = None,
    manoeuvres: Mapping[str, Manoeuvre] = MANOEUVRES,
    recording: Drive | None = None,
    T_max: float = inf,
) -> dict[str, Any]:
    """The data of a page.

    Args:
        of_car, gains: entries of the vehicle file and of the file of parameters that the loops were given.
        manoeuvres: that can be chosen, by name.
        recording: a recorded drive that can be chosen too.
        T_max: largest torque of the motor in N.m; inf: that of the default car.

    Raises:
        UserError: there is no module of the loops, a manoeuvre has the name of the recording, or the plant cannot
            follow it.
    """
    if recording is not None and recording.name in manoeuvres:
        raise UserError(f"two manoeuvres are called {recording.name}; rename the file of the recording")
    if mapped := next((of.settings.mapping for of in resolved_of.values() if of.settings.mapping), None):
        raise UserError(f"--map {'='.join(next(iter(mapped.items())))}: a page has the names of the loop")
    fits = {key: of.fit for key, of in resolved_of.items()}
    car = with_estimates(of_car or _built_for(fits.values()))
    plants, controllers = (list(dict.fromkeys(key[k] for key in resolved_of)) for k in (0, 1))
    loops = loops_of({named(*key): fitted for key, fitted in fits.items()}, _are_ours(resolved_of))
    first = [fits[plant, controllers[0]] for plant in plants]
    start = {
        name: value
        for plant in plants
        for name, value in resolved_of[plant, controllers[0]].settings.parameters.items()
    }
    started = {port.name for port in PARAMETERS} | {f"plant.{name}" for m in manoeuvres.values() for name in m.road}
    turned = {"gains": knobs(GAINS, first, start), "car": knobs(CAR, first, start), "road": knobs(ROAD, first, start)}
    return {
        "version": version("driveline-damping"),
        "step": STEP_SIZE,
        "T_s": T_S,
        "loops": loops,
        "plants": plants,
        "ours": controllers[0],
        "others": dict(zip(controllers[1:], cycle(BESIDE), strict=False)),
        "base": {named(*key): _base(of, loops) for key, of in resolved_of.items()},
        "manoeuvres": _recorded(recording, resolved_of, controllers[0], plants)
        | {name: _shown(manoeuvre, plants, first) for name, manoeuvre in manoeuvres.items()},
        **_by_hand(share_of(T_max)),
        "knobs": {kind: [knob._asdict() for knob in of_kind] for kind, of_kind in turned.items()},
        "sport": SPORT,
        "comfort": COMFORT,
        "follow": following(car, frequency_of_plant(next(iter(resolved_of.values())))),
        "set": {
            name: value
            for of in resolved_of.values()
            for name, value in of.settings.parameters.items()
            if name in started
        },
        "words": {**WORDS, **FORMS, "real": REAL.pattern},
        "panels": [
            {"label": label, "curves": [signal._asdict() for signal in signals]} for label, signals in PANELS.items()
        ],
        "held": HELD,
        "metrics": [
            {
                "name": metric.name,
                "heading": f"{column.plain_heading}\n{column.printed_unit}",
                "meaning": metric.description,
                "factor": column.factor,
                "decimals": column.decimals,
            }
            for metric, column in SHOWN
            if metric.name in WORTH
        ],
        "files": {"car": car, "gains": dict(gains or {})},
    }


def _built_for(fits: Iterable[Fit]) -> dict[str, float]:
    """Entries of a vehicle file for the car that the plants were built for, where it is not the default one."""
    starts = {name: start for fitted in fits for name, start in fitted.parameters({})["plant"].items()}
    return {name: start for name, start in starts.items() if start != DEFAULT_CAR.get(name, start)}


def _by_hand(share: float) -> dict[str, Any]:
    """The manoeuvre that is drawn by hand, for a motor with this share of the torque of the default car's."""
    demand = [[t, float(f"{share * T:.3g}")] for t, T in FREE["T_driver"]]
    return {"free": {**FREE, "T_driver": demand}, "most": float(f"{share * MOST:.2g}")}


def write_page(data: Mapping[str, Any], path: Path) -> None:
    """Writes the page; complete, or not at all."""
    names = ("loop.js", "metrics.js", "follow.js", "settings.js", "worker.js")
    worker = "\n".join((HERE / name).read_text(encoding="utf-8").replace('"use strict";\n', "") for name in names)
    text = document(
        "driveline explore",
        (HERE / "explorer.html").read_text(encoding="utf-8"),
        data,
        [HERE / "settings.js", HERE / "explorer.js"],
        [HERE / "explorer.css"],
        extra=f'<script type="text/plain" id="worker">\n{worker}</script>',
    )
    with complete(path) as unfinished:
        unfinished.write_text(text, encoding="utf-8")


def _are_ours(resolved_of: Given) -> bool:
    return all(of.system.own == PLACES.keys() for of in resolved_of.values())


def _base(resolved: ResolvedLoop, loops: Mapping[str, Any]) -> dict[str, float]:
    """`instance.name` -> value that a run has and the module's FMU does not start with."""
    settings, fitted = resolved.settings, resolved.fit
    values = {f"{place}.seed": float(settings.seed) for place in ("motor", "can")}
    for instance, interface in fitted.interfaces.items():
        declared = loops["fmus"][interface.identifier]["parameters"]
        for variable in interface.of_causality("parameter"):
            value = number(variable.start)
            if variable.type in KINDS and value is not None and value != declared[variable.name]["start"]:
                values[f"{instance}.{variable.name}"] = value
    values |= {name: float(value) for name, value in settings.parameters.items()}
    return {name: value for name, value in values.items() if _has(fitted, name)}


def _has(fitted: Fit, name: str) -> bool:
    instance, _, own = name.partition("@")[0].partition(".")
    return instance in fitted.interfaces and own in fitted.interfaces[instance].variables


def _shown(manoeuvre: Manoeuvre, plants: list[str], fits: list[Fit]) -> dict[str, Any]:
    """A manoeuvre, and which plants have its road."""
    return {
        **manoeuvre_data(manoeuvre),
        "window": shown_at_first(manoeuvre),
        "possible": [plant for plant, fitted in zip(plants, fits, strict=True) if _has_road(manoeuvre, fitted)],
    }


def _has_road(manoeuvre: Manoeuvre, fitted: Fit) -> bool:
    try:
        require_road(manoeuvre, fitted)
    except UserError:
        return False
    return True


def _recorded(recording: Drive | None, resolved_of: Given, ours: str, plants: list[str]) -> dict[str, Any]:
    """The recorded drive: on each plant brake and grade keep the car without control at the recorded speed."""
    if recording is None:
        return {}
    duration = float(np.ptp(recording.time))
    on_plants = {}
    for plant in plants:
        resolved = resolved_of[plant, ours]
        load, T_max = car_of(resolved)
        on_plants[plant] = manoeuvre_data(followed(Track.of(recording, T_max), load, resolved)[0])
    return {
        recording.name: {
            "description": f"recorded drive of {duration:.0f} s",
            "duration": duration,
            "window": (0.0, duration),
            "possible": plants,
            "plants": on_plants,
        }
    }
