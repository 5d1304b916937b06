"""Runs what is wanted: without control, with ours, and with the controllers beside it."""

from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ..cosimulation.wiring import Fit, beyond, fit, require
from ..errors import DrivelineError
from ..manoeuvres.catalogue import MANOEUVRES
from ..metrics.evaluate import evaluate
from ..metrics.record import Metrics
from ..names import nearest
from ..simulate import looped, simulate
from .knobs import CAR, GAINS, Knob, knobs
from .wanted import Wanted, characterised, parameters

Given = Mapping[tuple[str, str], tuple[str, Mapping[str, Any]]]
"""By the names of plant and controller the plant (name or file) and what else `harness.simulate.simulate` takes."""


class Run(NamedTuple):
    """One run, with what it is worth."""

    results: np.ndarray
    metrics: Metrics


class Answer(NamedTuple):
    """Attributes:
    without: the run without control.
    runs: with control, by the names of the controllers.
    """

    wanted: Wanted
    without: Run
    runs: Mapping[str, Run]


class Bench:
    """The loops that can be chosen.

    Attributes:
        controllers: by name; the first is the one whose gains can be turned.
        car, gains: what can be turned.
    """

    def __init__(self, given: Given) -> None:
        self._given = given
        self._undamped: tuple[Any, Run] | None = None
        self.controllers = list(dict.fromkeys(controller for _, controller in given))
        fits = [self.fit(plant, self.controllers[0]) for plant in self.plants]
        start = {key: value for plant in self.plants for key, value in self.settings(plant)["parameters"].items()}
        self.car: list[Knob] = list(knobs(CAR, fits, start))
        self.gains: list[Knob] = list(knobs(GAINS, fits, start))

    @property
    def plants(self) -> list[str]:
        return list(dict.fromkeys(plant for plant, _ in self._given))

    def settings(self, plant: str, controller: str | None = None) -> Mapping[str, Any]:
        """Of the loop with a controller, by default with ours."""
        return self._given[plant, controller or self.controllers[0]][1]

    @cache  # noqa: B019 (a bench lives as long as the program)
    def fit(self, plant: str, controller: str) -> Fit:
        return fit(looped(*self._given[plant, controller]))

    def require_parameter(self, key: str) -> None:
        """Refuses the name of a parameter, `instance.name`, that no loop has.

        Raises:
            DrivelineError: no loop has it.
        """
        known = {name for key in self._given for name in self._known(*key)}
        if key not in known:
            raise DrivelineError(f"there is no parameter {key}; {nearest(key, sorted(known))}")

    def _known(self, plant: str, controller: str) -> list[str]:
        names = self._names(plant, controller)
        return [f"{instance}.{name}" for instance, each in names.items() for name in each]

    def answer(self, wanted: Wanted) -> Answer:
        """Makes the runs.

        Raises:
            DrivelineError: a value is refused, or an FMU has ended a run.
        """
        first = self.controllers[0]
        shown = [*([first] if wanted.control else []), *(name for name in wanted.others if name in self.controllers)]
        return Answer(wanted, self._without(wanted), {name: self._run(wanted, name, True) for name in shown})

    def gains_of(self, wanted: Wanted) -> dict[str, float]:
        """The gains that our controller has, as they were changed and by the character."""
        return characterised({knob.name: knob.value for knob in self.gains} | dict(wanted.gains), wanted.character)

    def parameters(self, wanted: Wanted, controller: str) -> dict[str, float]:
        """Of the loop with a controller."""
        names, settings = self._names(wanted.plant, controller), self.settings(wanted.plant, controller)
        gains = self._changed_gains(wanted) if controller == self.controllers[0] else {}
        return parameters(wanted, names, settings["parameters"], gains)

    def _changed_gains(self, wanted: Wanted) -> dict[str, float]:
        if wanted.character == 0.5:
            return dict(wanted.gains)
        start = {knob.name: knob.value for knob in self.gains}
        return {name: value for name, value in self.gains_of(wanted).items() if value != start[name]}

    @cache  # noqa: B019
    def _names(self, plant: str, controller: str) -> dict[str, list[str]]:
        interfaces = self.fit(plant, controller).interfaces
        return {
            instance: [variable.name for variable in interface.of_causality("parameter")]
            for instance, interface in interfaces.items()
        }

    def _without(self, wanted: Wanted) -> Run:
        """The run without control, which is made again only where the controller is not all that has changed."""
        given = self.parameters(wanted, self.controllers[0])
        key = wanted.plant, wanted.manoeuvre, {k: v for k, v in given.items() if not k.startswith("controller.")}
        if self._undamped is None or self._undamped[0] != key:
            self._undamped = key, self._run(wanted, self.controllers[0], False)
        return self._undamped[1]

    def _run(self, wanted: Wanted, controller: str, control: bool) -> Run:
        manoeuvre, given = MANOEUVRES[wanted.manoeuvre], self.parameters(wanted, controller)
        require(beyond(self.fit(wanted.plant, controller), given))
        plant, settings = self._given[wanted.plant, controller]
        results = simulate(manoeuvre, plant, control, **{**settings, "parameters": given})
        return Run(results, evaluate(results, manoeuvre))
