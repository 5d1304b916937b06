"""Writes the closed loop as a System Structure Package (SSP 1.0), one file driveline.ssp in which everything is
that another tool needs to run it: the FMUs, how they are connected and drawn, their parameters with units,
and a source FMU that drives one manoeuvre. Open it in FMPy, libcosim, ecos or OMSimulator and press Run, or
unpack it and open the project that it holds in MasterSim; docs/ssp.md has the steps for each.

Its variants are the plants: the first one is what a tool opens that knows none (SystemStructure.ssd). The
numbers of --vehicle, --parameters and --set, the start and the points of the manoeuvre are parameter sets (SSV),
which can be edited there. A manoeuvre of your own is made of steps, ramps, pulses or points, or its demand is a sine
or a binary torque (docs/manoeuvres.md).

examples:
  driveline ssp
  driveline ssp --manoeuvre launch --output results/launch
  driveline ssp --plant ValidationVehicle                  only this plant, for tools that know no variants
  driveline ssp --vehicle examples/cars/van.toml --parameters van_gains.toml
  driveline ssp --controller NoDamping --output results/undamped
  driveline ssp --build python                             FMUs that run Python, for hosts that are Python
"""

import argparse
from typing import TYPE_CHECKING, Any

from ..loop.built_fmus import made_if_missing
from ..loop.places import BUILDS, PLANTS
from ..loop.settings import Settings, loop
from ..manoeuvres.manoeuvre import Manoeuvre
from .course import job
from .manoeuvres import add_manoeuvre, chosen
from .options import add_loop, add_output, add_plant, add_printing
from .settings import distinguishing, settings_of_plants

if TYPE_CHECKING:
    from ..cosimulation.wiring import Fit
    from ..exchange.ssp.package import Variant


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_manoeuvre(parser, "a name of the catalogue, or a file (default: %(default)s)", default="tipin15")
    add_plant(parser, several=True)
    add_loop(parser)
    add_output(parser, "results/ssp", "the package", of_a_run=True)
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    # here and not above: mistakes and help are answered without them
    from ..cosimulation.parameter_changes import require_constant

    require_constant(dict(args.assignments), "an SSP")
    given = {each.plant_name: each for each in settings_of_plants(args).values()}
    from ...fmus.archive import write_archive
    from ...fmus.catalogue import MANOEUVRE
    from ..exchange.ssp.loop_with_source import with_source
    from ..exchange.ssp.package import package

    asked = chosen([args.manoeuvre])
    (manoeuvre,) = asked.manoeuvres.values()
    ssp = args.output / "driveline.ssp"
    same: dict[str, Any] = {name: distinguishing(each, manoeuvre) for name, each in given.items()}
    same |= {"plants": list(dict.fromkeys(args.plant or PLANTS)), "manoeuvre": manoeuvre.name} | asked.digests
    build = next(iter(given.values())).build or BUILDS[0]
    source = made_if_missing(MANOEUVRE, args.fmus, build)
    sourced = {name: with_source(loop(each), source) for name, each in given.items()}
    with job(args, args.output / "driveline.json", same, sourced, [ssp], list(asked.files.values())) as made:
        asked.require_drivable(made.fits, given)
        variants = {name: _variant(fitted, manoeuvre, given[name]) for name, fitted in made.fits.items()}
        content = package(variants, manoeuvre)
        made.begin()
        write_archive(content, ssp)
        made.wrote(ssp)
        made.out.say(f"{manoeuvre.name}, variants {', '.join(variants)}, {ssp.stat().st_size / 1024:.0f} kB")
    return 0


def _variant(fitted: "Fit", manoeuvre: Manoeuvre, given: Settings) -> "Variant":
    from ..exchange.ssp.loop_with_source import points
    from ..exchange.ssp.package import Variant
    from ..simulation.simulate import start

    return Variant(fitted, {**start(manoeuvre, given.seed), **points(manoeuvre, fitted), **given.parameters})
