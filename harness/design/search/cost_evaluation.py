"""Costs of a controller: on a car, in the runs that count, against what the reference makes of them."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from fmuloop.campaign import RunRequest
from fmuloop.many_runs import many
from fmuloop.results import Results
from fmuloop.system import System

from ...loop.places import PLACES, PLANTS
from ...loop.settings import Settings, loop
from ...manoeuvres.for_car import for_car, given_torque
from ...manoeuvres.manoeuvre import Manoeuvre
from ...metrics.evaluate import evaluate
from ...metrics.run_metrics import Metrics
from ...simulation.same_fmus import anywhere, digests, require_same_fmus
from ...simulation.simulate import planned
from ..design import design
from ..uncertainty_box import deviating
from .controller_cost import Costs, costs
from .tuning_runs import RUNS, Run

REFERENCE = PLACES["controller"][0]
"""The controller with the gains that `driveline design` computes for the car."""


class Trial(NamedTuple):
    """A run with a controller and parameters of it."""

    controller: str
    parameters: Mapping[str, float]
    run: Run

    def __str__(self) -> str:
        return f"{self.run} with {self.controller} {dict(self.parameters)}"


@dataclass(frozen=True)
class CostEvaluation:
    """A controller on a car, whose parameters cost what they make of the runs that count.

        evaluation = driveline.CostEvaluation(driveline.Settings(controller="SpeedWashout"))
        with evaluation.opened() as costs_of:
            print([costs.total() for costs in costs_of([{"k_v": 1.5}, {"k_v": 2.5}])])

    Attributes:
        settings: of the loop with the controller; plant, parameters and seed are those of the runs.
        car: entries of the vehicle file.
        runs: that count.
    """

    settings: Settings = field(default_factory=Settings)
    car: Mapping[str, Any] = field(default_factory=dict)
    runs: Sequence[Run] = field(default_factory=lambda: RUNS)

    @property
    def controller(self) -> str:
        """Its name."""
        return str(self.settings.controller)

    def system(self, plant: str, controller: str) -> System:
        """The loop with a plant and a controller."""
        return loop(self.settings, plant=plant, controller=controller)

    def planned(self, trial: Trial) -> RunRequest:
        """The run."""
        run, (manoeuvre, parameters) = trial.run, self._car(trial)
        its = self.settings.replace(plant=run.plant, controller=trial.controller, parameters=parameters, seed=run.seed)
        return planned(manoeuvre, its)

    def measured(self, trial: Trial, results: Sequence[Results]) -> Metrics:
        """The metrics of the run."""
        return evaluate(results[0], self._car(trial)[0])

    def _car(self, trial: Trial) -> tuple[Manoeuvre, dict[str, float]]:
        """What the car is driven through, and its parameters."""
        controller, parameters, run = trial
        of_loop = deviating({**self.car, **parameters}, run.plant, controller, run.deviation)
        return for_car(run.manoeuvre, given_torque(of_loop)), of_loop

    def reference(self) -> dict[str, float]:
        """The gains that are computed for the car."""
        return design(self.car)

    def digests(self) -> dict[Path, str]:
        """Of the FMUs that run."""
        return digests(self.system(plant, name) for plant in PLANTS for name in (REFERENCE, self.controller))

    @contextmanager
    def opened(
        self, workers: int | None = None, executor: Executor | None = None
    ) -> Iterator[Callable[[Sequence[Mapping[str, float]]], Iterator[Costs]]]:
        """What gives the costs of candidates (parameters of the controller by name), in their order, on all cores.

        The same candidates cost the same, whoever stands beside them and however many processes share the runs.

        Args:
            workers, executor: see `run_many`.
        """
        expected, evaluation = self.digests(), replace(self, settings=anywhere(self.settings))

        def needed(trial: Trial) -> list[RunRequest]:
            require_same_fmus(expected)
            return [evaluation.planned(trial)]

        with many(evaluation.measured, workers, executor, runs=needed) as answers:

            def metrics(controller: str, candidates: Sequence[Mapping[str, float]]) -> Iterator[list[Metrics]]:
                trials = (Trial(controller, candidate, run) for candidate in candidates for run in self.runs)
                results = answers(trials)
                for _ in candidates:
                    yield [next(results) for _ in self.runs]

            @cache
            def reference() -> list[Metrics]:
                return next(metrics(REFERENCE, [self.reference()]))

            def costs_of(candidates: Sequence[Mapping[str, float]]) -> Iterator[Costs]:
                for metrics_of in metrics(self.controller, candidates):
                    yield costs(self.runs, metrics_of, reference())

            yield costs_of
