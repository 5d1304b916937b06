"""What one tip-in tells of a car: C and phi_B by `driveline identify --step`, and how often their intervals hold.

Cars are drawn, and so is what is known of them. Some have mounts, hubs and a body that no vehicle file tells.
"""

from collections.abc import Mapping, Sequence
from math import exp, log
from typing import Any, NamedTuple

import numpy as np

from driveline.fmus.building.one_car import DEFAULT_CAR, FOLLOW, of_one_car
from driveline.fmus.errors import ParameterFileError
from driveline.harness.design.loop_parameters import loop_parameters
from driveline.harness.identification.step import identify_step
from driveline.harness.loop.built_fmus import built
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.settings import Settings
from driveline.harness.loop.settings import settings as settings_of
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from driverecords.measurement import Measurement
from fmuloop.many_runs import run_many

from .study import Cell, Column, Measured, Study, Table

STEPS = ("tipin15", "tipin50", "tipout", "regen", "tipin15r")

SEED, CARS = 7, 10
"""Of the first car, and cars of each kind; none of these was used in development."""

UNLIKE = {"J_p": 1.5, "k_x": 0.6, "m_h": 1.3, "J_y": 0.8, "J_g": 1.5}
"""Factors on the detailed car by which it is another one than its vehicle file says."""

DESIGN_MODEL, VEHICLE, OTHER = (*PLANTS, f"{PLANTS[1]}, other mounts, hubs and body")

OF_VEHICLE_FILE = {"J_1": 0.055, "J_2": 0.3, "C": 117.4, "phi_B": 0.157, "c_slip": 140000.0, "m": 1450.0}


class Found(NamedTuple):
    """Of C and phi_B by how much they are off and half of their 95 % interval, both in the logarithm."""

    off: Mapping[str, float]
    halves: Mapping[str, float]


def drawn(seed: int, kind: str) -> tuple[dict[str, float], dict[str, float]]:
    """A car, and what is known of it."""
    draws = np.random.default_rng(seed)
    while True:
        spread = {"J_1": 0.4, "J_2": 0.4, "C": 0.4, "c_slip": 0.2, "m": 0.25}
        car = {name: OF_VEHICLE_FILE[name] * exp(draws.uniform(-by, by)) for name, by in spread.items()}
        car["phi_B"] = draws.uniform(0.05, 0.35)
        errors = {"J_2": draws.normal(0.0, 0.3), "c_slip": draws.normal(0.0, 0.2), "m": draws.normal(0.0, 0.03)}
        known = {**car, **{name: car[name] * exp(by) for name, by in errors.items()}, "C": 117.4, "phi_B": 0.157}
        try:
            full = of_one_car(car, FOLLOW)
            of_one_car(known, FOLLOW)
        except ParameterFileError:  # there is no such car
            continue
        other = {name: full.get(name, DEFAULT_CAR[name]) * by for name, by in UNLIKE.items() if kind == OTHER}
        return {**car, **other}, known


def recorded(
    plant: str, car: Mapping[str, float], step: str, seed: int, settings: Settings | None = None
) -> Measurement:
    """A step without control, as the sensors of the motor tell it every 2 ms."""
    of_run = settings_of(settings, plant=plant, control=False, parameters=loop_parameters(car, plant), seed=seed)
    signals = simulate(MANOEUVRES[step], of_run)[::2]
    time, T_mot, omega_1 = (np.array(signals[name]) for name in ("time", "motor.T_mot_est", "motor.omega_1_meas"))
    return Measurement(step, time, T_mot, omega_1, omega_1, None, None, None, None, {}, (), {})


def identified_car(case: tuple[int, str]) -> Found:
    """What a step of a car tells, by its seed and kind."""
    seed, kind = case
    car, known = drawn(seed, kind)
    recording = recorded(kind.partition(",")[0], car, STEPS[seed % len(STEPS)], seed)
    step = identify_step(recording, known, built(VEHICLE, build="native"))
    return Found({name: log(value / car[name]) for name, value in step.values.items()}, step.halves)


COLUMNS = (
    Column("recordings", decimals=0, tolerance=0.0),
    *(
        Column(f"{name}, {what}", "%", decimals)
        for name in ("C", "phi_B")
        for what, decimals in (
            ("rms error", 1),
            ("worst", 1),
            ("95 % interval, +- (median)", 1),
            ("in the interval", 0),
        )
    ),
)


def table(cases: Mapping[str, Sequence[Found]]) -> Table:
    def cells(those: Sequence[Found]) -> tuple[Cell, ...]:
        row: list[Any] = [len(those)]
        for name in ("C", "phi_B"):
            off, half = (np.array([getattr(case, what)[name] for case in those]) for what in ("off", "halves"))
            inside = np.mean(np.abs(off) <= half)
            row += [float(100.0 * x) for x in (np.sqrt(np.mean(off**2)), np.abs(off).max(), np.median(half), inside)]
        return tuple(row)

    return Table("recorded on", COLUMNS, {kind: cells(those) for kind, those in cases.items()})


def first_table() -> Table:
    """One recording, as a sentinel."""
    off = identified_car((SEED, DESIGN_MODEL)).off
    columns = (Column("C off", "%", 2, 0.0), Column("phi_B off", "%", 1, 0.0))
    return Table("recorded on", columns, {DESIGN_MODEL: (100.0 * off["C"], 100.0 * off["phi_B"])})


def measure() -> Measured:
    cases = [(SEED + n, kind) for kind in (DESIGN_MODEL, VEHICLE, OTHER) for n in range(CARS)]
    answers = iter(run_many(identified_car, cases, label="one step"))
    by_kind = {kind: [next(answers) for _ in range(CARS)] for kind in (DESIGN_MODEL, VEHICLE, OTHER)}
    return Measured({"first": first_table(), "steps": table(by_kind)})


def again() -> dict[str, Table]:
    return {"first": first_table()}


STUDY = Study(
    "what one tip-in tells of a car", measure, again, {"first": (DESIGN_MODEL,)}, seeds=(SEED,), seconds=120.0
)
