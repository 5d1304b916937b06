"""The terminal of an FMU of FMI 3.0 that sends frames over a CAN bus (FMI-LS-BUS 1.0, network abstraction)."""

from xml.etree.ElementTree import Element, SubElement, register_namespace

from ..block.types import Block
from .elements import written
from .states import shown_by_fmi3

TERMINAL = "Powertrain"
"""Its name, and that of the database of the bus."""

MEMBERS = ("Tx_Data", "Tx_Clock", "Rx_Data", "Rx_Clock")
"""Of a terminal, in the order of their value references."""

OPERATIONS_SIZE = 2048
"""In bytes, most that the operations of one communication step take."""

BAUD_RATE = 500_000
"""In bit/s, told to a simulation of the bus."""

STANDARD = "org.fmi-standard.fmi-ls-bus"
FOLDER = f"extra/{STANDARD}"
MIME_TYPE = f'application/{STANDARD}.can; version="1.0.0"'
NAMESPACE = "http://fmi-standard.org/fmi-ls-manifest"

MANIFEST = {
    "name": STANDARD,
    "version": "1.0.0",
    "description": "Layered Standard for the simulation of bus communication on a Physical Signal Abstraction or "
    "Network Abstraction based level.",
}


def members(block: Block) -> dict[str, int]:
    """The names and value references of its members, which come behind those of all other variables."""
    first = shown_by_fmi3(block)[-1].reference + 1
    return {f"{TERMINAL}.{member}": reference for reference, member in enumerate(MEMBERS, first)}


def outputs(block: Block) -> list[str]:
    """The names of those members that are outputs."""
    return list(members(block))[:2]


def add_members(listed: Element, block: Block) -> None:
    """The variables of the terminal, each binary one with its clock."""
    for name, reference in members(block).items():
        sends = "Tx" in name
        attributes = {
            "name": name,
            "valueReference": str(reference),
            "causality": "output" if sends else "input",
            "variability": "discrete",
        }
        if name.endswith("Clock"):
            meaning = "there is something to be sent" if sends else "something has come in"
            kind = {"description": meaning, "intervalVariability": "triggered"}
            SubElement(listed, "Clock", attributes | kind)
            continue
        kind = {
            "description": f"operations {'to' if sends else 'from'} the bus",
            "clocks": str(reference + 1),
            "initial": "calculated" if sends else "exact",
            "mimeType": MIME_TYPE,
            "maxSize": str(OPERATIONS_SIZE),
        }
        variable = SubElement(listed, "Binary", attributes | kind)
        if not sends:
            SubElement(variable, "Start", value="")


def terminal_files(block: Block, database: bytes) -> dict[str, bytes]:
    """The description of the terminal, the manifest of the standard and the database, by their names in the FMU.

    Args:
        database: DBC of the bus.
    """
    return {
        "terminalsAndIcons/terminalsAndIcons.xml": _terminals(block),
        f"{FOLDER}/fmi-ls-manifest.xml": _manifest(),
        f"{FOLDER}/{TERMINAL}.dbc": database,
    }


def _terminals(block: Block) -> bytes:
    root = Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    terminal = SubElement(
        SubElement(root, "Terminals"),
        "Terminal",
        name=TERMINAL,
        matchingRule="org.fmi-ls-bus.transceiver",
        terminalKind="org.fmi-ls-bus.network-terminal",
        description="CAN bus",
    )
    for name, member in zip(members(block), MEMBERS, strict=True):
        SubElement(terminal, "TerminalMemberVariable", variableName=name, memberName=member, variableKind="signal")
    return written(root)


def _manifest() -> bytes:
    register_namespace("fmi-ls", NAMESPACE)
    attributes = {f"{{{NAMESPACE}}}fmi-ls-{name}": text for name, text in MANIFEST.items()}
    return written(Element("fmiLayeredStandardManifest", attributes | {"isBusSimulationFMU": "false"}))
