"""Rules for the model description of an FMU: each is given its interface."""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from itertools import pairwise
from math import inf

from fmpy import read_model_description
from fmpy.model_description import ModelVariable, ValidationError

from fmuloop.interface import Interface, type_of, unit_of

from .document import REALS, SECTIONS, TRUE, Declared, Unknown, document
from .rule import Clause, Rules, Severity

DATE = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ")

NUMBERS = ("Real", "Float32", "Integer", "Enumeration")

VARIABLES = Clause("2.2.7", "2.4.7.4")

STRUCTURE = Clause("2.2.8", "2.4.8")


def _public(interface: Interface) -> list[ModelVariable]:
    return [v for v in interface.variables.values() if v.causality != "local"]


def _twice(names: Iterable[str | None]) -> list[str | None]:
    """Those that are there more than once."""
    return [name for name, count in Counter(names).items() if count > 1]


DESCRIPTION_RULES = Rules()


@DESCRIPTION_RULES.rule(
    "schema",
    Severity.ERROR,
    "the model description is valid (fmpy)",
    Clause("2.2", "2.4"),
    others="fmpy FMUChecker VDMCheck",
)
def standard(interface: Interface) -> list[str]:
    """What fmpy finds: the XML schema, start values, causalities, units. Its grammar of names takes a millisecond each,
    and it wants clocks among the InitialUnknowns: rules of our own are in their place."""
    try:
        read_model_description(str(interface.path), validate=True)
    except ValidationError as error:
        return error.problems
    except Exception as error:  # fmpy raises bare exceptions
        return [f"fmpy cannot read it: {error if type(error) is Exception else repr(error)}"]
    return []


# fmpy takes 1.4 ms a name to parse this
_QUOTED = r"""'(?:[\w!#$%&()*+,\-./:;<>=?@\[\]^{}|~ ]|\\['"?\\abfnrtv])+'"""
_PART = rf"(?:[A-Za-z_][A-Za-z0-9_]*|{_QUOTED})(?:\[\d+(?:,\d+)*\])?"
_PATH = rf"{_PART}(?:\.{_PART})*"

NAMES = {
    "flat": re.compile(r"[^\r\n\t]+"),
    "structured": re.compile(rf"{_PATH}|der\({_PATH}(?:,\d+)?\)", re.ASCII),
}
"""By variableNamingConvention."""


@DESCRIPTION_RULES.rule(
    "variable-names",
    Severity.ERROR,
    "names of variables are as the naming convention asks",
    Clause("2.2.9", "2.4.7.5.1"),
    others="fmpy",
)
def variable_names(interface: Interface) -> Iterator[str]:
    """Names that are not."""
    convention = interface.description.variableNamingConvention or "flat"
    pattern = NAMES.get(convention, NAMES["flat"])
    for name in interface.variables:
        if not pattern.fullmatch(name):
            yield f'"{name}" is not a legal variable name for naming convention "{convention}"'


@DESCRIPTION_RULES.rule(
    "structure",
    Severity.ERROR,
    "ModelStructure lists outputs, derivatives and initial unknowns, each once",
    STRUCTURE,
    others="fmpy VDMCheck",
)
def structure(interface: Interface) -> Iterator[str]:
    """What is missing in it, there twice, of another kind, or out of order. In co-simulation alone Derivatives count in
    FMI 2.0 only with directional derivatives."""
    doc = document(interface)
    listed = {section: doc.unknowns(section) for section in SECTIONS[interface.fmi]}
    for section, unknowns in listed.items():
        for key in _twice(unknown.key for unknown in unknowns):
            yield f"{section} has {doc.variables[str(key)].name} twice"
        for unknown in unknowns:
            if unknown.kinds and len(unknown.kinds) != len(unknown.dependencies or []):
                name = doc.variables[unknown.key].name
                yield f"the number of dependencies and of dependenciesKind of {name} in {section} do not match"
    yield from _differing(
        doc.variables, "Outputs", listed, {k for k, v in doc.variables.items() if v.model.causality == "output"}
    )
    for unknown in listed["Derivatives"]:
        if "derivative" not in doc.variables[unknown.key].attributes:
            yield f"{doc.variables[unknown.key].name} in Derivatives must have the attribute derivative"
    initial = {key for key, v in doc.variables.items() if _is_initial_unknown(v)}
    of_states = {*doc.states, *doc.states.values()} & doc.variables.keys()
    unknown = {key for key in of_states if doc.variables[key].model.initial in ("approx", "calculated")} - initial
    if interface.fmi == 2 and not (
        interface.description.modelExchange or doc.claims("providesDirectionalDerivatives", "CoSimulation")
    ):
        unknown &= {initial_unknown.key for initial_unknown in listed["InitialUnknowns"]}
    yield from _differing(doc.variables, "InitialUnknowns", listed, initial | unknown)
    numbers = [int(unknown.key) for unknown in listed["InitialUnknowns"] if interface.fmi == 2]
    for before, after in pairwise(numbers):
        if before > after:
            names = doc.variables[str(after)].name, doc.variables[str(before)].name
            yield f"{names[0]} stands behind {names[1]} in InitialUnknowns, and before it among the variables"
            break
    if interface.fmi == 3:
        clocked = {key for key, v in doc.variables.items() if "previous" in v.attributes}
        yield from _differing(doc.variables, "ClockedStates", listed, clocked)


