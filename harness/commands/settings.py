"""What the options of a run say: its settings, and what tells runs apart."""

import dataclasses
import logging
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from shlex import quote
from typing import Any

from ..loop.parameter_words import said
from ..loop.places import PLACES, PLANTS, by_name
from ..loop.settings import Settings, loop
from ..views.metrics_table import DAMPINGS
from .options import Loop

LOG = logging.getLogger(__name__)


def settings(args: Loop, plant: str, controller: str, **run: Any) -> Settings:
    """What the options say for a plant and a controller; the FMUs are there then.

    Args:
        run: fields of the settings that no option of the loop gives.

    Raises:
        WiringError: a text of --map is not of the form that it must have, or the FMUs do not have a parameter, or not
            with that value.
        UserError: an FMU is missing.
        ParameterFileError: a file of parameters is refused.
    """
    from ..loop.given_parameters import built_with  # mistakes and help are answered without

    given = [_given(args, plant, controller, args.map, **run)]
    (made,) = built_with(given, args.vehicle, args.parameters, dict(args.set))
    warn_of_gains(args.vehicle, args.parameters, [made])
    return made


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
        **run,
    )


def warn_of_gains(vehicle: Path | None, parameters: Path | None, loops: Iterable[Settings]) -> None:
    """Says that a car has the gains of another one, if a controller has such gains, or is the default car."""
    if vehicle is None:
        return
    from toolground.toml_file import toml_entries

    if not toml_entries(vehicle):
        LOG.warning(f"{vehicle} has no parameter: the car is the default one (`driveline car --template` has them all)")
    elif parameters is None and any(made.control and _has_gains(made) for made in loops):
        LOG.warning("the controller has the gains of the default car; `driveline design` makes those of a vehicle file")


def _has_gains(made: Settings) -> bool:
    if str(made.controller) in PLACES["controller"]:
        return True
    from fmuloop.wiring import fit

    from ...fmus.building.parameter_files import car_names
    from ...fmus.catalogue import FMUS

    has = {variable.name for variable in fit(loop(made)).interfaces["controller"].of_causality("parameter")}
    return bool(has & {*FMUS["DampingController"].block.Parameters._fields} - {*car_names()})


def all_settings(args: Loop, plants: Sequence[str], controllers: Sequence[str]) -> dict[tuple[str, str], Settings]:
    """What the options say for each plant with each controller, by the names of both.

    Of several controllers the file of parameters is for those that have all that it names, and a value of --set for
    those that have the parameter; the others keep theirs. Of --map see `harness.loop.mapped_names.mappings`.

    Args:
        plants: none: all of the project.
        controllers: none: all of the project.

    Raises:
        WiringError, UserError, ParameterFileError: as of `settings`; two plants or controllers have the same name,
            or the file or a value is for none of them.
    """
    from fmuloop.parameter_changes import parted
    from fmuloop.wiring import find, fit, require

    from ..loop.built_fmus import built_together
    from ..loop.given_parameters import NotTaken, require_of_plant, with_parameters
    from ..loop.mapped_names import mappings

    plants = list(by_name(plants or PLANTS, "plant").values())
    each = by_name(controllers or PLACES["controller"], "controller")
    mapped = mappings(args.map, plants, list(each.values()), args.limits)
    given = {(p, name): _given(args, p, each[name], mapped[p, each[name]]) for p in plants for name in each}
    assigned, several, found = dict(args.set), len(each) > 1, dict[tuple[str, str], Settings]()
    for plant in plants:
        require_of_plant(assigned, plant)
    refusals: dict[str, list[NotTaken]] = {plant: [] for plant in plants}
    for (plant, name), made in zip(given, built_together(given.values(), alike=False), strict=True):
        try:
            made = with_parameters(made, args.vehicle, args.parameters, assigned, several)
        except NotTaken as refusal:
            refusals[plant].append(refusal)
            if len(refusals[plant]) == len(each):
                raise refusals[plant][0] from None
            made = with_parameters(made, args.vehicle, None, assigned, several)
        found[made.plant_name, name] = made
    warn_of_gains(args.vehicle, args.parameters, found.values())
    for parameter in assigned if several else ():
        lacking = dict.fromkeys(name for (_, name), made in found.items() if parameter not in made.parameters)
        if len(lacking) == len(each):
            fits = (fit(loop(made)) for made in found.values())
            require(line for each in fits for line in find(parted(parameter)[0], "parameter", each.interfaces)[1])
        elif lacking:
            LOG.warning(said("without", name=f"--set {parameter}", controllers=", ".join(lacking)))
    return found


def plants_settings(args: Any) -> dict[str, Settings]:
    """What the options say for each plant, with the one controller that they name; by the names of the plants."""
    return {plant: made for (plant, _), made in all_settings(args, args.plant, [args.controller]).items()}


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
