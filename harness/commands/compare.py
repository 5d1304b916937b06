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
from ..manoeuvres.catalogue import COMPARED
from ..manoeuvres.manoeuvre import Manoeuvre
from ..metrics.run_metrics import Metrics
from ..views.metrics_table import legend
from .jobs import distinguishing, job
from .manoeuvres import Chosen, Listing, chosen, manoeuvre
from .options import DriveUnits, Figures, Loop, Replacing, Report, SignalsFormat, controllers, output, plants
from .settings import all_loops, caption, dampings, say_unknowns

if TYPE_CHECKING:
    from ..loop.resolved import ResolvedLoop
    from ..studies.compare.compare import Outcome

IN_HELP = {"metrics": legend(Metrics), "compared": ", ".join(COMPARED)}

TABLES = ("table.md", "metrics.csv")


@record
class Arguments(Listing, Loop, DriveUnits, Replacing, SignalsFormat, Figures, Report, JsonPrinting):
    manoeuvre: Chosen = manoeuvre("only this one of --list, or that of a file (repeatable; default: ten)")
    plant: tuple[str, ...] = plants()
    controller: tuple[str, ...] = controllers(PLACES["controller"][0])
    output: Path = output("results/compare", "tables, figures and the signals of every run")


def run(args: Arguments) -> int:
    given = all_loops(args, args.plant, args.controller or PLACES["controller"][:1])
    # here and not above: mistakes and help are answered without them
    from ..manoeuvres.drivable import require_possible
    from ..studies.compare.compare import RUNS, cases, loops_of, rows_of, run_cases, write_tables
    from ..studies.compare.compare_report import report
    from ..views.signals_file import signals_path
    from ..views.terminal import print_runs

    requested = args.manoeuvre if args.manoeuvre.manoeuvres else chosen(COMPARED)
    requested = requested.with_torque(next(iter(given.values())).T_max)
    manoeuvres, read = requested.manoeuvres, list(requested.files.values())
    plants, names = (list(dict.fromkeys(key[k] for key in given)) for k in (0, 1))
    options = args.options(caption(args), *((each.name, 0.0, each.duration) for each in manoeuvres.values()))
    fits = {" with ".join(key): each.fit for key, each in given.items()}
    same: dict[str, Any] = {" with ".join(key): distinguishing(each) for key, each in given.items()}
    same |= {"manoeuvres": list(manoeuvres)} | requested.digests | args.other_format
    loops, folder = loops_of(given), args.output / RUNS
    signals = {
        case: signals_path(folder / case.file_name, args.format) for case in cases(plants, list(manoeuvres), names)
    }
    with job(args, args.output / "compare.json", same, fits, [args.output / name for name in TABLES], read) as made:
        require_possible(*requested, given.values())
        made.begin(*signals.values(), *(path.with_suffix(".json") for path in signals.values()))
        outcomes, figures = run_cases(list(signals), args.output, loops, manoeuvres, args.format, options)
        made.found({str(outcome.case): outcome.results for outcome in outcomes})
        title, rows = dampings(names), rows_of(outcomes)
        made.wrote(*write_tables(outcomes, args.output, title), *figures)
        for case, outcome in {outcome.case: outcome for outcome in outcomes}.items():
            _record(outcome, signals[case], loops[case.plant, case.controller], manoeuvres[case.manoeuvre], read)
        for provenance, path in made.reports():
            report(outcomes, manoeuvres, provenance, path)
        of_plants = (each.settings for each in given.values() if "plant" in each.system.own)
        builds = {settings.plant_name: settings.build for settings in of_plants}
        built = ", ".join(f"{plant} {build}" for plant, build in builds.items())
        args.say(f"{f'FMUs: {built}; ' if built else ''}signals of {len(signals)} runs: {folder}")
        say_unknowns(args)
        made.tell(print_runs, rows, title, runs=[each.record for each in outcomes])
    return 0


def _record(
    outcome: "Outcome", signals: Path, resolved: "ResolvedLoop", manoeuvre: Manoeuvre, read: Sequence[Path]
) -> None:
    """Writes what made the signals of a run beside them."""
    from ..simulation.provenance import write_record

    case, found = outcome.case, outcome.results.remarks
    one = {"manoeuvre": case.manoeuvre, "damping": "on" if case.control else "off"}
    fits = {case.plant: resolved.fit}
    write_record(signals.with_suffix(".json"), one | distinguishing(resolved, manoeuvre), fits, [signals], read, found)
