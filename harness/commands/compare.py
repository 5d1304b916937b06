"""Runs ten manoeuvres, or those that are given, on every plant without damping and with each controller, and prints one
table, which goes to table.md in the output folder; all metrics go to metrics.csv, the signals of every run to runs/.

{metrics}

Metrics that make no sense for a manoeuvre, such as the settling of a pulse, are a dash. If none are given: {compared}.

examples:
  driveline compare --plant ValidationVehicle --manoeuvre tipin15 --manoeuvre drive
  driveline compare --controller mine.fmu --controller DampingController --controller SpeedWashout
  driveline compare --plant my_vehicle.fmu --set controller.k_d=1.5 --seed 7 --output results/mine
  driveline compare --manoeuvre examples/manoeuvres/overtaking.toml --window 0.95,1.3 --figures svg
  driveline compare --report comparison.html --json > comparison.json
"""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from toolground.arguments import record
from toolground.printing import JsonPrinting

from ..loop.places import PLACES
from ..loop.settings import Settings
from ..manoeuvres.catalogue import COMPARED
from ..manoeuvres.manoeuvre import Manoeuvre
from ..metrics.run_metrics import Metrics
from ..views.metrics_table import legend
from .jobs import RunJob, distinguishing, job
from .manoeuvres import Chosen, Listing, chosen, manoeuvre
from .options import Figures, Loop, Replacing, Report, SignalsFormat, controllers, output, plants
from .settings import all_settings, caption, dampings, say_unknowns

if TYPE_CHECKING:
    from ..studies.compare.compare import Outcome

IN_HELP = {"metrics": legend(Metrics), "compared": ", ".join(COMPARED)}

TABLES = ("table.md", "metrics.csv")


@record
class Arguments(Listing, Loop, Replacing, SignalsFormat, Figures, Report, JsonPrinting):
    manoeuvre: Chosen = manoeuvre("only this one of --list, or that of a file (repeatable; default: ten)")
    plant: tuple[str, ...] = plants()
    controller: tuple[str, ...] = controllers(PLACES["controller"][0])
    output: Path = output("results/compare", "tables, figures and the signals of every run")


def run(args: Arguments) -> int:
    given = all_settings(args, args.plant, args.controller or PLACES["controller"][:1])
    # here and not above: mistakes and help are answered without them
    from ..manoeuvres.drivable import require_possible
    from ..studies.compare.compare import RUNS, cases, loops_of, rows_of, run_cases, write_tables
    from ..studies.compare.compare_report import report
    from ..views.signals_file import signals_path
    from ..views.terminal import print_runs

    requested = args.manoeuvre if args.manoeuvre.manoeuvres else chosen(COMPARED)
    requested = requested.for_car(next(iter(given.values())))
    manoeuvres, read = requested.manoeuvres, list(requested.files.values())
    plants, names = (list(dict.fromkeys(key[k] for key in given)) for k in (0, 1))
    options = args.options(caption(args), *((each.name, 0.0, each.duration) for each in manoeuvres.values()))
    systems = {" with ".join(key): made for key, made in given.items()}
    same: dict[str, Any] = {name: distinguishing(each) for name, each in systems.items()}
    same |= {"manoeuvres": list(manoeuvres)} | requested.digests | args.other_format
    loops, folder = loops_of(given), args.output / RUNS
    signals = {
        case: signals_path(folder / case.file_name, args.format) for case in cases(plants, list(manoeuvres), names)
    }
    with job(args, args.output / "compare.json", same, systems, [args.output / name for name in TABLES], read) as made:
        require_possible(*requested, made.fits, systems)
        made.begin(*signals.values(), *(path.with_suffix(".json") for path in signals.values()))
        outcomes, figures = run_cases(list(signals), args.output, loops, manoeuvres, args.format, options)
        made.found({str(outcome.case): outcome.results for outcome in outcomes})
        title, rows = dampings(names), rows_of(outcomes)
        made.wrote(*write_tables(outcomes, args.output, title), *figures)
        for outcome, path in zip(outcomes, signals.values(), strict=True):
            case = outcome.case
            one = loops[case.plant, case.controller], manoeuvres[case.manoeuvre]
            _record(made, outcome, path, *one, read)
        for provenance, path in made.reports():
            report(outcomes, manoeuvres, provenance, path)
        builds = {made.plant_name: made.build for made in given.values() if str(made.plant) in PLACES["plant"]}
        built = ", ".join(f"{plant} {build}" for plant, build in builds.items())
        args.say(f"{f'FMUs: {built}; ' if built else ''}signals of {len(outcomes)} runs: {folder}")
        say_unknowns(args)
        made.tell(print_runs, rows, title, runs=[each.record for each in outcomes])
    return 0


def _record(
    made: RunJob, outcome: "Outcome", signals: Path, settings: Settings, manoeuvre: Manoeuvre, read: Sequence[Path]
) -> None:
    """Writes what made the signals of a run beside them."""
    from ..simulation.provenance import write_record

    case, found = outcome.case, outcome.results.remarks
    one = {"manoeuvre": case.manoeuvre, "damping": "on" if case.control else "off"}
    fits = {case.plant: made.fits[f"{case.plant} with {settings.controller_name}"]}
    write_record(signals.with_suffix(".json"), one | distinguishing(settings, manoeuvre), fits, [signals], read, found)
