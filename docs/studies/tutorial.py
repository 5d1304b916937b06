"""What the tutorial shows: a tip-in that swings, the same one damped, with other gains, and on a van."""

from collections.abc import Mapping
from typing import Any

from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.design.loop_parameters import loop_parameters
from driveline.harness.loop.places import PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.for_car import for_car, given_torque
from driveline.harness.metrics.evaluate import at_samples, evaluate
from driveline.harness.simulation.simulate import simulate
from driveline.harness.views.figure_options import FigureOptions
from driveline.harness.views.run_figure import run_drawing
from driveline.harness.views.signal_lines import WITHOUT
from driveline.harness.views.step_figure import step_drawing
from fmuloop.many_runs import run_many
from fmuloop.results import Results

from .data_file import ROOT
from .design_trials import own_gains
from .results import COLUMNS, DAMPINGS, metrics_cells
from .study import Measured, Study, Table

TIPIN = MANOEUVRES["tipin15"]
VAN = ROOT / "examples" / "cars" / "van.toml"
GAINS = (0.0, 0.5, 1.0, 2.0, 4.0)
"""Values of k_d."""


def cars() -> dict[str, dict[str, Any]]:
    """Parameters of the loop, by what they are."""
    van = read_vehicle(VAN)
    return {
        "default car": {},
        **{f"default car, k_d = {k_d:g}": {"controller.k_d": k_d} for k_d in GAINS},
        "van, default gains": loop_parameters(van, PLANTS[0]),
        "van, own gains": loop_parameters({**van, **own_gains(VAN)}, PLANTS[0]),
    }


def _run(row: tuple[Mapping[str, Any], bool]) -> Results:
    parameters, control = row
    return simulate(for_car(TIPIN, given_torque(parameters)), parameters=parameters, control=control)


def _table(rows: Mapping[str, tuple[Mapping[str, Any], bool]]) -> Table:
    runs = zip(rows.values(), run_many(_run, rows.values(), label="tutorial"), strict=True)
    cells = (
        metrics_cells(evaluate(results, for_car(TIPIN, given_torque(parameters)))) for (parameters, _), results in runs
    )
    return Table("tip-in", COLUMNS, dict(zip(rows, cells, strict=True)))


def rows() -> dict[str, tuple[Mapping[str, Any], bool]]:
    """All runs: parameters, and whether there is damping."""
    of = cars()
    without = {f"{name}, off": (of[name], False) for name in ("default car", "van, default gains")}
    return {**without, **{name: (parameters, True) for name, parameters in of.items()}}


def measure() -> Measured:
    both = {name: at_samples(simulate(TIPIN, control=control)) for name, control in DAMPINGS.items()}
    of_van = cars()["van, own gains"]
    van = {name: at_samples(_run((of_van, control))) for name, control in DAMPINGS.items()}
    title = f"{PLANTS[0]}, {TIPIN.description}, damping off"
    figures = {
        "oscillation": run_drawing(both[WITHOUT], TIPIN, title, FigureOptions(window=(0.8, 3.0))),
        "damped": step_drawing(both, TIPIN, PLANTS[0]),
        "van": step_drawing(van, for_car(TIPIN, given_torque(of_van)), f"{PLANTS[0]}, van"),
    }
    return Measured({"tipin15": _table(rows())}, figures)


SENTINELS = ("van, own gains", "default car, k_d = 1")


def again() -> dict[str, Table]:
    return {"tipin15": _table({name: (cars()[name], True) for name in SENTINELS})}


STUDY = Study("what the tutorial shows", measure, again, {"tipin15": SENTINELS}, seconds=10)
