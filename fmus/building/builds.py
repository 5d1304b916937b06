"""Building FMUs: those of the project by name, or one of a Python file of the user's own."""

import logging
import os
from collections.abc import Callable, Generator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from math import inf
from pathlib import Path
from typing import Any

from ..description.variables import interface
from ..errors import BuildError, NotPossible
from ..fmu import Fmu
from ..names import meant
from ..origin import NATIVE_FOLDER, is_as_made_now, is_stale, located, origin_of
from .operator_meant import operator_meant
from .own_file import fmu_in, place

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
    names: Sequence[str | Fmu],
    folder: Path,
    builds: str | None = None,
    platform: str = "host",
    vehicle: Path | None = None,
    parameters: Path | None = None,
    fmi: int = 2,
) -> Generator[Path, None, None]:
    """Builds FMUs, as many at a time as there are cores; yields the path of each file in their order.

    An FMU of the project that is there as it would be built is left as it is, unless CC names a compiler.

    Args:
        names: of FMUs of the project, or paths of Python files with a block of the user's own, of which there is a
            native build only, or these blocks themselves; none for all of the project but the comparators.
        folder: for the files; the native ones go to NATIVE_FOLDER in it, those for FMI 3.0 to FMI3_FOLDER.
        builds: one of BUILDS; None for each that is possible here.
        platform: of the native builds, one of PLATFORMS.
        vehicle, parameters: files with start values of the car's and of the controller's parameters.
        fmi: one of FMIS.

    Raises:
        NotPossible: there is no compiler where one is needed, or it compiles nothing.
        BuildError: a name is unknown, a build is not possible here, a file is refused, or a block of the user's own
            cannot be built.
    """
    from ..catalogue import EVERY, FMUS
    from .one_car import of_one_car
    from .parameter_files import read_files, require_taken

    fmus = [name if isinstance(name, Fmu) else _named(name) for name in _each_once(names or list(FMUS))]
    own = [fmu for fmu in fmus if fmu not in EVERY.values()]
    built = [fmu.name for fmu in fmus]
    if same := sorted({name for name in built if built.count(name) > 1}):
        raise BuildError(f"{same[0]} is the name of several FMUs, which would overwrite each other")
    if own and builds in ("python", "both"):
        raise NotPossible(f"{own[0].name} has a native build only, as every block in a file of your own")
    if builds == "python" and platform != "host":
        raise BuildError(f"--platform {platform} is for native builds; a Python build runs wherever Python does")
    of_the_project = builders(builds, platform, fmi) if len(own) < len(fmus) else []
    if "CC" not in os.environ:
        of_the_project = [_unless_made(build, platform, fmi) for build in of_the_project]
    files = [Path(name) for name in names if isinstance(name, str) and name.endswith(".py")]
    of_own = [_guarded(builder, files) for builder in builders("native", platform, fmi)] if own else []
    start_values = read_files(vehicle, parameters, own)
    require_taken(parameters, {name for fmu in fmus for name in fmu.block.Parameters._fields}, " or ".join(built))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        try:
            begun = [
                pool.submit(build, fmu.started_with(of_one_car(start_values, fmu.block.Parameters._fields)), folder)
                for fmu in fmus
                for build in (of_own if fmu in own else of_the_project)
            ]
            for each in begun:
                yield each.result()
        finally:
            pool.shutdown(cancel_futures=True)


def _unless_made(builder: Builder, platform: str, fmi: int) -> Builder:
    """The builder, which leaves what is there as it would build it."""
    from ..python.packaging import build as in_python

    kind = "python" if builder is in_python else "native"

    def build(fmu: Fmu, folder: Path) -> Path:
        path = folder / FMI3_FOLDER / f"{fmu.name}.fmu" if fmi == 3 else located(fmu.name, folder, kind)
        there = is_as_made_now(path, fmu, kind) and (kind == "python" or _for_all(path) == (platform == "all"))
        return path if there else builder(fmu, folder)

    return build


