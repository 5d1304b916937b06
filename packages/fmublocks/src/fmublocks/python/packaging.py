"""Building an FMU with PythonFMU, which packs block and slave; then the archive is put in its final form."""

import os
import shutil
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from errno import ENOSPC
from importlib.metadata import distribution, version
from pathlib import Path, PurePosixPath
from threading import Lock
from types import ModuleType

from pythonfmu.builder import FmuBuilder

from toolground.errors import full_disk

from ..archive import guid_of, write_archive
from ..description.build_kind import BuildKind
from ..description.documentation import documentation
from ..description.model_description import model_description
from ..fmu import Fmu
from ..native.compiler import WHOLE, CompilerError, host_binaries, host_platform
from ..origin import origin_entry
from ..protocol import LOG_CATEGORIES, LOG_DISCARD
from .bundle import bundle, package_name, package_text, script_text

EXTERNAL = """\
Python 3.11 or later with its standard library, in the process of the host:
- a host that is a Python program has it;
- on Linux start another with LD_PRELOAD set to libpython3.11.so.1.0 (or a later one), and with PYTHONHOME if that
  Python is not in a standard place;
- on Windows have the python3.dll of such a Python on the PATH.
On Linux also glibc 2.32 and libstdc++ with GLIBCXX_3.4.30 or later.
No package needs to be installed in that Python.
"""

EMULATOR = """\
qemu-system-arm on the PATH, on Linux: the controller runs on the Cortex-M4F that it emulates.
"""

HTML_EMULATOR = """ The controller itself runs on a
Cortex-M4F that qemu-system-arm emulates, which must be on the PATH (on Linux)."""

ENTRY = Path(__file__).with_name("entry.c")

SLAVE_MODULES = ("fmi2slave", "logmsg", "default_experiment", "_version", "enums", "variables")
"""Modules of PythonFMU that an FMU needs when it runs."""

PACKING = Lock()
"""Held while PythonFMU packs, which imports the block as a module."""


def build(fmu: Fmu, folder: Path) -> Path:
    """Builds `folder/<name>.fmu`, replacing one that is there, and returns its path."""
    kind = python_kind(on_target=bool(fmu.image))
    with PACKING:
        files = _resources_and_binaries(fmu)
    guid = guid_of(model_description(fmu, kind, ""), files)
    files |= documentation(fmu, kind) | _license_of_pythonfmu() | origin_entry(fmu, "python")
    files["modelDescription.xml"] = model_description(fmu, kind, guid)
    target = folder / f"{fmu.name}.fmu"
    write_archive(files, target)
    return target


def python_kind(on_target: bool = False) -> BuildKind:
    """What the build with PythonFMU says of itself; `on_target`: its functions run on an emulated target."""
    return BuildKind(
        tool=f"PythonFMU {version('pythonfmu')}",
        capabilities={
            "canInterpolateInputs": "false",
            "maxOutputDerivativeOrder": "0",
            "canNotUseMemoryManagementFunctions": "true",
            "providesDirectionalDerivative": "false",
            "needsExecutionTool": "true" if on_target else "false",
        },
        log_categories={LOG_DISCARD: LOG_CATEGORIES[LOG_DISCARD]},
        needs="""The model is Python code inside this file, on the
standard library alone. The host process must be a Python of version 3.11 or later, or have loaded
libpython with its symbols visible (on Linux: LD_PRELOAD)."""
        + (HTML_EMULATOR if on_target else ""),
        external=EXTERNAL + (EMULATOR if on_target else ""),
    )


def _resources_and_binaries(fmu: Fmu) -> dict[str, bytes]:
    """What PythonFMU packs, with its own modules inside the FMU's package."""
    files = bundle(fmu)
    package = package_name(fmu, files)
    packed = _packed_by_pythonfmu(fmu, package, files)
    moved: dict[str, bytes] = {}
    for name, content in packed.items():
        path = PurePosixPath(name)
        if path.parent == PurePosixPath("resources/pythonfmu"):
            if path.stem in SLAVE_MODULES:
                moved[f"resources/{package}/pythonfmu/{path.name}"] = content
        elif path.parts[0] in ("resources", "binaries"):
            moved[name] = content
    moved |= _entry(fmu.name, moved)
    moved[f"resources/{package}/pythonfmu/__init__.py"] = b""
    moved[f"resources/{package}/__init__.py"] = package_text(fmu, ".pythonfmu")
    return moved


def _entry(name: str, packed: dict[str, bytes]) -> dict[str, bytes]:
    """Stands between the host and PythonFMU's binary for Linux, which then has another name: entry.c. Without a C
    compiler, and elsewhere, the binary stays alone."""
    binary = f"binaries/linux64/{name}.so"
    if host_platform() != "linux64":
        return {}
    try:
        entry = host_binaries(name, {WHOLE: ENTRY.read_bytes()})
    except CompilerError:
        return {}
    return {f"binaries/linux64/{name}.python.so": packed[binary], binary: entry[binary]}


def _packed_by_pythonfmu(fmu: Fmu, package: str, files: dict[str, bytes]) -> dict[str, bytes]:
    """Files of the archive that PythonFMU makes of the package, by name."""
    with tempfile.TemporaryDirectory() as temporary, _no_traces(package):
        folder = Path(temporary)
        for path, content in (files | {"__init__.py": package_text(fmu, "pythonfmu")}).items():
            file = folder / package / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
        script = folder / f"{package}_main.py"
        script.write_bytes(script_text(fmu, package))
        archive = folder / f"{fmu.name}.fmu"
        try:
            FmuBuilder.build_FMU(script, dest=archive, project_files=[folder / package])
        except shutil.Error as error:  # a list of what could not be copied
            if os.strerror(ENOSPC) not in str(error):
                raise
            raise full_disk() from error
        with zipfile.ZipFile(archive) as packed:
            names = (name for name in packed.namelist() if "__pycache__" not in name)
            return {name: packed.read(name) for name in names}


@contextmanager
def _no_traces(package: str) -> Iterator[None]:
    """Takes back what PythonFMU's builder leaves in sys.path and sys.modules.

    It imports the package, so one of that name that belongs to a loaded FMU is set aside meanwhile.
    """
    path, write_bytecode = list(sys.path), sys.dont_write_bytecode
    loaded = _taken_out(package)
    sys.dont_write_bytecode = True
    try:
        yield
    finally:
        sys.path[:], sys.dont_write_bytecode = path, write_bytecode
        _taken_out(package)
        sys.modules.update(loaded)


def _taken_out(package: str) -> dict[str, ModuleType]:
    """Modules whose names begin so, which sys.modules then has no more."""
    return {name: sys.modules.pop(name) for name in list(sys.modules) if name.startswith(package)}


def _license_of_pythonfmu() -> dict[str, bytes]:
    license_of = next(file for file in distribution("pythonfmu").files or () if file.name == "LICENSE")
    return {"documentation/licenses/pythonfmu.txt": Path(license_of.locate()).read_bytes()}
