"""How the identified car answers: its resonance and the tyre behind the wheels."""

import numpy as np
import pytest

from driveline.harness.identification.drive_train import Parameters, Vehicle
from driveline.harness.identification.drive_train_response import FREQUENCIES, Tyre, resonance, response, rolling_tyre

P = Parameters(0.055, 0.3, 117.4, 0.0, 0.157)
BEHIND = Tyre(c_t=480.0, d_t=30.0, J_v=1.5)


def test_the_resonance_of_two_masses_is_that_of_the_formula() -> None:
    """A little damping, as without it the answer is infinite there."""
    formula = np.sqrt(P.C * (1.0 / P.J_1 + 1.0 / P.J_2)) / (2.0 * np.pi)
    assert resonance(P._replace(d=0.01)) == pytest.approx(formula, rel=1e-4)


def equations(p: Parameters, behind: Tyre, f: float) -> complex:
    """omega_1/T_mot by the equations of motion of three masses, with twist and torque of the tyre as states."""
    s = 2j * np.pi * f
    A = np.array([
        [-p.d / p.J_1, p.d / p.J_1, 0.0, -p.C / p.J_1, 0.0],
        [p.d / p.J_2, -p.d / p.J_2, 0.0, p.C / p.J_2, -1.0 / p.J_2],
        [0.0, 0.0, 0.0, 0.0, 1.0 / behind.J_v],
        [1.0, -1.0, 0.0, 0.0, 0.0],
        [0.0, behind.c_t, -behind.c_t, 0.0, -behind.c_t / behind.d_t],
    ])  # fmt: skip
    return complex(np.linalg.solve(s * np.eye(5) - A, np.array([1.0 / p.J_1, 0.0, 0.0, 0.0, 0.0]))[0])


def test_the_response_is_that_of_the_equations() -> None:
    p = P._replace(d=0.4)
    expected = [equations(p, BEHIND, f) for f in FREQUENCIES]
    np.testing.assert_allclose(response(p, FREQUENCIES, BEHIND), expected, rtol=1e-9)
    together = p._replace(J_2=p.J_2 + 1.5)
    np.testing.assert_allclose(
        response(p, FREQUENCIES, Tyre(1e9, 1e9, 1.5)), response(together, FREQUENCIES), rtol=1e-4
    )


def test_the_resonance_is_the_peak_of_the_response() -> None:
    p = P._replace(d=0.4)
    peak, f = resonance(p, BEHIND), np.linspace(3.0, 20.0, 3001)
    assert peak == pytest.approx(f[np.argmax(abs(response(p, f, BEHIND)))], abs=0.006)
    assert abs(peak - resonance(p)) > 0.3, "the vehicle behind the tyre changes it"


def test_a_rolling_tyre_slips_the_more_the_faster_it_relaxes() -> None:
    p = P._replace(c_t=2900.0, sigma_t=1.55)
    rolling = rolling_tyre(p, Vehicle(1.5), 129.0)
    assert (rolling.c_t, rolling.d_t, rolling.J_v) == pytest.approx((2900.0, 2900.0 * 1.55 / 129.0, 1.5))
    assert rolling_tyre(p, Vehicle(1.5), 0.0).d_t == pytest.approx(2900.0 * 1.55), "at rest it is a spring"
