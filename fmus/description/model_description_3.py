"""modelDescription.xml and buildDescription.xml of an FMU of FMI 3.0, written from the declarations of its block."""

from xml.etree.ElementTree import Element, SubElement

from ...models.block.declaration import Boolean, Declaration, Enumeration, Integer, Real
from ...models.block.types import Block
from ..fmu import Fmu
from .build_kind import BuildKind
from .dependencies import initial_dependencies, output_dependencies
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
from .terminal import add_members, members, outputs
from .variables import Variable, interface, rate_of, time_and_rates

CAPABILITIES = {
    "needsExecutionTool": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canGetAndSetFMUState": "true",
    "canSerializeFMUState": "true",
    "canHandleVariableCommunicationStepSize": "true",
    "hasEventMode": "false",
    "providesIntermediateUpdate": "false",
}

TYPES: dict[type[Declaration], str] = {
    Boolean: "Boolean",
    Enumeration: "Enumeration",
    Integer: "Int32",
    Real: "Float64",
}
"""XML element of each type."""


def model_description_3(fmu: Fmu, kind: BuildKind, token: str) -> bytes:
    """The XML with that instantiation token.

    Raises:
        ValueError: two variables have one name, or names that differ in case only.
    """
    all_variables = interface(fmu.block) + time_and_rates(fmu.block)
    check_names(all_variables)
    root = new_root(fmu, kind, {"instantiationToken": token})
    SubElement(root, "CoSimulation", {"modelIdentifier": fmu.name} | CAPABILITIES | kind.capabilities)
    add_definitions(root, fmu, kind, all_variables, _add_enumeration)
    listed = SubElement(root, "ModelVariables")
    for variable in all_variables:
        _add_variable(listed, variable, fmu.block)
    if kind.has_terminal:
        add_members(listed, fmu.block)
    _add_structure(root, fmu, kind)
    return written(root)


def build_description(fmu: Fmu, kind: BuildKind) -> bytes:
    """The XML that tells how the sources are compiled."""
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = SubElement(root, "BuildConfiguration", modelIdentifier=fmu.name)
    sources = SubElement(configuration, "SourceFileSet", language="C99")
    for name in kind.source_files:
        SubElement(sources, "SourceFile", name=name)
    return written(root)


def _add_enumeration(definitions: Element, name: str) -> Element:
    return SubElement(definitions, "EnumerationType", name=name)


def _add_variable(listed: Element, variable: Variable, block: Block) -> None:
    moves = rate_of(variable, block)
    derivative = {} if moves is None else {"derivative": str(moves)}
    attributes = variable_attributes(variable, block) | type_attributes(variable.declaration)
    SubElement(listed, TYPES[type(variable.declaration)], attributes | start(variable) | nominal(variable) | derivative)


def _add_structure(root: Element, fmu: Fmu, kind: BuildKind) -> None:
    references = {v.name: v.reference for v in interface(fmu.block)} | members(fmu.block)
    sent = dict.fromkeys(outputs(fmu.block) if kind.has_terminal else (), frozenset[str]())
    clocks = {name: on for name, on in sent.items() if name.endswith("Clock")}  # what is clocked has no initial value
    structure = SubElement(root, "ModelStructure")
    sections = {
        "Output": output_dependencies(fmu.block) | sent,
        "InitialUnknown": initial_dependencies(fmu.block) | clocks,
    }
    for section, unknowns in sections.items():
        for unknown, on in unknowns.items():
            reference = {"valueReference": str(references[unknown])}
            SubElement(structure, section, reference | dependencies(on, references))
