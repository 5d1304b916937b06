"""What lets a calibration tool into a native FMU: the layered standard FMI-LS-XCP 1.0.0, for FMI 2.0 and 3.0.

The FMU brings no XCP service of its own. It allows direct access to its memory: an A2L description has the addresses of
the first instance in the binary, relative to its base. https://github.com/modelica/fmi-ls-xcp
"""

import re
import struct
from collections.abc import Iterator, Mapping
from pathlib import PurePosixPath
from typing import Any
from xml.etree.ElementTree import Element, SubElement, register_namespace

from ..block.declaration import Declaration, Real, is_tuple, variables
from ..description import a2l
from ..description.elements import written
from ..description.numbers import numbers
from ..description.variables import Variable, interface
from ..fmu import Fmu
from .compiler import WHERE_HEADER
from .records import records_of
from .terms import TERMS

FOLDER = "extra/org.fmi-standard.fmi-ls-xcp"

NAMESPACE = "http://fmi-standard.org/fmi-ls-manifest"

ABOUT = {
    "name": "org.fmi-standard.fmi-ls-xcp",
    "version": "1.0.0",
    "description": "Layered standard based on FMI 2.0 and FMI 3.0 for describing and implementing XCP support for "
    "FMUs, which can either provide an XCP service or allow direct memory access via A2L files.",
}
"""Attributes of the manifest, as the standard has them."""

PAGE = """\
Measurement and calibration of {name} by XCP (FMI-LS-XCP 1.0.0)

The FMU brings no XCP service. The tool that runs it reads and writes the memory of the instance:
{folder}/<platform>/{name}.a2l has the addresses, relative to the base address of the
binary, and {folder}/{name}.a2l has symbol links for binaries that are
built from the sources, or have no addresses here.

- The addresses are those of the first instance in a process. Instantiate it once.
- All values are doubles. Inputs, outputs and states are measured between steps.
- Parameters are written between steps. The next step takes tunable ones over; a fixed one, or a value that is
  out of bounds, is put back with a message to the logger. Before initialization mode is left all can be written.
- Co-simulation only.
"""

PROTOCOL = """\
    /begin IF_DATA XCP
      /begin PROTOCOL_LAYER
        0x0104 1000 1000 0 0 0 0 0 252 1468 BYTE_ORDER_MSB_LAST ADDRESS_GRANULARITY_BYTE
      /end PROTOCOL_LAYER
      /begin XCP_ON_TCP_IP
        0x0104 5555 ADDRESS "127.0.0.1"
      /end XCP_ON_TCP_IP
    /end IF_DATA"""
"""Of the service that the importer starts, which puts its own address and port there."""

ELF, PE, DYNAMIC_SYMBOLS = b"\x7fELF\x02\x01", b"MZ", 11


def xcp_entries(fmu: Fmu, header: str, binaries: Mapping[str, bytes]) -> dict[str, bytes]:
    """Manifest, A2L descriptions and page by their names in the FMU.

    Args:
        header: block.h.
        binaries: by their paths in the FMU.
    """
    behind = re.search(rf"\b{TERMS}\[(\d+)\];", header)
    terms, file = int(behind[1]) if behind else 0, f"{fmu.name}.a2l"
    symbol = f"{fmu.name}_instance"
    entries = {f"{FOLDER}/fmi-ls-manifest.xml": _manifest(fmu, file)}
    entries[f"{FOLDER}/{file}"] = _a2l(fmu, terms, symbol, 0)
    for path, binary in binaries.items():
        platform, address = PurePosixPath(path).parent.name, address_in(binary, symbol)
        if address is not None:
            entries[f"{FOLDER}/{platform}/{file}"] = _a2l(fmu, terms, symbol, address)
    entries["documentation/fmi-ls-xcp.txt"] = PAGE.format(name=fmu.name, folder=FOLDER).encode()
    return entries


def _manifest(fmu: Fmu, file: str) -> bytes:
    register_namespace("fmi-ls", NAMESPACE)
    root = Element(
        "fmiLayeredStandardManifest", {f"{{{NAMESPACE}}}fmi-ls-{name}": text for name, text in ABOUT.items()}
    )
    what = f"memory of the first instance of {fmu.name}"
    access = {"types": "CoSimulation", "supportsDirectMemoryAccess": "true"}
    SubElement(root, "Interface", {"definition": file, "description": what} | access)
    return written(root)


