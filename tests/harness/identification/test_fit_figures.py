"""Figures of an identified model: what they show, and that they remain the same."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from driveline.harness.identification import fit_figures
from driveline.harness.identification.drive_train import STEPS
from driveline.harness.identification.drive_train_response import FREQUENCIES, response
from driveline.harness.identification.fit_figures import INSIDE, plot_fit, predicted
from driveline.harness.identification.identify import WITHOUT_LOAD
from driveline.harness.identification.prediction import Predictor
from driveline.harness.views.figure_options import FigureOptions
from driveline.harness.views.panels import Curve
from driverecords.file_units import FileUnit
from driverecords.measurement import Measurement
from tests.harness.identification.simulated import BEHIND, NOISE, SPARE, T_S, P, identified, simulated, states

WRITTEN = {
    "T_mot": FileUnit("kNm", 1e3),
    "omega_1": FileUnit("rpm", np.pi / 30.0),
    "omega_2": FileUnit("km/h", 9.0, "over ground"),
    "T_load": FileUnit("Nm", 0.1, "wheel side"),
}


@cache
def recording() -> Measurement:
    drive = identified().drive
    time, omega_2 = 100.0 + T_S * np.arange(len(drive) + 1), states(len(drive) + 2 * SPARE, P, 10.0)[2, SPARE:-SPARE]
    given = drive.T_mot, drive.omega_1, omega_2, time < 102.0, None, drive.T_load, None
    return Measurement("drive", time, *given, {}, (), WRITTEN)


def test_the_figure_is_in_the_units_of_the_file_and_shows_the_window(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    figures: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, path, **_: (figures.append(figure), path.touch()))
    plot_fit(identified(), recording(), tmp_path / "run", FigureOptions("", (101.1, 101.9), ("png",)))
    (figure,) = figures
    assert any(fit_figures.READING in " ".join(text.get_text().split()) for text in figure.texts), "what lines mean"
    assert [axes.get_ylabel().replace("\n", " ") for axes in figure.axes] == [
        "motor speed in rpm",
        "difference in rpm",
        "wheel speed in km/h, over ground",
        "torque in kNm",
        "load torque in Nm, wheel side",
        "motor speed over torque in dB",
        "phase in degrees",
        *(f"{name} off by, %" for name in ("$C$", "$\\varphi_B$", "$\\varphi_B$")),
    ]
    over_time = figure.axes[:5]
    assert all(axes.get_xlim() == (101.1, 101.9) for axes in over_time)
    speed, _, wheels, torque, load = (np.asarray(axes.lines[0].get_ydata()) for axes in over_time)
    at = (recording().time >= 101.1) & (recording().time <= 101.9)
    assert speed == pytest.approx(recording().omega_1[at] * 30.0 / np.pi)
    assert wheels.max() == pytest.approx(recording().omega_2[at].max() / 9.0, rel=0.05)
    assert torque == pytest.approx(1e-3 * recording().T_mot[at])
    assert load == pytest.approx(-10.0 * np.asarray(recording().T_load)[at])
    run = np.asarray(figure.axes[0].lines[1].get_xdata())
    assert (np.nanmin(run), np.nanmax(run)) == pytest.approx((101.1, 101.9), abs=2.0 * T_S)
    off = np.asarray(figure.axes[1].lines[0].get_ydata()) * np.pi / 30.0
    assert np.sqrt(np.nanmean(off**2)) < 1.0


@pytest.mark.parametrize("window", [(100.0, 100.1), (102.95, 103.0), (99.0, 104.0)])
def test_predictions_of_any_window_are_within_the_recording(window: tuple[float, float]) -> None:
    curve = predicted(identified(), recording(), window)[0].parts[1]
    assert isinstance(curve, Curve)
    assert np.nanmin(curve.x) >= recording().time[0]
    assert np.nanmax(curve.x) <= recording().time[-1]


def test_the_band_is_that_of_small_deviations() -> None:
    one = identified()
    covariance = np.zeros_like(one.found.covariance)
    k = one.found.free.index("C")
    covariance[k, k] = 0.25
    vars(one.found)["covariance"] = covariance
    drawn = np.abs(fit_figures.drawn_responses(one, one.tyre_of)).std(axis=0)
    p = one.p
    up, down = (np.abs(response(p._replace(C=p.C + by), FREQUENCIES, one.tyre_of(p))) for by in (0.1, -0.1))
    assert np.median(drawn / (0.5 * abs(up - down) / 0.2)) == pytest.approx(1.0, abs=0.05)


def test_the_ellipse_holds_95_percent_of_the_draws_in_percent_of_the_answer() -> None:
    one = identified()
    pair = [one.found.free.index(name) for name in ("J_2", "C")]
    centre = np.array([one.p.J_2, one.p.C])
    covariance = one.found.covariance[np.ix_(pair, pair)]
    edge = fit_figures.ellipses(one)[0].parts[0]
    assert isinstance(edge, Curve)
    away = np.array([edge.x, edge.y]) / 100.0 * centre[:, None]
    np.testing.assert_allclose(np.sum(away * np.linalg.solve(covariance, away), axis=0), INSIDE**2, rtol=1e-6)


def test_without_a_gap_the_recording_answers_as_the_model() -> None:
    p = P._replace(phi_B=1e-6, d=2.0, g_T=1.0)
    drive = simulated(seed=1, n=20000, p=p)
    base = identified()
    one = replace(base, found=replace(base.found, p=p), predictor=Predictor(drive, NOISE, BEHIND))
    f, recorded = fit_figures.recorded_response(one)
    at = (f > 4.0) & (f < 15.0)
    off = recorded[at] / response(p, f[at], one.tyre_of(p))
    assert 20.0 * np.log10(abs(off)) == pytest.approx(np.zeros(at.sum()), abs=1.0)
    assert np.degrees(np.angle(off)) == pytest.approx(np.zeros(at.sum()), abs=6.0)
    assert drive.torque(0.0).shape == (20000, STEPS)


@pytest.mark.slow
@pytest.mark.parametrize("name", [None, WITHOUT_LOAD], ids=["with load", "without load"])
def test_the_same_answer_gives_the_same_bytes(name: str | None, tmp_path: Path) -> None:
    one = identified() if name is None else replace(identified(), name=name)
    of = recording() if name is None else replace(recording(), T_load=None, valid=None)
    twice = [plot_fit(one, of, tmp_path / stem, FigureOptions("a caption")) for stem in ("one", "two")]
    assert [[path.name for path in paths] for paths in twice] == [["one.png"], ["two.png"]]
    assert [path.read_bytes() for path in twice[0]] == [path.read_bytes() for path in twice[1]]
