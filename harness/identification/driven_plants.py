"""C and phi_B of a car that two masses and a tyre do not explain, or whose load torque was not recorded.

The filter takes what it lacks for noise of the twist, and the flanks of the gap for those of two masses. Of the
validation vehicle, where the differential hits the teeth apart from the wheels and tyres and mounts unwind within the
gap, phi_B comes out up to 10 % too small so, and 28 % without the load torque. So both plants are driven by the
recorded torque, as by one step (`step`), and what meets the motor speed better tells both.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import product
from math import hypot, log
from typing import Any

import numpy as np

from fmuloop.runs import kept_loaded

from ...fmus.building.one_car import updated
from ..loop.places import PLANTS
from ..loop.settings import Settings
from .car_file import WIDEST_INTERVAL, of_car
from .identify import HELD_OUT, WITHOUT_LOAD, Identified
from .step import STEP_SIZE, Step, Tip, fitted, unexplained

LONGEST, FIRST = 10.0, 2.5
"""Time in s of the longest piece that is driven, and of its beginning, which is met before."""

STIFFNESSES, GAPS = (0.9, 1.0, 1.1), (0.85, 1.0, 1.2, 1.45)
"""Factors on C of the vehicle file and phi_B as the filter finds them, from which the search begins."""

LEAST = {"C": 0.02, "phi_B": 0.01}
"""Halves of the intervals at the least, in the logarithm: 1.3 and .9 % were both off by in nine recordings of four
cars where the plant met the motor speed to its noise."""


def driven_plants(identified: Identified, vehicle: Mapping[str, Any], settings: Settings) -> Step | None:
    """C and phi_B of the plant whose motor speed is nearest to the recorded one; None if the filter predicts better, or
    the gap is not crossed. The interval includes the distance of both answers, weighted by the unexplained share of the
    error.

    Args:
        vehicle: entries of the vehicle file as the car is known.
        settings: whose plants are driven.
    """
    noise, known = identified.found.noise.omega_1, {"C": of_car(identified)[0], "phi_B": identified.p.phi_B}
    car = updated(vehicle, known)
    starts = [{"C": log(C), "phi_B": log(phi_B)} for C, phi_B in product(STIFFNESSES, GAPS)]
    fits = []
    with kept_loaded():
        for plant in PLANTS:
            _, near = fitted(plant, _beginning(identified, FIRST), noise, car, settings, starts, most=20)
            fits.append(fitted(plant, _beginning(identified, LONGEST), noise, car, settings, [near])[0])
    best = min(fits, key=lambda step: step.error)
    held_out = identified.drive.omega_1[round((1.0 - HELD_OUT) * len(identified.drive)) :]
    if (
        best.error > (1.0 - 0.01 * identified.quality.omega_1) * float(np.std(held_out))
        or best.halves["phi_B"] > WIDEST_INTERVAL
    ):
        return None
    apart = {name: abs(log(value / known[name])) for name, value in best.values.items()}
    halves = {name: hypot(half, LEAST[name], unexplained(best) * apart[name]) for name, half in best.halves.items()}
    return replace(best, halves=halves)


def diagnose_driven(identified: Identified, failed: Exception | None = None) -> Iterator[str]:
    """Whose phi_B and C those of the vehicle file are, where two masses do not explain the car; and why. What holds of
    the filter's own answers without load torque, whose likelihood has many minima then.

    Args:
        failed: why no plant could be driven.
    """
    without_load = identified.name == WITHOUT_LOAD
    why = "without load torque" if without_load else "the gap of two masses is not that of this car"
    if without_load:
        yield (
            "J_2, C and d of the filter predict some ten milliseconds: without load torque another drive of this car "
            "gives others, outside these intervals"
        )
    doubt, by = f"may be off by up to {100.0 * identified.unconfirmed:g} %", identified.plant_fit
    if by:
        yield (
            f"{why}: phi_B = {identified.p.phi_B:.4g} rad of the filter {doubt}; {by.plant}, driven by the recorded "
            f"torque, meets the motor speed to {by.error:.2g} rad/s with phi_B = {by.values['phi_B']:.4g} rad, "
            "which is taken"
        )
    else:
        unconfirmed = (
            f"the plants that would confirm it could not be driven: {failed}"
            if failed
            else "no plant that was driven by the recorded torque confirms it"
        )
        yield f"{why}: phi_B {doubt}, so wide is its interval, as {unconfirmed}"


def _beginning(identified: Identified, duration: float) -> Tip:
    """Of the longest piece of a recording, with a duration in s."""
    drive = identified.drive
    at = slice(drive.longest.start, min(drive.longest.stop, drive.longest.start + round(duration / drive.T_s)))
    T_mot, omega_1 = drive.T_mot[at], drive.omega_1[at]
    t = np.arange(len(omega_1)) * drive.T_s
    time = np.arange(0.0, t[-1], STEP_SIZE)
    acting = np.interp(time + 0.5 * STEP_SIZE + identified.p.late_T, t, T_mot)
    return Tip(time, acting, t, omega_1, float(acting[0]), float(omega_1[:5].mean()), True)
