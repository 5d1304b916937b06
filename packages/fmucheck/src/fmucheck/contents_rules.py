"""Rules for what an FMU has beside its model description: sources, terminals and icons, layered standards."""

from collections import Counter
from collections.abc import Callable, Iterator
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import NamedTuple
from zipfile import ZipFile

import fmpy
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]

from fmuloop.interface import Interface
from toolground.plain_text import plain

from .archive_rules import EXTENSIONS
from .document import document
from .rule import Clause, Rules, Severity

SCHEMAS = Path(fmpy.__file__).parent / "schema" / "fmi3"

TERMINALS = "terminalsAndIcons/terminalsAndIcons.xml"

MANIFEST = "fmi-ls-manifest.xml"

NAMESPACE = "{http://fmi-standard.org/fmi-ls-manifest}"

CONTENTS_RULES = Rules()


@lru_cache(2)
def _names(path: Path) -> frozenset[str]:
    with ZipFile(path) as archive:
        return frozenset(archive.namelist())


def _parsed(interface: Interface, name: str) -> "etree._Element | str":
    """The root of an XML file in the archive, or why there is none."""
    parser = etree.XMLParser(resolve_entities=False, no_network=True)
    try:
        with ZipFile(interface.path) as archive:
            return etree.fromstring(archive.read(name), parser)
    except Exception as error:  # whatever strange bytes lead to
        return f"{name} cannot be read: {plain(error)}"


@CONTENTS_RULES.rule(
    "sources",
    Severity.ERROR,
    "sources that it lists are there",
    Clause("2.3, 3.3.1, 4.3.1", "2.5.1.3"),
)
def sources(interface: Interface) -> Iterator[str]:
    """Files that the description names, in FMI 3.0 buildDescription.xml, and the archive lacks."""
    names, built = _names(interface.path), "sources/buildDescription.xml"
    if interface.fmi == 2:
        listed = [file.get("name", "") for file in document(interface).root.iterfind(".//SourceFiles/File")]
    elif built in names:
        root = _parsed(interface, built)
        if isinstance(root, str):
            yield root
            return
        listed = [file.get("name", "") for file in root.iterfind(".//SourceFile")]
    else:
        listed = []
        if not any(name.startswith("binaries/") for name in names):
            yield f"it has no binaries, and no {built}"
    for name in dict.fromkeys(listed):
        if f"sources/{name}" not in names:
            yield f"sources/{name} is named, and is not there"


@CONTENTS_RULES.rule(
    "binary-folder", Severity.ERROR, "binaries are where their version of FMI has them", Clause("2.3", "2.5.1.4")
)
def binary_folder(interface: Interface) -> Iterator[str]:
    """Those that stand where the other version has them, which hosts other than ours do not find, and folders with
    libraries of which none has the name of the FMU."""
    folder, other = fmpy.platform, fmpy.platform_tuple
    if interface.fmi == 3:
        folder, other = other, folder
    names = [PurePosixPath(name) for name in _names(interface.path)]
    libraries = [
        name for name in names if name.suffix in EXTENSIONS and name.parent.parent == PurePosixPath("binaries")
    ]
    kinds = document(interface).root.iterfind("*[@modelIdentifier]")
    for identifier in dict.fromkeys(kind.get("modelIdentifier", "") for kind in kinds):
        file = f"{identifier}{fmpy.sharedLibraryExtension}"
        misplaced = PurePosixPath("binaries", other, file)
        if PurePosixPath("binaries", folder, file) not in libraries and misplaced in libraries:
            yield f"{misplaced} should be in binaries/{folder}"
        for place, suffix in sorted({(library.parent, library.suffix) for library in libraries}):
            there = [library.stem for library in libraries if (library.parent, library.suffix) == (place, suffix)]
            if identifier not in there and not (suffix == ".dll" and identifier.lower() in map(str.lower, there)):
                yield f"{place} has no {identifier}{suffix}"


