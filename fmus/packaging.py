"""Building an FMU: PythonFMU packs block and slave, then the archive is put in its final form.

The same content gives the same bytes: sorted names, fixed dates, a GUID made of the content.
"""

import hashlib
import os
import sys
import tempfile
import uuid
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import distribution
from pathlib import Path, PurePosixPath
from types import ModuleType

from pythonfmu.builder import FmuBuilder

from .bundle import bundle, package_name, package_text, script_text
from .documentation import page
from .fmu import Fmu
from .model_description import model_description
from .picture import picture

LICENSE = Path(__file__).parent.parent / "LICENSE"

SLAVE_MODULES = ("fmi2slave", "logmsg", "default_experiment", "_version", "enums", "variables")
"""Modules of PythonFMU that an FMU needs when it runs."""

ZIP_DATE = (1980, 1, 1, 0, 0, 0)


def build(fmu: Fmu, folder: Path) -> Path:
    """Builds `folder/<name>.fmu`, replacing one that is there, and returns its path."""
    files = _resources_and_binaries(fmu) | _documentation(fmu)
    files["model.png"] = picture(fmu.block)
    files["modelDescription.xml"] = model_description(fmu, _guid(fmu, files))
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / f"{fmu.name}.fmu"
    unfinished = target.with_suffix(f".{os.getpid()}.part")
    try:
        _write(files, unfinished)
        os.replace(unfinished, target)
    finally:
        unfinished.unlink(missing_ok=True)
    return target


def _resources_and_binaries(fmu: Fmu) -> dict[str, bytes]:
    """What PythonFMU packs, with its own modules inside the FMU's package."""
    files = bundle(fmu)
    package = package_name(fmu, files)
    packed = _packed_by_pythonfmu(fmu, package, files)
    moved = {}
    for name, content in packed.items():
        path = PurePosixPath(name)
        if path.parent == PurePosixPath("resources/pythonfmu"):
            if path.stem in SLAVE_MODULES:
                moved[f"resources/{package}/pythonfmu/{path.name}"] = content
        elif path.parts[0] in ("resources", "binaries"):
            moved[name] = content
    moved[f"resources/{package}/pythonfmu/__init__.py"] = b""
    moved[f"resources/{package}/__init__.py"] = package_text(fmu, ".pythonfmu")
    return moved


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
        FmuBuilder.build_FMU(script, dest=archive, project_files=[folder / package])
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


def _documentation(fmu: Fmu) -> dict[str, bytes]:
    """The page and the licences, of the project and of PythonFMU."""
    files = {"documentation/index.html": page(fmu).encode()}
    if LICENSE.exists():
        files["documentation/licenses/license.txt"] = LICENSE.read_bytes()
    for file in distribution("pythonfmu").files or ():
        if file.name == "LICENSE":
            files["documentation/licenses/pythonfmu.txt"] = Path(file.locate()).read_bytes()
    return files


def _guid(fmu: Fmu, files: dict[str, bytes]) -> str:
    """A GUID that changes with the code, the binaries and the description."""
    digest = hashlib.sha256(model_description(fmu, ""))
    for name in sorted(files):
        if name.startswith(("resources/", "binaries/")):
            digest.update(hashlib.sha256(name.encode()).digest() + hashlib.sha256(files[name]).digest())
    return f"{{{uuid.UUID(bytes=digest.digest()[:16])}}}"


def _write(files: dict[str, bytes], target: Path) -> None:
    """Writes a zip archive whose bytes depend on the files alone."""
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, ZIP_DATE)
            entry.create_system, entry.external_attr = 3, 0o100644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, files[name])
