"""The Python modules that an FMU carries: its model, the slave, and what these import.

They go into one package whose name comes from their content, so that neither another FMU nor a
`models` package of the host's program can be taken for ours.
"""

import ast
import hashlib
from collections.abc import Iterator
from importlib.util import resolve_name
from pathlib import Path

from ..fmu import PACKAGE, Fmu
from ..source_code import syntax_tree

PACKAGE_TEXT = '''"""The FMU {name}: the block run as a slave of PythonFMU."""

from {pythonfmu}.fmi2slave import Fmi2Slave

from .fmus.python.slave import BlockSlave
from .{module} import BLOCK


class {name}(BlockSlave, Fmi2Slave):
    block = BLOCK
'''

OTHER_START_VALUES = """
from .models.block.types import with_start_values

{name}.block = with_start_values(BLOCK, {start_values})
"""

ON_TARGET = """
from pathlib import Path

from .fmus.target.remote import OnTarget


class {name}(OnTarget, {name}):
    image = Path(__file__).with_name("{image}")
"""

IMAGE = "controller.elf"
"""Name of the program of the target in the package."""

SCRIPT_TEXT = '''"""Main script of the FMU {name}; its text is run once for every instance."""

from {package} import {name}
from {package}.fmus.python.repairs import own_class, undo_loading

globals()["{name}"] = own_class({name})
undo_loading(globals(), locals())
'''


def bundle(fmu: Fmu) -> dict[str, bytes]:
    """Files of the FMU's package by their paths in it, without the package's own `__init__.py`.

    A module's data, a file of its name beside it, comes along.
    """
    modules: set[str] = set()
    waiting = {"fmus.python.slave", fmu.module} | ({"fmus.target.remote"} if fmu.image else set[str]())
    while waiting:
        module = waiting.pop()
        modules.add(module)
        waiting |= {*imported(module), *packages_of(module)} - modules
    files = {IMAGE: fmu.image} if fmu.image else {}
    for module in modules:
        path = source_path(module)
        files[_place(path)] = path.read_bytes()
        files |= {_place(data): data.read_bytes() for data in path.parent.glob(f"{path.stem}.toml")}
    return dict(sorted(files.items()))


def _root() -> Path:
    """Folder that holds the packages `models` and `fmus`."""
    return Path(__file__).parents[2]


def _place(path: Path) -> str:
    """Path of a file in the FMU's package."""
    return path.relative_to(_root()).as_posix()


def source_path(module: str) -> Path:
    """File of a module or package of ours."""
    path = _root().joinpath(*module.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def imported(module: str) -> Iterator[str]:
    """Names of our own modules that a module imports: by relative imports, so that they are found in any package."""
    package = module if source_path(module).name == "__init__.py" else module.rpartition(".")[0]
    for node in ast.walk(syntax_tree(source_path(module).read_bytes())):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = resolve_name("." * node.level + (node.module or ""), PACKAGE + package).removeprefix(PACKAGE)
            names = [base, *(f"{base}.{alias.name}" for alias in node.names)]
            yield from (name for name in names if source_path(name).is_file())


def packages_of(module: str) -> Iterator[str]:
    """The packages that a module lies in, the outermost last."""
    while module := module.rpartition(".")[0]:
        yield module


def package_name(fmu: Fmu, files: dict[str, bytes]) -> str:
    """Name of the package, unique to the content of its files."""
    digest = hashlib.sha256(package_text(fmu, ""))
    for path, content in sorted(files.items()):
        digest.update(f"\0{path}\0{len(content)}\0".encode() + content)
    return f"driveline_{fmu.module.rpartition('.')[2]}_{digest.hexdigest()[:16]}"


def package_text(fmu: Fmu, pythonfmu: str) -> bytes:
    """`__init__.py` of the package, which takes its base class from the package `pythonfmu`."""
    text = PACKAGE_TEXT + (OTHER_START_VALUES if fmu.start_values else "") + (ON_TARGET if fmu.image else "")
    about = {"name": fmu.name, "module": fmu.module, "start_values": dict(fmu.start_values), "image": IMAGE}
    return text.format(pythonfmu=pythonfmu, **about).encode()


def script_text(fmu: Fmu, package: str) -> bytes:
    return SCRIPT_TEXT.format(name=fmu.name, package=package).encode()
