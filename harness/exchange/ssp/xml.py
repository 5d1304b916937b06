"""Elements of SSP documents, by names with the prefixes of the standard, which some tools look for as they stand."""

from collections.abc import Iterable, Mapping
from xml.etree import ElementTree

NAMESPACES = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
    "osp": "http://opensimulationplatform.com/SSP/OSPAnnotations",
    "oms": "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd",
}

for prefix, uri in NAMESPACES.items():
    ElementTree.register_namespace(prefix, uri)

Element = ElementTree.Element


def element(name: str, attributes: Mapping[str, object] | None = None, children: Iterable[Element] = ()) -> Element:
    """An element such as `ssd:System`; numbers are written so that they are read back the same."""
    node = Element(_qualified(name), {key: _text(value) for key, value in (attributes or {}).items()})
    node.extend(children)
    return node


def document(root: Element) -> bytes:
    """The file of a root element."""
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def _qualified(name: str) -> str:
    prefix, _, local = name.partition(":")
    return f"{{{NAMESPACES[prefix]}}}{local}"


def _text(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value) if isinstance(value, float) else str(value)
