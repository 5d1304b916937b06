"""Whether FMUs fit together: names, causality, types and units, checked before anything runs."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from math import inf
from typing import NamedTuple

from fmpy.model_description import ModelVariable

from toolground.known_names import nearest
from toolground.plain_text import plain

from . import mapping
from .errors import LONGEST_LINE, WiringError
from .interface import Interface, type_of, unit_of
from .parameter_changes import parted
from .parameter_words import said
from .system import Connection, Port, System


class Fit(NamedTuple):
    """A system whose FMUs fit together.

    Attributes:
        system: without what is absent, with what is offered.
        interfaces: of the instances by their names, mapped.
        absent: optional inputs and parameters that the FMUs do not have, and what they then stand for.
    """

    system: System
    interfaces: Mapping[str, Interface]
    absent: Mapping[str, float | None]

    def file(self, name: str) -> str:
        """Of the FMU that a variable `instance.variable` belongs to."""
        return self.interfaces[name.partition(".")[0]].path.name

    def start(self, name: str, otherwise: float) -> float:
        """With which a Real `instance.variable` starts, in the loop's unit; `otherwise` if its FMU does not tell."""
        instance, _, own = name.partition(".")
        interface = self.interfaces[instance]
        variable = interface.variables.get(own)
        if variable is None or variable.type != "Real" or not variable.start:
            return otherwise
        return float(variable.start) * interface.factors.get(own, 1.0)

    def parameters(self, values: Mapping[str, float]) -> dict[str, dict[str, float]]:
        """The numbers that the parameters have, by instance and name: those that are given, and where others start."""
        numbers: dict[str, dict[str, float]] = {}
        for instance, interface in self.interfaces.items():
            reals = [v for v in interface.of_causality("parameter") if v.type == "Real"]
            starts = {v.name: float(v.start) * interface.factors.get(v.name, 1.0) for v in reals if v.start is not None}
            numbers[instance] = {name: values.get(f"{instance}.{name}", start) for name, start in starts.items()}
        return numbers


def fit(system: System, inputs: Iterable[str] = (), parameters: Iterable[str] = ()) -> Fit:
    """Reads the FMUs of a system, maps their variables and checks that they fit.

    Args:
        inputs, parameters: `instance.variable` of all that a run gives.

    Raises:
        WiringError: lists everything that is missing, misnamed or of another type or unit.
    """
    interfaces = {name: Interface(path, system.limits) for name, path in system.instances.items()}
    for name in system.any_value:
        interfaces[name].any_value = True
    problems = list(mapping.apply(system, interfaces))
    absent = {name: value for name, value in system.optional.items() if _is_absent(name, interfaces)}
    added = [wire for wire in system.offered if not any(_is_absent(end, interfaces) for end in wire[:2])]
    there = system.without(absent)
    fitted = Fit(replace(there, connections=(*there.connections, *added), offered=()), interfaces, absent)
    problems += _duplicates(interfaces)
    misfits = [*_misfits(fitted.system, interfaces)]
    require([*problems, *misfits, *unknown(fitted, inputs, parameters), *_drafts(fitted.system, interfaces)])
    return fitted


def fitted_for(system: System | Fit, inputs: Iterable[str], parameters: Iterable[str]) -> Fit:
    """As `fit`, of a system whose FMUs are known to fit the names alone.

    Raises:
        WiringError: lists what does not fit.
    """
    if isinstance(system, System):
        return fit(system, inputs, parameters)
    require(unknown(system, inputs, parameters))
    return system


def require(problems: Iterable[str]) -> None:
    """Raises a WiringError that lists the problems if there are any, each once and in one line."""
    if lines := list(dict.fromkeys(plain(problem, LONGEST_LINE) for problem in problems)):
        raise WiringError("\n".join(lines))


def unknown(fitted: Fit, inputs: Iterable[str], parameters: Iterable[str]) -> Iterator[str]:
    """What is wrong with the names that a run gives; those that are absent are not looked at."""
    targets = {connection.target for connection in fitted.system.connections}
    for causality, names in {"input": inputs, "parameter": parameters}.items():
        for assigned in names:
            name, time = parted(assigned)
            if time is not None:
                yield from _fixed(assigned, fitted.interfaces)
            if name not in fitted.absent or time is not None:
                variable, missing = find(name, causality, fitted.interfaces)
                yield from missing
                if variable and type_of(variable) == "String":
                    yield f"{name} is a String; only numbers and truth values can be set"
            if name in targets:
                yield f"{name} is fed more than once"


def _fixed(assigned: str, interfaces: Mapping[str, Interface]) -> Iterator[str]:
    """What to say of a parameter that a run is to change and cannot."""
    name, _ = parted(assigned)
    variable, _ = find(name, "parameter", interfaces)
    if variable is not None and variable.variability != "tunable":
        interface = interfaces[name.partition(".")[0]]
        tunable = [v.name for v in interface.of_causality("parameter") if v.variability == "tunable"]
        known = f"tunable are {', '.join(tunable)}" if tunable else "none of its parameters is tunable"
        fixed = said("fixed", name=assigned, file=interface.path.name, parameter=variable.name)
        yield f"{fixed}; {known}"


