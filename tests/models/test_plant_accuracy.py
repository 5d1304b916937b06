"""Both plants against an independent solution of the specification to a tight tolerance."""

from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest

from driveline.models import two_mass_driveline, validation_vehicle
from fmublocks.block.integrator import Integrator
from tests.models import reference_vehicle as reference
from tests.models.reference_vehicle import Held

STEP = 1e-3
TOLERANCE = 1e-5
"""Of the range of each output; the requirement. Measured: at most 2.1e-6 (braking, hill start), 3e-7 otherwise."""

Manoeuvre = Callable[[float], tuple[float, float, float]]
BITS = np.random.default_rng(1).integers(0, 2, 100)


def tip_in(t: float) -> tuple[float, float, float]:
    return (100.0 if t > 0.0995 else -12.0), 0.0, 0.0


def launch(t: float) -> tuple[float, float, float]:
    return min(1200.0 * (t + STEP), 120.0), 0.0, 0.0


def prbs(t: float) -> tuple[float, float, float]:
    return 8.0 + 15.0 * (2.0 * BITS[int(t / 0.04 + 1e-9)] - 1.0), 0.0, 0.0


def braking_to_standstill(t: float) -> tuple[float, float, float]:
    return 0.0, (1500.0 if t > 0.0995 else 0.0), 0.0


def hill_start(t: float) -> tuple[float, float, float]:
    """Standing on a grade with brakes, then let go: back, and away with the motor."""
    return (60.0 if t > 0.6995 else 0.0), (1500.0 if t < 0.5005 else 0.0), 0.1


CASES = {
    "tip-in": (tip_in, 1.5, 15.0 / 3.6),
    "launch": (launch, 1.5, 0.0),
    "prbs": (prbs, 1.5, 15.0 / 3.6),
    "braking to standstill": (braking_to_standstill, 2.5, 1.5),
    "hill start": (hill_start, 1.5, 0.0),
}

PLANTS = [
    (two_mass_driveline, reference.SIMPLE, reference.SIMPLE_STATES),
    (validation_vehicle, reference.VEHICLE, reference.VEHICLE_STATES),
]


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize(
    ("plant", "equations", "names"),
    [PLANTS[0], pytest.param(*PLANTS[1], marks=pytest.mark.slow)],
    ids=["simple", "vehicle"],
)
def test_agrees_with_an_independent_solution(
    plant: ModuleType, equations: reference.Reference, names: tuple[str, ...], case: str
) -> None:
    manoeuvre, duration, v_0 = CASES[case]
    inputs = [Held(*(float(a) for a in manoeuvre(k * STEP))) for k in range(round(duration / STEP))]
    p = plant.Parameters(v_0=v_0, T_0=inputs[0].T_mot if v_0 else 0.0)
    x = plant.start(plant.Input(*inputs[0]), p)
    theirs = reference.solve(equations, [getattr(x, name) for name in names], inputs, STEP)

    integrator, ours = Integrator(plant.BLOCK), []
    for held in inputs:
        u = plant.Input(*held)
        ours.append(plant.output(x, u, p))
        x = integrator.advance(x, u, p, STEP)
    error = np.abs(np.array(ours) - theirs).max(axis=0)
    assert (error <= TOLERANCE * np.ptp(theirs, axis=0)).all(), dict(
        zip(plant.Output._fields, error / np.maximum(np.ptp(theirs, axis=0), 1e-30), strict=True)
    )


@pytest.mark.parametrize(("plant", "equations", "names"), PLANTS, ids=["simple", "vehicle"])
def test_rates_are_those_of_the_specification(
    plant: ModuleType, equations: reference.Reference, names: tuple[str, ...]
) -> None:
    """At random states, also such as no manoeuvre above comes to."""
    rng, p = np.random.default_rng(3), plant.Parameters()
    assert sorted(names) == sorted(plant.State._fields)
    for _ in range(300):
        x = plant.State(*(rng.normal(size=len(names)) * 10.0 ** rng.uniform(-3.0, 1.0, len(names))).tolist())
        held = Held(float(rng.normal(0.0, 100.0)), float(rng.uniform(0.0, 3000.0)), float(rng.normal(0.0, 0.1)))
        ours = plant.derivative(x, plant.Input(*held), p)._asdict()
        theirs = equations.rates(np.array([getattr(x, name) for name in names]), held)
        rounding = 1e-13 * max(abs(rate) for rate in theirs)
        assert [ours[name] for name in names] == pytest.approx(theirs, rel=1e-9, abs=rounding)
