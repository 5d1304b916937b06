"""modelDescription.xml of an FMU of FMI 2.0, written from the declarations of its block."""

from collections.abc import Iterable
from xml.etree.ElementTree import Element, SubElement

from ...models.block.declaration import Boolean, Declaration, Enumeration, Integer, Real
from ...models.block.types import Block, ContinuousBlock, SampledBlock
from ..fmu import Fmu
from ..release import ABOUT, date, tool
from .build_kind import BuildKind
from .dependencies import (
    exchanged_dependencies,
    initial_dependencies,
    initial_state_dependencies,
    output_dependencies,
)
from .elements import add_categories, add_experiment, add_units, check_names, limits, text, written
from .states import event_indicators, states
from .variables import Variable, interface

CAPABILITIES = {
    # The model is in the FMU and runs in the process of the host; no tool is started or talked to.
    "needsExecutionTool": "false",
    "canHandleVariableCommunicationStepSize": "true",
    "canRunAsynchronuously": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canGetAndSetFMUstate": "true",
    "canSerializeFMUstate": "true",
}
"""Of co-simulation, in every build."""

STEPPING_ALONE = ("canHandleVariableCommunicationStepSize", "canRunAsynchronuously")
"""Those that model exchange does not know."""

EXCHANGE_CAPABILITIES = {name: CAPABILITIES[name] for name in CAPABILITIES if name not in STEPPING_ALONE} | {
    "completedIntegratorStepNotNeeded": "true"
}


def model_description(fmu: Fmu, kind: BuildKind, guid: str) -> bytes:
    """The XML with that GUID.

    Raises:
        ValueError: the names of two variables differ in case only, which not every tool tells apart.
    """
    exchanged = states(fmu.block) if kind.model_exchange else ()
    all_variables = (*interface(fmu.block), *exchanged)
    check_names(all_variables)
    root = Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=fmu.name,
        guid=guid,
        description=fmu.block.description,
        generationTool=tool(kind.tool),
        generationDateAndTime=f"{date():%Y-%m-%dT%H:%M:%SZ}",
        variableNamingConvention="flat",
    )
    root.attrib.update(ABOUT if fmu.is_of_the_project else {})
    if isinstance(fmu.block, ContinuousBlock) and exchanged:
        root.set("numberOfEventIndicators", str(event_indicators(fmu.block)))
        _add_kind(root, "ModelExchange", fmu, kind, EXCHANGE_CAPABILITIES | kind.model_exchange)
    _add_kind(root, "CoSimulation", fmu, kind, CAPABILITIES | kind.capabilities)
    add_units(root, all_variables)
    _add_enumerations(root, all_variables)
    add_categories(root, kind)
    add_experiment(root, fmu)
    listed = SubElement(root, "ModelVariables")
    for variable in all_variables:
        _add_variable(listed, variable, sampled=isinstance(fmu.block, SampledBlock))
    _add_structure(root, fmu.block, all_variables, exchanged)
    return written(root)


def _add_kind(root: Element, name: str, fmu: Fmu, kind: BuildKind, capabilities: dict[str, str]) -> None:
    element = SubElement(root, name, {"modelIdentifier": fmu.name} | capabilities)
    if kind.source_files:
        sources = SubElement(element, "SourceFiles")
        for name in kind.source_files:
            SubElement(sources, "File", name=name)


def _add_enumerations(root: Element, all_variables: Iterable[Variable]) -> None:
    used = {v.declaration.name: v.declaration for v in all_variables if isinstance(v.declaration, Enumeration)}
    definitions = SubElement(root, "TypeDefinitions") if used else root
    for name, declaration in used.items():
        items = SubElement(SubElement(definitions, "SimpleType", name=name), "Enumeration")
        for value, (item, meaning) in enumerate(declaration.items, start=1):
            SubElement(items, "Item", name=item, value=str(value), description=meaning)


def _add_variable(listed: Element, variable: Variable, sampled: bool) -> None:
    declaration = variable.declaration
    attributes = {
        "name": variable.name,
        "valueReference": str(variable.reference),
        "description": declaration.description,
        "causality": variable.causality,
    }
    if variable.causality == "parameter":
        attributes |= {"variability": "fixed", "initial": "exact"}
    else:
        # what feeds a sampled block may change at any time; what leaves it may not
        discrete = not isinstance(declaration, Real) or (sampled and variable.causality == "output")
        attributes["variability"] = "discrete" if discrete else "continuous"
        if variable.causality != "input":
            attributes["initial"] = "calculated"
    start = {} if variable.start is None else {"start": text(variable.start)}
    scalar = SubElement(listed, "ScalarVariable", attributes)
    tag, attributes = _type(declaration)
    if variable.causality != "parameter" and variable.nominal is not None:
        attributes["nominal"] = text(variable.nominal)
    if variable.state is not None:
        attributes["derivative"] = str(variable.state + 1)
    SubElement(scalar, tag, attributes | start)


def _type(declaration: Declaration) -> tuple[str, dict[str, str]]:
    """XML element of a type and its attributes."""
    match declaration:
        case Boolean():
            return "Boolean", {}
        case Enumeration():
            return "Enumeration", {"declaredType": declaration.name}
        case Integer():
            return "Integer", limits(declaration, Integer(""))
        case Real():
            return "Real", {"unit": declaration.unit, **limits(declaration, Real("1", ""))}


def _add_structure(
    root: Element, block: Block, all_variables: tuple[Variable, ...], exchanged: tuple[Variable, ...]
) -> None:
    index = {v.name: v.reference + 1 for v in all_variables}
    structure = SubElement(root, "ModelStructure")
    sections = {"Outputs": output_dependencies(block), "InitialUnknowns": initial_dependencies(block)}
    if isinstance(block, ContinuousBlock) and exchanged:
        outputs, rates = exchanged_dependencies(block)
        initial = sections["InitialUnknowns"] | initial_state_dependencies(block)
        sections = {"Outputs": outputs, "Derivatives": rates, "InitialUnknowns": initial}
    for section, dependencies in sections.items():
        unknowns = SubElement(structure, section)
        for output, on in dependencies.items():
            known = sorted(index[name] for name in on)
            SubElement(
                unknowns,
                "Unknown",
                index=str(index[output]),
                dependencies=" ".join(map(str, known)),
                dependenciesKind=" ".join("dependent" for _ in known),
            )
