"""The effects of the detailed vehicle: each run is made with its own."""

from functools import partial
from pathlib import Path

import pytest

from docs.studies import vehicle_model
from docs.studies.vehicle_model import Run, measured
from driveline.harness.simulation.simulate import simulate

SLOW = ("motor.dT_max", 1000.0)


def test_a_slow_motor_delays_the_torque_and_damping_takes_the_overshoot(
    native: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = partial(simulate, folder=native.parent, build="native")
    monkeypatch.setattr(vehicle_model, "simulate", here)
    usual, slow, damped = map(measured, (Run(None, False), Run(SLOW, False), Run(None, True)))
    assert slow.response_delay > 2.0 * usual.response_delay
    assert damped.overshoot < 0.5 * usual.overshoot
