"""The settings of a run of the loop, as a record, and the loop that they make."""

import dataclasses
from collections.abc import Iterable, Iterator, Mapping
from ctypes import CDLL
from dataclasses import dataclass, field
from functools import cache, lru_cache
from math import pi, sqrt
from os import PathLike
from pathlib import Path
from typing import TypedDict, Unpack

from fmuloop.errors import WiringError
from fmuloop.limits import USUAL_LIMITS, Limits
from fmuloop.system import Scheme, System
from toolground.known_names import nearest

from . import roles
from .arguments import ARGUMENTS, require_arguments
from .places import (
    BUILD,
    BUILDS,
    NATIVE,
    NO_DAMPING,
    PLACES,
    STEP_SIZE,
    NameOrFile,
    block_and_variable,
)
from .topology import ONE_UNIT, Topology, read_topology


class RunChanges(TypedDict, total=False):
    """The fields of `Settings` but plant and controller as keyword arguments; None is what is usual."""

    motor: NameOrFile | None
    can: NameOrFile | None
    control: bool
    parameters: Mapping[str, float] | None
    road_load: Mapping[str, float] | None
    frequency: float | None
    step_size: float
    scheme: Scheme | str
    seed: int
    folder: str | Path
    build: str | None
    mapping: Mapping[str, str] | str | Path | None
    limits: Limits
    tolerance: float | None
    topology: Topology | str | Path


class Changes(RunChanges, total=False):
    """All fields of `Settings` as keyword arguments; None is what is usual."""

    plant: NameOrFile | None
    controller: NameOrFile | None


@dataclass(frozen=True)
class Settings:
    """All that makes a run of the loop what it is, beside the manoeuvre.

    Attributes:
        plant, controller, motor, can: what stands in these places, a block of the project by name or the path of
            an FMU.
        control: whether the damping control is enabled.
        parameters: `instance.variable` -> value, beside the start and the seeds that a run sets; `instance.variable@t`
            -> value of a tunable one from the time t in s on.
        road_load: what the road load takes of a plant that has no such parameter: i, r, m, g, c_rr, c_wa -> value.
        frequency: at which the drive train swings, Hz, for the band of the metrics; None: by C, J_1 and J_2 among the
            parameters of the controller, where all are, else as the FMU of the plant tells.
        step_size: communication step in s.
        scheme: when outputs reach inputs.
        seed: of all noise and jitter.
        folder: of the built FMUs.
        build: "native" or "python"; None: see `chosen_build`.
        mapping: names of the loop -> names of an FMU: what the loop calls `plant.T_gear` is `Shaft.tau` of the FMU in
            the place of the plant; `their_car.T_gear` is that of `their_car.fmu`; or the path of a file with them.
        limits: of FMUs that are given by their path.
        tolerance: relative, of FMUs that integrate; None: that of each FMU's default experiment.
        topology: the drive units, or the path of a file that declares them, see docs/loop.md; all have the same
            motor, controller and bus.

    Raises:
        WiringError: names a value that no run can take, whatever the FMUs are.
    """

    plant: NameOrFile = PLACES["plant"][0]
    controller: NameOrFile = PLACES["controller"][0]
    motor: NameOrFile = PLACES["motor"][0]
    can: NameOrFile = PLACES["can"][0]
    control: bool = True
    parameters: Mapping[str, float] = field(default_factory=dict)
    road_load: Mapping[str, float] = field(default_factory=dict)
    frequency: float | None = None
    step_size: float = STEP_SIZE
    scheme: Scheme = Scheme.PROPAGATED
    seed: int = 1
    folder: Path = BUILD
    build: str | None = None
    mapping: Mapping[str, str] = field(default_factory=dict)
    limits: Limits = USUAL_LIMITS
    tolerance: float | None = None
    topology: Topology = ONE_UNIT

    def __post_init__(self) -> None:
        require_arguments(**vars(self))
        given = {name: PLACES[name][0] if block is None else block for name, block in self.blocks.items()}
        if isinstance(self.mapping, str | PathLike):
            object.__setattr__(self, "mapping", _read_mapping(Path(self.mapping)))
        others = {name: dict(getattr(self, name) or {}) for name in ("parameters", "road_load")}
        if isinstance(self.topology, str | PathLike):
            object.__setattr__(self, "topology", read_topology(Path(self.topology)))
        others["mapping"] = _of_places(self.mapping or {}, given)
        for name, value in {**given, **others, "scheme": Scheme(self.scheme), "folder": Path(self.folder)}.items():
            object.__setattr__(self, name, value)

    @property
    def blocks(self) -> dict[str, NameOrFile]:
        """What stands in each place of the loop."""
        return {place: getattr(self, place) for place in PLACES}

    @property
    def plant_name(self) -> str:
        """By which tables and files name the plant."""
        return Path(self.plant).stem

    @property
    def controller_name(self) -> str:
        """The same of the controller."""
        return Path(self.controller).stem

    def replace(self, **changes: Unpack[Changes]) -> "Settings":
        """The same with other values of these fields.

        Raises:
            WiringError: names a value that no run can take.
            TypeError: there is no such field.
        """
        if unknown := next((name for name in changes if name not in ARGUMENTS), None):
            raise TypeError(f"there is no setting {unknown}; {nearest(unknown, ARGUMENTS)}")
        return dataclasses.replace(self, **changes)  # type: ignore[arg-type]  # None and names become values above

    def with_parameters(self, parameters: Mapping[str, float]) -> "Settings":
        """The same with these parameters too, `instance.variable` -> value."""
        return self.replace(parameters={**self.parameters, **parameters})


