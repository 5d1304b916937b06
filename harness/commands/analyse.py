"""Analyses the loop with a controller of the project, or of a Python file, and prints its margins with the true delays:
gain, phase, delay and M_s. The output folder gets margins.csv, sensitivity.csv, analysis.json (all results, and what
made them) and the figures: Bode, Nyquist, poles, the describing function of the backlash, the sensitivity of metrics.

The linear model is that of the blocks themselves, with the teeth in contact.

examples:
  driveline analyse --controller SpeedWashout --output results/washout
  driveline analyse --controller my_controller.py --plant TwoMassDriveline
  driveline analyse --vehicle examples/cars/van.toml --parameters van_gains.toml --output results/van
  driveline analyse --plant TwoMassDriveline --json > analysis.json
"""

from math import isfinite
from pathlib import Path
from typing import Any

from toolground.arguments import option, record
from toolground.printing import JsonPrinting

from ..loop.places import PLACES, PLANTS
from ..loop.settings import Settings
from .jobs import distinguishing, job
from .options import FmuFolder, ParameterFiles, Replacing, controller_with_equations, output
from .settings import warn_of_gains


@record
class Arguments(ParameterFiles, FmuFolder, Replacing, JsonPrinting):
    plant: tuple[str, ...] = option(
        (), f"the car: {' or '.join(PLANTS)} (repeatable; default: both)", choices=PLANTS, metavar="NAME"
    )
    controller: str = controller_with_equations(
        PLACES["controller"][0], "damping control: one of the project (default: %(default)s), or a Python file"
    )
    output: Path = output("results/analyse", "the tables and the figures")


def run(args: Arguments) -> int:
    # here and not above: mistakes and help are answered without them
    from ..loop.resolved import resolve_all
    from ..studies.margins.analysis_report import announce, write
    from ..studies.margins.loop_analysis import analyse

    settings = {
        (plant, args.controller): Settings(plant, args.controller, folder=args.fmus)
        for plant in dict.fromkeys(args.plant or PLANTS)
    }
    loops = resolve_all(settings, args.vehicle, args.parameters).values()
    given = {each.settings.plant_name: each for each in loops}
    warn_of_gains(args.vehicle, args.parameters, given.values())
    same = {plant: distinguishing(each) for plant, each in given.items()}
    fits = {plant: each.fit for plant, each in given.items()}
    with job(args, args.output / "analysis.json", same, fits, [args.output / "margins.csv"]) as made:
        found = analyse(given)
        made.begin()
        made.wrote(*write(found, args.output))
        made.tell(announce, found, **finite(found.record))
    return 0


def finite(content: Any) -> Any:
    """The same with None for what is no finite number."""
    if isinstance(content, dict):
        return {name: finite(value) for name, value in content.items()}
    if isinstance(content, list):
        return [finite(value) for value in content]
    return None if isinstance(content, float) and not isfinite(content) else content
