"""modelDescription.xml and buildDescription.xml of an FMU of FMI 3.0, written from the declarations of its block."""

from xml.etree.ElementTree import Element, SubElement

from ..block.declaration import Boolean, Declaration, Enumeration, Integer, Real
from ..block.types import Block, ContinuousBlock
from ..fmu import Fmu
from .build_kind import BuildKind
from .dependencies import (
    Dependencies,
    exchanged_dependencies,
    initial_dependencies,
    initial_state_dependencies,
    output_dependencies,
)
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
from .states import shown_by_fmi3
from .terminal import add_members, members, outputs
from .variables import Variable, interface

CAPABILITIES = {
    "needsExecutionTool": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canGetAndSetFMUState": "true",
    "canSerializeFMUState": "true",
}
"""Of co-simulation and of model exchange."""

STEPPING_CAPABILITIES = CAPABILITIES | {
    "canHandleVariableCommunicationStepSize": "true",
    "hasEventMode": "false",
    "providesIntermediateUpdate": "false",
}

EXCHANGE_CAPABILITIES = CAPABILITIES | {"needsCompletedIntegratorStep": "false"}

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
    all_variables = interface(fmu.block) + shown_by_fmi3(fmu.block)
    check_names(all_variables)
    root = new_root(fmu, kind, {"instantiationToken": token})
    identifier = {"modelIdentifier": fmu.name}
    if kind.model_exchange:
        SubElement(root, "ModelExchange", identifier | EXCHANGE_CAPABILITIES | kind.model_exchange)
    SubElement(root, "CoSimulation", identifier | STEPPING_CAPABILITIES | kind.capabilities)
    add_definitions(root, fmu, kind, all_variables, _add_enumeration)
    listed = SubElement(root, "ModelVariables")
    for variable in all_variables:
        _add_variable(listed, variable, fmu.block)
    if kind.has_terminal:
        add_members(listed, fmu.block)
    _add_structure(root, fmu, kind, all_variables)
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
    derivative = {} if variable.of is None else {"derivative": str(variable.of)}
    attributes = variable_attributes(variable, block) | type_attributes(variable.declaration)
    SubElement(listed, TYPES[type(variable.declaration)], attributes | start(variable) | nominal(variable) | derivative)


def _add_structure(root: Element, fmu: Fmu, kind: BuildKind, all_variables: tuple[Variable, ...]) -> None:
    block = fmu.block
    references = {v.name: v.reference for v in all_variables} | members(block)
    structure = SubElement(root, "ModelStructure")
    for section, unknowns in (
        _of_states(block) if isinstance(block, ContinuousBlock) else _of_samples(fmu, kind)
    ).items():
        for unknown, on in unknowns.items():
            reference = {"valueReference": str(references[unknown])}
            SubElement(structure, section, reference | dependencies(on, references))


def _of_states(block: ContinuousBlock) -> dict[str, Dependencies]:
    on = exchanged_dependencies(block)
    return {
        "Output": on.outputs,
        "ContinuousStateDerivative": on.rates,
        "InitialUnknown": initial_dependencies(block) | initial_state_dependencies(block),
        "EventIndicator": on.indicators,
    }


def _of_samples(fmu: Fmu, kind: BuildKind) -> dict[str, Dependencies]:
    sent = dict.fromkeys(outputs(fmu.block) if kind.has_terminal else (), frozenset[str]())
    # clocks and what is clocked have no initial value
    return {"Output": output_dependencies(fmu.block) | sent, "InitialUnknown": initial_dependencies(fmu.block)}
