"""The options that several commands have, each with its check, and how they are read."""

import argparse
import logging
from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any

from fmus.options import add_parameter_files, folder, output_folder

from ..cosimulation.limits import USUAL, Limits
from ..cosimulation.system import BUILD, BUILD_HELP, BUILDS, PLACES, PLANTS, System, loop
from ..errors import DrivelineError
from ..manoeuvres.manoeuvre import Manoeuvre
from ..plain import quoted

LOG = logging.getLogger(__name__)

LARGEST_SEED = 2**31 - 1
"""Of an FMI Integer."""

OTHERS = {"controller": "damping control", "motor": "motor with its torque loop", "can": "wheel speeds over the bus"}
"""The blocks of the loop beside the plant, and what they are."""


def add_plant(parser: argparse.ArgumentParser, several: bool = False, default: str = PLANTS[0]) -> None:
    """--plant; `several` can be given, or one with a default."""
    block = f"{' or '.join(PLANTS)}, or an FMU with the same interface"
    if several:
        action = parser.add_argument(
            "--plant", metavar="NAME|FILE", action="append", help=f"only this plant, {block} (repeatable)"
        )
    else:
        action = parser.add_argument(
            "--plant", metavar="NAME|FILE", default=default, help=f"{block} (default: %(default)s)"
        )
    action.complete = _names_or_fmus(PLANTS)  # type: ignore[attr-defined]


def _names_or_fmus(names: Sequence[str]) -> dict[str, Any]:
    """What shtab is told to complete one of the names or the path of an FMU."""
    function = f"_driveline_{names[0]}"
    return {
        "bash": function,
        "zsh": function,
        "preamble": {
            "bash": f"""\
{function}() {{
  compgen -W "{" ".join(names)}" -- $1
  compgen -f -X "!*.fmu" -- $1
  compgen -d -- $1
}}""",
            "zsh": f"""\
{function}() {{
  _alternative "names:block:({" ".join(names)})" "files:FMU:_files -g '*.fmu'"
}}""",
        },
    }


def add_loop(parser: argparse.ArgumentParser) -> None:
    """What every run of the loop can be given beside the plant; `settings` reads it."""
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        type=assignment,
        dest="assignments",
        metavar="INSTANCE.PARAMETER=VALUE",
        help="sets a parameter, in SI units, whatever the files say (repeatable)",
    )
    add_parameter_files(parser)
    for place, meaning in OTHERS.items():
        names = PLACES[place]
        action = parser.add_argument(
            f"--{place}",
            metavar="NAME|FILE",
            default=names[0],
            help=f"{meaning}: an FMU in the place of %(default)s",
        )
        action.complete = _names_or_fmus(names)  # type: ignore[attr-defined]
    parser.add_argument(
        "--map",
        action="append",
        default=[],
        metavar="INSTANCE.NAME=THEIRS",
        help="what an FMU calls a variable of the loop, as in plant.T_gear=Shaft.tau; units are converted (repeatable)",
    )
    parser.add_argument("--seed", type=seed, default=1, help="of the sensor noise (default: %(default)s)")
    parser.add_argument("--build", choices=BUILDS, help=BUILD_HELP)
    add_fmus(parser)
    add_limits(parser)


def add_fmus(parser: argparse.ArgumentParser) -> None:
    action = parser.add_argument(
        "--fmus",
        type=folder,
        default=BUILD,
        metavar="FOLDER",
        help="of the built FMUs, with the native ones in its folder native (default: %(default)s)",
    )
    action.complete = "directory"  # type: ignore[attr-defined]


def add_limits(parser: argparse.ArgumentParser) -> None:
    """What FMUs that are not ours may take; `limits` reads it."""
    parser.add_argument(
        "--time-limit",
        type=seconds,
        default=USUAL.call,
        metavar="SECONDS",
        help="how long a call of an FMU that is given by its path may last (default: %(default)g)",
    )
    parser.add_argument(
        "--unpacked-limit",
        type=megabytes,
        default=USUAL.unpacked,
        metavar="MB",
        help=f"how much it may unpack to (default: {USUAL.unpacked / 1e6:.0f})",
    )


def limits(args: argparse.Namespace) -> Limits:
    """What the options of `add_limits` say."""
    return Limits(args.time_limit, args.unpacked_limit)


def add_output(parser: argparse.ArgumentParser, default: str, files: str, of_a_run: bool = False) -> None:
    """--output, the folder for everything that the command writes; `files` says what that is.

    Where they are the results of a run that options distinguish, --replace too.
    """
    action = parser.add_argument(
        "--output",
        type=output_folder,
        default=default,
        metavar="FOLDER",
        help=f"for {files} (default: %(default)s)",
    )
    action.complete = "directory"  # type: ignore[attr-defined]
    if of_a_run:
        parser.add_argument("--replace", action="store_true", help="replace results that are those of another run")


