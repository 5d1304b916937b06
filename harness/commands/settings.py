"""What the options of a run say: its settings, and what tells runs apart."""

import argparse
import logging
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from shlex import quote
from typing import Any

from ..base.errors import DrivelineError
from ..base.known_names import require_different
from ..cosimulation.limits import Limits
from ..cosimulation.system import Scheme, System
from ..loop.built_fmus import built
from ..loop.fmu_cache import as_built
from ..loop.places import BUILD, PLACES, PLANTS, STEP_SIZE
from ..loop.settings import Settings, loop
from ..manoeuvres.manoeuvre import Manoeuvre
from ..views.metrics_table import DAMPINGS
from ..views.signals_file import require_format
from .options import OTHERS

LOG = logging.getLogger(__name__)


def limits(args: argparse.Namespace) -> Limits:
    """What the options of `add_limits` say."""
    return Limits(args.time_limit, args.unpacked_limit)


def settings(args: argparse.Namespace, plant: str) -> Settings:
    """What the options of `add_loop` say for a plant; the FMUs are there then.

    Raises:
        WiringError: a text of --map is not of the form that it must have, or the FMUs do not have a parameter, or not
            with that value.
        DrivelineError: an FMU is missing.
        ParameterFileError: a file of parameters is refused.
    """
    blocks = {place: getattr(args, place) for place in OTHERS}
    made = built(plant, **blocks, seed=args.seed, folder=args.fmus, build=args.build, limits=limits(args))
    # here and not above: mistakes and help are answered without them
    from ..cosimulation.mapping import parsed
    from ..cosimulation.wiring import fit, out_of_bounds, require

    require(_of_another_plant(dict(args.assignments), plant))
    made = made.replace(mapping=parsed(args.map))
    system = loop(made)
    parameters = _from_files(args, system) | dict(args.assignments)
    require(out_of_bounds(fit(system, parameters=parameters), parameters))
    return made.replace(parameters=parameters)


def _of_another_plant(names: Iterable[str], plant: str) -> Iterator[str]:
    """What to say of parameters that a plant of the project lacks and another one has."""
    from ...fmus.catalogue import FMUS

    for name in names if plant in PLANTS else ():
        place, _, parameter = name.partition("@")[0].partition(".")
        having = [other for other in PLANTS if parameter in FMUS[other].block.Parameters._fields]
        if place == "plant" and having and plant not in having:
            yield f"{name}: {plant} has no parameter {parameter}; --plant {' or '.join(having)} has it"


def settings_of_ours(args: argparse.Namespace, plants: Iterable[str]) -> dict[str, Settings]:
    """What --vehicle, --parameters, --controller and --fmus say for each of these plants, all FMUs being the project's.

    Raises:
        DrivelineError: an FMU is missing.
        ParameterFileError: a file of parameters is refused.
    """
    from ...fmus.building.parameter_files import read_files

    values = read_files(args.vehicle, args.parameters)
    made = {plant: built(plant, folder=args.fmus, controller=args.controller) for plant in plants}
    from ..design.design_trials import loop_parameters

    return {
        plant: each.replace(parameters=loop_parameters(values, plant, args.controller)) for plant, each in made.items()
    }


def settings_of_plants(args: argparse.Namespace) -> dict[str, Settings]:
    """What the options say for each of the plants that --plant names, by default all of the project.

    Raises:
        WiringError, DrivelineError, ParameterFileError: as of `settings`, or two plants have the same name.
    """
    plants = dict.fromkeys(args.plant or PLANTS)
    require_different(plants)
    return {plant: settings(args, plant) for plant in plants}


def settings_of_pairs(args: argparse.Namespace) -> dict[tuple[str, str], Settings]:
    """What the options say for each plant with each controller, by default all of the project, by the names of both.

    Raises:
        WiringError, DrivelineError, ParameterFileError: as of `settings_of_plants` and `settings_of_each`.
    """
    from ..studies.drives.replay import by_name

    plants, controllers = dict.fromkeys(args.plant or PLANTS), by_name(args.controller or PLACES["controller"])
    require_different(plants)
    return {
        (each.plant_name, name): each
        for plant in plants
        for name, each in settings_of_each(args, plant, controllers).items()
    }


def settings_of_each(args: argparse.Namespace, plant: str, controllers: Mapping[str, str]) -> dict[str, Settings]:
    """What the options say for each of several controllers (names or files, by the names that tables give them); the
    FMUs are there then.

    Of several the file of parameters is for those that have all that it names; the others keep theirs.

    Raises:
        WiringError, DrivelineError, ParameterFileError: as of `settings`, or the file is for none of them.
    """
    found, refusals = {}, []
    for name, controller in controllers.items():
        one = argparse.Namespace(**{**vars(args), "controller": controller})
        try:
            found[name] = settings(one, plant)
        except NotTaken as refusal:
            refusals.append(refusal)
            found[name] = settings(argparse.Namespace(**{**vars(one), "parameters": None}), plant)
    if len(refusals) == len(controllers):
        raise refusals[0]
    return found


class NotTaken(DrivelineError):
    """A file of parameters names some that a controller does not have."""


def other_format(args: argparse.Namespace) -> dict[str, Any]:
    """What distinguishes a run by the format of its signals: nothing, if it is the usual one.

    Raises:
        MissingExtra: the package that writes it is not installed.
    """
    require_format(args.format)
    return {} if args.format == "csv" else {"format": args.format}