def _is_initial_unknown(variable: Declared) -> bool:
    """Of FMI 2.0 and 3.0; clocks and what is clocked have no value in initialization mode."""
    if variable.model.causality == "calculatedParameter":
        return True
    # fmpy asks for clocks among the InitialUnknowns
    timed = variable.type == "Clock" or "clocks" in variable.attributes
    return variable.model.causality == "output" and variable.model.initial in ("approx", "calculated") and not timed


def _differing(
    variables: dict[str, Declared], section: str, listed: dict[str, list[Unknown]], expected: set[str]
) -> Iterator[str]:
    """What a section lacks or should not have."""
    there = {unknown.key for unknown in listed[section]}
    for key in variables:
        if (key in expected) != (key in there):
            verb = "lacks" if key in expected else "must not have"
            yield f"{section} {verb} {variables[key].name}"


@DESCRIPTION_RULES.rule(
    "initial", Severity.ERROR, "initial is given only to variables that may have it", VARIABLES, others="VDMCheck"
)
def initial(interface: Interface) -> Iterator[str]:
    """What is set from outside is not initialized; FMI 3.0 forbids it for the independent variable alone."""
    without = ("input", "independent") if interface.fmi == 2 else ("independent",)
    for variable in document(interface).variables.values():
        if "initial" in variable.attributes and variable.model.causality in without:
            yield f'{variable.name} is {variable.model.causality} and has initial="{variable.attributes["initial"]}"'


@DESCRIPTION_RULES.rule(
    "bounds", Severity.ERROR, "start values are within their bounds", Clause("2.2.7", "2.4.7.5"), others="VDMCheck"
)
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


@DESCRIPTION_RULES.rule("nominal", Severity.WARNING, "nominal values are above 0", Clause("2.2.7", "2.4.7.4"))
def nominal(interface: Interface) -> Iterator[str]:
    """What a solver divides by."""
    for variable in document(interface).variables.values():
        nominal_value = variable.attributes.get("nominal")
        if nominal_value is not None and not float(nominal_value) > 0.0:
            yield f"the nominal value of {variable.name} is {nominal_value}"


@DESCRIPTION_RULES.rule(
    "enumerations",
    Severity.ERROR,
    "items of an enumeration have values and names of their own, and starts are among them",
    Clause("2.2.3", "2.4.4"),
    others="VDMCheck",
)
def enumerations(interface: Interface) -> Iterator[str]:
    """Types whose items are alike, and starts that are no item."""
    doc = document(interface)
    items = {name: declared.findall("Item") for name, declared in doc.types.items()}
    for name, listed in items.items():
        for what in ("name", "value"):
            for twice in _twice(item.get(what) for item in listed):
                yield f"two items of {name} have the {what} {twice}"
    for variable in doc.variables.values():
        values = {item.get("value") for item in items.get(variable.attributes.get("declaredType"), [])}
        if variable.type == "Enumeration" and values:
            for start in doc.starts(variable):
                if start not in values:
                    kind = variable.attributes["declaredType"]
                    yield f"{variable.name} starts at {start}, which is no item of {kind}"


