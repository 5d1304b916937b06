"""The Python modules that an FMU carries: its model, the slave, and what these import.

They go into one package whose name comes from their content, so that neither another FMU nor a
package of the host's program can be taken for ours. What they import from each other they import from there.
"""

import ast
import hashlib
import sys
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from types import ModuleType

from toolground.imports import name_of, package_of, source_of, syntax_tree

from ..errors import BuildError
from ..fmu import Fmu

CARRIED = ("fmublocks", "toolground")
"""Packages whose modules come along, beside that of the block."""

PACKAGE_TEXT = '''"""The FMU {name}: the block run as a slave of PythonFMU."""

from {pythonfmu}.fmi2slave import Fmi2Slave

from .fmublocks.python.slave import BlockSlave
from .{module} import {block}


class {name}(BlockSlave, Fmi2Slave):
    block = {block}
'''

OTHER_START_VALUES = """
from .fmublocks.block.types import with_start_values

{name}.block = with_start_values({block}, {start_values})
"""

ON_TARGET = """
from pathlib import Path

from .fmublocks.target.remote import OnTarget


class {name}(OnTarget, {name}):
    image = Path(__file__).with_name("{image}")
"""

IMAGE = "controller.elf"
"""Name of the program of the target in the package."""

OWN = "the Python build of a block has the standard library and fmublocks alone, a native one needs neither"
"""What is said of imports that are not carried along."""

SCRIPT_TEXT = '''"""Main script of the FMU {name}; its text is run once for every instance."""

from {package} import {name}
from {package}.fmublocks.python.repairs import own_class, undo_loading

globals()["{name}"] = own_class({name})
undo_loading(globals(), locals())
'''


def bundle(fmu: Fmu) -> dict[str, bytes]:
    """Files of the FMU's package by their paths in it, without the package's own `__init__.py`.

    A module's data, a file of its name beside it, comes along. Packages from which nothing is imported are empty.

    Raises:
        BuildError: what the block imports is neither of the standard library nor carried along.
    """
    roots = {fmu.module.partition(".")[0], *CARRIED}
    files = {IMAGE: fmu.image} if fmu.image else {}
    waiting = {"fmublocks.python.slave", fmu.module} | ({"fmublocks.target.remote"} if fmu.image else set[str]())
    known = set[str]()
    while waiting:
        module = waiting.pop()
        known.add(module)
        path = _file(module)
        content, imported = _carried(module, path, roots)
        place = f"{module.replace('.', '/')}{'/__init__.py' if path.name == '__init__.py' else '.py'}"
        files[place] = content
        for data in path.parent.glob(f"{path.stem}.toml"):
            files[str(Path(place).with_suffix(".toml").as_posix())] = data.read_bytes()
        waiting |= imported - known
    for place in list(files):
        for folder in list(Path(place).parents)[:-1]:
            files.setdefault(f"{folder.as_posix()}/__init__.py", b"")
    return dict(sorted(files.items()))


def _file(module: str) -> Path:
    """Of a module; that of a user may be in no folder in which modules are looked for."""
    file = getattr(sys.modules.get(module), "__file__", None)
    path = Path(file) if file else source_of(module)
    if path is None or not path.is_file():
        raise BuildError(f"there is no source of the module {module}, which a Python build carries along")
    return path


def _carried(module: str, path: Path, roots: set[str]) -> tuple[bytes, set[str]]:
    """The source of a module, which imports what is carried along from there, and the names of these modules.

    Raises:
        BuildError: what it imports would have to be installed where the FMU runs.
    """
    source, package = path.read_bytes(), package_of(module, path)
    lines, modules = source.decode().splitlines(keepends=True), set[str]()
    up = "." * (package.count(".") + 2 if package else 1)
    for node in _imports(source):
        bases = [name_of(node, package)] if isinstance(node, ast.ImportFrom) else [alias.name for alias in node.names]
        outer = [base.partition(".")[0] for base in bases]
        if strangers := [root for root in outer if root not in {*roots, *sys.stdlib_module_names}]:
            raise BuildError(f"{path}, line {node.lineno}: {strangers[0]}: {OWN}")
        if outer[0] not in roots:
            continue
        if isinstance(node, ast.Import):
            raise BuildError(f"{path}, line {node.lineno}: write `from {bases[0]} import ...`: {OWN}")
        names = [(_definition(bases[0], alias.name), alias.asname or alias.name) for alias in node.names]
        for (holder, name), _ in names:
            inside = f"{holder}.{name}"
            modules.add(inside if source_of(inside) else holder)
        if not node.level:  # relative names are found in any package as they stand
            statements = (f"from {up}{holder} import {name} as {known_as}" for (holder, name), known_as in names)
            first, last = lines[node.lineno - 1].encode(), lines[(node.end_lineno or 0) - 1].encode()
            ends = first[: node.col_offset].decode(), last[node.end_col_offset :].decode()
            lines[node.lineno - 1 : node.end_lineno] = ["; ".join(statements).join(ends)]
    return "".join(lines).encode(), modules


def _imports(source: bytes) -> list[ast.Import | ast.ImportFrom]:
    """The statements that import, the last first, so that lines can be replaced one after the other."""
    nodes = [node for node in ast.walk(syntax_tree(source)) if isinstance(node, ast.Import | ast.ImportFrom)]
    return sorted(nodes, key=lambda node: node.lineno, reverse=True)


def _definition(base: str, name: str) -> tuple[str, str]:
    """Module that defines what `from base import name` imports, and its name there: a package may take it from another
    when it is asked for."""
    if source_of(f"{base}.{name}"):
        return base, name
    module = import_module(base)
    value = getattr(module, name)
    if isinstance(value, ModuleType):
        holder, _, name = value.__name__.rpartition(".")
        return holder, name
    return (base, name) if name in vars(module) else (value.__module__, value.__name__)


def package_name(fmu: Fmu, files: Mapping[str, bytes]) -> str:
    """Name of the package, unique to the content of its files."""
    digest = hashlib.sha256(package_text(fmu, ""))
    for path, content in sorted(files.items()):
        digest.update(f"\0{path}\0{len(content)}\0".encode() + content)
    return f"fmublocks_{fmu.module.rpartition('.')[2]}_{digest.hexdigest()[:16]}"


def package_text(fmu: Fmu, pythonfmu: str) -> bytes:
    """`__init__.py` of the package, which takes its base class from the package `pythonfmu`."""
    text = PACKAGE_TEXT + (OTHER_START_VALUES if fmu.start_values else "") + (ON_TARGET if fmu.image else "")
    about = {"name": fmu.name, "module": fmu.module, "start_values": dict(fmu.start_values), "image": IMAGE}
    return text.format(pythonfmu=pythonfmu, block=_name_of_block(fmu), **about).encode()


def _name_of_block(fmu: Fmu) -> str:
    """What its module calls the block.

    Raises:
        BuildError: nothing there is the block.
    """
    for name, value in vars(sys.modules[fmu.module]).items():
        if isinstance(value, type(fmu.block)) and value.name == fmu.name:
            return name
    raise BuildError(f"the module {fmu.module} has no block {fmu.name}, which a Python build imports from there")


def script_text(fmu: Fmu, package: str) -> bytes:
    return SCRIPT_TEXT.format(name=fmu.name, package=package).encode()
