"""How the identified car answers: its resonance, the tyre behind the wheels, and the two masses that answer so."""

import numpy as np
import pytest
from scipy.signal import lsim

from driveline.harness.identification.drive_train import Parameters
from driveline.harness.identification.drive_train_response import (
    FREQUENCIES,
    WINDOW,
    Tyre,
    resonance,
    response,
    tyre,
)
from driveline.harness.identification.two_mass_equivalent import equivalent
from tests.harness.identification.simulated import T_S, demand

P = Parameters(0.055, 0.3, 117.4, 0.0, 0.157)
BEHIND = Tyre(c_t=480.0, d_t=30.0, J_v=1.5, explained=1.0)


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
    rigid = Tyre(c_t=1e9, d_t=1e9, J_v=1.5, explained=1.0)
    together = p._replace(J_2=p.J_2 + 1.5)
    np.testing.assert_allclose(response(p, FREQUENCIES, rigid), response(together, FREQUENCIES), rtol=1e-4)


def test_the_resonance_is_the_peak_of_the_response() -> None:
    p = P._replace(d=0.4)
    peak = resonance(p, BEHIND)
    f = np.linspace(3.0, 20.0, 3001)
    assert peak == pytest.approx(f[np.argmax(abs(response(p, f, BEHIND)))], abs=0.006)
    assert abs(peak - resonance(p)) > 0.3, "the vehicle behind the tyre changes it"


def wheel_and_load(behind: Tyre, seed: int, n: int = 5000) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """T_mot, omega_2 and T_load of wheels that are driven directly, on the tyre with the vehicle behind."""
    T_mot, J_2 = demand(n) - 10.0, 0.3
    A = np.array([
        [0.0, 0.0, -1.0 / J_2],
        [0.0, 0.0, 1.0 / behind.J_v],
        [behind.c_t, -behind.c_t, -behind.c_t / behind.d_t],
    ])  # fmt: skip
    B, C = np.array([[1.0 / J_2], [0.0], [0.0]]), np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    _, y, _ = lsim((A, B, C, np.zeros((2, 1))), T_mot, T_S * np.arange(n), interp=False)
    white = np.random.default_rng(seed).standard_normal((2, n))
    return T_mot, y[:, 0] + 0.02 * white[0], y[:, 1] + 1.1 * white[1]


@pytest.mark.parametrize(("c_t", "d_t"), [(480.0, 30.0), (2900.0, 33.0)])
def test_the_tyre_of_a_simulated_car_is_found(c_t: float, d_t: float) -> None:
    true = Tyre(c_t, d_t, 1.5, 1.0)
    T_mot, omega_2, T_load = wheel_and_load(true, seed=1)
    found = tyre(T_load, omega_2, T_mot, T_S, 1.5)
    assert found.c_t == pytest.approx(c_t, rel=0.05)
    assert found.d_t == pytest.approx(d_t, rel=0.05)
    assert found.explained > 0.95
    assert found.J_v == 1.5


def test_a_load_torque_that_is_no_tyre_is_not_explained() -> None:
    T_mot, omega_2, _ = wheel_and_load(BEHIND, seed=1)
    noise = np.random.default_rng(2).standard_normal(len(T_mot))
    assert tyre(noise, omega_2, T_mot, T_S, 1.5).explained < 0.8


def test_without_a_tyre_the_two_masses_are_those_that_were_identified() -> None:
    assert equivalent(P, None, 7.0) is P


def test_with_a_tyre_they_keep_the_resonance_and_the_answer_about_it() -> None:
    """A car as `driveline identify` finds the ValidationVehicle: without the vehicle 15 Hz, with it 7.8 Hz."""
    p, behind = Parameters(0.055, 0.022, 187.0, 0.27, 0.127), Tyre(480.0, 30.0, 1.5, 1.0)
    peak = resonance(p, behind)
    found = equivalent(p, behind, peak)
    assert resonance(found) == pytest.approx(peak, rel=0.01)
    assert 0.5 < found.J_2 < 1.5, "the tyre slips, so that the vehicle is not all of it"
    assert found.C < 0.75 * p.C
    assert (found.J_1, found.phi_B) == (p.J_1, p.phi_B)
    f = peak * np.linspace(0.7, 1.3, 31)
    np.testing.assert_allclose(abs(response(found, f)), abs(response(p, f, behind)), rtol=0.1)


def test_a_stiff_tyre_makes_the_vehicle_part_of_the_wheels() -> None:
    p = P._replace(d=0.4)
    stiff = Tyre(1e7, 1e7, 1.5, 1.0)
    found = equivalent(p, stiff, resonance(p, stiff))
    assert found.J_2 == pytest.approx(1.8, rel=1e-3)
    assert found.C == pytest.approx(p.C, rel=1e-3)
    assert found.d == pytest.approx(p.d, rel=1e-2)


def test_two_masses_that_would_have_all_of_the_world_are_found_in_silence(recwarn: pytest.WarningsRecorder) -> None:
    """Behind heavy wheels and a tyre that slips, the likeliest second mass has no end."""
    p, behind = Parameters(0.055, 0.42, 96.0, 0.0, 0.11), Tyre(611.5, 36.0, 1.505, 1.0)
    assert 96.0 < equivalent(p, behind, resonance(p, behind)).C < 100.0
    assert [str(each.message) for each in recwarn] == []


def test_a_recording_that_is_shorter_than_the_window_is_one_window(recwarn: pytest.WarningsRecorder) -> None:
    rng = np.random.default_rng(1)
    T_mot, T_load, omega_2 = rng.standard_normal((3, WINDOW // 2))
    tyre(T_load, omega_2, T_mot, 0.002, 40.0)
    assert [str(each.message) for each in recwarn] == []