@DESCRIPTION_RULES.rule(
    "aliases",
    Severity.ERROR,
    "variables that share a value reference are one",
    Clause("2.2.7"),
    others="VDMCheck",
)
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


@DESCRIPTION_RULES.rule(
    "reinit",
    Severity.ERROR,
    "reinit is given only to continuous states in model exchange",
    Clause("2.2.7", "2.4.7.5"),
    others="VDMCheck",
)
def reinit(interface: Interface) -> Iterator[str]:
    """In FMI 2.0 it must not be present where there is no model exchange."""
    doc = document(interface)
    variables = [v for v in doc.variables.values() if "reinit" in v.attributes]
    if variables and interface.fmi == 2 and interface.description.modelExchange is None:
        yield f"{len(variables)} variables have reinit, but the FMU is for co-simulation alone"
        return
    states = {
        *doc.states.values(),
        *(v.attributes["derivative"] for v in doc.variables.values() if "derivative" in v.attributes),
    }
    for variable in variables:
        if variable.key not in states and variable.attributes["reinit"] in TRUE:
            yield f"{variable.name} has reinit, and is no continuous state"


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
    others="VDMCheck",
)
def names(interface: Interface) -> Iterator[str]:
    """Names that are there twice; fmpy sees to those of variables."""
    root = document(interface).root
    for what, where in LISTS.items():
        for name, count in Counter(element.get("name") for element in root.iterfind(where)).items():
            if count > 1:
                yield f"{count} {what} are called {name}"


@DESCRIPTION_RULES.rule(
    "derivatives",
    Severity.ERROR,
    "each derivative is that of one continuous state",
    Clause("2.2.7, 2.2.8", "2.4.7.5, 2.4.8"),
    others="VDMCheck",
)
def derivatives(interface: Interface) -> Iterator[str]:
    """What ModelStructure lists as derivatives: the states are theirs, in that order."""
    seen: dict[str, str] = {}
    for unknown in interface.description.derivatives:
        rate = unknown.variable
        state = None if rate is None else rate.derivative
        if rate is None or state is None:
            continue  # the rule `structure` says so
        if str(state.type).rpartition(" ")[2] not in REALS or state.variability not in (None, "continuous"):
            yield f"{rate.name} is the derivative of {state.name}, which is no continuous Real"
        if state.name in seen:
            yield f"{rate.name} and {seen[state.name]} are derivatives of {state.name}"
        seen[state.name] = rate.name


NEEDED = {
    "canSerializeFMUState": "canGetAndSetFMUState",
    "canReturnEarlyAfterIntermediateUpdate": "providesIntermediateUpdate",
}
"""What may be claimed only together with something else, by the names of FMI 3.0."""


@DESCRIPTION_RULES.rule(
    "capabilities", Severity.ERROR, "capabilities that need others come with them", Clause("3.3.1, 4.3.1", "2.4.2, 4.4")
)
def capabilities(interface: Interface) -> Iterator[str]:
    """Claims that cannot be."""
    doc = document(interface)
    for kind in doc.root:
        for claim, needs in NEEDED.items():
            if doc.claims(claim, kind.tag) and not doc.claims(needs, kind.tag):
                yield f"{kind.tag} has {doc.called(claim)}, but not {doc.called(needs)}"


