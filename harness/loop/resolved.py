"""The loop, resolved once: what runs, is recorded and is drawn takes from here what the FMUs and the files say."""

import logging
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import inf
from pathlib import Path
from typing import Any, Unpack

from fmublocks.origin import origin_of
from fmuloop.errors import WiringError
from fmuloop.interface import Interface, unit_of
from fmuloop.parameter_changes import parted
from fmuloop.system import System
from fmuloop.wiring import Fit, find, fit, out_of_bounds, require, unknown
from toolground.collected_warnings import warn_once
from toolground.errors import UserError
from toolground.unit_conversion import factor

from . import roles
from .built_fmus import built_together, require_there
from .mapped_names import known_variables
from .parameter_words import said
from .places import PLACES, PLANTS, ROAD_LOAD, NameOrFile
from .settings import Changes, Settings, loop, own_frequency, running, settings
from .topology import Topology

LOG = logging.getLogger(__name__)


class NotTaken(UserError):
    """A file of parameters names some that a controller does not have."""


@dataclass(frozen=True)
class ResolvedLoop:
    """A loop whose FMUs are there and fit together, see `resolve`. In another process they are read again, when they
    are first asked for.

    Attributes:
        settings: as they were given, with the parameters of files.
    """

    settings: Settings

    @cached_property
    def runs(self) -> Settings:
        """The settings as they run."""
        return running(self.settings)

    @property
    def system(self) -> System:
        """The loop before it is known what its FMUs have of that which is optional."""
        return loop(self.settings)

    @cached_property
    def fit(self) -> Fit:
        """The loop with the interfaces of its FMUs."""
        require_there(self.runs)
        fitted = fit(self.system, [port.name for port in self.system.inputs], self.runs.parameters)
        _warn_of_unfed(fitted, self.settings.topology)
        return fitted

    @property
    def frequency(self) -> float | None:
        """At which the drive train swings, Hz: as it is set, by the parameters of the controller, or as the FMU of the
        plant tells; None: that of the default car."""
        own, given = f"{self.settings.topology.instances('controller')[0]}.", self.runs.parameters.items()
        of_controller = {name.removeprefix(own): value for name, value in given if name.startswith(own)}
        return self.settings.frequency or own_frequency(of_controller) or frequency_of_plant(self)

    @property
    def T_max(self) -> float:
        """Largest torque of the motor of a drive unit in N.m, the smallest of all; inf: no FMU tells."""
        return min(self.value(unit.own(roles.LARGEST_TORQUE), inf) for unit in self.settings.topology.units)

    def value(self, name: str, otherwise: float) -> float:
        """The number of a parameter `instance.name`, as it is set, or as its FMU starts if that tells."""
        return self.settings.parameters.get(name, self.fit.start(name, otherwise))

    def replace(self, **changes: Unpack[Changes]) -> "ResolvedLoop":
        """The same with other values of these fields of its settings."""
        other = ResolvedLoop(self.settings.replace(**changes))
        if "fit" in vars(self) and other.system == self.system:
            vars(other)["fit"] = self.fit
        return other

    def with_parameters(self, parameters: Mapping[str, float]) -> "ResolvedLoop":
        """The same with these parameters too, `instance.variable` -> value."""
        return self.replace(parameters={**self.settings.parameters, **parameters})

    def __getstate__(self) -> dict[str, Any]:
        return {"settings": self.settings}


def _warn_of_unfed(fitted: Fit, topology: Topology) -> None:
    """Names the inputs of FMUs of somebody else that stay as they start, but for those that our blocks leave so too."""
    fed = {connection.target for connection in fitted.system.connections} | {port.name for port in topology.inputs}
    for instance, interface in fitted.interfaces.items():
        if instance in fitted.system.own:
            continue
        inputs = (v for v in interface.of_causality("input") if v.valueReference not in interface.rates.values())
        unfed = [v.name for v in inputs if f"{instance}.{v.name}" not in fed]
        if foreign := [name for name in unfed if name not in known_variables(topology.places[instance])]:
            warn_once(f"{interface.path.name}: nothing in the loop feeds {', '.join(foreign)}; it stays as it starts")


GivenLoop = ResolvedLoop | Settings | NameOrFile | None
"""As which functions take a loop: resolved already, or its settings, or only its plant."""


