"""How surely parameters are known where innovations are not white, and which of them the data do not ask for."""

from pathlib import Path

import numpy as np
import pytest

from driveline.harness.base.csv_file import write_csv
from driveline.harness.identification import identify, prior_knowledge
from driveline.harness.identification.diagnostics import LIKELY
from driveline.harness.identification.drive_train import DELAYS, Parameters
from driveline.harness.identification.identify import (
    backward_elimination,
    fit,
    prediction_error_fit,
    sandwich_covariance,
)
from driveline.harness.identification.late_load import price
from driveline.harness.identification.maximum_likelihood import Found
from driveline.harness.identification.model_inputs import Drive
from driveline.harness.identification.output_error import Fitted
from driveline.harness.identification.prediction import Innovations, Noise, Predictor
from driveline.harness.manoeuvres.prbs import binary_torque
from driveline.harness.recordings.measurement import read_measurement
from driveline.harness.simulation.excitation_drive import MeasurementWheels, sensed
from driveline.harness.simulation.simulate import simulate
from tests.harness.identification.simulated import NOISE, P, simulated

BLOCK = 50


def white(n: int) -> np.ndarray:
    """By two parameters, for n samples."""
    return np.random.default_rng(5).standard_normal((n, 2))


def found(d_size: np.ndarray, free: tuple[str, ...] = ("J_2", "C"), p: tuple[float, ...] = (1.0, 1.0)) -> Found:
    """With innovations of size 1 that depend on the free parameters so."""
    ones, nothing = np.ones(len(d_size)), np.zeros_like(d_size)
    innovations = Innovations(
        size=ones, log_S=0.0 * ones, counted=slice(None), likelihood=True, d_size=d_size, d_log_S=nothing
    )
    return Found(P._replace(**dict(zip(free, p, strict=True))), free, innovations, passes=1)


def test_a_sandwich_is_the_scatter_of_the_blocks_about_their_mean() -> None:
    """At the end of a search the gradient need not be nothing; what all blocks share is no scatter."""
    scores = white(20 * BLOCK) + np.array([0.5, -0.2])
    given = found(scores)
    sums = scores.reshape(20, BLOCK, 2).sum(axis=1)
    scatter = 20 * np.cov(sums.T, bias=True)
    inverse = given.inverse_information
    np.testing.assert_allclose(sandwich_covariance(given, BLOCK), inverse @ scatter @ inverse, rtol=1e-9)


def test_blocks_that_all_say_the_same_leave_no_doubt() -> None:
    same = np.tile(white(BLOCK), (20, 1))
    given = found(same)
    assert np.abs(sandwich_covariance(given, BLOCK)).max() < 1e-12 * np.abs(given.inverse_information).max()


def test_a_sandwich_of_white_innovations_is_the_covariance() -> None:
    """However long the blocks are; a recording shorter than two of them is parted in two."""
    given = found(white(40_000))
    for block in (1, 20):
        np.testing.assert_allclose(np.diag(sandwich_covariance(given, block)), np.diag(given.covariance), rtol=0.15)
    assert np.linalg.matrix_rank(sandwich_covariance(given, 30_000)) == 1


def standing(name: str, likelihood: float) -> tuple[float, float]:
    """Value of a parameter, and what one innovation must depend on it, to be asked for with this likelihood."""
    return identify.NEUTRAL[name] + 0.1, np.sqrt(likelihood) / 0.1


