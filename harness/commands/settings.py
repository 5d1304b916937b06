"""What the options of a run say: its loop, and what tells runs apart."""

import dataclasses
import logging
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Any

from ..loop.places import PLACES, PLANTS, by_name
from ..loop.settings import Settings
from ..loop.topology import ONE_UNIT
from ..views.metrics_table import DAMPINGS
from .options import Loop

if TYPE_CHECKING:
    from ..loop.resolved import ResolvedLoop

LOG = logging.getLogger(__name__)


def resolved(args: Loop, plant: str, controller: str, **run: Any) -> "ResolvedLoop":
    """The loop of a plant and a controller, as the options say.

    Args:
        run: fields of the settings that no option of the loop gives.

    Raises:
        WiringError, UserError, ParameterFileError: as of `harness.loop.resolved.resolve_all`.
    """
    return _resolved(args, {(plant, controller): _given(args, plant, controller, args.map, **run)})[plant, controller]


def _resolved(args: Loop, given: Mapping[tuple[str, str], Settings]) -> "dict[tuple[str, str], ResolvedLoop]":
    from ..loop.resolved import resolve_all  # mistakes and help are answered without

    loops = resolve_all(given, args.vehicle, args.parameters, dict(args.set))
    warn_of_gains(args.vehicle, args.parameters, loops.values())
    return loops


def _given(args: Loop, plant: str, controller: str, mapping: Mapping[str, str], **run: Any) -> Settings:
    """What the options give without the values of parameters."""
    return Settings(
        plant,
        controller,
        args.motor,
        args.can,
        seed=args.seed,
        folder=args.fmus,
        build=args.build,
        mapping=mapping,
        limits=args.limits,
        topology=getattr(args, "topology", None) or ONE_UNIT,
        **run,
    )


def warn_of_gains(vehicle: Path | None, parameters: Path | None, loops: "Iterable[ResolvedLoop]") -> None:
    """Says that a car has the gains of another one, if a controller has such gains, or is the default car."""
    if vehicle is None:
        return
    from toolground.toml_file import toml_entries

    if not toml_entries(vehicle):
        LOG.warning(f"{vehicle} has no parameter: the car is the default one (`driveline car --template` has them all)")
    elif parameters is None and any(each.settings.control and _has_gains(each) for each in loops):
        LOG.warning("the controller has the gains of the default car; `driveline design` makes those of a vehicle file")


def _has_gains(resolved: "ResolvedLoop") -> bool:
    if str(resolved.settings.controller) in PLACES["controller"]:
        return True
    from ...fmus.building.parameter_files import car_names
    from ...fmus.catalogue import FMUS

    controller = resolved.fit.interfaces[resolved.settings.topology.instances("controller")[0]]
    has = {variable.name for variable in controller.of_causality("parameter")}
    return bool(has & {*FMUS["DampingController"].block.Parameters._fields} - {*car_names()})


def all_loops(args: Loop, plants: Sequence[str], controllers: Sequence[str]) -> "dict[tuple[str, str], ResolvedLoop]":
    """The loops of each plant with each controller, as the options say, by the names of both; of --map see
    `harness.loop.mapped_names.mappings`.

    Args:
        plants: none: all of the project.
        controllers: none: all of the project.

    Raises:
        WiringError, UserError, ParameterFileError: as of `harness.loop.resolved.resolve_all`; two plants or controllers
            have the same name.
    """
    from ..loop.mapped_names import mappings

    plants = list(by_name(plants or PLANTS, "plant").values())
    each = by_name(controllers or PLACES["controller"], "controller")
    mapped = mappings(args.map, plants, list(each.values()), args.limits)
    given = {(p, name): _given(args, p, each[name], mapped[p, each[name]]) for p in plants for name in each}
    return {(one.settings.plant_name, name): one for (_, name), one in _resolved(args, given).items()}


def plants_loops(args: Any) -> "dict[str, ResolvedLoop]":
    """The loops of each plant with the one controller that the options name, by the names of the plants."""
    return {plant: each for (plant, _), each in all_loops(args, args.plant, [args.controller]).items()}


def say_unknowns(args: Any) -> None:
    """Says what of the car of --vehicle is estimated or usual, and what that costs."""
    from ..design.unknowns import unknowns_line

    if not args.silent and (lacks := unknowns_line(args.vehicle)):
        args.say(lacks)


def caption(args: Any) -> str:
    """What a figure, whose title names plant and manoeuvre, says of the options: those that are not the usual ones."""
    given, usual = vars(args), {each.name: each.default for each in dataclasses.fields(args)}
    others = [(name, given[name]) for name in ("held", "seed", "step", "scheme") if given.get(name) != usual.get(name)]
    return _joined([*_set(given), *others])


def _set(given: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """The options for blocks and parameters."""
    return [
        *(
            (place, block)
            for place in ("controller", "motor", "can")
            for block in _other_than(PLACES[place][0], given.get(place))
        ),
        *(("set", f"{name}={value!r}") for name, value in given.get("set", ())),
        *(("map", "=".join(names)) for names in given.get("map", {}).items()),
        *((name, given[name]) for name in ("vehicle", "parameters")),
    ]


def _other_than(usual: str, given: str | tuple[str, ...] | None) -> tuple[str, ...]:
    """The blocks of a place, if they are not the usual one alone."""
    blocks = given if isinstance(given, tuple) else (given or usual,)
    return () if blocks == (usual,) else blocks


def _joined(options: Iterable[tuple[str, Any]]) -> str:
    return " ".join(f"--{name} {quote(str(value))}" for name, value in options if value is not None)


def dampings(controllers: Sequence[str]) -> str:
    """Above a table of runs: what its rows are, and with which controller if it is one that is not the usual one."""
    if len(controllers) > 1:
        return "without damping (off) and with each controller"
    return DAMPINGS if controllers[0] == PLACES["controller"][0] else f"{DAMPINGS} by {controllers[0]}"
