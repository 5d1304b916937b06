"""How the drive train of a plant swings, by its linearised equations."""

from math import pi, sqrt

import numpy as np
import pytest

from driveline.fmus.building.oscillation import SPEED, oscillation
from driveline.harness.studies.margins.linear_plant import linear_plant
from driveline.harness.studies.margins.operating_point import Point
from driveline.models import two_mass_driveline, validation_vehicle
from driveline.models.block.types import ContinuousBlock
from tests.together import together

DESIGN, DETAILED = two_mass_driveline.BLOCK, validation_vehicle.BLOCK


def test_on_a_stiff_tyre_the_motor_swings_against_wheels_and_vehicle() -> None:
    p = DESIGN.Parameters(c_slip=5e6)
    M = p.m * p.r**2 / p.i**2
    rigid = sqrt(p.C * (1.0 / p.J_1 + 1.0 / (p.J_2 + M))) / (2.0 * pi)
    assert oscillation(DESIGN, p).frequency == pytest.approx(rigid, rel=0.01)


@together("plant", [DESIGN, DETAILED])
def test_the_mode_is_one_of_the_linear_plant_of_the_analysis(plant: ContinuousBlock) -> None:
    """Which has the motor in it, and more of the tyres' bend at its torque."""
    found = oscillation(plant, plant.Parameters())
    poles = np.linalg.eigvals(linear_plant(Point(plant, v=SPEED, T=27.0)).A)
    s = min(poles, key=lambda s: abs(abs(s) - 2.0 * pi * found.frequency))
    assert found.frequency == pytest.approx(abs(s) / (2.0 * pi), rel=2e-3)
    assert found.damping_ratio == pytest.approx(-s.real / abs(s), rel=0.03)


def test_ripple_ice_and_gap_are_of_no_account() -> None:
    usual = oscillation(DETAILED, DETAILED.Parameters())
    other = oscillation(DETAILED, DETAILED.Parameters(r_6b=0.2, mu=0.05, phi_B=0.5))
    assert other == pytest.approx(usual, rel=1e-6)


@together("factor", [0.1, 0.3, 3.0, 30.0])
def test_neither_pitch_nor_mounts_are_taken_for_the_drive_train(factor: float) -> None:
    """It gets faster with stiffer shafts, up to what the tyres let it."""
    p = DETAILED.Parameters()
    found = [
        oscillation(DETAILED, p._replace(k_s=f * p.k_s, k_g=f * p.k_g, k_p=f * p.k_p)).frequency
        for f in (factor, 1.1 * factor)
    ]
    assert 2.5 < found[0] < found[1] < 12.5


@together("plant", [DESIGN, DETAILED])
def test_behind_a_heavy_motor_what_rolls_out_is_not_taken_for_the_oscillation(plant: ContinuousBlock) -> None:
    """The speed of a motor of 1.65 kg.m2 shows the rolling vehicle more than the swing."""
    p = plant.Parameters()
    found = oscillation(plant, p._replace(J_1=30.0 * p.J_1))
    assert 1.0 < found.frequency < 3.0
    assert found.damping_ratio < 0.3
