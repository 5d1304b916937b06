"""Standing, stopping and rolling back: what the two plants do around zero speed."""

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from fmutesting.slow import slow

from driveline.models import two_mass_driveline, validation_vehicle
from fmublocks.block.integrator import Integrator

BOTH = [two_mass_driveline, validation_vehicle]
PLANTS = pytest.mark.parametrize("plant", BOTH, ids=lambda m: m.BLOCK.name)
LONG_ON_PLANTS = pytest.mark.parametrize("plant", slow(BOTH, but=(two_mass_driveline,)), ids=lambda m: m.BLOCK.name)


def drive(plant: ModuleType, duration: float, u_of_t: Any, h: float = 2e-3, **start: float) -> list[Any]:
    """Outputs every h seconds under the inputs (T_mot, T_brake, slope) of each instant."""
    p = plant.Parameters(**start)
    integrator = Integrator(plant.BLOCK)
    x, outputs = plant.start(plant.Input(*u_of_t(0.0)), p), []
    for k in range(round(duration / h)):
        u = plant.Input(*(float(value) for value in u_of_t(k * h)))
        x = integrator.advance(x, u, p, h)
        outputs.append(plant.output(x, u, p))
    return outputs


@PLANTS
def test_a_car_at_rest_stays_at_rest(plant: ModuleType) -> None:
    y = drive(plant, 1.0, lambda t: (0.0, 0.0, 0.0))[-1]
    assert y.v == y.omega_1 == y.omega_wheel_L == y.T_gear == 0.0


@LONG_ON_PLANTS
def test_brakes_hold_the_car_on_a_grade(plant: ModuleType) -> None:
    slope = np.arctan(0.1)

    def inputs(t: float) -> tuple[float, float, float]:
        return 0.0, 1500.0, float(np.interp(t, [0.2, 0.7], [0.0, slope]))

    outputs = drive(plant, 12.0, inputs)
    moved = sum(y.v for y in outputs) * 2e-3
    limit = {"TwoMassDriveline": 1.1e-3, "ValidationVehicle": 4.1e-3}[plant.BLOCK.name]
    assert -moved == pytest.approx(limit, rel=0.05), "mostly elastic deflection; figures of the specification"
    assert abs(outputs[-1].v) < 1e-4
    assert all(abs(y.v) < 1e-3 for y in outputs[-500:])


@LONG_ON_PLANTS
def test_braking_ends_in_standstill_without_chatter(plant: ModuleType) -> None:
    def inputs(t: float) -> tuple[float, float, float]:
        return 0.0, float(np.interp(t, [0.2, 0.6], [0.0, 1500.0])), 0.0

    outputs = drive(plant, 12.0, inputs, v_0=4.0)
    swing = np.abs([y.v for y in outputs])
    assert swing[-3000:].max() < 0.01, "it swings on its tyres, undamped in the gear"
    late = np.array([y.T_load for y in outputs[-250:]])
    assert np.abs(np.diff(late)).max() < 0.5, "a chattering brake would switch its whole torque"


@PLANTS
def test_a_sliding_brake_gives_its_whole_torque(plant: ModuleType) -> None:
    pushed = drive(plant, 0.4, lambda t: (0.0, 600.0, 0.0), v_0=20.0)[-1]
    free = drive(plant, 0.4, lambda t: (0.0, 0.0, 0.0), v_0=20.0)[-1]
    p = plant.Parameters()
    braked = -p.i * pushed.T_load - pushed.T_rim
    assert braked == pytest.approx(600.0, rel=1e-6)
    assert -p.i * free.T_load == pytest.approx(free.T_rim, rel=1e-6)
