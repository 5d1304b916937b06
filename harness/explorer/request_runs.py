"""Makes the runs of a request: without control, with ours, and with the controllers beside it."""

from collections.abc import Mapping
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np
from numpy.lib.recfunctions import repack_fields

from ...fmus.building.one_car import FOLLOW
from ...fmus.errors import ParameterFileError
from ..base.errors import DrivelineError
from ..base.known_names import nearest
from ..cosimulation.parameter_changes import parted
from ..cosimulation.wiring import Fit, fit, out_of_bounds, require
from ..loop.settings import Settings, loop
from ..manoeuvres.catalogue import MANOEUVRES
from ..manoeuvres.drivable import require_road
from ..manoeuvres.manoeuvre import Manoeuvre
from ..manoeuvres.road_load import Track
from ..metrics.evaluate import at_samples, evaluate
from ..metrics.run_metrics import Metrics
from ..recordings.drive import Drive
from ..simulation.simulate import simulate
from ..studies.drives.replay import car_of, followed
from ..views.html.paired_runs import NEEDED, shown_at_first
from .knobs import CAR, GAINS, Knob, knobs
from .request import Request, characterised, parameters
from .worker import Beside

Given = Mapping[tuple[str, str], Settings]
"""The settings of the loops by the names of plant and controller."""


class Run(NamedTuple):
    """What is drawn of one run, at the samples of the controller, with what it is worth."""

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

    Args:
        of_car: entries of the vehicle file that the loops were given.
        manoeuvres: that can be chosen, by name.
        recording: a recorded drive that can be chosen too.

    Attributes:
        controllers: by name; the first is the one whose gains can be turned.
        car, gains: what can be turned.
        beside: makes the run without control while this thread makes the others; None: they follow each other.

    Raises:
        DrivelineError: a manoeuvre has the name of the recording.
    """

    def __init__(
        self,
        given: Given,
        of_car: Mapping[str, float] | None = None,
        manoeuvres: Mapping[str, Manoeuvre] = MANOEUVRES,
        recording: Drive | None = None,
    ) -> None:
        if recording is not None and recording.name in manoeuvres:
            raise DrivelineError(f"two manoeuvres are called {recording.name}; rename the file of the recording")
        self._given = given
        self.of_car = of_car or {}
        self._manoeuvres = manoeuvres
        self._recording = recording
        self._undamped: tuple[Any, Run] | None = None
        self.beside: Beside | None = None
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

    @property
    def manoeuvres(self) -> dict[str, str]:
        """What can be chosen, with what it is; the recorded drive first."""
        drive = self._recording
        recorded = {} if drive is None else {drive.name: f"recorded drive of {np.ptp(drive.time):.0f} s"}
        return recorded | {name: each.description for name, each in self._manoeuvres.items()}

    def window(self, manoeuvre: str) -> tuple[float, float]:
        """From and to when in s it is shown at first."""
        if manoeuvre in self._manoeuvres:
            return shown_at_first(self._manoeuvres[manoeuvre])
        assert self._recording is not None
        return 0.0, float(np.ptp(self._recording.time))

    @cache  # noqa: B019
    def manoeuvre(self, name: str, plant: str) -> Manoeuvre:
        """That of a recorded drive keeps the car, as it is at the start and without control, at the recorded speed."""
        if name in self._manoeuvres:
            return self._manoeuvres[name]
        assert self._recording is not None
        load, T_max = car_of(self.settings(plant))
        return followed(Track.of(self._recording, T_max), load, self.settings(plant))[0]

    def require(self, request: Request) -> None:
        """Refuses what cannot run.

        Raises:
            DrivelineError: there is no such plant, manoeuvre or parameter, the plant cannot have the road, or an FMU
                does not take a value.
        """
        if request.plant not in self.plants or request.manoeuvre not in self.manoeuvres:
            raise DrivelineError(f"there is no {request.plant} or {request.manoeuvre}")
        if request.manoeuvre in self._manoeuvres:
            require_road(self._manoeuvres[request.manoeuvre], self.fit(request.plant, self.controllers[0]))
        shown = {self.controllers[0], *self._controllers(request)}
        known = {
            f"{place}.{name}"
            for each in shown
            for place, has in self._names(request.plant, each).items()
            for name in has
        }
        if lacking := {parted(name)[0] for name in request.typed} - self._known():
            name = min(lacking)
            raise DrivelineError(f"there is no parameter {name}; {nearest(name, sorted(known))}")
        for controller in shown:
            require(out_of_bounds(self.fit(request.plant, controller), self.parameters(request, controller)))

    @cache  # noqa: B019
    def _known(self) -> frozenset[str]:
        """`instance.name` of the parameters of all loops."""
        names = (self._names(*key) for key in self._given)
        return frozenset(f"{place}.{name}" for each in names for place, has in each.items() for name in has)

    def turnable(self, request: Request) -> set[str]:
        """Names of the knobs that change something of what is shown."""
        found: set[str] = set()
        for controller in (None, *self._controllers(request)):
            names = self._names(request.plant, controller or self.controllers[0])
            places = names.keys() - ({"controller"} if controller is None or not request.informed else set())
            found |= {knob.name for knob in self.car if any(knob.name in names[place] for place in places)}
            if set(names["plant"]) >= set(FOLLOW):
                found |= {"C", "J_2"}  # which they follow from
            if controller == self.controllers[0]:
                found |= {knob.name for knob in self.gains if knob.name in names["controller"]}
        return found

    def _controllers(self, request: Request) -> list[str]:
        """Those whose runs are shown."""
        first = [self.controllers[0]] if request.control else []
        return [*first, *(name for name in request.others if name in self.controllers)]

    def answer(self, request: Request) -> Answer:
        """Makes the runs.

        Raises:
            DrivelineError: as of `require`, or an FMU has ended a run.
        """
        self.require(request)
        without = partial(self._without, request)
        if self.beside is not None:
            without = self.beside.begin(without)
        runs = {name: self._run(request, name, True) for name in self._controllers(request)}
        return Answer(request, without(), runs)

    def gains_of(self, request: Request) -> dict[str, float]:
        """The gains that our controller has, as they were changed and by the character, as far as sliders go."""
        gains = {knob.name: knob.value for knob in self.gains} | dict(request.gains)
        turned = characterised(gains, request.character)
        ends = {k.name: (min(k.low, gains[k.name]), max(k.high, gains[k.name])) for k in self.gains}
        return turned | {name: min(max(turned[name], low), high) for name, (low, high) in ends.items()}

    def parameters(self, request: Request, controller: str) -> dict[str, float]:
        """Of the loop with a controller.

        Raises:
            DrivelineError: there is no such car.
        """
        names, settings = self._names(request.plant, controller), self.settings(request.plant, controller)
        gains = self._changed_gains(request) if controller == self.controllers[0] else {}
        try:
            return parameters(request, names, settings.parameters, gains, self.of_car)
        except ParameterFileError as refusal:
            raise DrivelineError(str(refusal)) from refusal

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
        manoeuvre, given = self.manoeuvre(request.manoeuvre, request.plant), self.parameters(request, controller)
        settings = self._given[request.plant, controller]
        results = simulate(manoeuvre, settings, control=control, parameters=given)
        return Run(repack_fields(at_samples(results)[NEEDED]), evaluate(results, manoeuvre))
