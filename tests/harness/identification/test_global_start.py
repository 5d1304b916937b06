"""A search that begins anywhere finds the right valley."""

from dataclasses import replace

import pytest
from fmutesting.slow import slow

from driveline.harness.identification.estimator import search
from driveline.harness.identification.global_start import best_start
from driveline.harness.identification.identify import COARSE, WIDE
from driveline.harness.identification.prediction import Noise, Predictor
from tests.harness.identification.simulated import BEHIND, NOISE, P, predictor, simulated

STARTS = [(1.87, 33.5, 0.0021), (0.077, 295.0, 0.12), (1.17, 35.0, 0.0045)]


@pytest.mark.parametrize(("J_2", "C", "phi_B"), slow(STARTS, but=STARTS[:1]))
def test_from_wide_starts(J_2: float, C: float, phi_B: float) -> None:
    far = P._replace(J_2=J_2, C=C, phi_B=phi_B, g_T=1.0, g_L=1.0, **WIDE)
    right = search(predictor(), best_start(predictor(), far, COARSE), COARSE, far, most=10).p
    for name in ("J_2", "C", "phi_B"):
        assert getattr(right, name) == pytest.approx(getattr(P, name), rel=0.1), name


@pytest.mark.slow
def test_a_truck_is_begun_as_well() -> None:
    """All inertias, torques and stiffnesses ten times as large."""
    car = simulated(seed=3)
    truck = replace(car, T_mot=10.0 * car.T_mot, T_load=10.0 * (car.T_load if car.T_load is not None else 0.0))
    far = P._replace(J_1=10.0 * P.J_1, J_2=1.87, C=33.5, phi_B=0.0021, c_t=1e4, g_T=1.0, g_L=1.0, **WIDE)
    noise = Noise(NOISE.omega_1, 10.0 * NOISE.T_mot, 10.0 * NOISE.T_load)
    heavy = BEHIND._replace(J_v=10.0 * BEHIND.J_v, d_low=10.0 * BEHIND.d_low)
    begun = best_start(Predictor(truck, noise, heavy), far, COARSE)
    assert (begun.J_2, begun.C, begun.phi_B) == pytest.approx((10.0 * P.J_2, 10.0 * P.C, P.phi_B), rel=0.15)
