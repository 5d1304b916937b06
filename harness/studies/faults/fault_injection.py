"""Fault injection: the loop with SignalFaults between sensors and controller, and the three runs of a case."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.lib.recfunctions import append_fields, repack_fields

from fmuloop.campaign import RunRequest
from fmuloop.errors import RunEnded
from fmuloop.experiment import Experiment
from fmuloop.results import Results
from fmuloop.system import Connection, Port, System
from fmuloop.wiring import Fit, fit

from ...loop import roles
from ...loop.built_fmus import warn_of_stale
from ...loop.places import by_name
from ...loop.resolved import ResolvedLoop
from ...loop.topology import ONE_UNIT, DriveUnit, Topology
from ...loop.unit_runs import of_unit
from ...manoeuvres.for_car import for_car, share_of
from ...manoeuvres.manoeuvre import Manoeuvre
from ...manoeuvres.parts import Sum
from ...manoeuvres.signals import lines
from ...metrics.evaluate import at_samples
from ...simulation.same_fmus import anywhere, digests, require_same_fmus
from ...simulation.simulate import signals, start
from .fault_cases import SITUATIONS, Case, Fault
from .fault_catalogue import ICE, LOCK, SPIN, SWITCHED_OFF

INSTANCE = "faults"
"""Name of SignalFaults in the loop."""

PASSES = {
    "omega_1_meas": "omega_1_sent",
    "T_mot_est": "T_mot_sent",
    "omega_2_can": "omega_2_sent",
    "valid": "valid_sent",
    "counter": "counter_sent",
    "alive": "alive_sent",
}
"""What the controller gets from SignalFaults, and what that gets in its place."""

COUNTED = f"{INSTANCE}.alive_sent"
"""The counter of the frames of motor control."""

STATUS, T_DAMP = roles.STATUS, roles.DAMPING_TORQUE

JUDGED = (
    Port(STATUS, None),
    Port(T_DAMP, "N.m"),
    Port(roles.MEASURED_MOTOR_SPEED, "rad/s"),
    Port(roles.BUS_VALID, None),
)
"""What judges and figures read beside what every loop puts out."""

KEPT = [STATUS, T_DAMP, roles.GEAR_TORQUE]
"""What they read of the runs without faults, of which hundreds are kept."""

SLIPPERY = 1e5
"""Slip stiffness in N over the friction coefficient, for tyres without a limit of friction."""


class Runs(NamedTuple):
    """The runs of a case at the samples of the controller: with the faults of its signals, without these, and without
    control. What happens on ice happens in all of them."""

    faulty: np.ndarray
    healthy: np.ndarray
    undamped: np.ndarray


class Limits(NamedTuple):
    """What the controller may demand, what it may add to the driver's demand, and take from it, N.m; the largest speed
    that it takes for plausible, rad/s; and the share of the demands of the catalogue that the car is asked for."""

    T_max: float
    T_add_max: float
    T_take_max: float
    omega_max: float
    share: float


class FaultRunner:
    """Runs cases; runs without faults that several cases have in common are made once.

    Attributes:
        plants: in their order, each as often as it has drive units; a case is of one unit's signals.
        digests: of the FMUs.
    """

    def __init__(self, injector: Path, loops: Mapping[str, ResolvedLoop]) -> None:
        """
        Args:
            injector: FMU of SignalFaults.
            loops: with each plant.

        Raises:
            UserError: two plants have the same name, by which the cases are distinguished.
        """
        by_name(loops, "plant")
        self._injector = injector.absolute()
        self._loops = {
            unit.named(Path(plant).stem) if unit.name else plant: (anywhere(resolved), unit)
            for plant, resolved in loops.items()
            for unit in resolved.settings.topology.units
        }
        self.plants = tuple(self._loops)
        self.digests = digests(map(self._system, self.plants))
        self._kept: dict[tuple[Any, ...], list[np.ndarray]] = {}
        self._shared: dict[tuple[Any, ...], list[RunRequest]] = {}
        self._fitted: dict[str, Fit] = {}

    def runs(self, case: Case) -> Runs:
        """The three runs of a case.

        Raises:
            UserError: an FMU is not the one that it is where the campaign was begun.
            RunEnded: an FMU ended a run before its time.
            SimulationError: an FMU cannot be loaded, or refused a call.
        """
        return self.completed(case, [request.results() for request in self.planned(case)])

    def planned(self, case: Case) -> list[RunRequest]:
        """The run with the faults of signals and, unless they are kept, those without these: with and without control.

        Raises:
            UserError: an FMU is not the one that it is where the campaign was begun.
        """
        require_same_fmus(self.digests)
        common = _in_common(case)
        faulty = self._request(*common, faults=tuple(fault for fault in case.faults if fault.kind.number))
        if common in self._kept:
            return [faulty]
        if common not in self._shared:
            self._shared[common] = [self._request(*common, control=control) for control in (True, False)]
        return [faulty, *self._shared[common]]

    def completed(self, case: Case, results: Sequence[np.ndarray]) -> Runs:
        """The three runs, from the results of those that were planned.

        Raises:
            RunEnded, SimulationError: as of `runs`.
        """
        common = _in_common(case)
        faulty, *shared = results
        if shared:
            self._shared.pop(common, None)
        if shared and not common[-1]:  # hardly two cases have the same ice
            shared = self._kept[common] = [repack_fields(run[KEPT]) for run in shared]
        return Runs(faulty, *(shared or self._kept[common]))

    def limits(self, plant: str) -> Limits:
        """As the parameters of the controller say."""
        resolved, unit = self._loops[plant]

        def value(name: str) -> float:
            return float(resolved.value(unit.own(f"controller.{name}"), np.inf))

        share = share_of(resolved.T_max)
        return Limits(value("T_max"), value("T_add_max"), value("T_take_max"), value("omega_max"), share)

    def without_status(self, plant: str) -> str | None:
        """The file of a controller of somebody else that does not tell its status."""
        fitted, status = self._fit(plant), self._loops[plant][1].own(STATUS)
        return fitted.file(status) if status in fitted.absent else None

    def _request(
        self,
        plant: str,
        situation: str,
        noise: int,
        on_ice: tuple[Fault, ...],
        faults: Sequence[Fault] = (),
        control: bool = True,
    ) -> RunRequest:
        manoeuvre = for_car(_with(on_ice, SITUATIONS[situation].manoeuvre), self._loops[plant][0].T_max)
        road = {**manoeuvre.road, "mu": ICE} if on_ice else manoeuvre.road
        loop, unit = self._loops[plant]
        resolved, topology = loop.replace(control=control), loop.settings.topology
        parameters = start(replace(manoeuvre, road=_of_plant(road, self._fit(plant))), noise, topology)
        parameters |= dict(resolved.runs.parameters) | _parameters(faults, noise, unit)
        inputs = dict(signals(manoeuvre, control, topology=topology))
        for fault in faults:
            if fault.kind.number == SWITCHED_OFF:
                inputs[unit.own(roles.ENABLE)] = partial(np.less_equal, fault.end)
        given = {"inputs": inputs, "parameters": parameters, "label": manoeuvre.name}
        system = with_faults(resolved.system, self._injector, topology)
        return RunRequest(system, Experiment(manoeuvre.duration, **given), partial(_completed, unit))

    def _fit(self, plant: str) -> Fit:
        if plant not in self._fitted:
            warn_of_stale(system := self._system(plant))
            self._fitted[plant] = fit(system)
        return self._fitted[plant]

    def _system(self, plant: str) -> System:
        resolved, _ = self._loops[plant]
        return with_faults(resolved.system, self._injector, resolved.settings.topology)


def _in_common(case: Case) -> tuple[str, str, int, tuple[Fault, ...]]:
    """What a case shares with those whose runs without faults of signals are the same."""
    on_ice = tuple(fault for fault in case.faults if fault.name in (LOCK, SPIN))
    return case.plant, case.situation, case.noise, on_ice


def _completed(unit: DriveUnit, make: Callable[[], Results]) -> np.ndarray:
    """A run of a drive unit at the samples of the controller, with what that has not told: the torque that it adds to
    the demand of the sample before, and a status that stands for none."""
    results = make()
    if results.ended:
        raise RunEnded(f"{results.ended}: there is nothing to judge")
    run = at_samples(of_unit(results, unit))
    lacking = [name for name in (STATUS, T_DAMP) if name not in (run.dtype.names or ())]
    demand = run[roles.DEMAND]
    told = {STATUS: np.zeros(len(run)), T_DAMP: run[roles.REFERENCE_TORQUE] - np.append(demand[:1], demand[:-1])}
    return append_fields(run, lacking, [told[name] for name in lacking], usemask=False) if lacking else run


def with_faults(system: System, injector: Path, topology: Topology = ONE_UNIT) -> System:
    """The loop with SignalFaults, an FMU, between the sensors and the controller of each drive unit.

    Frames of motor control are counted where a run gives the input COUNTED.
    """
    units, motors = topology.units, topology.instances("motor")
    injectors = {unit.instance(INSTANCE): injector for unit in units}
    first = {name: system.instances[name] for name in (*motors, *topology.instances("controller"))}
    return replace(
        system,
        instances={name: first[name] for name in motors} | injectors | first | dict(system.instances),
        connections=tuple(_through_faults(system.connections, units)),
        outputs=(*system.outputs, *(port._replace(name=unit.own(port.name)) for unit in units for port in JUDGED)),
        offered=tuple(_through_faults(system.offered, units)),
        optional={**system.optional, **{unit.own(name): None for unit in units for name in (STATUS, T_DAMP)}},
        own=system.own | injectors.keys(),
        any_value=frozenset(injectors),
    )


def _through_faults(connections: Iterable[Connection], units: Iterable[DriveUnit]) -> Iterator[Connection]:
    passed = {
        unit.own(f"controller.{name}"): (unit.own(f"{INSTANCE}.{sent}"), unit.own(f"{INSTANCE}.{name}"))
        for unit in units
        for name, sent in PASSES.items()
    }
    for connection in connections:
        if connection.target in passed:
            sent, gets = passed[connection.target]
            yield connection._replace(target=sent)
            yield connection._replace(source=gets)
        else:
            yield connection


def _parameters(faults: Sequence[Fault], seed: int, unit: DriveUnit) -> dict[str, float]:
    """Of SignalFaults in a drive unit."""
    instance = unit.instance(INSTANCE)
    given: dict[str, float] = {f"{instance}.seed": seed}
    for k, fault in enumerate((fault for fault in faults if fault.kind.signal), 1):
        values = {
            "kind": fault.kind.number,
            "signal": fault.kind.signal,
            "begin": fault.begin,
            "end": fault.end,
            "size": fault.size,
            "share": fault.share,
        }
        given |= {f"{instance}.{name}_{k}": value for name, value in values.items()}
    return given


def _of_plant(road: Mapping[str, float], fitted: Fit) -> dict[str, float]:
    """What a plant has of the parameters of a road; without a limit of friction slip in its place."""
    has = fitted.interfaces["plant"].variables
    slip = {} if "mu" in has or "mu" not in road else {"c_slip": SLIPPERY * road["mu"]}
    return {name: value for name, value in {**road, **slip}.items() if name in has}


def _with(on_ice: Sequence[Fault], manoeuvre: Manoeuvre) -> Manoeuvre:
    """The manoeuvre with brakes or torque that make the wheels lock or spin."""
    for fault in on_ice:
        pulse = lines((fault.begin, 0.0), (fault.begin, fault.size), (fault.end, fault.size), (fault.end, 0.0))
        if fault.name == LOCK:
            manoeuvre = replace(manoeuvre, T_brake=Sum((manoeuvre.T_brake, pulse)))
        elif fault.name == SPIN:
            manoeuvre = replace(manoeuvre, T_driver=Sum((manoeuvre.T_driver, pulse)))
    return manoeuvre
