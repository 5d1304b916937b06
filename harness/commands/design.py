"""Computes the gains of the controller for the car of a vehicle file and prints them as TOML, each with its
unit and meaning, or writes them to a file that the other commands take as --parameters. What the vehicle
file does not name is that of the default car. docs/control.md says how the gains come about.

With --search the parameters of the law are searched instead, for this or another controller: by a cost over all
manoeuvres on both plants and at corners of the parameter box, see docs/tuning.md. The folder gets all candidates
(evaluations.csv), what made them (search.json), the gains of the one that is chosen (gains.toml) and the front between
comfort and response (front.png and .pdf). A search that was stopped goes on there with the same command, and another
--character chooses from the same candidates.

examples:
  driveline design --vehicle examples/cars/van.toml --output van_gains.toml
  driveline simulate --vehicle examples/cars/van.toml --parameters van_gains.toml
  driveline design                                          the gains for the default car, only printed
  driveline design --search results/design                  searched, in some minutes
  driveline design --search results/design --character 0.8  softer, from the same candidates
  driveline design --search results/washout --controller SpeedWashout
"""

import argparse
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from ...fmus.building.options import file
from .options import add_printing, add_replace
from .printing import Printer
from .search_options import add_search, require_search, run_search, write_toml

if TYPE_CHECKING:
    from ..design.design_weights import Weights

COMMENT = """\
Gains of the DampingController for {car}, by `driveline design` (driveline-damping {version}).
Drive train: {alone.frequency:.2f} Hz; damped: {damped.frequency:.2f} Hz, damping ratio {damped.damping_ratio:.2f}."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    for option, meaning in (("--vehicle", "the car (default: that of all blocks)"), ("--output", "for the gains")):
        parser.add_argument(option, type=file, metavar="FILE.toml", help=meaning)
    add_search(parser)
    add_replace(parser)
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    if args.search is not None:
        return run_search(args)
    require_search(args)
    text, out = designed(args.vehicle), Printer(args)
    if args.output is None:
        out.say(text.rstrip())
    else:
        write_toml(text, args.output, args.replace)
        out.say(f"gains: {args.output}")
    return 0


def designed(vehicle: Path | None = None, weights: "Weights | None" = None) -> str:
    """The file of gains for the car of a vehicle file, by default for the default car.

    Args:
        weights: of the design (default: those of the default gains).

    Raises:
        ParameterFileError: the vehicle file is refused.
        DesignError: there is no controller for this car.
    """
    from ...fmus.building.parameter_files import read_vehicle
    from ..design.design import gains_file, gains_of
    from ..design.design_weights import WEIGHTS, records
    from ..design.kalman import DesignError
    from ..studies.margins.modes import swing

    plant, motor, can = records(read_vehicle(vehicle) if vehicle else {})
    gains = gains_of(plant, motor, can, weights or WEIGHTS)
    alone, damped = swing(plant, motor, gains)
    if damped.damping_ratio <= alone.damping_ratio:
        raise DesignError(
            f"the motor is too slow for this car (tau = {motor.tau:g} s, drive train {alone.frequency:.2f} Hz): "
            f"the damping ratio would be {damped.damping_ratio:.2f}, it is {alone.damping_ratio:.2f} without damping"
        )
    car = vehicle.name if vehicle else "the default car"
    if weights and weights.washout != WEIGHTS.washout:
        car += f", with the washout at {weights.washout / WEIGHTS.washout:.2f} of its frequency"
    return gains_file(gains, COMMENT.format(car=car, version=version("driveline-damping"), alone=alone, damped=damped))
