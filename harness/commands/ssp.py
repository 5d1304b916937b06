"""Writes the closed loop as a System Structure Package (SSP 1.0, or 2.0 with an FMU of FMI 3.0), one file driveline.ssp
in which everything is that another tool needs to run it: the FMUs, how they are connected and drawn, their parameters
with units, and a source FMU that drives one manoeuvre. Open it in FMPy, libcosim, ecos or OMSimulator and press Run;
see docs/hosts.md.

Its variants are the plants: the first one is what a tool opens that knows none (SystemStructure.ssd). The numbers of
--vehicle, --parameters and --set, the start and the points of the manoeuvre are parameter sets (SSV).

examples:
  driveline ssp --manoeuvre launch --output results/launch
  driveline ssp --plant ValidationVehicle                  only this plant, for tools that know no variants
  driveline ssp --vehicle examples/cars/van.toml --parameters van_gains.toml
  driveline ssp --build python                             FMUs that run Python, for hosts that are Python
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from toolground.arguments import record
from toolground.printing import Printing

from ..loop.places import BUILDS, PLANTS
from ..loop.settings import Settings
from ..manoeuvres.manoeuvre import Manoeuvre
from .jobs import distinguishing, job
from .manoeuvres import Chosen, Listing, manoeuvre
from .options import DriveUnits, Loop, Replacing, controller, output, plants
from .settings import plants_loops

if TYPE_CHECKING:
    from fmuloop.wiring import Fit

    from ..exchange.ssp.package import Variant


@record
class Arguments(Listing, Loop, DriveUnits, Replacing, Printing):
    manoeuvre: Chosen = manoeuvre("one of --list, or a file (default: %(default)s)", "tipin15")
    plant: tuple[str, ...] = plants()
    controller: str = controller()
    output: Path = output("results/ssp", "the package")


def run(args: Arguments) -> int:
    # here and not above: mistakes and help are answered without them
    from fmuloop.parameter_changes import require_constant

    require_constant(dict(args.set), "an SSP")
    given = plants_loops(args)
    from fmublocks.archive import write_archive
    from fmuloop.wiring import fit

    from ...fmus.catalogue import MANOEUVRE
    from ..exchange.ssp.loop_with_source import with_source
    from ..exchange.ssp.package import package
    from ..loop.built_fmus import made_if_missing
    from ..manoeuvres.drivable import require_possible

    first = next(iter(given.values()))
    chosen = args.manoeuvre.with_torque(first.T_max)
    manoeuvre, ssp = chosen.first, args.output / "driveline.ssp"
    same: dict[str, Any] = {name: distinguishing(each, manoeuvre) for name, each in given.items()}
    plants = list(dict.fromkeys(args.plant or PLANTS))
    same |= {"plants": plants, "manoeuvre": manoeuvre.name} | args.manoeuvre.digests
    source = made_if_missing(MANOEUVRE, args.fmus, first.settings.build or BUILDS[0])
    sourced = {name: fit(with_source(each.system, source)) for name, each in given.items()}
    with job(args, args.output / "driveline.json", same, sourced, [ssp], args.manoeuvre.files.values()) as made:
        require_possible(*chosen, given.values())
        variants = {name: _variant(fitted, manoeuvre, given[name].settings) for name, fitted in sourced.items()}
        content = package(variants, manoeuvre)
        made.begin()
        write_archive(content, ssp)
        made.wrote(ssp)
        args.say(f"{manoeuvre.name}, variants {', '.join(variants)}, {ssp.stat().st_size / 1024:.0f} kB")
    return 0


def _variant(fitted: "Fit", manoeuvre: Manoeuvre, given: Settings) -> "Variant":
    from ..exchange.ssp.loop_with_source import points
    from ..exchange.ssp.package import Variant
    from ..simulation.simulate import start

    return Variant(fitted, {**start(manoeuvre, given.seed), **points(manoeuvre, fitted), **given.parameters})
