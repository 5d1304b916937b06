"""What the options of a run say: the arguments of `driveline.simulate`, and what tells runs apart."""

import argparse
import logging
from collections.abc import Iterable, Mapping
from shlex import quote
from typing import Any

from ..base.errors import DrivelineError
from ..cosimulation.limits import Limits
from ..cosimulation.system import Scheme, System
from ..loop.built_fmus import built
from ..loop.places import BUILD, PLACES, STEP_SIZE
from ..manoeuvres.manoeuvre import Manoeuvre
from .options import OTHERS

LOG = logging.getLogger(__name__)


def blocks(args: argparse.Namespace) -> dict[str, Any]:
    """The blocks of the loop beside the plant."""
    return {place: getattr(args, place) for place in OTHERS}


def limits(args: argparse.Namespace) -> Limits:
    """What the options of `add_limits` say."""
    return Limits(args.time_limit, args.unpacked_limit)


def settings(args: argparse.Namespace, plant: str, build: str) -> dict[str, Any]:
    """What the options of `add_loop` say for a plant and a build, as arguments of `driveline.simulate`.

    Raises:
        WiringError: a text of --map is not of the form that it must have, or the FMUs do not have a parameter, or not
            with that value.
        DrivelineError: a file of parameters is refused.
    """
    from ..cosimulation.mapping import parsed
    from ..cosimulation.wiring import fit, out_of_bounds, require
    from ..simulation.simulate import looped

    given = {
        "seed": args.seed,
        "folder": args.fmus,
        "build": build,
        "mapping": parsed(args.map),
        "limits": limits(args),
        **blocks(args),
    }
    system = looped(plant, given)
    parameters = _from_files(args, system) | dict(args.assignments)
    require(out_of_bounds(fit(system, parameters=parameters), parameters))
    return given | {"parameters": parameters}


def settings_of_each(args: argparse.Namespace, plant: str, controllers: Mapping[str, str]) -> dict[str, dict[str, Any]]:
    """What the options say for each of several controllers (names or files, by the names that tables give them), whose
    FMUs are there then.

    Of several the file of parameters is for those that have all that it names; the others keep theirs.

    Raises:
        WiringError, DrivelineError: as of `settings`, or the file is for none of them.
    """
    found, refusals = {}, []
    for name, controller in controllers.items():
        one = argparse.Namespace(**{**vars(args), "controller": controller})
        build = built(plant, args.fmus, args.build, **blocks(one))
        try:
            found[name] = settings(one, plant, build)
        except NotTaken as refusal:
            refusals.append(refusal)
            found[name] = settings(argparse.Namespace(**{**vars(one), "parameters": None}), plant, build)
    if len(refusals) == len(controllers):
        raise refusals[0]
    return found


class NotTaken(DrivelineError):
    """A file of parameters names some that a controller does not have."""


def other_format(args: argparse.Namespace) -> dict[str, Any]:
    """What distinguishes a run by the format of its signals: nothing, if it is the usual one."""
    return {} if args.format == "csv" else {"format": args.format}


def as_given(args: argparse.Namespace) -> str:
    """The options that make a run what it is, as they are given."""
    given = [
        ("seed", args.seed),
        *(("plant", plant) for plant in args.plant or ()),
        *_set(args),
        ("build", args.build),
        ("fmus", None if args.fmus == BUILD else args.fmus),
    ]
    return _joined(given)


def caption(args: argparse.Namespace) -> str:
    """What a figure, whose title names plant and manoeuvre, says of the options: those that are not the usual ones."""
    usual = {"seed": 1, "step": STEP_SIZE, "scheme": Scheme.PROPAGATED.value, "held": None}
    return _joined([*_set(args), *((n, v) for n, v in vars(args).items() if n in usual and v != usual[n])])


def _set(args: argparse.Namespace) -> list[tuple[str, Any]]:
    """The options for blocks and parameters."""
    return [
        *((place, block) for place, given in blocks(args).items() for block in _other_than(PLACES[place][0], given)),
        *(("set", f"{name}={value!r}") for name, value in args.assignments),
        *(("map", text) for text in args.map),
        *((name, getattr(args, name)) for name in ("vehicle", "parameters")),
    ]


def _other_than(usual: str, given: str | list[str] | None) -> list[str]:
    """The blocks of a place, if they are not the usual one alone."""
    blocks = given if isinstance(given, list) else [given or usual]
    return [] if blocks == [usual] else blocks


def _joined(options: Iterable[tuple[str, Any]]) -> str:
    return " ".join(f"--{name} {quote(str(value))}" for name, value in options if value is not None)


def distinguishing(given: Mapping[str, Any], system: System, manoeuvre: Manoeuvre | None) -> dict[str, Any]:
    """What distinguishes a run of the loop from others: all that was set, and the FMUs: ours by the start values
    that they were built with, others by their content.

    Args:
        given: of `settings`.
        manoeuvre: None: several.
    """
    from ...fmus.origin import origin_of
    from ..simulation.provenance import digest
    from ..simulation.simulate import start

    ours = {name: origin_of(path) for name, path in system.instances.items() if name in system.own}
    others = {name: path for name, path in system.instances.items() if name not in system.own}
    own = start(manoeuvre, given["seed"]) if manoeuvre else {}
    digests = {name: digest(path) for name, path in others.items() if path.is_file()}
    return {
        "fmus": {name: str(path) for name, path in system.instances.items()},
        "start_values": {name: origin.start_values for name, origin in ours.items() if origin},
        **({"digests": digests} if digests else {}),
        "parameters": own | given["parameters"],
        "seed": given["seed"],
        "mapping": given["mapping"],
    }


def _from_files(args: argparse.Namespace, system: System) -> dict[str, float]:
    """`instance.parameter` -> value: what --vehicle and --parameters name, for every instance that has it.

    Raises:
        DrivelineError: a file is refused.
        WiringError: an FMU that is not ours has a parameter of the same name in another unit.
    """
    if args.vehicle is None and args.parameters is None:
        return {}
    from ...fmus.building.parameter_files import for_instances, of_plants, read_files, require_taken, units
    from ...fmus.errors import ParameterFileError
    from ..cosimulation.wiring import fit, require

    interfaces = fit(system).interfaces
    names = {
        instance: {variable.name for variable in interface.of_causality("parameter")}
        for instance, interface in interfaces.items()
    }
    every = set().union(*names.values())
    try:
        values = read_files(args.vehicle, args.parameters, others=every)
    except ParameterFileError as refusal:
        raise DrivelineError(str(refusal)) from refusal
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