def resolve(given: GivenLoop = None, **changes: Unpack[Changes]) -> ResolvedLoop:
    """A loop whose FMUs are there and fit together; one that is resolved already is not read again.

    Args:
        changes: fields of the settings that are to be others.

    Raises:
        WiringError: no run can take a value, there is no such block, or the FMUs do not fit.
        UserError: FMUs are missing, and says which command makes them.
    """
    resolved = as_given(given, **changes)
    _ = resolved.fit
    return resolved


def as_given(given: GivenLoop = None, **changes: Unpack[Changes]) -> ResolvedLoop:
    """The same, whose FMUs are read when they are first asked for."""
    return given.replace(**changes) if isinstance(given, ResolvedLoop) else ResolvedLoop(settings(given, **changes))


def resolve_all(
    given: Mapping[tuple[str, str], Settings],
    vehicle: Path | None = None,
    gains: Path | None = None,
    assigned: Mapping[str, float] | None = None,
) -> dict[tuple[str, str], ResolvedLoop]:
    """Loops by plant and controller, which are given the same folder, of FMUs that are made where they are missing,
    with what the files name, for every instance that has it, and with values of `instance.parameter`, which go before.

    Of several controllers the file of gains is for those that have all that it names, and a value for those that have
    the parameter; the others keep theirs.

    Raises:
        WiringError: the FMUs do not fit, or do not have a parameter, or not with that value or in that unit.
        UserError: an FMU is missing and cannot be made; the gains are for none of the controllers.
        ParameterFileError: a file is refused.
    """
    assigned = assigned or {}
    for plant in dict.fromkeys(plant for plant, _ in given):
        require_of_plant(assigned, plant)
    controllers = len({controller for _, controller in given})
    refused: dict[str, list[NotTaken]] = {plant: [] for plant, _ in given}
    resolved = dict[tuple[str, str], ResolvedLoop]()
    for key, made in zip(given, built_together(given.values(), alike=False), strict=True):
        base = ResolvedLoop(made)
        values = _taken(base, assigned) if controllers > 1 else assigned
        try:
            loop_of_key = _with_files(base, vehicle, gains, values)
        except NotTaken as refusal:
            refused[key[0]].append(refusal)
            if len(refused[key[0]]) == controllers:
                raise refused[key[0]][0] from None
            loop_of_key = _with_files(base, vehicle, None, values)
        resolved[key] = loop_of_key
    if controllers > 1:
        _require_one_with_each(resolved, assigned)
    return resolved


def _require_one_with_each(loops: Mapping[tuple[str, str], ResolvedLoop], assigned: Iterable[str]) -> None:
    """Says which of several controllers do not have a parameter that is assigned; refuses one that none has."""
    for parameter in assigned:
        having = {name for (_, name), each in loops.items() if parameter in each.settings.parameters}
        lacking = list(dict.fromkeys(name for _, name in loops if name not in having))
        if not having:
            fits = (each.fit for each in loops.values())
            require(line for fit in fits for line in find(parted(parameter)[0], "parameter", fit.interfaces)[1])
        elif lacking:
            LOG.warning(said("without", name=f"--set {parameter}", controllers=", ".join(lacking)))


def _taken(base: ResolvedLoop, assigned: Mapping[str, float]) -> dict[str, float]:
    """Without values of parameters that the controller does not have."""
    known, controllers = base.fit.interfaces, base.settings.topology.instances("controller")
    of_controllers = [name for name in assigned if name.partition(".")[0] in controllers]
    lacking = [name for name in of_controllers if not find(parted(name)[0], "parameter", known)[0]]
    return {name: value for name, value in assigned.items() if name not in lacking}


def _with_files(
    base: ResolvedLoop, vehicle: Path | None, gains: Path | None, assigned: Mapping[str, float]
) -> ResolvedLoop:
    values, car, frequency = _of_files(base, vehicle, gains) if vehicle or gains else ({}, {}, None)
    resolved = base.replace(parameters=values | dict(assigned), road_load=car, frequency=frequency)
    parameters = resolved.settings.parameters
    require(unknown(resolved.fit, (), parameters))
    require(out_of_bounds(resolved.fit, parameters))
    return resolved


