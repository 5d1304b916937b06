"""Makes the runs of a request: without control, with ours, and with the controllers beside it."""

from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ..base.errors import DrivelineError
from ..base.known_names import nearest
from ..cosimulation.wiring import Fit, fit, out_of_bounds, require
from ..loop.settings import Settings, loop
from ..manoeuvres.catalogue import MANOEUVRES
from ..metrics.evaluate import evaluate
from ..metrics.run_metrics import Metrics
from ..simulation.simulate import simulate
from .knobs import CAR, GAINS, Knob, knobs
from .request import Request, characterised, parameters

Given = Mapping[tuple[str, str], Settings]
"""The settings of the loops by the names of plant and controller."""


class Run(NamedTuple):
    """One run, with what it is worth."""

    results: np.ndarray
    metrics: Metrics


class Answer(NamedTuple):
    """Attributes:
    without: the run without control.
    runs: with control, by the names of the controllers.
    """

    request: Request
    without: Run
    runs: Mapping[str, Run]


class RequestRunner:
    """Runs requests with the loops that can be chosen.

    Attributes:
        controllers: by name; the first is the one whose gains can be turned.
        car, gains: what can be turned.
    """

    def __init__(self, given: Given) -> None:
        self._given = given
        self._undamped: tuple[Any, Run] | None = None
        self.controllers = list(dict.fromkeys(controller for _, controller in given))
        fits = [self.fit(plant, self.controllers[0]) for plant in self.plants]
        start = {key: value for plant in self.plants for key, value in self.settings(plant).parameters.items()}
        self.car: list[Knob] = list(knobs(CAR, fits, start))
        self.gains: list[Knob] = list(knobs(GAINS, fits, start))

    @property
    def plants(self) -> list[str]:
        return list(dict.fromkeys(plant for plant, _ in self._given))

    def settings(self, plant: str, controller: str | None = None) -> Settings:
        """Of the loop with a controller, by default with ours."""
        return self._given[plant, controller or self.controllers[0]]

    @cache  # noqa: B019 (a runner lives as long as the program)
    def fit(self, plant: str, controller: str) -> Fit:
        return fit(loop(self._given[plant, controller]))

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

    def answer(self, request: Request) -> Answer:
        """Makes the runs.

        Raises:
            DrivelineError: a value is refused, or an FMU has ended a run.
        """
        first = self.controllers[0]
        shown = [*([first] if request.control else []), *(name for name in request.others if name in self.controllers)]
        return Answer(request, self._without(request), {name: self._run(request, name, True) for name in shown})

    def gains_of(self, request: Request) -> dict[str, float]:
        """The gains that our controller has, as they were changed and by the character."""
        return characterised({knob.name: knob.value for knob in self.gains} | dict(request.gains), request.character)

    def parameters(self, request: Request, controller: str) -> dict[str, float]:
        """Of the loop with a controller."""
        names, settings = self._names(request.plant, controller), self.settings(request.plant, controller)
        gains = self._changed_gains(request) if controller == self.controllers[0] else {}
        return parameters(request, names, settings.parameters, gains)

    def _changed_gains(self, request: Request) -> dict[str, float]:
        if request.character == 0.5:
            return dict(request.gains)
        start = {knob.name: knob.value for knob in self.gains}
        return {name: value for name, value in self.gains_of(request).items() if value != start[name]}

    @cache  # noqa: B019
    def _names(self, plant: str, controller: str) -> dict[str, list[str]]:
        interfaces = self.fit(plant, controller).interfaces
        return {
            instance: [variable.name for variable in interface.of_causality("parameter")]
            for instance, interface in interfaces.items()
        }

    def _without(self, request: Request) -> Run:
        """The run without control, which is made again only where the controller is not all that has changed."""
        given = self.parameters(request, self.controllers[0])
        key = request.plant, request.manoeuvre, {k: v for k, v in given.items() if not k.startswith("controller.")}
        if self._undamped is None or self._undamped[0] != key:
            self._undamped = key, self._run(request, self.controllers[0], False)
        return self._undamped[1]

    def _run(self, request: Request, controller: str, control: bool) -> Run:
        manoeuvre, given = MANOEUVRES[request.manoeuvre], self.parameters(request, controller)
        require(out_of_bounds(self.fit(request.plant, controller), given))
        settings = self._given[request.plant, controller]
        results = simulate(manoeuvre, settings, control=control, parameters=given)
        return Run(results, evaluate(results, manoeuvre))
