"""Computes the gains of the controller for the car of a vehicle file and prints them as TOML, each with its unit and
meaning, or writes them to a file that the other commands take as --parameters (docs/control.md). A file of parameters
can set limits: with its T_take_max and T_add_max the control never takes or adds more, whatever the car would need.

With --search the parameters of the law are searched instead, for this or another controller, by a cost over all
manoeuvres (docs/calibration.md). The folder gets all candidates, what made them, the gains of the one that is chosen,
and the front between comfort and response. A search that was stopped goes on there with the same command, and another
--character chooses from the same candidates. Without a search, --character makes the computed gains softer or harder.

examples:
  driveline design                                          the gains for the default car, only printed
  driveline design --vehicle examples/cars/van.toml --output van_gains.toml
  driveline design --character 0.8                          softer
  driveline design --search results/design                  searched, in some minutes
  driveline design --search results/design --character 0.8  softer, from the same candidates
"""

from importlib.metadata import version
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

from toolground.arguments import record
from toolground.errors import UserError

from ..loop.places import PLANTS
from .design_search import Search, require_search, run_search
from .options import file_of, write_toml

if TYPE_CHECKING:
    from ..design.design_weights import Weights

COMMENT = """\
Gains of the DampingController for {car}, by `driveline design` (driveline-damping {version}).
Drive train of the design model at 15 km/h: {0.frequency:.2f} Hz, damping ratio {0.damping_ratio:.3f}.
With control: {1.frequency:.2f} Hz, damping ratio {1.damping_ratio:.2f}
({meant})."""


@record
class Arguments(Search):
    parameters: Path | None = file_of("with limits, T_take_max and T_add_max")


def run(args: Arguments) -> int:
    if args.search is not None:
        if args.parameters is not None:
            raise UserError("--parameters has limits for computed gains: leave it out, or --search")
        return run_search(args, args.search)
    require_search(args)
    from ..design.unknowns import unknowns_line

    text = designed(args.vehicle, limits=args.parameters, character=args.character)
    lacks = unknowns_line(args.vehicle)
    if args.output is None and not args.silent:
        print(text.rstrip())
    elif args.output is not None:
        write_toml(text, args.output, args.replace)
        args.say(f"gains: {args.output}")
    if lacks and not args.silent:
        print(lacks if args.output else "\n".join(f"# {line}" for line in wrap(lacks, 118)))
    return 0


def designed(
    vehicle: Path | None = None,
    weights: "Weights | None" = None,
    limits: Path | None = None,
    character: float | None = None,
) -> str:
    """The file of gains for the car of a vehicle file, by default for the default car.

    Args:
        weights: of the design (default: those of the default gains).
        limits: file with the most that the control may take and add.
        character: from 0, sport, to 1, comfort.

    Raises:
        ParameterFileError: a file is refused, or the limits have something else.
        DesignError: there is no controller for this car.
    """
    from ...fmus.building.parameter_files import ParameterFileError, read_parameters, read_vehicle, require_taken
    from ..design.design import AUTHORITY, gains_file, gains_of
    from ..design.design_weights import WEIGHTS, records
    from ..design.kalman import DesignError
    from ..design.remedies import cause
    from ..studies.margins.car_properties import swing
    from ..studies.margins.modes import MEANT

    entries = read_vehicle(vehicle) if vehicle else {}
    require_taken(limits, AUTHORITY, f"a file of limits ({' and '.join(AUTHORITY)})")
    most = read_parameters(limits) if limits else {}
    if nothing := [name for name in most if most[name] == 0.0]:
        raise ParameterFileError(f"{limits}: {nothing[0]} = 0: a limit must be above 0 N.m")
    plant, motor, can = records(entries)
    try:
        gains = gains_of(plant, motor, can, weights or WEIGHTS, most, 0.5 if character is None else character)
    except DesignError as refusal:
        raise DesignError(f"{refusal}{cause(plant, motor, can, weights or WEIGHTS)}") from refusal
    # the limits of a user may be too small for any linear loop
    train = swing(PLANTS[0], entries, gains | dict.fromkeys(AUTHORITY, motor.T_max))
    if train.damped is None or train.damped.damping_ratio <= train.damping_ratio:
        would = (
            f"damping ratio would be {train.damped.damping_ratio:.2f}" if train.damped else "loop would not be stable"
        )
        raise DesignError(
            f"the motor is too slow for this car (tau = {motor.tau:g} s, drive train {train.frequency:.2f} Hz): the "
            f"{would}; without control the damping ratio is {train.damping_ratio:.2f}"
        )
    car = vehicle.name if vehicle else "the default car"
    if weights and weights.washout != WEIGHTS.washout:
        car += f", with the washout at {weights.washout / WEIGHTS.washout:.2f} of its frequency"
    if character is not None:
        car += f", character {character:g} (0 sport, 1 comfort)"
    comment = COMMENT.format(train, train.damped, car=car, version=version("driveline-damping"), meant=MEANT)
    return gains_file(gains, comment)
