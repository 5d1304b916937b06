"""Building FMUs: by which tools, for which machines and standards, and where each file goes."""

import logging
import os
import sys
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from .errors import BuildError, NotPossible
from .fmu import Fmu
from .operator_meant import operator_meant
from .origin import NATIVE_FOLDER, is_as_made_now, located, origin_of
from .own_file import place

BUILDS = ("python", "native", "both")
PLATFORMS = ("host", "all")

FMIS = (2, 3)
"""Of FMI 2.0 and FMI 3.0; there are native builds alone for the latter."""

FMI3_FOLDER = "fmi3"
"""Of the builds for FMI 3.0, in that of the others."""

LOG = logging.getLogger(__name__)

Builder = Callable[[Fmu, Path], Path]
"""Builds an FMU into a folder and returns the path of its file."""


def build_fmus(
    fmus: Sequence[Fmu], folder: Path, builds: str | None = None, platform: str = "host", fmi: int = 2
) -> Generator[Path, None, None]:
    """Builds FMUs, as many at a time as there are cores; yields the path of each file in their order.

    One whose sources are known, and that is there as it would be built, is left as it is, unless CC names a compiler.

    Args:
        folder: for the files; the native ones go to NATIVE_FOLDER in it, those for FMI 3.0 to FMI3_FOLDER.
        builds: one of BUILDS; None for each that is possible here.
        platform: of the native builds, one of PLATFORMS.
        fmi: one of FMIS.

    Raises:
        NotPossible: there is no compiler where one is needed, or it compiles nothing.
        BuildError: a build is not possible here, two FMUs have one name, or a block cannot be built.
    """
    names = [fmu.name for fmu in fmus]
    if same := sorted({name for name in names if names.count(name) > 1}):
        raise BuildError(f"{same[0]} is the name of several FMUs, which would overwrite each other")
    if builds == "python" and platform != "host":
        raise BuildError(f"--platform {platform} is for native builds; a Python build runs wherever Python does")
    possible = builders(builds, platform, fmi)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        try:
            begun = [
                pool.submit(_guarded(_unless_made(build, platform, fmi)), fmu, folder)
                for fmu in fmus
                for build in possible
            ]
            for future in begun:
                yield future.result()
        finally:
            pool.shutdown(cancel_futures=True)


def _unless_made(builder: Builder, platform: str, fmi: int) -> Builder:
    """The builder, which leaves what is there as it would build it."""
    from .python.packaging import build as in_python

    kind = "python" if builder is in_python else "native"

    def build(fmu: Fmu, folder: Path) -> Path:
        if fmu.sources is None or "CC" in os.environ:
            return builder(fmu, folder)
        path = folder / FMI3_FOLDER / f"{fmu.name}.fmu" if fmi == 3 else located(fmu.name, folder, kind)
        there = is_as_made_now(path, fmu, kind) and (kind == "python" or is_for_all(path) == (platform == "all"))
        return path if there else builder(fmu, folder)

    return build


def is_for_all(path: Path) -> bool:
    """Whether a native FMU has binaries for more platforms than one."""
    origin = origin_of(path)
    return origin is not None and len(origin.platforms) > 1


def builders(builds: str | None, platform: str = "host", fmi: int = 2) -> list[Builder]:
    """What makes the chosen builds.

    Args:
        builds: one of BUILDS; None for each that is possible.
        platform: of the native build, one of PLATFORMS.
        fmi: one of FMIS.

    Raises:
        NotPossible: a build that is asked for cannot be made here. Why native is left out otherwise is logged.
    """
    from .python.packaging import build

    if fmi == 3 and builds in ("python", "both"):
        raise NotPossible("for FMI 3.0 there are native builds only: PythonFMU3 ends hosts (docs/fmus.md)")
    if fmi == 3:
        return [_native_builder(platform, fmi, FMI3_FOLDER)]
    if builds == "python":
        return [build]
    try:
        native = _native_builder(platform, fmi, NATIVE_FOLDER)
    except NotPossible as reason:
        if builds is None and platform == "host":
            LOG.warning("there is no native build: %s", reason)
            return [build]
        raise
    return [native] if builds == "native" else [build, native]


def sender_builder(database: bytes, platform: str = "host") -> Builder:
    """What makes FMUs of FMI 3.0 that send their frames over a bus (FMI-LS-BUS).

    Args:
        database: DBC of the bus.
        platform: one of PLATFORMS.

    Raises:
        NotPossible: they cannot be made here.
    """
    return _native_builder(platform, 3, "", database)


def _native_builder(platform: str, fmi: int, own_folder: str, database: bytes = b"") -> Builder:
    """
    Args:
        own_folder: of the files, in the folder that the builder gets.
        database: as of `build_native`.
    """
    from .native import compiler
    from .native.packaging import build_native

    try:
        if platform == "all":
            compiler.zig_compiler()
        else:
            compiler.host_command()
    except compiler.CompilerError as reason:
        raise NotPossible(str(reason)) from reason
    binaries = compiler.all_binaries if platform == "all" else compiler.host_binaries

    def build(fmu: Fmu, folder: Path) -> Path:
        try:
            return build_native(fmu, folder / own_folder, binaries, fmi, database)
        except compiler.CompilerError as refusal:
            raise NotPossible(_refused(fmu, str(refusal))) from refusal

    return build


def _refused(fmu: Fmu, refusal: str) -> str:
    """That a compiler makes no FMU, in one line.

    Args:
        refusal: its command, and in the lines below what it says.
    """
    command, *lines = refusal.splitlines()
    said = next((line for line in lines if "error" in line.lower()), next(filter(None, lines), "nothing"))
    return (
        f"the C compiler {command.partition(' ')[0]} does not compile {fmu.name}; it says: {said[:200]} "
        "(the environment variable CC can name another, `--build python` makes FMUs of the project without one)"
    )


def _guarded(builder: Builder) -> Builder:
    """The builder for blocks of anybody, of a file or a notebook: whatever goes wrong is a BuildError."""

    def build(fmu: Fmu, folder: Path) -> Path:
        try:
            return builder(fmu, folder)
        except (OSError, BuildError):
            raise
        except Exception as error:
            file = getattr(sys.modules.get(fmu.module), "__file__", None)
            where = f"{place(error, [Path(file)])}: " if file else ""
            why = operator_meant(error) or f"{type(error).__name__}: {error}"
            raise BuildError(f"{where}{fmu.name} cannot be built: {why}") from error

    return build
