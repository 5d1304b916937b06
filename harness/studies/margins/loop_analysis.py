"""The whole analysis of the loop with a controller, on all cores: linear, and from runs."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from fmuloop.many_runs import run_many
from fmuloop.parameter_changes import require_constant
from toolground.errors import UserError

from ....fmus.building.builds import fmu_of
from ...loop.resolved import ResolvedLoop
from ...manoeuvres.catalogue import MANOEUVRES
from ...manoeuvres.for_car import for_car
from ...metrics.estimate import EstimateMetrics, estimate_metrics
from ...metrics.evaluate import evaluate
from ...metrics.run_metrics import Metrics
from ...simulation.simulate import simulate
from . import sensitivity
from .describing_function import LimitCycle, Swing, limit_cycles, swings
from .linear_loop import LinearLoop, linear_loop
from .margins import Margins, margins
from .modes import Mode, alone, drive_train_mode, is_stable
from .operating_point import Point
from .parameter_sweeps import SWEEPS, Swept, swept

SPEEDS = (5.0, 15.0, 50.0, 100.0)
"""In km/h, at which margins are told; the figures are drawn at the second."""

TORQUE = 0.2
"""Of the point, over T_max: the teeth stay in contact."""

ESTIMATED = ("tipin15", "tipout", "launch", "drive", "creep")
"""Manoeuvres in which the estimate is looked at."""


FACTORS = (1.0 - sensitivity.CHANGE, 1.0 + sensitivity.CHANGE)

BY_NAME = {sweep.name: sweep for sweep in SWEEPS}


class At(NamedTuple):
    """The loop of a plant at a speed in km/h."""

    plant: str
    speed: float
    loop: LinearLoop
    mode: Mode
    margins: Margins


class Analysis(NamedTuple):
    """What was found for a controller; all by the names of the plants.

    Attributes:
        swept: by plant and sweep.
        estimates: by plant and manoeuvre.
    """

    controller: str
    at: list[At]
    swept: dict[str, dict[str, list[Swept]]]
    swings: dict[str, list[Swing]]
    limit_cycles: dict[str, list[LimitCycle]]
    estimates: dict[tuple[str, str], EstimateMetrics]
    sensitivities: list[sensitivity.Sensitivity]

    @property
    def record(self) -> dict[str, Any]:
        """All of it for files, in SI units; what is infinite or no number is left as it is."""
        return {
            "controller": self.controller,
            "margins": [
                {"plant": at.plant, "speed_km_per_h": at.speed, **at.mode._asdict(), **vars(at.margins)}
                for at in self.at
            ],
            "poles": [
                {"plant": plant, "sweep": name, "value": each.value, **each.mode._asdict()}
                | {"margins": each.margins and vars(each.margins)}
                for plant, sweeps in self.swept.items()
                for name, swept in sweeps.items()
                for each in swept
            ],
            "backlash": [
                {"plant": plant, "amplitude": each.amplitude, "N": each.N, "stable": each.stable}
                | {"margins": each.margins and vars(each.margins)}
                for plant, swings in self.swings.items()
                for each in swings
            ],
            "limit_cycles": [
                {"plant": plant, **each._asdict()} for plant, cycles in self.limit_cycles.items() for each in cycles
            ],
            "estimates": [
                {"plant": plant, "manoeuvre": manoeuvre, **vars(metrics)}
                for (plant, manoeuvre), metrics in self.estimates.items()
            ],
            "sensitivities": [each._asdict() for each in self.sensitivities],
        }


class Run(NamedTuple):
    """A run of the loop: what is changed to what, if anything is."""

    plant: str
    manoeuvre: str
    parameter: str | None = None
    value: float = 0.0


class Part(NamedTuple):
    """A piece of the linear analysis: a speed in km/h, "backlash" or the name of a sweep."""

    plant: str
    what: str


def point_of(plant: str, controller: str, parameters: Mapping[str, Any]) -> Point:
    """The loop of a plant and a controller at 15 km/h.

    Args:
        parameters: `instance.name` -> value.
    """
    given: dict[str, dict[str, Any]] = {}
    for name, value in parameters.items():
        place, _, parameter = name.partition(".")
        given.setdefault(place, {})[parameter] = value
    plant_block: Any = fmu_of(plant).block
    block: Any = fmu_of(controller).block
    T_max = block.Parameters(**given.get("controller", {})).T_max
    return Point(plant_block, block, given, v=SPEEDS[1] / 3.6, T=TORQUE * T_max)


def linear_part(part: Part, controller: str, parameters: Mapping[str, Mapping[str, Any]]) -> Any:
    """A piece of the linear analysis; parameters by plant.

    Raises:
        NotLinear: the controller is not linear in contact.
        UserError: the loop is not stable in contact.
    """
    point = point_of(part.plant, controller, parameters[part.plant])
    if part.what == "backlash":
        found = swings(point)
        return found, limit_cycles(point, found)
    if part.what in BY_NAME:
        return list(swept(point, BY_NAME[part.what]))
    speed = float(part.what)
    loop = linear_loop(replace(point, v=speed / 3.6))
    if not is_stable(loop):
        raise UserError(f"the loop with {controller} is not stable in contact at {speed:g} km/h: it has no margins")
    return At(part.plant, speed, loop, drive_train_mode(loop, alone(point).frequency), margins(loop))


def run_of(run: Run, loops: Mapping[str, ResolvedLoop]) -> tuple[Metrics, EstimateMetrics]:
    """What a run of the loop is worth; loops by plant."""
    changed = {} if run.parameter is None else {run.parameter: run.value}
    manoeuvre = for_car(MANOEUVRES[run.manoeuvre], loops[run.plant].T_max)
    results = simulate(manoeuvre, loops[run.plant].with_parameters(changed))
    return evaluate(results, manoeuvre), estimate_metrics(results)


def analyse(loops: Mapping[str, ResolvedLoop]) -> Analysis:
    """Analyses the loop.

    Args:
        loops: by the names of plants of the project, with one of its controllers.

    Raises:
        NotLinear, UserError: see `linear_part`.
    """
    plants, controller = list(loops), str(next(iter(loops.values())).settings.controller)
    parameters = {plant: loops[plant].settings.parameters for plant in plants}
    for given in parameters.values():
        require_constant(given, "a linear loop")
    pieces = [*(f"{speed:g}" for speed in SPEEDS), *BY_NAME, "backlash"]
    parts = [Part(plant, piece) for plant in plants for piece in pieces]
    linear = partial(linear_part, controller=controller, parameters=parameters)
    found = dict(zip(parts, run_many(linear, parts, label="linear loop"), strict=True))

    changed = {plant: sensitivity.varied(plant, controller, parameters[plant]) for plant in plants}
    runs = [Run(plant, name) for plant in plants for name in dict.fromkeys((*ESTIMATED, *sensitivity.VARIED_IN))]
    runs += [
        Run(plant, name, parameter, factor * value)
        for plant in plants
        for name in sensitivity.VARIED_IN
        for parameter, value in changed[plant].items()
        for factor in FACTORS
    ]
    worth = dict(zip(runs, run_many(partial(run_of, loops=loops), runs, label="runs"), strict=True))

    def depends(plant: str, manoeuvre: str, parameter: str) -> sensitivity.Sensitivity:
        value = changed[plant][parameter]
        small, large = (worth[Run(plant, manoeuvre, parameter, factor * value)][0] for factor in FACTORS)
        nominal = worth[Run(plant, manoeuvre)][0]
        return sensitivity.sensitivity(plant, manoeuvre, parameter, (small, nominal, large))

    return Analysis(
        Path(controller).stem,
        [found[Part(plant, f"{speed:g}")] for plant in plants for speed in SPEEDS],
        {plant: {name: found[Part(plant, name)] for name in BY_NAME} for plant in plants},
        {plant: found[Part(plant, "backlash")][0] for plant in plants},
        {plant: found[Part(plant, "backlash")][1] for plant in plants},
        {(plant, name): worth[Run(plant, name)][1] for plant in plants for name in ESTIMATED},
        [depends(p, name, parameter) for p in plants for name in sensitivity.VARIED_IN for parameter in changed[p]],
    )
