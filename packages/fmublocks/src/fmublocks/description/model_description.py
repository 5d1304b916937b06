"""modelDescription.xml of an FMU of FMI 2.0, written from the declarations of its block."""

from xml.etree.ElementTree import Element, SubElement

from ..block.declaration import Boolean, Declaration, Enumeration, Integer, Real
from ..block.types import Block, ContinuousBlock
from ..fmu import Fmu
from .build_kind import BuildKind
from .dependencies import exchanged_dependencies, initial_dependencies, initial_state_dependencies, output_dependencies
from .elements import (
    add_definitions,
    check_names,
    dependencies,
    new_root,
    nominal,
    start,
    type_attributes,
    variable_attributes,
    written,
)
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

TYPES: dict[type[Declaration], str] = {Boolean: "Boolean", Enumeration: "Enumeration", Integer: "Integer", Real: "Real"}
"""XML element of each type."""


def model_description(fmu: Fmu, kind: BuildKind, guid: str) -> bytes:
    """The XML with that GUID.

    Raises:
        ValueError: the names of two variables differ in case only, which not every tool tells apart.
    """
    exchanged = states(fmu.block) if kind.model_exchange else ()
    all_variables = (*interface(fmu.block), *exchanged)
    check_names(all_variables)
    root = new_root(fmu, kind, {"guid": guid})
    if exchanged:
        root.set("numberOfEventIndicators", str(len(event_indicators(fmu.block))))
        _add_kind(root, "ModelExchange", fmu, kind, EXCHANGE_CAPABILITIES | kind.model_exchange)
    _add_kind(root, "CoSimulation", fmu, kind, CAPABILITIES | kind.capabilities)
    add_definitions(root, fmu, kind, all_variables, _add_enumeration)
    listed = SubElement(root, "ModelVariables")
    for variable in all_variables:
        _add_variable(listed, variable, fmu.block)
    _add_structure(root, fmu.block, all_variables, exchanged)
    return written(root)


def _add_kind(root: Element, name: str, fmu: Fmu, kind: BuildKind, capabilities: dict[str, str]) -> None:
    element = SubElement(root, name, {"modelIdentifier": fmu.name} | capabilities)
    if kind.source_files:
        sources = SubElement(element, "SourceFiles")
        for name in kind.source_files:
            SubElement(sources, "File", name=name)


def _add_enumeration(definitions: Element, name: str) -> Element:
    return SubElement(SubElement(definitions, "SimpleType", name=name), "Enumeration")


def _add_variable(listed: Element, variable: Variable, block: Block) -> None:
    scalar = SubElement(listed, "ScalarVariable", variable_attributes(variable, block))
    derivative = {} if variable.of is None else {"derivative": str(variable.of + 1)}
    attributes = type_attributes(variable.declaration) | nominal(variable) | derivative | start(variable)
    SubElement(scalar, TYPES[type(variable.declaration)], attributes)


def _add_structure(
    root: Element, block: Block, all_variables: tuple[Variable, ...], exchanged: tuple[Variable, ...]
) -> None:
    index = {v.name: v.reference + 1 for v in all_variables}
    structure = SubElement(root, "ModelStructure")
    sections = {"Outputs": output_dependencies(block), "InitialUnknowns": initial_dependencies(block)}
    if isinstance(block, ContinuousBlock) and exchanged:
        on = exchanged_dependencies(block)
        initial = sections["InitialUnknowns"] | initial_state_dependencies(block)
        sections = {"Outputs": on.outputs, "Derivatives": on.rates, "InitialUnknowns": initial}
    for section, unknowns in sections.items():
        listed = SubElement(structure, section)
        for unknown, on in unknowns.items():
            SubElement(listed, "Unknown", {"index": str(index[unknown])} | dependencies(on, index))
