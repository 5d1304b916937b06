"""What co-simulation does to the loop, measured against its monolithic solution.

Everything is compared without noise, at the samples of the controller, which all communication steps share.
The demand changes only at these instants, so that all runs are given the same.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from driveline.harness.loop.places import BUILD
from driveline.harness.loop.settings import loop
from driveline.harness.manoeuvres.catalogue import KMH
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.signals import Signal, lines
from driveline.harness.simulation.simulate import signals, start
from driveline.models.controller import T_S
from fmuloop.experiment import Experiment
from fmuloop.runs import run
from fmuloop.system import Scheme

from . import monolithic
from .monolithic import INTERVAL, PLANTS

STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4)
"""Communication steps in s; each divides T_S."""

SIGNALS: tuple[str, ...] = (
    "plant.T_gear",
    "plant.omega_1",
    "motor.T_mot",
    "controller.T_ref",
    "controller.T_gear_hat",
)

NOISELESS = {"motor.sigma_T": 0.0, "motor.sigma_omega": 0.0, "motor.q_omega": 0.0, "can.q_v": 0.0}


def short(name: str, description: str, T_driver: Signal) -> Manoeuvre:
    return Manoeuvre(name, description, duration=0.6, v_0=15 * KMH, T_driver=T_driver)


COUPLING_MANOEUVRES = (
    short("in contact", "20 to 100 N.m, the teeth stay in contact", lines((0.1, 20.0), (0.1, 100.0))),
    short("through the gap", "-12 to 100 N.m, through the backlash", lines((0.1, -12.0), (0.1, 100.0))),
)


class Deviation(NamedTuple):
    """Distance of a signal from the monolithic solution, as shares of the latter's range."""

    largest: float
    rms: float


class Comparison(NamedTuple):
    """One manoeuvre with one plant under one scheme: deviations by communication step and signal."""

    plant: str
    manoeuvre: Manoeuvre
    scheme: Scheme
    deviations: Mapping[float, Mapping[str, Deviation]]

    def __str__(self) -> str:
        return f"{self.plant}, {self.manoeuvre.name}, {self.scheme.value}"

    def order(self, signal: str) -> float:
        """Power of the communication step with which the rms of the deviation falls."""
        steps = list(self.deviations)
        rms = [self.deviations[step][signal].rms for step in steps]
        return float(np.polyfit(np.log(steps), np.log(rms), 1)[0])


def reference(plant: str, manoeuvre: Manoeuvre, parameters: Mapping[str, float]) -> np.ndarray:
    """Monolithic run of a manoeuvre without brake and slope, at the instants k * T_S."""
    by_instance: dict[str, dict[str, float]] = {}
    for name, value in (start(manoeuvre) | dict(parameters)).items():
        instance, _, parameter = name.partition(".")
        by_instance.setdefault(instance, {})[parameter] = value

    def driver_and_road(k: int) -> tuple[float, float, float]:
        return float(manoeuvre.T_driver(k * INTERVAL)), 0.0, 0.0

    results = monolithic.run(PLANTS[plant], driver_and_road, manoeuvre.duration, by_instance)
    return results[:: round(T_S / INTERVAL)]


def cosimulated(
    plant: str,
    manoeuvre: Manoeuvre,
    parameters: Mapping[str, float],
    step_size: float,
    scheme: Scheme,
    folder: Path = BUILD,
) -> np.ndarray:
    """The same run with the FMUs in `folder`, at the same instants."""
    experiment = Experiment(
        manoeuvre.duration,
        step_size,
        signals(manoeuvre),
        start(manoeuvre) | dict(parameters),
        scheme,
        label=f"{plant}, {scheme.value}, {1e3 * step_size:g} ms",
    )
    return run(loop(plant, folder=folder), experiment)[:: round(T_S / step_size)]


def compare(
    plant: str,
    manoeuvre: Manoeuvre,
    scheme: Scheme,
    steps: Sequence[float] = STEPS,
    folder: Path = BUILD,
) -> Comparison:
    """Deviations of the co-simulated from the monolithic run, for each communication step in s."""
    exact = reference(plant, manoeuvre, NOISELESS)
    deviations = {}
    for step in steps:
        results = cosimulated(plant, manoeuvre, NOISELESS, step, scheme, folder)
        deviations[step] = {name: deviation(results[name], exact[name]) for name in SIGNALS}
    return Comparison(plant, manoeuvre, scheme, deviations)


def deviation(signal: np.ndarray, exact: np.ndarray) -> Deviation:
    """Largest and rms distance of two signals over the range of the exact one."""
    distance = (signal - exact) / np.ptp(exact)
    return Deviation(float(np.abs(distance).max()), float(np.sqrt(np.mean(distance**2))))
