"""Innovations of the filter where parameters and noise are true, and where they are not."""

from dataclasses import replace

import numpy as np
import pytest

from driveline.harness.identification.drive_train import Parameters, State
from driveline.harness.identification.free_runs import free_runs
from driveline.harness.identification.model_inputs import Drive
from driveline.harness.identification.prediction import Noise, Predicted, Predictor
from tests.harness.identification.simulated import BEHIND, NOISE, SPARE, P, predictor, simulated, states

SETTLED, LAST = 100, 3
"""Samples until the filter has forgotten what it began with, and those at the end whose torque comes 6 ms late."""

AT = State._make(range(len(State._fields)))


def of(drive: Drive, p: Parameters = P, noise: Noise = NOISE) -> Predicted:
    return Predictor(drive, noise, BEHIND).predicted(p)


def test_with_true_parameters_and_noise_the_innovations_are_white_and_of_size_1() -> None:
    for size in predictor().predicted(P).size[:, SETTLED:]:
        n = len(size)
        assert np.mean(size**2) == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / n))
        correlations = np.array([size[lag:] @ size[:-lag] / (size @ size) for lag in range(1, 26)])
        assert np.abs(correlations).max() < 4.0 / np.sqrt(n)


@pytest.mark.parametrize(
    ("changes", "noise"),
    [
        ({"J_1": 1.03 * P.J_1}, NOISE),
        ({"C": 1.03 * P.C}, NOISE),
        ({"phi_B": 1.1 * P.phi_B}, NOISE),
        ({"late_T": 0.0005}, NOISE),
        ({"late_L": -0.002}, NOISE),
        ({}, NOISE._replace(omega_1=0.8 * NOISE.omega_1)),
    ],
)
def test_with_wrong_ones_they_are_larger(changes: dict[str, float], noise: Noise) -> None:
    right, wrong = predictor().predicted(P), of(predictor().drive, P._replace(**changes), noise)
    assert (wrong.rms**2).sum() > (right.rms**2).sum() + 0.05


@pytest.mark.parametrize("late", [{"late_T": 0.0007}, {"late_T": -0.0013}, {"late_L": 0.0015}, {"late_L": -0.001}])
def test_channels_that_are_late_are_explained_by_their_delays(late: dict[str, float]) -> None:
    found = of(simulated(seed=2, p=P._replace(**late)), P._replace(**late))
    np.testing.assert_allclose(found.rms, 1.0, atol=0.08)


def test_the_filter_finds_twist_speeds_and_offsets() -> None:
    small = Noise(0.01, 0.01, 0.01)
    found = of(simulated(seed=2, noise=small, o_T=0.8, o_L=-1.2), noise=small).states
    _, _, omega_2, phi, _ = states(1500 + 2 * SPARE, P, 10.0)[:, SPARE + 1 : SPARE + 1501]
    np.testing.assert_allclose(found[SETTLED:, AT.phi], phi[SETTLED:], atol=5e-3)
    np.testing.assert_allclose(found[SETTLED:, AT.omega_2], omega_2[SETTLED:], atol=0.2)
    assert found[-1, AT.o_T] == pytest.approx(0.8, abs=0.1)
    assert found[-1, AT.o_L] == pytest.approx(-1.2, abs=0.1)


def test_a_motor_torque_without_noise_is_trusted() -> None:
    """Where it is that of the demand, but not next to where it is not."""
    drive = simulated(seed=3, noise=NOISE._replace(T_mot=0.0))
    exact = np.ones(len(drive) + 1, bool)
    wide, narrow = of(drive), of(replace(drive, exact=exact))
    assert narrow.log_S[0].mean() < wide.log_S[0].mean() - 0.02
    exact[800] = False
    again = of(replace(drive, exact=exact)).log_S[0] - narrow.log_S[0]
    assert again[:790] == pytest.approx(0.0, abs=1e-12)
    assert again[801] > 0.01


def test_without_a_load_torque_it_is_not_predicted() -> None:
    drive = replace(predictor().drive, T_load=None)
    found = of(drive, P._replace(c_t=0.0, J_2=1.8, lack_L=3.0))
    assert not found.size[1].any()
    assert not found.log_S[1].any()
    assert np.isfinite(found.cost)


def test_a_recording_that_begins_in_the_middle_of_a_swing_is_explained_as_well() -> None:
    """What the filter is off by until it has found its state does not count."""
    drive = predictor().drive
    for first in range(100, 700, 100):
        through = of(drive.between(first, len(drive)))
        np.testing.assert_array_equal(through.counted, np.arange(SETTLED, len(drive) - first - LAST))
        np.testing.assert_allclose(through.rms, 1.0, atol=0.1)
        counted = through.size[:, SETTLED:-LAST] ** 2 + through.log_S[:, SETTLED:-LAST]
        assert through.cost == pytest.approx(0.5 * counted.sum())


def test_pieces_are_predicted_each_for_itself() -> None:
    drive = predictor().drive
    parted = of(replace(drive, starts=(0, 600)))
    for first, last in ((0, 599), (600, len(drive))):
        alone = of(drive.between(first, last))
        np.testing.assert_allclose(parted.size[:, first:last], alone.size, rtol=1e-9)
        np.testing.assert_array_equal(np.intersect1d(parted.counted, np.arange(first, last)), first + alone.counted)
    at, runs = free_runs(Predictor(replace(drive, starts=(0, 600)), NOISE, BEHIND), P, parted.states, SETTLED)
    assert at[:, 0].tolist() == [101, 701, 951, 1201]
    assert at[:, -1].tolist() == [350, 950, 1200, 1450]
    assert np.sqrt(np.mean((runs[..., 0] - drive.omega_1[at]) ** 2)) < 1.0


def test_the_errors_are_those_of_the_motor_speed() -> None:
    """What the filter knows after a sample lies between what it predicted and what was recorded."""
    through = predictor().predicted(P)
    share = (predictor().drive.omega_1[1:] - through.states[:, 0])[SETTLED:] / through.errors[0, SETTLED:]
    low, middle, high = np.percentile(share, [5.0, 50.0, 95.0])
    assert 0.0 < low < middle < high < 1.2