@CONTENTS_RULES.rule(
    "terminals", Severity.ERROR, "terminals and icons are valid, and name what there is", Clause(fmi3="2.4.9"),
)  # fmt: skip
def terminals(interface: Interface) -> Iterator[str]:
    """What is wrong in terminalsAndIcons.xml, and pictures that are missing."""
    names = _names(interface.path)
    if "terminalsAndIcons/icon.svg" in names and "terminalsAndIcons/icon.png" not in names:
        yield "there is terminalsAndIcons/icon.svg without icon.png"
    if TERMINALS not in names:
        return
    root = _parsed(interface, TERMINALS)
    if isinstance(root, str):
        yield root
        return
    schema = etree.XMLSchema(etree.parse(SCHEMAS / "fmi3TerminalsAndIcons.xsd"))
    if not schema.validate(root):
        yield from (f"{TERMINALS}, line {entry.line}: {plain(entry.message)}" for entry in schema.error_log)
        return
    for holder in root.iter("Terminals", "Terminal"):
        for name, count in Counter(terminal.get("name") for terminal in holder.iterfind("Terminal")).items():
            if count > 1:
                yield f"{count} terminals are called {name}"
    for terminal in root.iter("Terminal"):
        yield from _of_terminal(terminal, interface, names)


def _of_terminal(terminal: "etree._Element", interface: Interface, names: frozenset[str]) -> Iterator[str]:
    called = plain(terminal.get("name"))
    members = terminal.findall("TerminalMemberVariable")
    for member in members:
        if member.get("variableName") not in interface.variables:
            yield f"terminal {called} names {plain(member.get('variableName'))}, which is no variable"
    if terminal.get("matchingRule") in ("plug", "bus"):
        counted = Counter(member.get("memberName") for member in members)
        if None in counted:
            yield f"a member of terminal {called} has no memberName, by which {terminal.get('matchingRule')} matches"
        for name, count in counted.items():
            if count > 1 and name is not None:
                yield f"{count} members of terminal {called} are called {name}"
    for picture in terminal.iterfind("TerminalGraphicalRepresentation"):
        file = f"terminalsAndIcons/{picture.get('iconBaseName')}.png"
        if file not in names:
            yield f"terminal {called} is shown by {file}, which is not there"


class Layered(NamedTuple):
    """What a manifest is asked.

    Attributes:
        folder: in the archive.
    """

    interface: Interface
    folder: str
    root: "etree._Element"


def _xcp(layered: Layered) -> Iterator[str]:
    for interface in layered.root.iterfind("Interface"):
        file = f"{layered.folder}/{interface.get('definition')}"
        if file not in _names(layered.interface.path):
            yield f"{file} is named, and is not there"
            continue
        with ZipFile(layered.interface.path) as archive:
            if b"/begin PROJECT" not in archive.read(file):
                yield f"{file} is no A2L file: it has no PROJECT"


def _bus(layered: Layered) -> Iterator[str]:
    root = None if TERMINALS not in _names(layered.interface.path) else _parsed(layered.interface, TERMINALS)
    kinds = (
        set() if root is None or isinstance(root, str) else {part.get("terminalKind") for part in root.iter("Terminal")}
    )
    if "org.fmi-ls-bus.network-terminal" not in kinds and layered.root.get("isBusSimulationFMU") not in ("true", "1"):
        yield "it is of FMI-LS-BUS, but has no network terminal"


LAYERED: dict[str, Callable[[Layered], Iterator[str]]] = {
    "org.fmi-standard.fmi-ls-xcp": _xcp,
    "org.fmi-standard.fmi-ls-bus": _bus,
}
"""Layered standards that are known."""


@CONTENTS_RULES.rule(
    "layered-standards", Severity.ERROR, "layered standards have a manifest that is true", Clause(fmi3="2.6.3")
)
def layered_standards(interface: Interface) -> Iterator[str]:
    """Manifests that cannot be read, lack a name or a version, or whose standard is not kept."""
    for place in sorted(name for name in _names(interface.path) if PurePosixPath(name).match(f"extra/*/{MANIFEST}")):
        root = _parsed(interface, place)
        if isinstance(root, str):
            yield root
            continue
        for attribute in ("fmi-ls-name", "fmi-ls-version"):
            if root.get(NAMESPACE + attribute) is None:
                yield f"{place} has no {attribute}"
        folder = PurePosixPath(place).parent
        name = root.get(NAMESPACE + "fmi-ls-name", folder.name)
        if name != folder.name:
            yield f"{place} is of {plain(name)}, and stands in the folder of another"
        if known := LAYERED.get(name):
            yield from known(Layered(interface, str(folder), root))
