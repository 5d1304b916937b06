"""Rules for the model description of an FMU."""

from collections.abc import Iterator
from math import inf
from pathlib import Path

from fmpy.model_description import ModelVariable
from fmpy.validation import validate_fmu

from ..cosimulation.interface import Interface, unit_of


def standard(path: Path) -> list[str]:
    """What fmpy finds: the XML schema, names, start values, causalities, units, InitialUnknowns."""
    return [str(problem) for problem in validate_fmu(str(path))]


def variables(path: Path) -> Iterator[str]:
    """Public variables without unit or description, start values out of bounds, shared references."""
    public = [v for v in Interface(path).variables.values() if v.causality != "local"]
    for variable in public:
        if variable.type == "Real" and unit_of(variable) is None:
            yield f'{variable.name} has no unit ("1" if it has no dimension)'
        if not variable.description:
            yield f"{variable.name} has no description"
        yield from _start_out_of_bounds(variable)
    seen: dict[tuple[str, int], str] = {}
    for variable in public:
        key = (str(variable.type), variable.valueReference)
        if key in seen:
            yield f"{variable.name} has the value reference of {seen[key]}"
        seen[key] = variable.name


def _start_out_of_bounds(variable: ModelVariable) -> Iterator[str]:
    if variable.type not in ("Real", "Integer") or variable.start is None:
        return
    declared = variable.declaredType
    lower = variable.min or (declared.min if declared else None) or -inf
    upper = variable.max or (declared.max if declared else None) or inf
    if not float(lower) <= float(variable.start) <= float(upper):
        yield f"{variable.name} starts at {variable.start}, out of [{lower}, {upper}]"


def structure(path: Path) -> Iterator[str]:
    """Outputs that do not say what they depend on: tools then see algebraic loops everywhere."""
    description = Interface(path).description
    for unknown in description.outputs:
        if unknown.dependencies is None and unknown.variable is not None:
            yield f"output {unknown.variable.name} does not tell its dependencies"


def experiment(path: Path) -> Iterator[str]:
    """What a tool shows before the first run."""
    interface = Interface(path)
    description = interface.description
    default = description.defaultExperiment
    if default is None or default.stopTime is None or default.stepSize is None:
        yield "DefaultExperiment lacks stopTime or stepSize"
    for attribute in ("description", "generationTool", "generationDateAndTime"):
        if not getattr(description, attribute):
            yield f"{attribute} is not given"
    if not (description.generationDateAndTime or "Z").endswith("Z"):
        yield "generationDateAndTime does not end in Z, as FMI asks"
    if description.coSimulation is not None and description.coSimulation.needsExecutionTool:
        yield "needsExecutionTool is true: some tools refuse such FMUs"
    if not description.logCategories:
        yield "there are no log categories"