def _for_all(path: Path) -> bool:
    """Whether a native FMU has binaries for more platforms than one."""
    origin = origin_of(path)
    return origin is not None and len(origin.platforms) > 1


def _each_once(names: Sequence[str | Fmu]) -> list[str | Fmu]:
    return [name for k, name in enumerate(names) if name not in names[:k]]


def refreshed(names: Sequence[str], folder: Path, build: str) -> list[Path]:
    """Builds those FMUs of the project that are missing or stale, as they were built: with their start values and
    for their platforms.

    Args:
        names: of FMUs of the project.
        folder: of the files; the native ones are in NATIVE_FOLDER in it.
        build: "python" or "native".

    Returns:
        The files that were made; none if all were there and up to date.

    Raises:
        NotPossible: there is something to build, and it is not possible here.
        BuildError: start values that one was built with are refused by what it is now.
    """
    made: list[Path] = []
    for name in names:
        if is_stale(path := located(name, folder, build)):
            from ..catalogue import EVERY  # what is up to date is found to be so without

            made += rebuilt(EVERY[name], path, folder, build)
    return made


def rebuilt(fmu: Fmu, path: Path, folder: Path, build: str) -> list[Path]:
    """Builds an FMU of the project into a folder as that at `path` was built, if there is one; returns the files.

    Raises:
        NotPossible, BuildError: as of `refreshed`.
    """
    origin = origin_of(path)
    platform = "all" if build == "native" and _for_all(path) else "host"
    made = _as_built(fmu, origin.start_values, path) if origin else fmu
    return [builder(made, folder) for builder in builders(build, platform)]


def _as_built(fmu: Fmu, start_values: Mapping[str, Any], path: Path) -> Fmu:
    """The FMU as it is now, with the start values that the one at `path` was built with.

    Raises:
        BuildError: it does not take them any more.
    """
    parameters = {variable.name: variable for variable in interface(fmu.block) if variable.causality == "parameter"}
    for name, value in start_values.items():
        low, high = parameters[name].bounds() if name in parameters else (inf, -inf)
        if not low <= value <= high:
            allowed = parameters[name].allowed() if name in parameters else "no such parameter"
            raise BuildError(
                f"{path} is stale and was built with {name} = {value!r}; {fmu.name} now takes {allowed}: "
                f"build it again with --vehicle and --parameters"
            )
    return fmu.started_with(start_values)


def _named(name: str) -> Fmu:
    from ..catalogue import EVERY

    if name in EVERY:
        return EVERY[name]
    if name.endswith(".py"):
        return fmu_in(Path(name))
    if name.endswith(".toml"):
        raise BuildError(f"{name} is no FMU; a car is given as --vehicle {name}, its gains as --parameters")
    raise BuildError(f"unknown FMU {name}; {meant(name, EVERY) or 'there are ' + ', '.join(EVERY)}")


def builders(builds: str | None, platform: str = "host", fmi: int = 2) -> list[Builder]:
    """What makes the chosen builds.

    Args:
        builds: one of BUILDS; None for each that is possible.
        platform: of the native build, one of PLATFORMS.
        fmi: one of FMIS.

    Raises:
        NotPossible: a build that is asked for cannot be made here. Why native is left out otherwise is logged.
    """
    from ..python.packaging import build

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
    from ..native import compiler
    from ..native.packaging import build_native

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


def _guarded(builder: Builder, files: Sequence[Path]) -> Builder:
    """The builder for blocks that are not ours, of these files or a notebook: whatever goes wrong is a BuildError."""

    def build(fmu: Fmu, folder: Path) -> Path:
        try:
            return builder(fmu, folder)
        except (OSError, NotPossible):
            raise
        except Exception as error:
            where = f"{place(error, files)}: " if files else ""
            why = operator_meant(error) or f"{type(error).__name__}: {error}"
            raise BuildError(f"{where}{fmu.name} cannot be built: {why}") from error

    return build