@DESCRIPTION_RULES.rule(
    "clocks",
    Severity.ERROR,
    "clocks have what their kind needs, and what is clocked names them",
    Clause(fmi3="2.4.7.5.9, 4.4, 5.4"),
)
def clocks(interface: Interface) -> Iterator[str]:
    """Of FMI 3.0: intervals, priorities, event mode, and the attributes clocks and previous."""
    doc = document(interface)
    of_type = {key: v for key, v in doc.variables.items() if v.type == "Clock"}
    stepping, scheduled = interface.description.coSimulation, interface.description.scheduledExecution
    if of_type and stepping and not stepping.hasEventMode:
        yield "it has clocks, but no event mode (hasEventMode)"
    for clock in of_type.values():
        attributes = clock.attributes
        if attributes.get("intervalVariability") == "constant" and "intervalDecimal" not in attributes:
            yield f"{clock.name} is a constant clock without intervalDecimal"
        if "intervalDecimal" in attributes and not float(attributes["intervalDecimal"]) > 0.0:
            yield f"the interval of {clock.name} is {attributes['intervalDecimal']}, which is not above 0"
        if "intervalCounter" in attributes and "resolution" not in attributes:
            yield f"{clock.name} has intervalCounter without resolution"
        if scheduled and clock.model.causality == "input" and "priority" not in attributes:
            yield f"{clock.name} has no priority, which scheduled execution needs"
    for variable in doc.variables.values():
        for named in variable.attributes.get("clocks", "").split():
            if named not in of_type:
                yield f"clocks of {variable.name} names {named}, which is no clock"
        if "clocks" in variable.attributes and variable.model.variability not in ("discrete", "tunable"):
            yield f"{variable.name} has clocks, and is {variable.model.variability}"
        if "previous" in variable.attributes and variable.attributes["previous"] not in doc.variables:
            yield f"previous of {variable.name} is {variable.attributes['previous']}, which no variable has"


@DESCRIPTION_RULES.rule(
    "dimensions",
    Severity.ERROR,
    "dimensions have one size, and arrays as many start values",
    Clause(fmi3="2.4.7.3, 2.4.7.4"),
)
def dimensions(interface: Interface) -> Iterator[str]:
    """Of FMI 3.0."""
    doc = document(interface)
    for variable in doc.variables.values():
        sized = variable.element.findall("Dimension")
        if any((size.get("start") is None) == (size.get("valueReference") is None) for size in sized):
            yield f"a dimension of {variable.name} must have either start or valueReference"
            continue
        for size in sized:
            named = doc.variables.get(size.get("valueReference", ""))
            if named and (named.model.causality != "structuralParameter" or named.type != "UInt64"):
                yield f"a dimension of {variable.name} is {named.name}, which is no structural parameter of type UInt64"
        starts = doc.starts(variable)
        if sized and len(starts) not in (0, doc.size(variable)):
            yield f"{variable.name} has {len(starts)} start values for {doc.size(variable)} elements"


@DESCRIPTION_RULES.rule("date", Severity.WARNING, "the date is as YYYY-MM-DDThh:mm:ssZ", Clause("2.2.1", "2.4.1"))
def date(interface: Interface) -> Iterator[str]:
    """When it was made."""
    written = interface.description.generationDateAndTime
    if written and not DATE.fullmatch(written):
        yield f"generationDateAndTime is {written}"


@DESCRIPTION_RULES.rule(
    "experiment-numbers",
    Severity.ERROR,
    "the default experiment stops after it starts, tolerance and internal step are above 0",
    Clause("2.2.5", "2.4.6, 4.4"),
    others="VDMCheck",
)
def experiment_numbers(interface: Interface) -> Iterator[str]:
    """Numbers with which no host can start."""
    default = interface.description.defaultExperiment
    if default is not None:
        start = default.startTime or 0
        if default.stopTime is not None and float(default.stopTime) <= float(start):
            yield f"stopTime = {default.stopTime} is not after startTime = {start}"
        if default.tolerance is not None and not float(default.tolerance) > 0.0:
            yield f"tolerance = {default.tolerance} is not above 0"
    for kind in document(interface).root:
        if not float(kind.get("fixedInternalStepSize", 1.0)) > 0.0:
            yield f"fixedInternalStepSize = {kind.get('fixedInternalStepSize')} is not above 0"


@DESCRIPTION_RULES.rule("experiment", Severity.NOTE, "there is a default experiment", Clause("2.2.5", "2.4.6"))
def experiment(interface: Interface) -> Iterator[str]:
    """What a tool runs first; every attribute may be missing."""
    default = interface.description.defaultExperiment
    if default is None or default.stopTime is None or default.stepSize is None:
        yield "DefaultExperiment lacks stopTime or stepSize"


@DESCRIPTION_RULES.rule("dependencies", Severity.NOTE, "outputs tell their dependencies", STRUCTURE)
def dependencies(interface: Interface) -> Iterator[str]:
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


# the standard does not ask for units
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
