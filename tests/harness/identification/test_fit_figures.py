"""What the figures of identification show is what they say, and the same answer gives the same bytes."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from driveline.harness.identification import cost_surface, uncertainty_figures
from driveline.harness.identification.drive_train import STEPS, Parameters
from driveline.harness.identification.drive_train_response import Tyre, response
from driveline.harness.identification.fit_figures import plot_innovations, plot_simulation
from driveline.harness.identification.free_runs import free_runs
from driveline.harness.identification.identify import WITH_LOAD, WITHOUT_LOAD, Identified
from driveline.harness.identification.maximum_likelihood import maximise
from driveline.harness.identification.model_inputs import Drive
from driveline.harness.identification.prediction import Noise, Predictor
from driveline.harness.identification.quality import SIMULATED, Quality
from driveline.harness.identification.segment_simulation import Simulator
from driveline.harness.identification.uncertainty_figures import INSIDE, plot_cost, plot_response
from driveline.harness.manoeuvres.prbs import shift_register
from driveline.harness.recordings.file_units import FileUnit
from driveline.harness.recordings.measurement import Measurement
from driveline.harness.views.figure_options import FigureOptions
from tests.slow import slow

CAR = Parameters(J_1=0.055, J_2=0.3, C=117.4, d=0.3, phi_B=0.157)
T_S, COUNT, SIGMA, SIGMA_LOAD = 0.002, 1500, 0.15, 0.5
FREE = ("J_2", "C", "phi_B", "d")
WRITTEN = {
    "T_mot": FileUnit("kNm", 1e3),
    "omega_1": FileUnit("rpm", np.pi / 30.0),
    "omega_2": FileUnit("km/h", 9.0, "over ground"),
    "T_load": FileUnit("Nm", 0.1, "wheel side"),
}


@cache
def truth(p: Parameters = CAR, count: int = COUNT) -> tuple[Drive, np.ndarray]:
    """A drive of the model itself with noise of motor speed and load torque, and its states."""
    bits = np.repeat(shift_register(count // 20 + 1), 20)[:count]
    T_mot = np.repeat(10.0 + 30.0 * (2.0 * bits[:, None] - 1.0), STEPS, axis=1)
    drive = Drive(T_S, np.zeros(count + 1), T_mot, np.full((count, STEPS), -10.0))
    start = np.array([130.0, 130.0, p.phi_B + 10.0 / p.C, 0.0, 0.0])
    states = np.vstack([start, Simulator(count).run(drive, 0, start, p)])
    noise = np.random.default_rng(1).standard_normal((2, count + 1))
    T_load = drive.T_load + SIGMA_LOAD * noise[1, 1:, None]
    return replace(drive, omega_1=states[:, 0] + SIGMA * noise[0], T_load=T_load), states


@cache
def answer() -> Identified:
    drive, _ = truth()
    noise = Noise(SIGMA, 0.0, SIGMA_LOAD)
    found = maximise(Predictor(FREE), drive, CAR, noise)
    tyre, quality = Tyre(480.0, 27.0, 1.5, 0.98), Quality(99.0, 99.0, 99.0, 1.0, 0.0)
    return Identified(
        "prediction error", found.p, found.covariance, FREE, noise, (), WITH_LOAD, None, tyre, quality, drive
    )


def without_load() -> Identified:
    return replace(answer(), name=WITHOUT_LOAD, method="output error", tyre=None)


@cache
def recording() -> Measurement:
    drive, states = truth()
    time = 100.0 + T_S * np.arange(COUNT + 1)
    T_mot, T_load = np.append(drive.T_mot[:, 0], drive.T_mot[-1, 0]), np.full(COUNT + 1, -10.0)
    return Measurement(
        "drive", time, T_mot, drive.omega_1, states[:, 1], time < 102.0, None, T_load, None, {}, (), (), WRITTEN
    )


def test_free_runs_of_the_true_model_are_the_truth() -> None:
    drive, states = truth()
    runs = free_runs(replace(answer(), p=CAR), recording(), (101.0, 103.0))
    between = np.isnan(runs.time)
    assert between.sum() == 4
    assert np.isnan(runs.T_gear[between]).all()
    assert np.diff(runs.time[~between]) == pytest.approx(T_S)
    assert runs.time[~between][-1] == pytest.approx(recording().time[-1])
    at = np.rint((runs.time[~between] - 100.0) / T_S).astype(int)
    assert len(at) == 4 * round(SIMULATED / T_S)
    y = states[at, 2] - np.clip(states[at, 2], -CAR.phi_B, CAR.phi_B)
    for found, true, off in (
        (runs.omega_1, states[at, 0], 0.1),
        (runs.omega_2, states[at, 1], 0.5),
        (runs.T_gear, CAR.C * y + CAR.d * np.minimum(1.0, abs(y) / 0.01) * (states[at, 0] - states[at, 1]), 0.5),
    ):
        assert np.sqrt(np.mean((found[~between] - true) ** 2)) < off
    assert runs.error[~between] == pytest.approx(runs.omega_1[~between] - drive.omega_1[at], abs=1e-12)


@pytest.mark.parametrize(("x", "y"), [("J_2", "C"), ("C", "phi_B")])
def test_where_the_likelihood_is_right_the_ellipse_is_a_contour_of_the_cost(x: str, y: str) -> None:
    one = answer()
    fine = cost_surface.cost_over(one, x, y, cost_surface.curvature(one)).fine
    on_x, on_y = cost_surface.ellipse(one, x, y, INSIDE)
    rows, columns = (
        np.rint(np.interp(v, of, np.arange(cost_surface.FINE))).astype(int)
        for v, of in ((on_x, fine.x), (on_y, fine.y))
    )
    assert fine.cost[rows, columns] == pytest.approx(0.5 * INSIDE, rel=0.2)
    assert fine.cost.min() == pytest.approx(0.0, abs=0.05)


def test_the_cost_of_output_error_is_that_of_the_covariance() -> None:
    one = without_load()
    surface = cost_surface.cost_over(one, "J_2", "phi_B", cost_surface.curvature(one))
    pair = [FREE.index("J_2"), FREE.index("phi_B")]
    away = np.array([surface.x[-1] - one.p.J_2, surface.y[0] - one.p.phi_B])
    alone = np.linalg.inv(one.covariance[np.ix_(pair, pair)])
    assert surface.cost[-1, 0] == pytest.approx(0.5 * away @ alone @ away)


def test_the_band_is_that_of_small_deviations() -> None:
    one, f = replace(answer(), free=("C",), covariance=np.array([[0.25]])), np.array([4.0, 8.0, 12.0])
    found = np.abs(uncertainty_figures.drawn_responses(one, f, one.tyre, 1)).std(axis=0)
    up, down = (np.abs(response(one.p._replace(C=one.p.C + by), f, one.tyre)) for by in (0.1, -0.1))
    assert found == pytest.approx(0.5 * abs(up - down) / 0.2, rel=0.1)


def test_a_peak_that_is_not_determined_is_not_drawn() -> None:
    k, unknown = FREE.index("J_2"), answer().covariance.copy()
    unknown[k, k] = 1.0
    for one, drawn in ((answer(), True), (replace(answer(), covariance=unknown), False)):
        labels = [getattr(part, "label", "") for part in uncertainty_figures.responses(one)[0].parts]
        assert any("peak at" in label for label in labels) == drawn
        assert any(label.startswith("car on its own") for label in labels)


def test_without_a_gap_the_recording_answers_as_the_model() -> None:
    p = CAR._replace(phi_B=1e-6, d=2.0)
    one = replace(answer(), p=p, drive=truth(p, 20000)[0])
    f, found = uncertainty_figures.recorded_response(one)
    at = (f > 4.0) & (f < 15.0)
    off = found[at] / response(p, f[at])
    assert 20.0 * np.log10(abs(off)) == pytest.approx(np.zeros(at.sum()), abs=0.5)
    assert np.degrees(np.angle(off)) == pytest.approx(np.zeros(at.sum()), abs=3.0)


def test_the_figure_is_in_the_units_of_the_file_and_shows_the_window(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    figures: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, path, **_: (figures.append(figure), path.touch()))
    plot_simulation(answer(), recording(), tmp_path / "run", FigureOptions("", (101.1, 101.9), ("png",)))
    (figure,) = figures
    assert [axes.get_ylabel().replace("\n", " ") for axes in figure.axes] == [
        "motor speed in rpm",
        "difference in rpm",
        "wheel speed in km/h, over ground",
        "torque in kNm",
        "load torque in Nm, wheel side",
    ]
    assert all(axes.get_xlim() == (101.1, 101.9) for axes in figure.axes)
    speed, _, wheels, torque, load = (np.asarray(axes.lines[0].get_ydata()) for axes in figure.axes)
    at = (recording().time >= 101.1) & (recording().time <= 101.9)
    assert speed == pytest.approx(recording().omega_1[at] * 30.0 / np.pi)
    assert wheels == pytest.approx(recording().omega_2[at] / 9.0)
    assert torque == pytest.approx(1e-3 * recording().T_mot[at])
    assert load == pytest.approx(100.0)
    simulated = figure.axes[0].lines[1]
    assert np.nanmax(np.asarray(simulated.get_xdata())) == pytest.approx(101.9, abs=T_S)
    assert np.nanmin(np.asarray(simulated.get_xdata())) == pytest.approx(101.1, abs=2.0 * T_S)


@pytest.mark.parametrize("window", [(100.0, 100.1), (102.95, 103.0), (99.0, 104.0)])
def test_free_runs_of_any_window_are_within_the_recording(window: tuple[float, float]) -> None:
    runs = free_runs(answer(), recording(), window)
    assert np.nanmin(runs.time) >= recording().time[0]
    assert np.nanmax(runs.time) <= recording().time[-1]


Plot = Callable[[Identified, Measurement, Path], list[Path]]

PLOTS: dict[str, Plot] = {
    "simulation": lambda one, of, stem: plot_simulation(one, of, stem, FigureOptions("a caption")),
    "innovations": lambda one, _, stem: plot_innovations(one, stem, FigureOptions("a caption")),
    "cost": lambda one, _, stem: plot_cost(
        replace(one, drive=one.drive.between(0, 300)), stem, FigureOptions("a caption")
    ),
    "response": lambda one, _, stem: plot_response(one, stem, FigureOptions("a caption")),
}


@pytest.mark.parametrize("load", slow([True, False], but=(True,)), ids=["with load", "without load"])
@pytest.mark.parametrize("plot", slow(PLOTS, but=("response",)))
@pytest.mark.slow
def test_the_same_answer_gives_the_same_bytes(plot: str, load: bool, tmp_path: Path) -> None:
    one = answer() if load else without_load()
    of = recording() if load else replace(recording(), T_load=None, valid=None)
    twice = [PLOTS[plot](one, of, tmp_path / name) for name in ("one", "two")]
    assert [[path.name for path in paths] for paths in twice] == [[f"{n}.png"] for n in ("one", "two")]
    assert [path.read_bytes() for path in twice[0]] == [path.read_bytes() for path in twice[1]]
