"""Rules for the model description of an FMU: each is given its interface."""

from collections.abc import Iterator
from math import inf

from fmpy.model_description import ModelVariable
from fmpy.validation import validate_fmu

from ...cosimulation.interface import Interface, unit_of
from .rule import Rules, Severity


def _public(interface: Interface) -> list[ModelVariable]:
    return [v for v in interface.variables.values() if v.causality != "local"]


DESCRIPTION_RULES = Rules()


@DESCRIPTION_RULES.rule("schema", Severity.ERROR, "the model description is valid (fmpy)")
def standard(interface: Interface) -> list[str]:
    """What fmpy finds: the XML schema, names, start values, causalities, units, InitialUnknowns."""
    try:
        return [str(problem) for problem in validate_fmu(str(interface.path))]
    except Exception as error:  # fmpy raises bare exceptions
        return [f"fmpy cannot read it: {error}"]


@DESCRIPTION_RULES.rule("bounds", Severity.ERROR, "start values are within their bounds")
def bounds(interface: Interface) -> Iterator[str]:
    """Start values that are out of bounds."""
    for variable in _public(interface):
        if variable.type not in ("Real", "Float32", "Integer") or variable.start is None:
            continue
        declared = variable.declaredType
        lower = variable.min or (declared.min if declared else None) or -inf
        upper = variable.max or (declared.max if declared else None) or inf
        if not float(lower) <= float(variable.start) <= float(upper):
            yield f"{variable.name} starts at {variable.start}, out of [{lower}, {upper}]"


@DESCRIPTION_RULES.rule("derivatives", Severity.ERROR, "each derivative is that of one continuous state (2.2.7, 2.2.8)")
def derivatives(interface: Interface) -> Iterator[str]:
    """What ModelStructure lists as derivatives: the states are theirs, in that order (FMI 2.0.4, 2.2.7 and 2.2.8)."""
    seen: dict[str, str] = {}
    for unknown in interface.description.derivatives:
        rate = unknown.variable
        state = None if rate is None else rate.derivative
        if rate is None or state is None:
            continue  # the schema's rule says so
        if state.type != "Real" or state.variability not in (None, "continuous"):
            yield f"{rate.name} is the derivative of {state.name}, which is no continuous Real"
        if state.name in seen:
            yield f"{rate.name} and {seen[state.name]} are derivatives of {state.name}"
        seen[state.name] = rate.name


@DESCRIPTION_RULES.rule("units", Severity.NOTE, "variables have units")
def units(interface: Interface) -> Iterator[str]:
    """Public variables without unit."""
    for variable in _public(interface):
        if variable.type in ("Real", "Float32") and unit_of(variable) is None:
            yield f'{variable.name} has no unit ("1" if it has no dimension)'


@DESCRIPTION_RULES.rule("references", Severity.WARNING, "variables have value references of their own")
def references(interface: Interface) -> Iterator[str]:
    """Public variables that share a value reference."""
    seen: dict[tuple[str, int], str] = {}
    for variable in _public(interface):
        key = (str(variable.type), variable.valueReference)
        if key in seen:
            yield f"{variable.name} has the value reference of {seen[key]}"
        seen[key] = variable.name


@DESCRIPTION_RULES.rule("dependencies", Severity.WARNING, "outputs tell their dependencies")
def structure(interface: Interface) -> Iterator[str]:
    """Outputs that do not say what they depend on: tools then see algebraic loops everywhere."""
    for unknown in interface.description.outputs:
        if unknown.dependencies is None and unknown.variable is not None:
            yield f"output {unknown.variable.name} does not tell its dependencies"


@DESCRIPTION_RULES.rule("execution-tool", Severity.WARNING, "it needs no other tool")
def execution_tool(interface: Interface) -> Iterator[str]:
    """Whether it claims to need the tool that made it."""
    cosimulation = interface.description.coSimulation
    if cosimulation is not None and cosimulation.needsExecutionTool:
        yield "needsExecutionTool is true: some tools refuse such FMUs"


@DESCRIPTION_RULES.rule("experiment", Severity.WARNING, "there is a default experiment")
def experiment(interface: Interface) -> Iterator[str]:
    """What a tool runs first."""
    default = interface.description.defaultExperiment
    if default is None or default.stopTime is None or default.stepSize is None:
        yield "DefaultExperiment lacks stopTime or stepSize"


@DESCRIPTION_RULES.rule("descriptions", Severity.NOTE, "variables have descriptions")
def descriptions(interface: Interface) -> Iterator[str]:
    """Public variables without description."""
    for variable in _public(interface):
        if not variable.description:
            yield f"{variable.name} has no description"


@DESCRIPTION_RULES.rule("origin", Severity.NOTE, "it tells what made it")
def origin(interface: Interface) -> Iterator[str]:
    """What a tool shows before the first run."""
    description = interface.description
    for attribute in ("description", "generationTool", "generationDateAndTime"):
        if not getattr(description, attribute):
            yield f"{attribute} is not given"
    if not (description.generationDateAndTime or "Z").endswith("Z"):
        yield "generationDateAndTime does not end in Z, as FMI asks"
    if not description.logCategories:
        yield "there are no log categories"
