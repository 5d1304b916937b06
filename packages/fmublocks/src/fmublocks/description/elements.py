"""What the model descriptions of FMI 2.0 and FMI 3.0 have in common."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from ..block.declaration import Boolean, Declaration, Enumeration, Integer, Real
from ..block.types import Block, SampledBlock
from ..fmu import Fmu
from ..release import date, tool
from .build_kind import BuildKind
from .units import base_exponents
from .variables import Variable


def new_root(fmu: Fmu, kind: BuildKind, token: dict[str, str]) -> Element:
    """The root of a model description; `token` is the attribute by which its binaries know it."""
    root = Element("fmiModelDescription", {"fmiVersion": kind.version, "modelName": fmu.name} | token)
    root.attrib |= {
        "description": fmu.block.description,
        "generationTool": tool(kind.tool),
        "generationDateAndTime": f"{date():%Y-%m-%dT%H:%M:%SZ}",
        "variableNamingConvention": "flat",
    }
    root.attrib |= fmu.about
    return root


def check_names(all_variables: Iterable[Variable]) -> None:
    """
    Raises:
        ValueError: two variables have one name, or names that differ in case only, which not every tool tells apart.
    """
    alike: dict[str, list[str]] = {}
    for variable in all_variables:
        alike.setdefault(variable.name.casefold(), []).append(variable.name)
    problems = [
        f"the variables {' and '.join(names)} {'differ in case only' if len({*names}) > 1 else 'have one name'}"
        for names in alike.values()
        if len(names) > 1
    ]
    if problems:
        raise ValueError("; ".join(problems))


def text(value: Any) -> str:
    """A number or truth value as XML writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value)


def add_definitions(
    root: Element,
    fmu: Fmu,
    kind: BuildKind,
    all_variables: Iterable[Variable],
    add_enumeration: Callable[[Element, str], Element],
) -> None:
    """What stands before the variables: units, enumerations, categories of messages, the experiment that is proposed.

    Args:
        add_enumeration: adds the element of an enumeration of that name and returns what has its items.
    """
    _add_units(root, all_variables)
    _add_enumerations(root, all_variables, add_enumeration)
    _add_categories(root, kind)
    _add_experiment(root, fmu)


def _add_units(root: Element, all_variables: Iterable[Variable]) -> None:
    units = sorted({v.declaration.unit for v in all_variables if isinstance(v.declaration, Real)})
    definitions = SubElement(root, "UnitDefinitions") if units else root
    for unit in units:
        exponents = {base: str(exponent) for base, exponent in base_exponents(unit).items()}
        SubElement(SubElement(definitions, "Unit", name=unit), "BaseUnit", exponents)


def _add_enumerations(
    root: Element, all_variables: Iterable[Variable], add_enumeration: Callable[[Element, str], Element]
) -> None:
    used = {v.declaration.name: v.declaration for v in all_variables if isinstance(v.declaration, Enumeration)}
    definitions = SubElement(root, "TypeDefinitions") if used else root
    for name, declaration in used.items():
        items = add_enumeration(definitions, name)
        for value, (item, meaning) in enumerate(declaration.items, start=1):
            SubElement(items, "Item", name=item, value=str(value), description=meaning)


def _add_categories(root: Element, kind: BuildKind) -> None:
    categories = SubElement(root, "LogCategories")
    for name, description in kind.log_categories.items():
        SubElement(categories, "Category", {"name": name, "description": description})


def _add_experiment(root: Element, fmu: Fmu) -> None:
    experiment = {"startTime": "0", "stopTime": text(fmu.stop_time), "stepSize": text(fmu.step_size)}
    SubElement(root, "DefaultExperiment", experiment)


def variable_attributes(variable: Variable, block: Block) -> dict[str, str]:
    """What a variable of any type has: name, number, meaning, causality, and when its value is known and changes."""
    attributes = {
        "name": variable.name,
        "valueReference": str(variable.reference),
        "description": variable.declaration.description,
        "causality": variable.causality,
    }
    if variable.causality == "parameter":
        return attributes | {"variability": variable.variability, "initial": "exact"}
    # what feeds a sampled block may change at any time; what leaves it may not
    sampled = isinstance(block, SampledBlock) and variable.causality == "output"
    discrete = sampled or not isinstance(variable.declaration, Real)
    attributes["variability"] = "discrete" if discrete else "continuous"
    return attributes | ({"initial": "calculated"} if variable.causality in ("output", "local") else {})


def type_attributes(declaration: Declaration) -> dict[str, str]:
    """What the values of a type can be."""
    match declaration:
        case Boolean():
            return {}
        case Enumeration():
            return {"declaredType": declaration.name}
        case Integer():
            return limits(declaration, Integer(""))
        case Real():
            return {"unit": declaration.unit, **limits(declaration, Real("1", ""))}


def start(variable: Variable) -> dict[str, str]:
    """The start value of what has one."""
    return {} if variable.start is None else {"start": text(variable.start)}


def nominal(variable: Variable) -> dict[str, str]:
    """How large a variable typically is; parameters have their values."""
    told = variable.causality != "parameter" and variable.nominal is not None
    return {"nominal": text(variable.nominal)} if told else {}


def dependencies(on: Iterable[str], numbers: Mapping[str, int]) -> dict[str, str]:
    """On which variables an unknown depends, by their numbers in the order of these."""
    known = [str(number) for number in sorted(numbers[name] for name in on)]
    return {"dependencies": " ".join(known), "dependenciesKind": " ".join("dependent" for _ in known)}


def limits(declaration: Integer | Real, unlimited: Integer | Real) -> dict[str, str]:
    """The bounds that say more than those of an unlimited declaration."""
    attributes: dict[str, str] = {}
    if declaration.minimum != unlimited.minimum:
        attributes["min"] = text(declaration.minimum)
    if declaration.maximum != unlimited.maximum:
        attributes["max"] = text(declaration.maximum)
    return attributes


def written(root: Element) -> bytes:
    """The XML."""
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"
