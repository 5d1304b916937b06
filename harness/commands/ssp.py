"""`driveline ssp`: the loop as a System Structure Package."""

import argparse
from pathlib import Path
from typing import Any

from ..base.known_names import require_different
from ..loop.built_fmus import built, made_if_missing
from ..loop.places import PLANTS
from .manoeuvres import add_manoeuvre, chosen, digests, files, require_files_drivable
from .options import add_loop, add_output, add_plant, add_printing
from .printing import Printer
from .settings import blocks, distinguishing, settings

DESCRIPTION = """\
Writes the closed loop as a System Structure Package (SSP 1.0), one file driveline.ssp in which everything is
that another tool needs to run it: the FMUs, how they are connected and drawn, their parameters with units,
and a source FMU that drives one manoeuvre. Open it in FMPy, libcosim, ecos or OMSimulator and press Run, or
unpack it and open the project that it holds in MasterSim; docs/ssp.md has the steps for each.

Its variants are the plants: the first one is what a tool opens that knows none (SystemStructure.ssd). The
numbers of --vehicle, --parameters and --set, the start and the points of the manoeuvre are parameter sets (SSV),
which can be edited there. The manoeuvre is one made of straight lines: of the catalogue all but creep and prbs, or a
file of your own with steps, ramps, pulses or points (docs/manoeuvres.md).
"""

EXAMPLES = """\
examples:
  driveline ssp
  driveline ssp --manoeuvre launch --output results/launch
  driveline ssp --plant ValidationVehicle                  only this plant, for tools that know no variants
  driveline ssp --vehicle examples/cars/van.toml --parameters van_gains.toml
  driveline ssp --controller NoDamping --output results/undamped
  driveline ssp --build python                             FMUs that run Python, for hosts that are Python
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_manoeuvre(parser, "a name of the catalogue, or a file (default: %(default)s)", default="tipin15")
    add_plant(parser, several=True)
    add_loop(parser)
    add_output(parser, "results/ssp", "the package", of_a_run=True)
    add_printing(parser)


def run(args: argparse.Namespace) -> int:
    plants = list(dict.fromkeys(args.plant or PLANTS))
    require_different(plants)
    builds = {plant: built(plant, args.fmus, args.build, **blocks(args)) for plant in plants}
    # here and not above: mistakes and help are answered without them
    from ...fmus.archive import write_archive
    from ...fmus.manoeuvre import FMU
    from ..exchange.ssp.loop_with_source import points, with_source
    from ..exchange.ssp.package import Variant, package
    from ..simulation.provenance import recorded
    from ..simulation.simulate import looped, start

    out = Printer(args)
    (manoeuvre,) = chosen([args.manoeuvre]).values()
    given = {Path(plant).stem: settings(args, plant, build) for plant, build in builds.items()}
    systems = {Path(plant).stem: looped(plant, given[Path(plant).stem]) for plant in plants}
    ssp, record = args.output / "driveline.ssp", args.output / "driveline.json"
    same: dict[str, Any] = {name: distinguishing(given[name], systems[name], manoeuvre) for name in systems}
    same |= {"plants": plants, "manoeuvre": manoeuvre.name} | digests([args.manoeuvre])
    read = [*files([args.manoeuvre]).values(), args.vehicle, args.parameters]
    with made_if_missing(FMU, args.fmus, builds[plants[0]]) as source:
        sourced = {name: with_source(system, source) for name, system in systems.items()}
        with recorded(record, same, sourced, read, [ssp], args.replace) as made:
            variants = {}
            for name, fitted in made.fits.items():
                require_files_drivable([args.manoeuvre], {manoeuvre.name: manoeuvre}, fitted, given[name]["parameters"])
                lines = points(manoeuvre, fitted)
                variants[name] = Variant(fitted, start(manoeuvre, args.seed) | lines | given[name]["parameters"])
            content = package(variants, manoeuvre)
            made.begin()
            write_archive(content, ssp)
            made.files.append(ssp)
    out.say(f"{ssp} ({ssp.stat().st_size / 1024:.0f} kB): {manoeuvre.name}, variants {', '.join(variants)}")
    out.say(f"made by: {record} (version, FMUs, parameters, units)")
    return 0