def as_given(args: argparse.Namespace) -> str:
    """The options that make runs what they are, as they are given."""
    given = [
        ("seed", getattr(args, "seed", None)),
        ("campaign", getattr(args, "campaign", None)),
        *((name, value) for name in ("manoeuvre", "plant") for value in getattr(args, name, None) or ()),
        *_set(args),
        ("build", getattr(args, "build", None)),
        ("fmus", None if args.fmus == BUILD else args.fmus),
    ]
    return _joined(given)


def caption(args: argparse.Namespace) -> str:
    """What a figure, whose title names plant and manoeuvre, says of the options: those that are not the usual ones."""
    usual = {"seed": 1, "step": STEP_SIZE, "scheme": Scheme.PROPAGATED.value, "held": None}
    return _joined([*_set(args), *((n, v) for n, v in vars(args).items() if n in usual and v != usual[n])])


def dampings(given: Settings) -> str:
    """Above a table of runs: what its rows are, and with which controller if it is not the usual one."""
    controller = Path(given.controller).stem
    return DAMPINGS if controller == PLACES["controller"][0] else f"{DAMPINGS} by {controller}"


def _set(args: argparse.Namespace) -> list[tuple[str, Any]]:
    """The options for blocks and parameters."""
    return [
        *((place, block) for place in OTHERS for block in _other_than(PLACES[place][0], getattr(args, place, None))),
        *(("set", f"{name}={value!r}") for name, value in getattr(args, "assignments", ())),
        *(("map", text) for text in getattr(args, "map", ())),
        *((name, getattr(args, name)) for name in ("vehicle", "parameters")),
    ]


def _other_than(usual: str, given: str | list[str] | None) -> list[str]:
    """The blocks of a place, if they are not the usual one alone."""
    blocks = given if isinstance(given, list) else [given or usual]
    return [] if blocks == [usual] else blocks


def _joined(options: Iterable[tuple[str, Any]]) -> str:
    return " ".join(f"--{name} {quote(str(value))}" for name, value in options if value is not None)


def distinguishing(made: Settings, manoeuvre: Manoeuvre | None = None) -> dict[str, Any]:
    """What distinguishes a run of the loop from others: all that was set, and the FMUs: ours by the start values
    that they were built with, others by their content.

    Args:
        manoeuvre: None: several.
    """
    from ...fmus.origin import origin_of
    from ..simulation.provenance import digest
    from ..simulation.simulate import start

    system = loop(made)
    ours = {name: origin_of(path) for name, path in system.instances.items() if name in system.own}
    others = {name: path for name, path in system.instances.items() if name not in system.own}
    own = start(manoeuvre, made.seed) if manoeuvre else {}
    digests = {name: digest(path) for name, path in others.items() if path.is_file()}
    return {
        "fmus": {name: str(as_built(path)) for name, path in system.instances.items()},
        "start_values": {name: origin.start_values for name, origin in ours.items() if origin},
        **({"digests": digests} if digests else {}),
        "parameters": {**own, **made.parameters},
        "seed": made.seed,
        "mapping": made.mapping,
    }


def _from_files(args: argparse.Namespace, system: System) -> dict[str, float]:
    """`instance.parameter` -> value: what --vehicle and --parameters name, for every instance that has it.

    Raises:
        ParameterFileError: a file is refused.
        NotTaken: the controller does not have all that it names.
        WiringError: an FMU that is not ours has a parameter of the same name in another unit.
    """
    if args.vehicle is None and args.parameters is None:
        return {}
    from ...fmus.building.one_car import of_one_car
    from ...fmus.building.parameter_files import for_instances, of_plants, read_files, require_taken, units
    from ...fmus.errors import ParameterFileError
    from ..cosimulation.wiring import fit, require

    interfaces = fit(system).interfaces
    names = {
        instance: {variable.name for variable in interface.of_causality("parameter")}
        for instance, interface in interfaces.items()
    }
    every = set().union(*names.values())
    values = of_one_car(read_files(args.vehicle, args.parameters, others=every), every)
    try:
        require_taken(args.parameters, every, system.instances["controller"].name)
    except ParameterFileError as refusal:
        raise NotTaken(str(refusal)) from refusal
    meant = {name: unit for name, unit in units().items() if name in values}
    if args.vehicle is not None and args.parameters is None:
        LOG.warning("the controller has the gains of the default car; `driveline design` makes those of a vehicle file")
    plant = system.instances["plant"]
    if "plant" not in system.own and (lacking := sorted(of_plants() & values.keys() - names["plant"])):
        LOG.warning("%s has no parameter %s: the file reaches the other blocks alone", plant, ", ".join(lacking))
    require(
        problem
        for instance, interface in interfaces.items()
        for name in sorted(names[instance] & meant.keys())
        if (problem := _other_unit(interface, f"{instance}.{name}", meant[name], system.mapping))
    )
    return for_instances(values, names)


def _other_unit(interface: Any, name: str, meant: str, mapping: Mapping[str, str]) -> str | None:
    """Why the number of a file, in the unit that is meant, does not reach the parameter `instance.name`, or None."""
    from ..cosimulation.interface import unit_of
    from ..cosimulation.unit_conversion import factor

    theirs = mapping.get(name, name.partition(".")[2])
    unit = next(unit_of(variable) for variable in interface.description.modelVariables if variable.name == theirs)
    if unit in (None, "", meant):
        return None
    try:
        factor(unit, meant)
    except ValueError as reason:
        return f"{name} {reason}, the unit of the file"
    if name in mapping:
        return None
    return f"{name} is in {unit}; the file gives it in {meant} (--map {name}={theirs} converts it)"