@pytest.mark.parametrize(
    ("d", "g_T", "free"),
    [
        (0.999, 2.0, {"g_T"}),
        (2.0, 0.999, {"d"}),
        (0.5, 0.999, set()),
        (0.999, 0.5, set()),
        (1.001, 2.0, {"d", "g_T"}),
        (1.001, 0.999, {"d"}),
    ],
)
def test_what_the_data_ask_for_least_goes_first(
    d: float, g_T: float, free: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where one is asked for and the other is not, the one goes and the other stays.

    Args:
        d, g_T: twice what each gains in likelihood, over the least that counts.
    """
    values = {"d": standing("d", d * LIKELY), "g_T": standing("g_T", g_T * LIKELY)}
    dropped: list[str] = []

    def with_(names: tuple[str, ...]) -> Found:
        """Each parameter seen by two innovations of its own, whose mean square is 1."""
        slopes = np.diag([values[name][1] for name in names]) / np.sqrt(2.0)
        return found(np.repeat(slopes, 2, axis=0), names, tuple(values[name][0] for name in names))

    def maximise(predictor: Predictor, drive: Drive, start: Parameters, noise: Noise, most: int) -> Found:
        (gone,) = {"d", "g_T"} - {*dropped} - {*predictor.free}
        assert getattr(start, gone) == identify.NEUTRAL[gone]
        dropped.append(gone)
        return with_(predictor.free)

    monkeypatch.setattr(identify, "maximise", maximise)
    best = backward_elimination(simulated(seed=1, n=10), with_(("d", "g_T")), NOISE, (), lambda _: None)
    assert {*best.free} == free
    assert dropped == sorted({"d", "g_T"} - free, key=lambda name: {"d": d, "g_T": g_T}[name])


SURE = 1e-4
"""Standard deviation in s of the delay of a load torque."""

LATE_ALONE, ALSO_LATE = price(SURE, ("late_L",)), price(SURE, ("late_T", "late_L"))


@pytest.mark.parametrize(
    ("fewer", "more", "least"),
    [
        (("J_2",), ("J_2", "late_T"), LIKELY),
        (("J_2", "late_1"), ("J_2", "late_T", "late_L"), ALSO_LATE),
        (("J_2",), ("J_2", "late_T", "late_L"), LIKELY + ALSO_LATE),
        (("J_2",), ("J_2", "late_L"), LATE_ALONE),
        (("J_2", "late_1"), ("J_2", "late_L"), LATE_ALONE - LIKELY),
    ],
)
@pytest.mark.parametrize("share", [-0.01, 0.01])
def test_the_channels_that_are_late_are_those_with_which_the_recording_is_likelier_by_what_they_cost(
    fewer: tuple[str, ...], more: tuple[str, ...], least: float, share: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Twice the gain in likelihood, over the mean square of the innovations of the likelier one."""
    n = 1000

    def with_(free: tuple[str, ...], size: float) -> Found:
        by = np.outer(np.ones(n), [size / (SURE * np.sqrt(n)) if name == "late_L" else 0.0 for name in free])
        return Found(P, free, Innovations(np.full(n, size), np.zeros(n), slice(None), False, by, by), 1)

    ends = (with_(fewer, np.sqrt(1.0 + (least + share) / n)), with_(more, 1.0))
    monkeypatch.setattr(identify, "fits_with_delays", lambda *_: ends)
    monkeypatch.setattr(identify, "backward_elimination", lambda _, end, *__: end)
    best = prediction_error_fit(simulated(seed=1, n=10), P, NOISE)
    assert best is ends[1 if share > 0.0 else 0]


@pytest.mark.parametrize(("error", "near"), [(0.99, True), (1.01, False)])
def test_free_runs_are_fitted_from_the_predicted_parameters_where_those_do_better(
    error: float, near: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Than what was fitted from what a wide filter found: that one ended in a false valley."""
    drive, given = simulated(seed=1, n=10), []
    predicted = P._replace(J_2=0.31, late_1=0.001)
    size = np.full(100, 2.0)
    best = Found(predicted, ("J_2",), Innovations(size, size, slice(None), False, np.ones((100, 1)), size[:, None]), 1)

    def output_error_fit(_: Drive, begin: Parameters, *__: object, near: bool = False) -> Fitted:
        given.append((begin, near))
        return Fitted(begin, ("J_2",), 0.0, np.zeros((1, 4)), np.eye(1), 1.0)

    monkeypatch.setattr(identify, "coarse_fit", lambda _, start, *__: start)
    monkeypatch.setattr(identify, "prediction_error_fit", lambda *_: best)
    monkeypatch.setattr(identify, "output_error_fit", output_error_fit)
    monkeypatch.setattr(identify, "free_run_error", lambda *_: error)
    estimate = fit(drive, P, NOISE, True, (), lambda _: None)
    assert estimate.method == "output error"
    *tried, last = given
    assert tried == [(P._replace(late_1=0.001), False), *([(predicted, True)] if near else [])]
    assert estimate.p == tried[-1][0]
    assert last == (P._replace(late_1=0.001), True)


@pytest.mark.parametrize(
    ("C", "error", "found", "doubt"),
    [
        (1.6 * P.C, 0.99, 1.6 * P.C, 0.6),
        (1.6 * P.C, 1.14, P.C, 0.6),
        (1.6 * P.C, 1.16, P.C, 0.0),
        (P.C / 1.6, 1.14, P.C, 1.0 - 1.0 / 1.6),
        (1.4 * P.C, 1.14, P.C, 0.0),
    ],
)
def test_of_two_valleys_that_fit_free_runs_alike_the_intervals_hold_both(
    C: float, error: float, found: float, doubt: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The second one is sought from what was known of the car; the better of both is the answer."""
    size = np.full(100, 2.0)
    best = Found(P, ("C",), Innovations(size, size, slice(None), False, np.ones((100, 1)), size[:, None]), 1)

    def output_error_fit(_: Drive, begin: Parameters, *__: object, near: bool = False) -> Fitted:
        p, off = (begin._replace(C=C), error) if near else (begin, 1.0)
        return Fitted(p, ("C",), 0.0, np.zeros((1, 4)), np.eye(1), off)

    monkeypatch.setattr(identify, "coarse_fit", lambda _, start, *__: start)
    monkeypatch.setattr(identify, "prediction_error_fit", lambda *_: best)
    monkeypatch.setattr(identify, "output_error_fit", output_error_fit)
    monkeypatch.setattr(identify, "free_run_error", lambda *_: 2.0)
    estimate = fit(simulated(seed=1, n=10), P, NOISE, True, (), lambda _: None)
    assert estimate.p.C == pytest.approx(found)
    assert estimate.deviations["C"] == pytest.approx(np.sqrt(1.0 + 0.5 * (doubt * P.C) ** 2))
    named = [text for text in estimate.warnings if "fit about as well with J_2 = " in text]
    assert len(named) == (doubt > 0.0)


@pytest.mark.parametrize(("g_T", "kept"), [(0.83, True), (0.85, False), (1.15, False), (1.17, True)])
def test_a_motor_torque_has_a_gain_where_it_is_off_by_more_than_four_deviations(
    g_T: float, kept: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To either side; the deviation is 0.04 here."""

    class Pieces:
        def __init__(self, free: tuple[str, ...]) -> None:
            self.free = free

        def fit(self, p: Parameters, starts: object, most: int = 0) -> Fitted:
            scaled = p._replace(g_T=g_T) if "g_T" in self.free else p
            return Fitted(scaled, self.free, 0.0, np.zeros((1, 4)), 0.04**2 * np.eye(len(self.free)), 1.0)

    monkeypatch.setattr(identify, "segments", lambda _, free, __: Pieces(free))
    monkeypatch.setattr(identify, "near_starts", lambda *_: None)
    monkeypatch.setattr(identify, "filtered", lambda *_: None)
    found = identify.output_error_fit(simulated(seed=1, n=3000), P, NOISE, near=True)
    assert (found.p.g_T == g_T) == kept


@pytest.mark.parametrize("late", [0.0, 0.0005, -0.0003])
def test_a_motor_torque_that_is_recorded_late_is_found_and_nothing_else_where_all_is_aligned(late: float) -> None:
    """It is recorded late where it acts as much earlier. A load torque as slow as here does not tell it from a motor
    speed that is as early."""
    car = P._replace(d=0.0, g_T=1.0)
    recorded = simulated(seed=7, n=2000, p=car).acting(P._replace(late_T=-late))
    found = prediction_error_fit(recorded, car._replace(J_2=0.33, C=110.0), NOISE)
    assert len({*DELAYS} & {*found.free}) == (1 if late else 0)
    assert "late_L" not in found.free
    assert found.p.shifts[0] == pytest.approx(late, abs=5e-5)
    assert found.innovations.rms == pytest.approx(1.0, abs=0.08)


@pytest.mark.slow
@pytest.mark.parametrize("amplitude", [2.0, 10.0])
def test_a_weak_drive_of_a_car_that_is_no_two_masses_tells_what_is_not_determined_and_no_cause(
    amplitude: float, both_built: Path, tmp_path: Path
) -> None:
    """What the model lacks is below the noise, and was named as gains, zeros and delays of the torques."""
    manoeuvre = binary_torque("weak", 25.0, amplitude, 0.04, 9, 10.0, 15.0 / 3.6)
    results = simulate(manoeuvre, "ValidationVehicle", control=False, seed=101, folder=both_built)
    write_csv(sensed(results, 9.0, MeasurementWheels(), 101), tmp_path / "drive.csv")
    warnings = prior_knowledge.identify(read_measurement(tmp_path / "drive.csv", 9.0, 0.29)).warnings
    expected = ("not determined", "fit about as well with", "95 % interval wider", "do not explain all")
    assert [text for text in warnings if not any(part in text for part in expected)] == []
    assert any(text.startswith("J_2, C") and "not determined" in text for text in warnings)
