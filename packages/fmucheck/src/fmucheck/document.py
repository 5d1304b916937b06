"""The model description of an FMU as it stands there, alike for FMI 2.0 and 3.0."""

from collections.abc import Mapping
from functools import cached_property, lru_cache
from math import prod
from typing import NamedTuple
from xml.etree.ElementTree import Element

from fmpy.model_description import ModelVariable

from fmuloop.description import document_root
from fmuloop.interface import Interface

SECTIONS = {
    2: {name: f"ModelStructure/{name}/Unknown" for name in ("Outputs", "Derivatives", "InitialUnknowns")},
    3: {
        "Outputs": "ModelStructure/Output",
        "Derivatives": "ModelStructure/ContinuousStateDerivative",
        "InitialUnknowns": "ModelStructure/InitialUnknown",
        "ClockedStates": "ModelStructure/ClockedState",
        "EventIndicators": "ModelStructure/EventIndicator",
    },
}
"""Where unknowns are listed, by FMI."""

REALS = ("Real", "Float32", "Float64")

DOUBLES = ("Real", "Float64")

CALLED_IN_FMI2 = {
    "canGetAndSetFMUState": "canGetAndSetFMUstate",
    "canSerializeFMUState": "canSerializeFMUstate",
    "providesDirectionalDerivatives": "providesDirectionalDerivative",
}
"""Capabilities by the names that they have in FMI 3.0."""

TYPES_OF_FMI2 = ("Real", "Integer", "Boolean", "String", "Enumeration")

TRUE = ("true", "1")


class Declared(NamedTuple):
    """A variable.

    Attributes:
        key: by which ModelStructure refers to it.
        type: as the standard calls it, of an element.
        attributes: of its element, in FMI 2.0 those of its type too.
        model: what fmpy made of it, with what is true by default.
    """

    key: str
    name: str
    type: str
    attributes: Mapping[str, str]
    element: Element
    model: ModelVariable

    @property
    def is_scalar(self) -> bool:
        return self.element.find("Dimension") is None


class Unknown(NamedTuple):
    """An entry of ModelStructure: what it depends on, by keys (None: it is not said, so it may be everything)."""

    key: str
    dependencies: list[str] | None
    kinds: list[str]


class Document:
    """The description.

    Attributes:
        variables: by key.
        types: attributes of declared types by name, in FMI 2.0 those of the element within.
    """

    def __init__(self, interface: Interface) -> None:
        self.root = document_root(interface.path, interface.limits)
        self.fmi = interface.fmi
        listed = self.root.findall("ModelVariables/*")
        self.variables: dict[str, Declared] = {}
        for position, element in enumerate(listed, start=1):
            kind = element if self.fmi == 3 else next(child for child in element if child.tag in TYPES_OF_FMI2)
            key = element.get("valueReference", "") if self.fmi == 3 else str(position)
            attributes = element.attrib | kind.attrib
            name = attributes["name"]
            self.variables[key] = Declared(key, name, kind.tag, attributes, element, interface.variables[name])

    @cached_property
    def types(self) -> dict[str | None, Element]:
        """The elements with the attributes of declared types, by name."""
        return {
            declared.get("name"): declared[0] if self.fmi == 2 and len(declared) else declared
            for declared in self.root.iterfind("TypeDefinitions/*")
        }

    def claims(self, capability: str, *kinds: str) -> bool:
        """Whether it claims a capability, by its name in FMI 3.0, for one of these kinds; none given: for any."""
        return any(kind.get(self.called(capability)) in TRUE for kind in self.root if not kinds or kind.tag in kinds)

    def called(self, capability: str) -> str:
        """What a capability of FMI 3.0 is called in this version."""
        return CALLED_IN_FMI2.get(capability, capability) if self.fmi == 2 else capability

    def unknowns(self, section: str) -> list[Unknown]:
        """Those of a section, of SECTIONS."""
        key = "index" if self.fmi == 2 else "valueReference"
        where = SECTIONS[self.fmi].get(section)
        return [_unknown(element, key) for element in self.root.iterfind(where)] if where else []

    @cached_property
    def states(self) -> dict[str, str]:
        """Keys of the states by those of their derivatives, in the order in which the FMU has them."""
        rates = [self.variables[unknown.key] for unknown in self.unknowns("Derivatives")]
        return {rate.key: rate.attributes["derivative"] for rate in rates if "derivative" in rate.attributes}

    def sizes(self, variable: Declared) -> list[int]:
        """The sizes of its dimensions at the start; of a scalar none."""
        return [
            int(size.get("start") or self.variables[size.get("valueReference", "")].attributes["start"])
            for size in variable.element.iterfind("Dimension")
        ]

    def size(self, variable: Declared) -> int:
        """How many values it has at the start."""
        return prod(self.sizes(variable))

    def starts(self, variable: Declared) -> list[str]:
        """Its start values, one for each element."""
        if self.fmi == 3 and variable.type in ("String", "Binary"):
            starts = [start.get("value", "") for start in variable.element.iterfind("Start")]
        else:
            written = variable.attributes.get("start")
            starts = [] if written is None else written.split() if self.fmi == 3 else [written]
        return starts * self.size(variable) if len(starts) == 1 else starts


def _unknown(element: Element, key: str) -> Unknown:
    on = element.get("dependencies")
    return Unknown(
        element.get(key, ""), None if on is None else on.split(), element.get("dependenciesKind", "").split()
    )


@lru_cache(2)
def document(interface: Interface) -> Document:
    """That of an FMU; many rules look at one."""
    return Document(interface)


def accessor(fmi: int, kind: str) -> str:
    """How calls name the type of a variable."""
    return {2: "Integer", 3: "Int64"}[fmi] if kind == "Enumeration" else kind