def own_frequency(car: Mapping[str, float]) -> float | None:
    """Frequency in Hz at which a drive train swings, sqrt(C (1/J_1 + 1/J_2))/(2 pi), None where it is not told.

    Args:
        car: its entries in SI units, motor side.
    """
    if not {"C", "J_1", "J_2"} <= car.keys():
        return None
    return sqrt(car["C"] * (1.0 / car["J_1"] + 1.0 / car["J_2"])) / (2.0 * pi)


def _read_mapping(path: Path) -> dict[str, str]:
    from fmuloop.mapping import read  # who asks for help alone needs no fmpy

    return read(path)


def _of_places(mapping: Mapping[str, str], blocks: Mapping[str, NameOrFile]) -> dict[str, str]:
    """The mapping of a loop with what stands in a table named as the file of an FMU as of its place, before what stands
    there.

    Args:
        blocks: what stands in each place.

    Raises:
        WiringError: two places have a file of that name.
    """
    places = {Path(block).stem: place for place, block in blocks.items()}
    parts = {name: block_and_variable(name, places) for name in mapping}
    for of, _ in parts.values():
        if of not in PLACES and len(same := [place for place, block in blocks.items() if Path(block).stem == of]) > 1:
            both = " and ".join(same)
            raise WiringError(f"--map {of}: {both} are both {of}.fmu; rename one, or name the tables {both}")
    of_file = [name for name, (of, _) in parts.items() if of in places.keys() - PLACES.keys()]
    own = {f"{places[parts[name][0]]}.{parts[name][1]}": mapping[name] for name in of_file}
    return {name: theirs for name, theirs in mapping.items() if name not in of_file} | own


def settings(given: Settings | NameOrFile | None = None, **changes: Unpack[Changes]) -> Settings:
    """What a function was given: settings or only a plant, its name or file, and what is to be changed of that.

    Raises:
        WiringError: names a value that no run can take.
        TypeError: there is no such field, or the plant is given twice.
    """
    if isinstance(given, Settings):
        return given.replace(**changes) if changes else given
    if given is not None:
        if "plant" in changes:
            raise TypeError(f"plant is given twice: {given} and {changes['plant']}")
        changes["plant"] = given
    return _usual().replace(**changes)


_usual = cache(Settings)


