"""Recordings of a loop that is not ours: what holding does to its torques, and that identification knows a skew."""

from pathlib import Path

import numpy as np
import pytest

from docs.studies.foreign_loop import CARS, FINE, STEP, Car, Loop, driven, logged
from driveline.harness.identification.identify import Identified
from driveline.harness.identification.prior_knowledge import identify
from driveline.harness.identification.quality import Z_95
from driveline.harness.recordings.measurement import read_measurement
from tests.slow import slow

WITHIN = {"J_2": 0.01, "C": 0.002, "phi_B": 0.005}
"""Relative errors that are allowed."""


def identified(car: Car, loop: Loop, folder: Path, seed: int = 1) -> Identified:
    logged(car, loop, seed, folder / "drive.csv")
    return identify(read_measurement(folder / "drive.csv", car.i, car.r), car.known)


def require_right(found: Identified, car: Car, loop: Loop) -> None:
    assert found.method == "prediction error"
    assert found.quality.size == pytest.approx(1.0, abs=0.12)
    for name, within in WITHIN.items():
        off = getattr(found.p, name) - getattr(car, name)
        assert abs(off) < within * getattr(car, name), name
        assert abs(off) < 1.6 * Z_95 * found.deviations[name], f"{name}: 99.8 %"
    np.testing.assert_allclose(found.p.shifts, loop.shifts, atol=2e-4)


@pytest.mark.parametrize(
    ("loop", "channels"),
    [
        pytest.param(Loop("averaged"), [], marks=pytest.mark.slow),
        (Loop("averaged", late_omega=0.001), ["motor speed looks late: it is recorded 1.0"]),
        pytest.param(Loop("plant first"), ["motor torque looks early: it is recorded 0.5"], marks=pytest.mark.slow),
    ],
)
@pytest.mark.slow
def test_a_skew_is_found_and_named_and_nothing_else(loop: Loop, channels: list[str], tmp_path: Path) -> None:
    found = identified(CARS[0], loop, tmp_path)
    require_right(found, CARS[0], loop)
    warnings = [text for text in found.warnings if not text.startswith("tau = ")]
    assert len(warnings) == len(channels)
    assert all(channel in text for channel, text in zip(channels, warnings, strict=True))


@pytest.mark.slow
@pytest.mark.parametrize("number", [0, 2])
@pytest.mark.parametrize(
    "loop",
    [
        Loop("motor first", T_s=0.0025, late_omega=0.001),
        Loop("averaged", late_T_load=0.0015),
        Loop("plant first", T_s=0.001, late_omega=0.0018, load_held=True),
        Loop("motor first", T_s=0.004, late_T_mot=0.002, late_T_load=0.0007),
        Loop("averaged", late_omega=0.005),
        Loop("averaged", late_T_mot=0.003, late_T_load=0.003),
    ],
)
def test_cars_in_other_loops_are_right_to_within_what_is_asked(number: int, loop: Loop, tmp_path: Path) -> None:
    require_right(identified(CARS[number], loop, tmp_path), CARS[number], loop)


@pytest.mark.parametrize("late_omega", slow([0.0, 0.001], but=[0.001]))
@pytest.mark.slow
def test_of_a_weak_excitation_what_it_does_not_tell_is_named_and_no_cause(late_omega: float, tmp_path: Path) -> None:
    loop = Loop("averaged", mean=25.0, amplitude=2.0, late_omega=late_omega)
    found = identified(CARS[2], loop, tmp_path)
    assert any(text.startswith("phi_B is not determined: the teeth never brake") for text in found.warnings)
    others = [text for text in found.warnings if not text.startswith("phi_B") and " looks late: " not in text]
    assert others == []


def test_the_drive_is_that_of_the_equations_of_motion_with_what_is_held() -> None:
    # Balance of momentum over half a second, with the mean of the torque that acted.
    car, loop = CARS[0], Loop("averaged", duration=1.0)
    true = driven(car, loop, seed=1)
    first, last = 2000, 7000
    T = np.trapezoid([true["T_mot"][first : last + 1], true["T_load"][first : last + 1]], dx=FINE)
    gained = [car.J_1, car.J_2] @ np.array([true[name][last] - true[name][first] for name in ("omega_1", "omega_2")])
    assert gained == pytest.approx(T.sum(), abs=2e-3 * np.abs(T).max())
    # Beside what the logger delays.
    half = 0.5 * STEP * FINE
    assert Loop("averaged", late_omega=0.001, late_T_load=0.0015).shifts == pytest.approx((-0.001, 0.0005))
    assert Loop("motor first").shifts == (half, 0.0)
    assert Loop("plant first", load_held=True).shifts == (-half, -half)
