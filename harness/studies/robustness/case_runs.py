"""The loop of a case: a plant and a controller, with car and sensors as they were drawn."""

from collections.abc import Mapping, Sequence
from math import nan
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fmuloop.campaign import RunRequest
from fmuloop.errors import RunEnded, SimulationError, UnpackingError
from fmuloop.results import Results
from toolground.collected_warnings import warn_once
from toolground.plain_text import plain

from ...design.uncertainty_box import changed
from ...loop import roles
from ...loop.resolved import ResolvedLoop
from ...loop.topology import DriveUnit
from ...loop.unit_runs import of_unit
from ...manoeuvres.catalogue import MANOEUVRES
from ...manoeuvres.for_car import for_car, share_of
from ...manoeuvres.manoeuvre import Manoeuvre
from ...metrics.evaluate import evaluate
from ...simulation.same_fmus import anywhere, digests, require_same_fmus
from ...simulation.simulate import planned
from .draws import draw
from .outcome import METRICS, PEAK, Case, Outcome

Given = Mapping[tuple[str, str], ResolvedLoop]
"""The loops by the names of plant and controller."""


class Loop(NamedTuple):
    """A plant with a controller.

    Attributes:
        resolved: with absolute paths, so that any process can make its runs.
        blocks: the parameters of each block but the controllers, as they are without a deviation.
        digests: of the FMUs.
        unit: whose signals count.
    """

    resolved: ResolvedLoop
    blocks: Mapping[str, Mapping[str, float]]
    digests: Mapping[Path, str]
    unit: DriveUnit = DriveUnit()


class CaseRunner:
    """Runs cases.

    Args:
        given: the loops.
        seed: of the draws.
    """

    def __init__(self, given: Given, seed: int) -> None:
        self.seed = seed
        self.loops = {
            (unit.named(plant), controller): _loop(resolved, unit)
            for (plant, controller), resolved in given.items()
            for unit in resolved.settings.topology.units
        }
        for (plant, _), one in self.loops.items():
            if not any(name.startswith("plant.") for name in changed(one.blocks, draw(1, seed).deviation)):
                warn_once(f"{plant} has no parameter that is drawn: all cars are the same one, with other sensors")

    def results(self, case: Case, control: bool = True) -> Results:
        """The signals of a case.

        Args:
            control: whether the damping control is enabled.

        Raises:
            UserError: an FMU is not the one that it is where the campaign was begun.
            SimulationError: see `driveline.simulate`.
        """
        return of_unit(self._request(case, control).results(), self.loops[case.plant, case.controller].unit)

    def planned(self, case: Case) -> list[RunRequest]:
        """The run of a case.

        Raises:
            UserError: an FMU is not the one that it is where the campaign was begun.
        """
        return [self._request(case, control=True)]

    def _request(self, case: Case, control: bool) -> RunRequest:
        one, drawn = self.loops[case.plant, case.controller], draw(case.number, self.seed)
        require_same_fmus(one.digests)
        resolved = one.resolved.with_parameters(changed(one.blocks, drawn.deviation))
        return planned(self.manoeuvre(case), resolved, control=control, seed=drawn.noise)

    def outcome(self, case: Case, runs: Sequence[Results]) -> Outcome:
        """What came of a case, from its run; one that an FMU ends has no metrics.

        Raises:
            UnpackingError: an FMU cannot be unpacked or loaded on this machine.
        """
        try:
            (results,) = runs
            if results.ended:
                raise RunEnded(str(results.ended))
        except UnpackingError:
            raise  # that is the machine, and not the controller
        except SimulationError as reason:
            return Outcome(case, {metric.name: nan for metric in METRICS}, plain(reason))
        results = of_unit(results, self.loops[case.plant, case.controller].unit)
        metrics = evaluate(results, self.manoeuvre(case))
        peak = float(np.abs(results[roles.GEAR_TORQUE]).max()) / self._T_max(case)
        return Outcome(case, {m.name: peak if m is PEAK else m.of(metrics) for m in METRICS})

    def manoeuvre(self, case: Case) -> Manoeuvre:
        """What the car of a case is driven through."""
        return for_car(MANOEUVRES[case.manoeuvre], self._T_max(case))

    def share(self, case: Case) -> float:
        """Of the demands of the catalogue that its car is asked for."""
        return share_of(self._T_max(case))

    def _T_max(self, case: Case) -> float:
        """The largest torque of the motor in N.m; inf where its FMU does not say."""
        one = self.loops[case.plant, case.controller]
        return one.blocks[one.unit.instance("motor")].get("T_max", np.inf)


def _loop(resolved: ResolvedLoop, unit: DriveUnit) -> Loop:
    controllers = resolved.settings.topology.instances("controller")
    every = resolved.fit.parameters(resolved.settings.parameters)
    blocks = {instance: parameters for instance, parameters in every.items() if instance not in controllers}
    return Loop(anywhere(resolved), blocks, digests([resolved.system]), unit)
