"""Which FMUs are built for a car: those of the project by name, blocks of a file of the user's own."""

from collections.abc import Generator, Mapping, Sequence
from functools import cache
from math import inf
from pathlib import Path
from typing import Any

from fmublocks import builds as blocks
from fmublocks.description.variables import interface
from fmublocks.errors import BuildError
from fmublocks.fmu import Fmu
from fmublocks.origin import located, origin_of
from fmublocks.own_file import fmu_in
from toolground.known_names import meant

from ..origin import is_stale


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
        names: of FMUs of the project, or paths of Python files with a block of the user's own, or these blocks
            themselves; none for all of the project but the comparators.
        folder, builds, platform, fmi: as of `fmublocks.builds.build_fmus`; of a block of the user's own there is the
            native build, unless another is asked for.
        vehicle, parameters: files with start values of the car's and of the controller's parameters.

    Raises:
        NotPossible: there is no compiler where one is needed, or it compiles nothing.
        BuildError: a name is unknown or taken, a build is not possible here, a file is refused, or a block of the
            user's own cannot be built.
    """
    from ..catalogue import EVERY, FMUS
    from .one_car import of_one_car
    from .parameter_files import read_files, require_taken

    fmus = [name if isinstance(name, Fmu) else _named(name) for name in _each_once(names or list(FMUS))]
    own = [fmu for fmu in fmus if fmu not in EVERY.values()]
    if taken := [fmu.name for fmu in own if fmu.name in EVERY]:
        raise BuildError(f"{taken[0]} is an FMU of the project, which runs by this name; give the block another name")
    start_values = read_files(vehicle, parameters, own)
    built = " or ".join(fmu.name for fmu in fmus)
    require_taken(parameters, {name for fmu in fmus for name in fmu.block.Parameters._fields}, built)
    cars = [fmu.started_with(of_one_car(start_values, fmu.block.Parameters._fields)) for fmu in fmus]
    if builds is None and own:
        ours = [car for car, fmu in zip(cars, fmus, strict=True) if fmu not in own]
        theirs = [car for car, fmu in zip(cars, fmus, strict=True) if fmu in own]
        yield from blocks.build_fmus(ours, folder, builds, platform, fmi)
        yield from blocks.build_fmus(theirs, folder, "native", platform, fmi)
    else:
        yield from blocks.build_fmus(cars, folder, builds, platform, fmi)


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
    paths: list[Path] = []
    for name in names:
        if is_stale(path := located(name, folder, build)):
            from ..catalogue import EVERY  # what is up to date is found to be so without

            paths += rebuilt(EVERY[name], path, folder, build)
    return paths


def rebuilt(fmu: Fmu, path: Path, folder: Path, build: str) -> list[Path]:
    """Builds an FMU of the project into a folder as that at `path` was built, if there is one; returns the files.

    Raises:
        NotPossible, BuildError: as of `refreshed`.
    """
    origin = origin_of(path)
    platform = "all" if build == "native" and blocks.is_for_all(path) else "host"
    as_built = _as_built(fmu, origin.start_values, path) if origin else fmu
    return [builder(as_built, folder) for builder in blocks.builders(build, platform)]


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


@cache
def fmu_of(block: str) -> Fmu:
    """An FMU of the project by its name, or one of the user's own by its path, with its Python file beside it.

    Raises:
        BuildError: there is no such file.
    """
    from ..catalogue import EVERY

    return EVERY[block] if block in EVERY else fmu_in(Path(block).with_suffix(".py"))
