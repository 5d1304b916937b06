"""The start of the search is the best of many."""

from dataclasses import replace

import pytest

from driveline.harness.identification.global_start import best_start
from driveline.harness.identification.identify import WIDE_LOAD_NOISE
from driveline.harness.identification.maximum_likelihood import maximise
from driveline.harness.identification.prediction import Noise, Predictor
from tests.harness.identification.simulated import NOISE, P, simulated

WIDE = Noise(NOISE.omega_1, NOISE.T_mot, WIDE_LOAD_NOISE)
FREE = ("J_2", "C", "phi_B", "d")


@pytest.mark.parametrize(("J_2", "C", "phi_B"), [(1.87, 33.5, 0.0021), (0.077, 295.0, 0.12), (1.17, 35.0, 0.0045)])
def test_from_wide_starts(J_2: float, C: float, phi_B: float) -> None:
    drive, far = simulated(seed=3), P._replace(J_2=J_2, C=C, phi_B=phi_B, g_L=1.0)
    begun = best_start(Predictor(FREE), drive, far, WIDE)
    right = maximise(Predictor(FREE), drive, begun, WIDE).p
    for name in ("J_2", "C", "phi_B"):
        assert getattr(right, name) == pytest.approx(getattr(P, name), rel=0.03), name


def test_a_truck_is_begun_as_well() -> None:
    """All inertias, torques and stiffnesses ten times as large."""
    car = simulated(seed=3)
    truck = replace(car, T_mot=10.0 * car.T_mot, T_load=10.0 * car.T_load)
    wide = Noise(WIDE.omega_1, 10.0 * WIDE.T_mot, 10.0 * WIDE.T_load)
    far = P._replace(J_2=1.87, C=33.5, phi_B=0.0021, g_L=1.0)
    begun = best_start(Predictor(FREE), truck, far._replace(J_1=10.0 * P.J_1), wide)
    assert begun[1:] == pytest.approx((10.0 * P.J_2, 10.0 * P.C, 10.0 * P.d, *P[4:]), rel=0.05)
