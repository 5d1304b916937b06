"""Whether FMUs fit together: names, causality, types and units, checked before anything runs."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from zipfile import BadZipFile

from fmpy import read_model_description
from fmpy.model_description import ModelDescription, ModelVariable

from ..errors import WiringError
from ..names import nearest
from .system import Connection, Signal, System


class Interface:
    """What an FMU shows to the outside.

    Attributes:
        path: of the FMU.
        description: as fmpy read it.
        identifier: of the binary.
        variables: by name, in the order of the description.
    """

    def __init__(self, path: Path) -> None:
        """Reads the model description.

        Raises:
            WiringError: the file is no FMI 2.0 Co-Simulation FMU.
        """
        self.path = path
        self.description = _read(path)
        assert self.description.coSimulation is not None
        self.identifier = str(self.description.coSimulation.modelIdentifier)
        self.variables: dict[str, ModelVariable] = {v.name: v for v in self.description.modelVariables}

    def of_causality(self, causality: str) -> list[ModelVariable]:
        return [v for v in self.variables.values() if v.causality == causality]


def _read(path: Path) -> ModelDescription:
    if not path.is_file():
        raise WiringError(f"there is no FMU {path} (`driveline build` makes those of the project)")
    try:
        description = read_model_description(str(path), validate=False)
    except (BadZipFile, KeyError) as error:
        raise WiringError(f"{path} is not an FMU: {error}") from error
    except Exception as error:  # fmpy raises bare exceptions
        raise WiringError(f"the model description of {path} cannot be read: {error}") from error
    if description.fmiVersion != "2.0" or description.coSimulation is None:
        raise WiringError(f"{path} is of FMI {description.fmiVersion}; only FMI 2.0 Co-Simulation runs here")
    return description


def unit_of(variable: ModelVariable) -> str | None:
    """Unit of a variable, its own or that of its declared type."""
    if variable.unit is None and variable.declaredType is not None:
        return variable.declaredType.unit
    return variable.unit


def type_of(variable: ModelVariable) -> str:
    """FMI type of a variable; an enumeration travels as an Integer."""
    return "Integer" if variable.type == "Enumeration" else str(variable.type)


def check_interfaces(
    system: System, interfaces: Mapping[str, Interface], inputs: Iterable[str], parameters: Iterable[str]
) -> None:
    """Checks that the FMUs of a system have everything that its wiring and a run ask of them.

    Args:
        interfaces: of the instances, by their names.
        inputs, parameters: `instance.variable` of all that the run gives.

    Raises:
        WiringError: lists everything that is missing, misnamed or of another type or unit.
    """
    problems = list(_problems(system, interfaces, inputs, parameters))
    if problems:
        raise WiringError("\n".join(dict.fromkeys(problems)))


def _problems(
    system: System, interfaces: Mapping[str, Interface], inputs: Iterable[str], parameters: Iterable[str]
) -> Iterator[str]:
    for connection in system.connections:
        yield from _check_connection(connection, interfaces)
    wanted = {"input": system.inputs, "parameter": system.parameters, "output": system.outputs}
    for causality, signals in wanted.items():
        for signal in signals:
            yield from _check_signal(signal, causality, interfaces)
    for causality, names in {"input": inputs, "parameter": parameters}.items():
        for name in names:
            yield from find(name, causality, interfaces)[1]
    fed = [connection.target for connection in system.connections] + list(inputs)
    for name in {name for name in fed if fed.count(name) > 1}:
        yield f"{name} is fed more than once"


def _check_connection(connection: Connection, interfaces: Mapping[str, Interface]) -> Iterator[str]:
    source, missing_source = find(connection.source, "output", interfaces)
    target, missing_target = find(connection.target, "input", interfaces)
    yield from missing_source + missing_target
    if source is None or target is None:
        return
    if type_of(source) != type_of(target):
        yield (
            f"{connection.source} is {type_of(source)}, but {connection.target}, which it feeds, is {type_of(target)}"
        )
    elif unit_of(source) != unit_of(target):
        yield (
            f"{connection.source} is in {_unit(source)}, but {connection.target}, which it feeds, is in {_unit(target)}"
        )


def _check_signal(signal: Signal, causality: str, interfaces: Mapping[str, Interface]) -> Iterator[str]:
    variable, missing = find(signal.name, causality, interfaces)
    yield from missing
    if variable is None or signal.unit is None:
        return
    if variable.type != "Real":
        yield f"{signal.name} is {type_of(variable)}; it must be Real, in {signal.unit}"
    elif unit_of(variable) != signal.unit:
        yield f"{signal.name} is in {_unit(variable)}; it must be in {signal.unit}"


def _unit(variable: ModelVariable) -> str:
    return unit_of(variable) or "no unit"


def find(name: str, causality: str, interfaces: Mapping[str, Interface]) -> tuple[ModelVariable | None, list[str]]:
    """The variable `instance.variable` of that causality; if there is none, what to say about it."""
    instance, _, variable_name = name.partition(".")
    if instance not in interfaces:
        return None, [f"{name}: there is no instance {instance}; {nearest(instance, interfaces)}"]
    interface = interfaces[instance]
    file = interface.path.name
    variable = interface.variables.get(variable_name)
    if variable is None:
        known = [v.name for v in interface.of_causality(causality)]
        return None, [f"{name}: {file} has no {causality} {variable_name}; {nearest(variable_name, known)}"]
    if variable.causality != causality:
        return None, [f"{name}: in {file} {variable_name} is of causality {variable.causality}; it must be {causality}"]
    return variable, []
