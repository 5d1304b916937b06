"""What the model descriptions of FMI 2.0 and FMI 3.0 have in common."""

from collections.abc import Iterable
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from ...models.block.declaration import Integer, Real
from ..fmu import Fmu
from .build_kind import BuildKind
from .units import base_exponents
from .variables import Variable


def check_names(all_variables: Iterable[Variable]) -> None:
    """
    Raises:
        ValueError: two variables have one name, or names that differ in case only, which not every tool tells apart.
    """
    known: dict[str, str] = {}
    for variable in all_variables:
        name = variable.name.casefold()
        if name in known:
            how = "differ in case only" if known[name] != variable.name else "have one name"
            raise ValueError(f"the variables {known[name]} and {variable.name} {how}")
        known[name] = variable.name


def text(value: Any) -> str:
    """A number or truth value as XML writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value)


def add_units(root: Element, all_variables: Iterable[Variable]) -> None:
    """The units that the variables have, if there are any."""
    units = sorted({v.declaration.unit for v in all_variables if isinstance(v.declaration, Real)})
    definitions = SubElement(root, "UnitDefinitions") if units else root
    for unit in units:
        exponents = {base: str(exponent) for base, exponent in base_exponents(unit).items()}
        SubElement(SubElement(definitions, "Unit", name=unit), "BaseUnit", exponents)


def add_categories(root: Element, kind: BuildKind) -> None:
    """The categories of messages."""
    categories = SubElement(root, "LogCategories")
    for name, description in kind.log_categories.items():
        SubElement(categories, "Category", {"name": name, "description": description})


def add_experiment(root: Element, fmu: Fmu) -> None:
    """The experiment that a tool proposes."""
    experiment = {"startTime": "0", "stopTime": text(fmu.stop_time), "stepSize": text(fmu.step_size)}
    SubElement(root, "DefaultExperiment", experiment)


def limits(declaration: Integer | Real, unlimited: Integer | Real) -> dict[str, str]:
    """The bounds that say more than those of an unlimited declaration."""
    found: dict[str, str] = {}
    if declaration.minimum != unlimited.minimum:
        found["min"] = text(declaration.minimum)
    if declaration.maximum != unlimited.maximum:
        found["max"] = text(declaration.maximum)
    return found


def written(root: Element) -> bytes:
    """The XML."""
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"