def _a2l(fmu: Fmu, terms: int, symbol: str, base: int) -> bytes:
    """The description for a binary in which the instance lies at an address; 0: for any, by its symbol alone."""
    items = [
        a2l.Item(variable, base + offset if base else 0, f'"{symbol}" {offset}')
        for variable, offset in places(fmu, terms)
    ]
    return a2l.description(fmu, items, a2l.DOUBLE, PROTOCOL).encode()


def places(fmu: Fmu, terms: int) -> Iterator[tuple[Variable, int]]:
    """Each variable and where in the memory of an instance (Memory of instance.h) it lies, in bytes.

    Inputs, outputs and parameters with their terms come first, then the rates of the inputs, one number more, and the
    state, of which buffers are left out. A record without numbers has one in C.

    Args:
        terms: how many numbers stand behind the parameters.
    """
    listed, records = interface(fmu.block), records_of(fmu.block)
    sizes = {letter: max(len(list(numbers("", record))), 1) for letter, record in records.items()}
    begin = {"input": 0, "output": sizes["u"], "parameter": sizes["u"] + sizes["y"]}
    for causality, first in begin.items():
        members = [v for v in listed if v.causality == causality]
        yield from ((variable, 8 * (first + k)) for k, variable in enumerate(members))
    first = begin["parameter"] + sizes["p"] + terms + sizes["u"] + 1
    for k, (path, declaration) in enumerate(_states("x", records["x"])):
        if "[" not in path:
            yield Variable(len(listed) + k, path, "local", declaration, None), 8 * (first + k)


def _states(name: str, value: Any, declaration: Declaration | None = None) -> Iterator[tuple[str, Declaration]]:
    """The numbers of a state, as `numbers` names them, with what they are declared to be."""
    if not is_tuple(value):
        yield name, declaration or Real("1", "part of the state")
    elif fields := getattr(value, "_fields", ()):
        declared = {v.name: v.declaration for v in variables(type(value))}
        for field, item in zip(fields, value, strict=True):
            yield from _states(f"{name}.{field}", item, declared.get(field))
    else:
        for k, item in enumerate(value):
            yield from _states(f"{name}[{k}]", item, declaration)


def address_in(binary: bytes, symbol: str) -> int | None:
    """Where a symbol that a shared library of 64 bits exports lies, relative to its base; None: it is not known of
    libraries other than those for Linux and Windows.

    Raises:
        KeyError: there is none of that name.
    """
    if binary.startswith(ELF):
        return dict(_exported_by_elf(binary))[symbol]
    return dict(_exported_by_pe(binary))[symbol] if binary.startswith(PE) else None


def _name(binary: bytes, at: int) -> str:
    return binary[at : binary.index(b"\0", at)].decode()


def _exported_by_elf(binary: bytes) -> Iterator[tuple[str, int]]:
    """Names and addresses by the dynamic symbol table of a library for Linux."""
    (sections,) = struct.unpack_from("<Q", binary, 0x28)
    size, count = struct.unpack_from("<2H", binary, 0x3A)
    headers = [struct.unpack_from("<2I4Q2I2Q", binary, sections + size * k) for k in range(count)]
    table = next(header for header in headers if header[1] == DYNAMIC_SYMBOLS)
    names = headers[table[6]][4]
    for at in range(table[4], table[4] + table[5], table[9]):
        name, _, _, _, value, _ = struct.unpack_from("<IBBHQQ", binary, at)
        yield _name(binary, names + name), value


def _exported_by_pe(binary: bytes) -> Iterator[tuple[str, int]]:
    """Names and addresses by the export directory of a library for Windows."""
    (header,) = struct.unpack_from("<I", binary, WHERE_HEADER)
    count, size = struct.unpack_from("<H12xH", binary, header + 6)
    sections = [struct.unpack_from("<8x4I", binary, header + 24 + size + 40 * k) for k in range(count)]

    def place(address: int) -> int:
        """In the file."""
        return next(raw + address - first for _, first, length, raw in sections if first <= address < first + length)

    (directory,) = struct.unpack_from("<I", binary, header + 24 + 112)
    number, functions, names, ordinals = struct.unpack_from("<4I", binary, place(directory) + 24)
    for k in range(number):
        (name,) = struct.unpack_from("<I", binary, place(names) + 4 * k)
        (ordinal,) = struct.unpack_from("<H", binary, place(ordinals) + 2 * k)
        yield _name(binary, place(name)), struct.unpack_from("<I", binary, place(functions) + 4 * ordinal)[0]