def frequency_of_plant(resolved: ResolvedLoop) -> float | None:
    """Frequency in Hz of the drive train that the plant's FMU was built for, or that its parameters give; None for the
    default car's, which is said where it is only taken."""
    design = PLACES["plant"][0]
    path = resolved.system.instances["plant"]
    lacking = f"{path} tells no C, J_1 and J_2"
    if path.stem in PLACES["plant"] and (origin := origin_of(path)):
        if not origin.start_values:
            return None
        lacking = f"{path} was built for a car of its own, and there is no {design}.fmu beside it that tells C"
        if beside := origin_of(path.with_name(f"{design}.fmu")):
            from ...fmus.catalogue import FMUS  # all equations, which a run of the default car does not need

            return own_frequency({**FMUS[design].block.Parameters._field_defaults, **beside.start_values})
    elif told := own_frequency(resolved.fit.parameters(resolved.runs.parameters)["plant"]):
        return told
    warn_once(f"{lacking}: the band of the metrics is that of the default car; --vehicle, or frequency=, tells it")
    return None


def require_of_plant(names: Collection[str], plant: str) -> None:
    """Refuses parameters that a plant of the project lacks and another one has.

    Raises:
        WiringError: names them, and that plant.
    """
    if not (names and plant in PLANTS):
        return
    from ...fmus.catalogue import FMUS  # all equations, which a run of FMUs does not need

    problems = []
    for name in names:
        place, _, parameter = name.partition("@")[0].partition(".")
        having = [other for other in PLANTS if parameter in FMUS[other].block.Parameters._fields]
        if place == "plant" and having and plant not in having:
            others = f"--plant {' or '.join(having)}"
            problems.append(said("elsewhere", name=name, plant=plant, parameter=parameter, others=others))
    if problems:
        raise WiringError("\n".join(problems))


def _of_files(
    base: ResolvedLoop, vehicle: Path | None, gains: Path | None
) -> tuple[dict[str, float], dict[str, float], float | None]:
    """The parameters `instance.name` that the FMUs have; by name what the plant of somebody else does not tell of its
    car: what the file of the vehicle has, else what the default car has; and the frequency of the car of a file, Hz."""
    from ...fmus.building.one_car import of_one_car
    from ...fmus.building.parameter_files import for_instances, of_plants, read_files, require_taken, units
    from ...fmus.catalogue import FMUS
    from ...fmus.errors import ParameterFileError

    system, interfaces = base.system, base.fit.interfaces
    names = {
        instance: {variable.name for variable in interface.of_causality("parameter")}
        for instance, interface in interfaces.items()
    }
    every = set().union(*names.values())
    values = of_one_car(read_files(vehicle, gains, others=every), every)
    try:
        require_taken(gains, every, system.instances[base.settings.topology.instances("controller")[0]].name)
    except ParameterFileError as refusal:
        raise NotTaken(str(refusal)) from refusal
    meant = {name: unit for name, unit in units().items() if name in values}
    plant = system.instances["plant"]
    car: dict[str, float] = {}
    usual = FMUS[PLANTS[0]].block.Parameters._field_defaults
    if "plant" not in system.own and vehicle is not None:
        if lacking := sorted(of_plants() & values.keys() - names["plant"]):
            taken, lacks = ", ".join(sorted(values.keys() & names["plant"])), ", ".join(lacking)
            if taken:
                own = f"it takes {taken}, and the rest stays its own: it may be another car than that of the file"
            else:
                own = "the file reaches the other blocks alone"
            warn_once(f"{plant} has no parameter {lacks}: {own}")
        car = {name: values.get(name, usual[name]) for name in ROAD_LOAD if name not in names["plant"]}
    require(
        problem
        for instance, interface in interfaces.items()
        for name in sorted(names[instance] & meant.keys())
        if (problem := _other_unit(interface, f"{instance}.{name}", meant[name], system.mapping))
    )
    return for_instances(values, names), car, own_frequency({**usual, **values}) if vehicle else None


def _other_unit(interface: Interface, name: str, meant: str, mapping: Mapping[str, str]) -> str | None:
    """Why the number of a file, in the unit that is meant, does not reach the parameter `instance.name`, or None."""
    theirs = mapping.get(name, name.partition(".")[2])
    unit = next(unit_of(variable) for variable in interface.description.modelVariables if variable.name == theirs)
    if unit in (None, "", meant):
        return None
    try:
        other = factor(unit, meant)
    except ValueError as reason:
        return f"{name} {reason}, the unit of the file"
    if name in mapping or other == 1.0:
        return None
    return f"{name} is in {unit}; the file gives it in {meant} (--map {name}={theirs} converts it)"
