"""Rules for the model description of an FMU: each is given its interface."""

import re
from collections import Counter, defaultdict
from collections.abc import Iterator
from math import inf

from fmpy.model_description import ModelVariable
from fmpy.validation import validate_fmu

from ...cosimulation.description import attributes
from ...cosimulation.interface import Interface, type_of, unit_of
from .rule import Clause, Rules, Severity

DATE = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ")

REALS = ("Real", "Float32")

NUMBERS = (*REALS, "Integer", "Enumeration")

VARIABLES = Clause("2.2.7", "2.4.7.4")


def _public(interface: Interface) -> list[ModelVariable]:
    return [v for v in interface.variables.values() if v.causality != "local"]


DESCRIPTION_RULES = Rules()


@DESCRIPTION_RULES.rule("schema", Severity.ERROR, "the model description is valid (fmpy)", Clause("2.2", "2.4"))
def standard(interface: Interface) -> list[str]:
    """What fmpy finds: the XML schema, names, start values, causalities, units, InitialUnknowns."""
    try:
        return [str(problem) for problem in validate_fmu(str(interface.path))]
    except Exception as error:  # fmpy raises bare exceptions
        return [f"fmpy cannot read it: {error}"]


@DESCRIPTION_RULES.rule("initial", Severity.ERROR, "initial is given only to variables that may have it", VARIABLES)
def initial(interface: Interface) -> Iterator[str]:
    """What is set from outside is not initialized; FMI 3.0 forbids it for the independent variable alone."""
    without = ("input", "independent") if interface.fmi == 2 else ("independent",)
    for given in attributes(interface.path, interface.limits, "ModelVariables/*"):
        if "initial" in given and given.get("causality") in without:
            yield f'{given.get("name")} is {given["causality"]} and has initial="{given["initial"]}"'


@DESCRIPTION_RULES.rule("bounds", Severity.ERROR, "start values are within their bounds", Clause("2.2.7", "2.4.7.5"))
def bounds(interface: Interface) -> Iterator[str]:
    """Start values that are out of bounds, and bounds between which there is nothing."""
    for variable in interface.variables.values():
        if variable.type not in NUMBERS:
            continue
        declared = variable.declaredType
        lower = variable.min or (declared.min if declared else None) or -inf
        upper = variable.max or (declared.max if declared else None) or inf
        if float(lower) > float(upper):
            yield f"{variable.name} has min {lower} above max {upper}"
        elif variable.start is not None and not float(lower) <= float(variable.start) <= float(upper):
            yield f"{variable.name} starts at {variable.start}, out of [{lower}, {upper}]"


@DESCRIPTION_RULES.rule("aliases", Severity.ERROR, "variables that share a value reference are one", Clause("2.2.7"))
def aliases(interface: Interface) -> Iterator[str]:
    """What FMI 2.0 asks of variables of one value; in FMI 3.0 none share one, which the rule `schema` says."""
    sharing: dict[tuple[str, int], list[ModelVariable]] = defaultdict(list)
    for variable in interface.variables.values() if interface.fmi == 2 else ():
        sharing[type_of(variable), variable.valueReference].append(variable)
    for alike in (alike for alike in sharing.values() if alike[1:]):
        names = f"{alike[0].name} and {alike[1].name}" + (f" and {len(alike) - 2} more" if alike[2:] else "")
        constant = [v for v in alike if v.variability == "constant"]
        started = [v.name for v in alike if v.start is not None and v not in constant]
        if constant and (len(constant) < len(alike) or len({v.start for v in constant}) > 1):
            yield f"{names} have one value reference, but are not the same constant"
        if started[1:]:
            yield f"{started[0]} and {started[1]} have one value reference and a start value each"
        if len({unit_of(v) for v in alike}) > 1:
            yield f"{names} have one value reference, but not one unit"


@DESCRIPTION_RULES.rule("reinit", Severity.ERROR, "reinit is given only in model exchange", Clause("2.2.7"))
def reinit(interface: Interface) -> Iterator[str]:
    """In FMI 2.0 it must not be present where there is no model exchange."""
    if interface.fmi == 2 and interface.description.modelExchange is None:
        given = [
            each for each in attributes(interface.path, interface.limits, "ModelVariables/*/*") if "reinit" in each
        ]
        if given:
            yield f"{len(given)} variables have reinit, but the FMU is for co-simulation alone"


LISTS = {
    "units": "UnitDefinitions/Unit",
    "types": "TypeDefinitions/*",
    "log categories": "LogCategories/Category",
}
"""Where names stand that are unique."""