def out_of_bounds(fitted: Fit, parameters: Mapping[str, float]) -> Iterator[str]:
    """Which of the values that a run gives to parameters are beyond the bounds that an FMU declares."""
    for name, value in parameters.items():
        if problem := beyond_bounds(fitted, "parameter", parted(name)[0], value):
            yield f"{name} = {value:g}: {problem}"


def beyond_bounds(fitted: Fit, causality: str, name: str, value: float) -> str | None:
    """What to say of a value of the variable `instance.variable` that is beyond the bounds that its FMU declares."""
    variable, _ = find(name, causality, fitted.interfaces)
    if variable is None:
        return None
    instance, _, own = name.partition(".")
    interface = fitted.interfaces[instance]
    factor = interface.factors.get(own, 1.0)
    low = -inf if variable.min is None else factor * float(variable.min)
    high = inf if variable.max is None else factor * float(variable.max)
    if low <= value <= high:
        return None
    return said("bounds", file=interface.path.name, low=low, high=high, unit=unit_of(variable) or "").rstrip()


def _is_absent(name: str, interfaces: Mapping[str, Interface]) -> bool:
    instance, _, variable = name.partition(".")
    interface = interfaces.get(instance)
    return interface is not None and variable not in interface.variables.keys() | interface.refused


def _duplicates(interfaces: Mapping[str, Interface]) -> Iterator[str]:
    """What an FMU has more than one of, by a name that is then no name."""
    for instance, interface in interfaces.items():
        variables = [v for v in interface.description.modelVariables if v.causality in ("input", "output", "parameter")]
        for name, number in Counter(str(v.name) for v in variables).items():
            if number > 1:
                yield f"{instance}: {interface.path.name} has {number} variables of the name {plain(name)}"


def _misfits(system: System, interfaces: Mapping[str, Interface]) -> Iterator[str]:
    for causality, ports in system.ports.items():
        for port in ports:
            yield from _check_port(port, causality, interfaces)
    targets = [connection.target for connection in system.connections]
    yield from (f"{name} is fed more than once" for name in targets if targets.count(name) > 1)
    for connection in system.connections:
        if connection.unit is None:
            yield from _check_ends(connection, interfaces)


def _check_port(port: Port, causality: str, interfaces: Mapping[str, Interface]) -> Iterator[str]:
    variable, missing = find(port.name, causality, interfaces)
    yield from missing
    if variable is None or port.unit is None:
        return
    if variable.type != "Real":
        yield f"{port.name} is {type_of(variable)}; it must be Real, in {port.unit}"


def _drafts(system: System, interfaces: Mapping[str, Interface]) -> Iterator[str]:
    """Which command helps where FMUs of somebody else beside ours, which nobody maps, lack what is exchanged with
    them."""
    ports = [(port.name, causality) for causality, ports in system.ports.items() for port in ports]
    known = {*system.own, *(name.partition(".")[0] for name in system.mapping)}
    for instance, interface in interfaces.items() if system.own else ():
        lacks = (find(*port, interfaces)[1] for port in ports if port[0].startswith(f"{instance}."))
        if instance not in known and any(lacks):
            place = "" if instance == "plant" else f" --place {instance}"
            yield f"`driveline map {interface.path}{place}` drafts which of its variables are meant, for --map"


def _check_ends(connection: Connection, interfaces: Mapping[str, Interface]) -> Iterator[str]:
    """The ends must be alike if nothing is declared about them."""
    source, _ = find(connection.source, "output", interfaces)
    target, _ = find(connection.target, "input", interfaces)
    if source is None or target is None:
        return
    feeds = f"but {connection.target}, which it feeds, is"
    if type_of(source) != type_of(target):
        yield f"{connection.source} is {type_of(source)}, {feeds} {type_of(target)}"
    elif unit_of(source) != unit_of(target):
        yield f"{connection.source} is in {_unit(source)}, {feeds} in {_unit(target)}"


def _unit(variable: ModelVariable) -> str:
    return plain(unit_of(variable) or "no unit", 60)


def find(name: str, causality: str, interfaces: Mapping[str, Interface]) -> tuple[ModelVariable | None, list[str]]:
    """The variable `instance.variable` of that causality; if there is none, what to say about it."""
    instance, _, variable_name = name.partition(".")
    if instance not in interfaces:
        return None, [f"{said('instance', name=name, instance=instance)}; {nearest(instance, interfaces)}"]
    interface = interfaces[instance]
    file = interface.path.name
    variable = interface.variables.get(variable_name)
    if variable_name in interface.refused:
        return None, []
    if variable is None:
        known = [v.name for v in interface.of_causality(causality)]
        near = nearest(variable_name, known) if known else "it has none"
        lacks = said("lacks", name=name, file=file, causality=causality, parameter=variable_name)
        return None, [f"{lacks}; {near}"]
    if variable.causality != causality:
        return None, [f"{name}: in {file} {variable_name} is of causality {variable.causality}; it must be {causality}"]
    return variable, []