def add_printing(parser: argparse.ArgumentParser, table: bool = False) -> None:
    """--quiet and, of a command that prints a table, --json."""
    parser.add_argument("--quiet", action="store_true", help="print only what goes wrong")
    if table:
        parser.add_argument("--json", action="store_true", help="print one JSON document in the place of the table")


def assignment(text: str) -> tuple[str, float]:
    """`instance.parameter` and value of `instance.parameter=value`; true and false are 1 and 0."""
    name, equals, value = (part.strip() for part in text.partition("="))
    instance, dot, parameter = name.partition(".")
    try:
        number = {"true": 1.0, "false": 0.0}.get(value.lower())
        number = float(value) if number is None else number
    except ValueError:
        number = None
    if not (instance and dot and parameter and equals) or number is None:
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not of the form plant.J_1=0.06")
    if not isfinite(number):
        raise argparse.ArgumentTypeError(f"{quoted(text)}: a parameter is a finite number")
    return name, number


def seed(text: str) -> int:
    """A whole number that an FMI Integer holds."""
    try:
        number = int(text)
    except ValueError:
        number = -1
    if not 0 <= number <= LARGEST_SEED:
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a whole number from 0 to {LARGEST_SEED}")
    return number


def seconds(text: str) -> float:
    """A time above 0 s."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not (isfinite(number) and number > 0.0):
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a time above 0 s")
    return number


def megabytes(text: str) -> int:
    """A size above 0 MB, in bytes."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not (isfinite(number * 1e6) and number > 0.0):
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a size above 0 MB")
    return round(number * 1e6)


def blocks(args: argparse.Namespace) -> dict[str, Any]:
    """The blocks of the loop beside the plant."""
    return {place: getattr(args, place) for place in OTHERS}


def settings(args: argparse.Namespace, plant: str, build: str) -> dict[str, Any]:
    """What the options of `add_loop` say for a plant and a build, as arguments of `harness.simulate.simulate`.

    Raises:
        WiringError: a text of --map is not of the form that it must have.
        DrivelineError: a file of parameters is refused.
    """
    from ..cosimulation.mapping import parsed

    mapping = parsed(args.map)
    system = loop(plant, args.fmus, build, mapping=mapping, limits=limits(args), **blocks(args))
    return {
        "parameters": _from_files(args, system) | dict(args.assignments),
        "seed": args.seed,
        "folder": args.fmus,
        "build": build,
        "mapping": mapping,
        "limits": limits(args),
        **blocks(args),
    }


def distinguishing(given: Mapping[str, Any], system: System, manoeuvre: Manoeuvre | None) -> dict[str, Any]:
    """What distinguishes a run of the loop from others: all that was set, and the FMUs: ours by the start values
    that they were built with, others by their content.

    Args:
        given: of `settings`.
        manoeuvre: None: several.
    """
    from fmus.origin import origin_of

    from ..provenance import digest
    from ..simulate import start

    ours = {name: origin_of(path) for name, path in system.instances.items() if name in system.own}
    others = {name: path for name, path in system.instances.items() if name not in system.own}
    own = start(manoeuvre, given["seed"]) if manoeuvre else {}
    return {
        "fmus": {name: str(path) for name, path in system.instances.items()},
        "start_values": {name: origin.start_values for name, origin in ours.items() if origin},
        "digests": {name: digest(path) for name, path in others.items() if path.is_file()},
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
    from fmus.errors import ParameterFileError
    from fmus.parameter_files import for_instances, of_plants, read_files, units

    from ..cosimulation.wiring import fit, require

    interfaces = fit(system).interfaces
    names = {
        instance: {variable.name for variable in interface.of_causality("parameter")}
        for instance, interface in interfaces.items()
    }
    try:
        values = read_files(args.vehicle, args.parameters, others=set().union(*names.values()))
    except ParameterFileError as refusal:
        raise DrivelineError(str(refusal)) from refusal
    meant = {name: unit for name, unit in units().items() if name in values}
    if args.vehicle is not None and args.parameters is None:
        LOG.warning("the controller has the gains of the default car; `driveline design` makes those of a vehicle file")
    plant = system.instances["plant"]
    if plant.stem not in PLANTS and (lacking := sorted(of_plants() & values.keys() - names["plant"])):
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
    from ..cosimulation.units import factor

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
