"""modelDescription.xml and buildDescription.xml of an FMU of FMI 3.0, written from the declarations of its block."""

from collections.abc import Iterable
from xml.etree.ElementTree import Element, SubElement

from ...models.block.declaration import Boolean, Declaration, Enumeration, Integer, Real
from ...models.block.types import SampledBlock
from ..fmu import Fmu
from ..release import ABOUT, date, tool
from .build_kind import BuildKind
from .dependencies import initial_dependencies, output_dependencies
from .elements import add_categories, add_experiment, add_units, check_names, limits, text, written
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


def model_description_3(fmu: Fmu, kind: BuildKind, token: str) -> bytes:
    """The XML with that instantiation token.

    Raises:
        ValueError: two variables have one name, or names that differ in case only.
    """
    all_variables = interface(fmu.block) + time_and_rates(fmu.block)
    check_names(all_variables)
    root = Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName=fmu.name,
        instantiationToken=token,
        description=fmu.block.description,
        generationTool=tool(kind.tool),
        generationDateAndTime=f"{date():%Y-%m-%dT%H:%M:%SZ}",
        variableNamingConvention="flat",
    )
    root.attrib.update(ABOUT if fmu.is_of_the_project else {})
    SubElement(root, "CoSimulation", {"modelIdentifier": fmu.name} | CAPABILITIES | kind.capabilities)
    add_units(root, all_variables)
    _add_enumerations(root, all_variables)
    add_categories(root, kind)
    add_experiment(root, fmu)
    listed = SubElement(root, "ModelVariables")
    for variable in all_variables:
        _add_variable(listed, variable, fmu)
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


def _add_enumerations(root: Element, all_variables: Iterable[Variable]) -> None:
    used = {v.declaration.name: v.declaration for v in all_variables if isinstance(v.declaration, Enumeration)}
    definitions = SubElement(root, "TypeDefinitions") if used else root
    for name, declaration in used.items():
        items = SubElement(definitions, "EnumerationType", name=name)
        for value, (item, meaning) in enumerate(declaration.items, start=1):
            SubElement(items, "Item", name=item, value=str(value), description=meaning)


def _add_variable(listed: Element, variable: Variable, fmu: Fmu) -> None:
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
        sampled_output = variable.causality == "output" and isinstance(fmu.block, SampledBlock)
        discrete = not isinstance(declaration, Real) or sampled_output
        attributes["variability"] = "discrete" if discrete else "continuous"
        if variable.causality == "output":
            attributes["initial"] = "calculated"
    tag, of_type = _type(declaration)
    attributes |= of_type
    if variable.start is not None:
        attributes["start"] = text(variable.start)
    if variable.causality in ("input", "output") and variable.nominal is not None:
        attributes["nominal"] = text(variable.nominal)
    if (rate_of_input := rate_of(variable, fmu.block)) is not None:
        attributes["derivative"] = str(rate_of_input)
    SubElement(listed, tag, attributes)


def _type(declaration: Declaration) -> tuple[str, dict[str, str]]:
    """XML element of a type and its attributes."""
    match declaration:
        case Boolean():
            return "Boolean", {}
        case Enumeration():
            return "Enumeration", {"declaredType": declaration.name}
        case Integer():
            return "Int32", limits(declaration, Integer(""))
        case Real():
            return "Float64", {"unit": declaration.unit, **limits(declaration, Real("1", ""))}


def _add_structure(root: Element, fmu: Fmu, kind: BuildKind) -> None:
    references = {v.name: v.reference for v in interface(fmu.block)} | members(fmu.block)
    sent = dict.fromkeys(outputs(fmu.block) if kind.has_terminal else (), frozenset[str]())
    clocks = {name: on for name, on in sent.items() if name.endswith("Clock")}  # what is clocked has no initial value
    structure = SubElement(root, "ModelStructure")
    for element, dependencies in (
        ("Output", output_dependencies(fmu.block) | sent),
        ("InitialUnknown", initial_dependencies(fmu.block) | clocks),
    ):
        for output, on in dependencies.items():
            known = sorted(references[name] for name in on)
            SubElement(
                structure,
                element,
                valueReference=str(references[output]),
                dependencies=" ".join(map(str, known)),
                dependenciesKind=" ".join("dependent" for _ in known),
            )
