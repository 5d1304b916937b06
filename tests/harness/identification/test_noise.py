"""The white noise of a channel is found beside all that a drive train does."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from fmutesting.slow import slow
from fmutesting.together import together

from driveline.harness.identification.noise import white_noise
from driveline.harness.manoeuvres.prbs import binary_torque
from driveline.harness.simulation.simulate import simulate
from packages.driverecords.tests.car import drive

WITHIN = 0.1
"""What is asked for."""

COUNT = 5000
K = np.arange(COUNT)


def white(seed: int, count: int = COUNT) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(count)


def test_white_noise_alone() -> None:
    found = [white_noise(0.15 * white(seed)) / 0.15 for seed in range(8)]
    assert np.mean(found) == pytest.approx(1.0, abs=0.05)
    assert np.std(found) < 0.03


def test_of_interpolated_noise_that_of_the_lowest_frequencies_looked_at_counts() -> None:
    """Half-way between samples .71 of it are left in all, and nothing at the highest."""
    between = [0.5 * (x[1:] + x[:-1]) for x in map(white, range(3))]
    assert np.mean([white_noise(x, coloured=True) for x in between]) == pytest.approx(0.64, abs=0.05)
    assert max(white_noise(x) for x in between) < 0.4


def test_it_grows_with_the_unit_and_knows_no_offset_and_no_slope() -> None:
    x = white(1)
    assert white_noise(30.0 * x + 500.0 + 0.1 * K) == pytest.approx(30.0 * white_noise(x), rel=1e-9)


def test_without_noise_there_is_none() -> None:
    assert white_noise(np.full(COUNT, 7.0)) < 1e-12


@pytest.mark.parametrize(("name", "noise"), [("omega_1", 0.15), ("T_mot", 0.3), ("T_load", 1.1)])
def test_beside_what_a_drive_train_does(name: str, noise: float) -> None:
    clean = drive()[name]
    assert white_noise(clean) < 0.1 * noise
    for seed in range(2):
        assert white_noise(clean + noise * white(seed, len(clean))) == pytest.approx(noise, rel=WITHIN)


@pytest.mark.parametrize("resolution", [0.05, 0.1, 0.3])
def test_with_the_noise_of_the_rounding(resolution: float) -> None:
    clean = drive()["omega_1"]
    rounded = np.round((clean + 0.15 * white(1, len(clean))) / resolution) * resolution
    assert white_noise(rounded) == pytest.approx(np.hypot(0.15, resolution / np.sqrt(12.0)), rel=WITHIN)


@together("size, frequency, swing", product([1.0, 5.0], [0.45, 0.9], [0.0, 1.5]))
def test_beside_the_ripple_of_a_motor(size: float, frequency: float, swing: float) -> None:
    """A line, also one that goes to and fro with an oscillation of 8 Hz; rms over noise, frequency over Nyquist's."""
    ripple = size * np.sqrt(2.0) * np.sin(np.pi * frequency * K + swing * np.sin(2.0 * np.pi * 8.0 * 0.002 * K))
    assert white_noise(white(2) + ripple) == pytest.approx(1.0, abs=WITHIN)


def test_beside_hits_that_ring() -> None:
    """180 Hz for some 10 ms, at ten times the noise, 6 times a second."""
    ring = 10.0 * np.exp(-np.arange(40) / 5.0) * np.sin(0.72 * np.pi * np.arange(40))
    hits = (np.random.default_rng(3).random(COUNT) < 6.0 * 0.002).astype(float)
    assert white_noise(white(3) + np.convolve(hits, ring)[:COUNT]) == pytest.approx(1.0, abs=WITHIN)


CARS = [
    ("TwoMassDriveline", False),
    ("TwoMassDriveline", True),
    ("ValidationVehicle", False),
    ("ValidationVehicle", True),
]


@pytest.mark.parametrize(("plant", "control"), slow(CARS, but=[("ValidationVehicle", True)]))
def test_in_what_the_sensors_of_a_test_drive_record(both_built: Path, plant: str, control: bool) -> None:
    true = {"motor.omega_1_meas": np.hypot(0.15, 0.1 / np.sqrt(12.0)), "motor.T_mot_est": 0.3}
    manoeuvre = binary_torque("prbs", 10.0, 30.0, 0.04, 9, 10.0, 15.0 / 3.6)
    for seed in (1, 2):
        results = simulate(manoeuvre, plant=plant, control=control, seed=seed, folder=both_built)[::2]
        for name, noise in true.items():
            assert white_noise(results[name]) == pytest.approx(noise, rel=WITHIN), name
        T_wheel = results["plant.T_rim"] + 10.0 * white(seed, len(results))
        assert white_noise(T_wheel) == pytest.approx(10.0, rel=WITHIN)
