"""Recordings of a loop that is not ours: what holding does to its torques, and that identification knows a skew."""

from pathlib import Path

import numpy as np
import pytest

from docs.studies.foreign_loop import PARTS, STEP, Car, Loop, drawn, driven, logged
from driveline.harness.identification.prior_knowledge import identify
from driverecords.measurement import read_measurement

CAR = Car(J_2=0.42, C=96.0, phi_B=0.11, tau=0.0036)
LOOPS = [
    Loop("car first", late_omega=0.001, late_T_load=0.0007, amplitude=15.0),
    Loop("motor first", late_T_mot=0.003, late_T_load=0.003, amplitude=50.0),
]


@pytest.mark.slow
@pytest.mark.parametrize("loop", LOOPS)
def test_cars_in_other_loops_are_right_to_within_what_is_asked(loop: Loop, tmp_path: Path) -> None:
    logged(driven([CAR], [loop], [1])[..., 0], CAR, loop, 1, tmp_path / "drive.csv")
    found = identify(read_measurement(tmp_path / "drive.csv", CAR.i, CAR.r), CAR.known)
    for name, within in (("J_2", 0.02), ("C", 0.003), ("phi_B", 0.01)):
        off = getattr(found.p, name) / getattr(CAR, name) - 1.0
        assert abs(off) < within, name
    np.testing.assert_allclose((found.p.late_T, found.p.late_L), loop.shifts, atol=2e-4)
    named = [text for text in found.warnings if " comes " in text]
    assert bool(named) == (max(map(abs, loop.shifts)) > 3e-4)


def test_the_drive_is_that_of_the_equations_of_motion() -> None:
    """Balance of momentum over half a second, with the mean of the torque that acted."""
    true = driven([CAR], [Loop()], [1], duration=1.0)[..., 0]
    first, last = 200 * PARTS, 700 * PARTS
    T = np.trapezoid(true[first : last + 1, [1, 4]], dx=STEP / PARTS, axis=0)
    gained = (true[last, 2:4] - true[first, 2:4]) @ [CAR.J_1, CAR.J_2]
    assert gained == pytest.approx(T.sum(), abs=3e-3 * np.abs(T).max())


def test_what_is_held_acts_half_a_step_early_or_late_beside_what_the_logger_delays() -> None:
    assert Loop(late_omega=0.001, late_T_load=0.0015).shifts == pytest.approx((-0.001, 0.0005))
    assert Loop("motor first").shifts == (0.5 * STEP, 0.0)
    assert Loop("car first", late_T_mot=0.001).shifts == pytest.approx((0.0005, 0.0))


def test_every_second_recording_that_is_drawn_is_skewed() -> None:
    _, loops = drawn(20, seed=3)
    assert all(loop.shifts == (0.0, 0.0) for loop in loops[::2])
    assert all(0.0 < loop.late_omega < 0.001 for loop in loops[1::2])
    assert {loop.amplitude for loop in loops} == {15.0, 30.0, 50.0}
