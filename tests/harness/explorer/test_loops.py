"""The module of a page gives the numbers of `simulate`, of `evaluate` and of a vehicle file."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from driveline.fmus.building import one_car
from driveline.fmus.building.one_car import DEFAULT_CAR, FOLLOW
from driveline.fmus.errors import ParameterFileError
from driveline.harness.explorer.content import WORTH
from driveline.harness.explorer.follow import following
from driveline.harness.explorer.knobs import COMFORT, SPORT
from driveline.harness.explorer.module import named
from driveline.harness.explorer.signal_data import manoeuvre_data
from driveline.harness.loop.places import COMPARATORS, PLANTS
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.composed import composed
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.parts import points, prbs, sine
from driveline.harness.metrics.evaluate import COLUMNS, evaluate
from driveline.harness.simulation.simulate import simulate
from tests.harness.explorer.made import column, runs_and_cars

DESIGN, VEHICLE = PLANTS
OURS = "DampingController"
SEEDS = {"motor.seed": 1, "can.seed": 1}

SAME = 1e-9
"""Of the range of a signal."""

OF_THE_LIBRARY = {
    ("abs", VEHICLE, False): 1e-7,
    ("abs", VEHICLE, True): 1e-8,
    ("park_forward", DESIGN, True): 1e-8,
    ("prbs", VEHICLE, True): 1e-5,
}
"""Where the last digits of exp, log and the like grow through the backlash: a page has those of musl, Python and native
FMUs those of the machine."""


def require_same(
    cases: Sequence[tuple[Manoeuvre, str, str, bool]],
    folder: Path,
    fmus: Path,
    given: Mapping[str, float] | None = None,
) -> None:
    """Signals and metrics of manoeuvre, plant, controller, and whether it controls."""
    parameters = SEEDS | dict(given or {})
    asked = [
        {
            "loop": named(plant, controller),
            "manoeuvre": manoeuvre_data(each),
            "parameters": parameters,
            "control": int(on),
        }
        for each, plant, controller, on in cases
    ]
    answers = runs_and_cars(folder, asked)["runs"]
    for k, (manoeuvre, plant, controller, on) in enumerate(cases):
        changes: Any = {"parameters": given or {}, "folder": fmus, "build": "native"} | (
            {} if on else {"control": False}
        )
        results = simulate(manoeuvre, plant, controller=controller, **changes)
        about = f"{manoeuvre.name} on {plant} with {controller if on else 'none'}"
        for name in COLUMNS:
            furthest = np.abs(column(folder, k, name) - results[name]).max(initial=0.0)
            limit = OF_THE_LIBRARY.get((manoeuvre.name, plant, on), SAME)
            assert furthest <= limit * max(np.ptp(results[name]), 1e-3), f"{name} in {about}"
        metrics = evaluate(results, manoeuvre)
        assert set(answers[k]) == set(WORTH)
        for name, value in answers[k].items():
            expected = getattr(metrics, name)
            assert (value is None) == np.isnan(expected), f"{name} in {about}"
            assert value is None or value == pytest.approx(expected, rel=1e-6, abs=1e-9), f"{name} in {about}"


def test_signals_and_metrics_are_those_of_simulate(native: Path, tmp_path: Path) -> None:
    cases = [(MANOEUVRES["tipin15"], plant, OURS, on) for plant in PLANTS for on in (True, False)]
    require_same([*cases, (MANOEUVRES["launch_brake"], DESIGN, OURS, True)], tmp_path, native.parent)


@pytest.mark.slow
def test_signals_and_metrics_are_those_of_simulate_in_every_manoeuvre(native: Path, tmp_path: Path) -> None:
    plants = {name: [VEHICLE] if each.road else PLANTS for name, each in MANOEUVRES.items()}
    cases = [
        (each, plant, OURS, on) for each in MANOEUVRES.values() for plant in plants[each.name] for on in (True, False)
    ]
    require_same(cases, tmp_path, native.parent)


@pytest.mark.slow
def test_the_comparators_are_in_it_too(native: Path, native_builder: Any, tmp_path: Path) -> None:
    from driveline.fmus.catalogue import EVERY

    for name in COMPARATORS:
        native_builder(EVERY[name], native.parent)
    cases = [(MANOEUVRES["tipin15"], VEHICLE, controller, True) for controller in COMPARATORS]
    require_same(cases, tmp_path, native.parent)


def test_a_manoeuvre_of_a_file_and_a_parameter_that_changes_in_the_run(native: Path, tmp_path: Path) -> None:
    demand = [points([(0.0, 5.0), (0.5, 5.0), (0.5, 60.0)]), sine(10.0, 5.0, begin=0.2, end=0.8), prbs(5.0, begin=1.0)]
    own = composed("own", 1.5, 5.0, demand, points([(1.2, 0.0), (1.3, 400.0)]))
    given = {"plant.m": 1800.0, "controller.k_d": 1.5, "controller.k_d@0.6": 2.0}
    require_same([(own, DESIGN, OURS, True)], tmp_path, native.parent, given)


CARS: Sequence[tuple[dict[str, float], dict[str, float]]] = (
    ({}, {"C": 150.0}),
    ({}, {"J_2": 0.4, "m": 2000.0}),
    ({}, {"c_slip": 100000.0, "J_1": 0.08, "phi_B": 0.1}),
    ({"C": 150.0, "m": 1900.0, "i": 8.0}, {"J_1": 0.04}),
    ({"k_s": 9000.0, "m": 1200.0}, {"m": 1500.0}),
    ({"k_s": 9000.0, "m": 1200.0}, {"C": 100.0}),
    ({}, {"C": 230.0, "c_slip": 72000.0}),
    ({}, {}),
)
"""Entries of a vehicle file, and those that are turned."""


def test_what_follows_from_a_car_follows_as_in_a_vehicle_file(tmp_path: Path) -> None:
    cars = [(one_car.with_estimates(known), turned) for known, turned in CARS]
    asked = [{"known": following(known), "turned": turned} for known, turned in cars]
    for found, (known, turned) in zip(runs_and_cars(tmp_path, cars=asked)["followed"], cars, strict=True):
        try:
            before, after = (
                one_car.of_one_car(car, {*FOLLOW, *DEFAULT_CAR}) for car in (known, one_car.updated(known, turned))
            )
        except ParameterFileError:
            assert (
                "the frequency of the drive train would have to be 12 Hz, and that of ValidationVehicle can be"
                in found["refused"]
            )
        else:
            changed = {name: value for name, value in after.items() if before.get(name) != value}
            back = {name: DEFAULT_CAR[name] for name in before.keys() - after.keys()}
            assert found == pytest.approx(changed | back, rel=2e-6)


@pytest.mark.slow
def test_comfort_swings_and_jerks_less_and_sport_answers_sooner(native: Path) -> None:
    """In the mean over the steps on both plants."""
    from fmuloop.interface import Interface

    declared = Interface(native / f"{OURS}.fmu").variables

    def worth(factors: Mapping[str, float]) -> np.ndarray:
        gains = {
            f"controller.{name}": max(by * float(declared[name].start or 0.0), float(declared[name].min or 0.0))
            for name, by in factors.items()
        }
        found = []
        for plant in PLANTS:
            for name in ("tipin15", "tipin50", "tipout", "launch"):
                results = simulate(MANOEUVRES[name], plant, parameters=gains, folder=native.parent, build="native")
                metrics = evaluate(results, MANOEUVRES[name])
                response = metrics.response_delay + metrics.withheld_time
                found.append((metrics.overshoot, metrics.jerk_rms_to_50_Hz, response))
        return np.log(found).mean(axis=0)

    sport, middle, comfort = map(worth, (SPORT, {}, COMFORT))
    assert (comfort[:2] < middle[:2]).all()
    assert (middle[:2] < sport[:2]).all()
    assert sport[2] < middle[2] < comfort[2]