def running(made: Settings) -> Settings:
    """The settings as they run: without damping, NoDamping stands in the place of a controller that has no `enable`."""
    if made.control or str(made.controller) in PLACES["controller"]:
        return made
    path = Path(made.controller)
    state = path.stat() if path.is_file() else None
    written = state and (state.st_mtime_ns, state.st_size)
    if _has(path, made.mapping.get(roles.ENABLE, "enable"), made.limits, written):
        return made
    controllers = {"controller", *made.topology.instances("controller")}
    others = {
        name: {key: value for key, value in getattr(made, name).items() if key.partition(".")[0] not in controllers}
        for name in ("parameters", "mapping")
    }
    return dataclasses.replace(made, controller=NO_DAMPING, **others)


@lru_cache(64)  # every run asks more than once
def _has(path: Path, variable: str, limits: Limits, written: object) -> bool:
    """Whether an FMU that was `written` so has a variable."""
    from fmuloop.description import read  # who asks for help alone needs no fmpy

    return any(each.name == variable for each in read(path, limits).modelVariables)


def loop(given: Settings | NameOrFile | None = None, **changes: Unpack[Changes]) -> System:
    """The closed loop of controller, motor, plant and the wheel speeds over CAN, as settings say; arguments as of
    `settings`.

    Raises:
        WiringError: there is no such block or build.
    """
    made = running(settings(given, **changes))
    files = _files(made, made.build or chosen_build(made))
    own = frozenset(place for place, block in made.blocks.items() if str(block) in PLACES[place])
    return _system(tuple(files.items()), tuple(made.mapping.items()), own, made.limits, made.topology)


@lru_cache(64)  # of many runs one
def _system(
    files: tuple[tuple[str, Path], ...],
    mapping: tuple[tuple[str, str], ...],
    own: frozenset[str],
    limits: Limits,
    topology: Topology,
) -> System:
    blocks = dict(files)
    return System(
        instances={instance: blocks[place] for instance, place in topology.places.items()},
        connections=topology.connections + (topology.truth if blocks["controller"].stem == "TrueMotion" else ()),
        inputs=topology.inputs,
        parameters=topology.parameters,
        outputs=topology.outputs,
        mapping=dict(_of_instances(mapping, topology)),
        optional=topology.optional,
        offered=topology.offered,
        own=frozenset(instance for instance, place in topology.places.items() if place in own),
        limits=limits,
        lane_libraries=libraries_of,
    )


def _of_instances(mapping: Iterable[tuple[str, str]], topology: Topology) -> Iterator[tuple[str, str]]:
    """What is mapped of a place is so of each block there."""
    for name, theirs in mapping:
        place, _, variable = name.partition(".")
        for instance in topology.instances(place) or [place]:
            yield f"{instance}.{variable}", theirs


def libraries_of(system: System) -> dict[str, CDLL] | None:
    """What makes runs of a system in the lanes of the processor."""
    from .lane_libraries import lane_libraries  # few runs are made so

    return lane_libraries(system)


def chosen_build(given: Settings | NameOrFile | None = None, **changes: Unpack[Changes]) -> str:
    """The build that runs if none is asked for: native where all FMUs of the loop have that build; arguments as of
    `settings`.

    Raises:
        WiringError: there is no such block.
    """
    native = _files(settings(given, **changes), NATIVE)
    return NATIVE if all(path.is_file() for path in native.values()) else "python"


def _files(made: Settings, build: str) -> dict[str, Path]:
    if build not in BUILDS:
        raise WiringError(f"unknown build {build}; {nearest(build, BUILDS)}")
    folder = made.folder / NATIVE if build == NATIVE else made.folder
    return {place: _file(place, block, folder) for place, block in made.blocks.items()}


@lru_cache(64)  # every run asks for them
def _file(place: str, block: NameOrFile, folder: Path) -> Path:
    names = PLACES[place]
    if str(block) in names:
        return folder / f"{block}.fmu"
    path = Path(block)
    if path.suffix == ".fmu":
        return path
    name = str(block) or "(an empty name)"
    raise WiringError(f"unknown {place} {name}; {nearest(str(block), names)} (or give the path of a .fmu file)")