@DESCRIPTION_RULES.rule(
    "names",
    Severity.ERROR,
    "units, types and log categories have names of their own",
    Clause("2.2.2 to 2.2.4", "2.4.3 to 2.4.5"),
)
def names(interface: Interface) -> Iterator[str]:
    """Names that are there twice; fmpy sees to those of variables."""
    for what, where in LISTS.items():
        for name, count in Counter(
            given.get("name") for given in attributes(interface.path, interface.limits, where)
        ).items():
            if count > 1:
                yield f"{count} {what} are called {name}"


@DESCRIPTION_RULES.rule(
    "derivatives",
    Severity.ERROR,
    "each derivative is that of one continuous state",
    Clause("2.2.7, 2.2.8", "2.4.7.5, 2.4.8"),
)
def derivatives(interface: Interface) -> Iterator[str]:
    """What ModelStructure lists as derivatives: the states are theirs, in that order."""
    seen: dict[str, str] = {}
    for unknown in interface.description.derivatives:
        rate = unknown.variable
        state = None if rate is None else rate.derivative
        if rate is None or state is None:
            continue  # the schema's rule says so
        if str(state.type).rpartition(" ")[2] not in REALS or state.variability not in (None, "continuous"):
            yield f"{rate.name} is the derivative of {state.name}, which is no continuous Real"
        if state.name in seen:
            yield f"{rate.name} and {seen[state.name]} are derivatives of {state.name}"
        seen[state.name] = rate.name


@DESCRIPTION_RULES.rule("date", Severity.WARNING, "the date is as YYYY-MM-DDThh:mm:ssZ", Clause("2.2.1", "2.4.1"))
def date(interface: Interface) -> Iterator[str]:
    """When it was made."""
    given = interface.description.generationDateAndTime
    if given and not DATE.fullmatch(given):
        yield f"generationDateAndTime is {given}"


@DESCRIPTION_RULES.rule("experiment", Severity.NOTE, "there is a default experiment", Clause("2.2.5", "2.4.6"))
def experiment(interface: Interface) -> Iterator[str]:
    """What a tool runs first; every attribute may be missing."""
    default = interface.description.defaultExperiment
    if default is None or default.stopTime is None or default.stepSize is None:
        yield "DefaultExperiment lacks stopTime or stepSize"
    elif float(default.stopTime) <= float(default.startTime or 0.0):
        yield f"stopTime = {default.stopTime} is not after startTime = {default.startTime or 0}"


@DESCRIPTION_RULES.rule("dependencies", Severity.NOTE, "outputs tell their dependencies", Clause("2.2.8", "2.4.8"))
def structure(interface: Interface) -> Iterator[str]:
    """Outputs that do not say what they depend on: it may be everything, and tools see algebraic loops."""
    for unknown in interface.description.outputs:
        if unknown.dependencies is None and unknown.variable is not None:
            yield f"output {unknown.variable.name} does not tell its dependencies"


@DESCRIPTION_RULES.rule("execution-tool", Severity.NOTE, "it needs no other tool", Clause("3.3.1, 4.3.1", "2.5.3"))
def execution_tool(interface: Interface) -> Iterator[str]:
    """Whether it claims to need the tool that made it."""
    cosimulation = interface.description.coSimulation
    if cosimulation is not None and cosimulation.needsExecutionTool:
        yield "needsExecutionTool is true: some tools refuse such FMUs"


@DESCRIPTION_RULES.rule("units", Severity.NOTE, "variables have units", Clause("2.2.2", "2.4.3"))
def units(interface: Interface) -> Iterator[str]:
    """Public variables without unit."""
    for variable in _public(interface):
        if variable.type in REALS and unit_of(variable) is None:
            yield f'{variable.name} has no unit ("1" if it has no dimension)'


@DESCRIPTION_RULES.rule("descriptions", Severity.NOTE, "variables have descriptions", VARIABLES)
def descriptions(interface: Interface) -> Iterator[str]:
    """Public variables without description."""
    for variable in _public(interface):
        if not variable.description:
            yield f"{variable.name} has no description"


@DESCRIPTION_RULES.rule("origin", Severity.NOTE, "it tells what made it", Clause("2.2.1", "2.4.1"))
def origin(interface: Interface) -> Iterator[str]:
    """What a tool shows before the first run."""
    description = interface.description
    for attribute in ("description", "generationTool", "generationDateAndTime"):
        if not getattr(description, attribute):
            yield f"{attribute} is not given"
    if not description.logCategories:
        yield "there are no log categories"
