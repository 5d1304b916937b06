"""What the figures show: axes, lines, what is marked, and the files."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patches import Rectangle
from matplotlib.text import Annotation

import driveline
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.metrics.evaluate import evaluate
from driveline.harness.metrics.step_response import SETTLED, response
from driveline.harness.views import figure_style, replay_figure
from driveline.harness.views.annotations import BAND, GAP, gap
from driveline.harness.views.drive_figure import AROUND, plot_drive, reversal
from driveline.harness.views.figure_options import KINDS, FigureOptions
from driveline.harness.views.figure_style import titled
from driveline.harness.views.replay_figure import PIECE, plot_replay, roughest
from driveline.harness.views.run_figure import plot_run
from driveline.harness.views.step_figure import plot_step
from driverecords.file_units import FileUnit
from fmuloop.results import Results
from toolground.plain_text import printed

TIPIN, DRIVE = MANOEUVRES["tipin15"], MANOEUVRES["drive"]
OPEN = (1.010, 1.030)
"""From and to when the teeth are apart after the step."""


def run(manoeuvre: Any, swing: float, duration: float, with_estimate: bool = True) -> np.ndarray:
    """Signals that look like those of a run: `swing` N.m about the demand at 8 Hz after each jump."""
    t = 0.001 * np.arange(round(duration / 0.001) + 1)
    names = [
        "time", "controller.T_driver", "controller.T_ref", "controller.T_damp", "controller.T_gear_hat",
        "motor.T_mot", "can.omega_2_can", "plant.T_gear", "plant.T_rim", "plant.omega_1", "plant.omega_2",
        "plant.omega_wheel_L", "plant.omega_wheel_R", "plant.v", "plant.a_body",
    ]  # fmt: skip
    if not with_estimate:
        names = [name for name in names if name not in ("controller.T_gear_hat", "controller.T_damp")]
    found = np.zeros(len(t), dtype=[(name, float) for name in names])
    demand = np.asarray(manoeuvre.T_driver(t), dtype=float)
    since = np.zeros(len(t))
    for k in range(1, len(t)):
        since[k] = 0.0 if abs(demand[k] - demand[k - 1]) > 0.1 else since[k - 1] + 0.001
    T_gear = demand + swing * np.exp(-4.0 * since) * np.sin(2.0 * np.pi * 8.0 * t)
    if manoeuvre.dT:
        T_gear[(t >= OPEN[0] - 1e-9) & (t <= OPEN[1] + 1e-9)] = 0.0
    speed = 100.0 + 5.0 * t + 0.1 * swing * np.exp(-4.0 * since) * np.sin(50.0 * t)
    columns = {
        "time": t, "controller.T_driver": demand, "controller.T_ref": demand, "motor.T_mot": demand,
        "plant.T_gear": T_gear, "plant.T_rim": 9.0 * T_gear, "plant.omega_1": speed, "plant.omega_2": 100.0 + 5.0 * t,
        "plant.omega_wheel_L": (100.0 + 5.0 * t) / 9.0, "plant.omega_wheel_R": (100.0 + 5.0 * t) / 9.0,
        "plant.v": (100.0 + 5.0 * t) / 30.0, "plant.a_body": T_gear / 50.0, "can.omega_2_can": 100.0 + 5.0 * t,
        "controller.T_gear_hat": T_gear, "controller.T_damp": 0.0 * t,
    }  # fmt: skip
    for name in names:
        found[name] = columns[name]
    return found


NAMES = "without damping", "mine", "theirs"
STEPS = run(TIPIN, 60.0, 4.0), run(TIPIN, 8.0, 4.0)
TWO_STEPS: dict[str, np.ndarray] = dict(zip(NAMES, STEPS, strict=False))
DRIVES = run(DRIVE, 60.0, 20.0), run(DRIVE, 8.0, 20.0)
RECORDED = (np.array([0.0, 10.0, 20.0]), np.array([3.0, 5.0, 7.0]))
UNITS = {"v": FileUnit("km/h", 1.0 / 3.6), "T_mot": FileUnit("kNm", 1e3)}
RIDES: dict[str, np.ndarray] = dict(zip(NAMES, (*DRIVES, DRIVES[1]), strict=True))

WITHOUT = {name: run(TIPIN, swing, 4.0, False) for name, swing in zip(NAMES, (60.0, 8.0, 7.0), strict=True)}

PLOTS: dict[str, Callable[[Path, FigureOptions], list[Path]]] = {
    "step": lambda stem, options: plot_step(TWO_STEPS, TIPIN, "Plant", stem, options),
    "drive": lambda stem, options: plot_drive(dict(zip(NAMES, DRIVES, strict=False)), DRIVE, "Plant", stem, options),
    "run": lambda stem, options: plot_run(STEPS[0], TIPIN, "Plant", stem, options),
    "run of a drive": lambda stem, options: plot_run(DRIVES[0], DRIVE, "Plant", stem, options),
    "replay": lambda stem, options: plot_replay(RIDES, RECORDED, "a drive", stem, options, UNITS),
}
POORER: dict[str, Callable[[Path, FigureOptions], list[Path]]] = {
    "without an estimate": lambda stem, options: plot_step(WITHOUT, TIPIN, "Plant", stem, options),
    "without units": lambda stem, options: plot_replay(RIDES, RECORDED, "a drive", stem, options),
}

Drawn = Callable[..., Figure]


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    """Draws one of the PLOTS, neither laid out nor written."""
    figures: list[Figure] = []

    def keep(figure: Figure, path: Path, **_: Any) -> None:
        FigureCanvasAgg(figure)
        figures.append(figure)
        path.touch()

    @cache
    def draw(name: str, window: tuple[float, float] | None = None) -> Figure:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Figure, "savefig", keep)
            (PLOTS | POORER)[name](tmp_path_factory.mktemp("drawn") / name, FigureOptions("", window, ("png",)))
        return figures[-1]

    return draw


def labelled(figure: Figure, *words: str) -> list[Axes]:
    """The axes whose label has all these words."""
    return [axes for axes in figure.axes if all(word in axes.get_ylabel() for word in words)]


def notes(axes: Axes) -> str:
    return "\n".join(text.get_text() for text in axes.texts if not isinstance(text, Annotation))


def spans(axes: Axes) -> list[tuple[float, float]]:
    """From and to when the gap is shaded."""
    filled = [patch for patch in axes.patches if isinstance(patch, Rectangle) and patch.get_fill()]
    return [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in filled]


def test_the_body_is_in_the_figure_of_a_step_with_the_rms_of_its_jerk(drawn: Drawn) -> None:
    figure = drawn("step")
    assert [axes.get_ylabel().replace("\n", " ") for axes in figure.axes[::2]] == [
        "gear torque in N·m",
        "motor torque in N·m",
        "speed in rad/s, motor side",
        "acceleration of the body in m/s²",
        "its jerk up to 50 Hz in m/s³",
    ]
    assert len(drawn("without an estimate").axes) == 3 * 5
    for axes, results in zip(figure.axes[-2:], STEPS, strict=True):
        assert notes(axes) == f"rms {evaluate(results, TIPIN).jerk_rms:.1f} m/s³"


@pytest.mark.parametrize("name", ["step", "run"])
def test_a_step_is_marked_as_the_metrics_find_it_and_no_other_manoeuvre(drawn: Drawn, name: str) -> None:
    assert not drawn("run of a drive").axes[0].collections
    found, metrics = drawn(name).axes[0], evaluate(STEPS[0], TIPIN)
    answer = response(STEPS[0]["time"][::2], STEPS[0]["plant.T_gear"][::2], 1.0, 112.0)
    (band,) = (each for each in found.collections if each.get_label() == BAND and isinstance(each, PolyCollection))
    (outline,) = band.get_paths()
    at_end = np.asarray(outline.vertices)
    at_end = at_end[at_end[:, 0] == at_end[:, 0].max()][:, 1]
    assert np.ptp(at_end) == pytest.approx(2.0 * SETTLED * 112.0)
    (arrow,) = (text for text in found.texts if isinstance(text, Annotation))
    peak, final = arrow.xy[1], arrow.xyann[1]
    assert peak - final == pytest.approx(
        metrics.overshoot * (answer.final[500] - STEPS[0]["plant.T_gear"][998]), rel=1e-6
    )
    (settled,) = (x for line in found.lines if np.ptp(x := np.asarray(line.get_xdata())) == 0.0)
    assert settled[0] == pytest.approx(1.0 + metrics.settling_time)
    text = notes(found)
    assert f"overshoot {100.0 * metrics.overshoot:.0f} %, settling {1e3 * metrics.settling_time:.0f} ms" in text
    assert f"rms {metrics.gear_torque_rms:.1f} N·m" in text


def test_the_teeth_float_wherever_the_gear_torque_is_zero() -> None:
    run = STEPS[0][:100].copy()
    run["plant.T_gear"] = 1.0
    t = run["time"]
    for first, last in ((0, 3), (40, 40), (50, 70), (90, 99)):
        run["plant.T_gear"][first : last + 1] = 0.0
    spans = gap(run)  # at least one sample wide, so that it can be seen
    assert list(zip(spans.x, spans.end, strict=True)) == [
        (t[0], t[3]), (t[40], pytest.approx(t[41])), (t[50], t[70]), (t[90], t[99])
    ]  # fmt: skip


def test_the_gap_is_shaded_in_every_row_and_told_once(drawn: Drawn) -> None:
    for name in ("step", "run"):
        figure = drawn(name)
        assert all(spans(axes) == [pytest.approx(OPEN)] for axes in figure.axes)
        labels = [text.get_text() for axes in figure.axes if (made := axes.get_legend()) for text in made.get_texts()]
        assert labels.count(GAP) == 1


@pytest.mark.slow
def test_a_run_with_long_steps_is_drawn_without_what_needs_the_samples_of_the_controller(tmp_path: Path) -> None:
    for stride in (7, 100):
        plot_run(STEPS[0][::stride], TIPIN, "Plant", tmp_path / "run", FigureOptions(kinds=("png",)))
    assert (tmp_path / "run.png").stat().st_size > 0


def test_the_drive_shows_the_wheel_side_a_reversal_and_the_envelope(drawn: Drawn) -> None:
    figure = drawn("drive")
    (wheel,) = labelled(figure, "wheel speed", "wheel side")
    (line,) = wheel.lines
    assert line.get_ydata() == pytest.approx(DRIVES[0]["plant.omega_wheel_L"])
    (closer,) = labelled(figure, "close-up")
    begin, end = closer.get_xlim()
    assert end - begin == pytest.approx(AROUND[1] - AROUND[0])
    turn = begin - AROUND[0]
    before, after = (float(DRIVE.T_driver(turn + by)) for by in (-0.05, 0.01))
    assert before * after < 0.0
    (envelopes,) = labelled(figure, "5-50 Hz", "envelope")
    off, on = (np.asarray(line.get_ydata()) for line in envelopes.lines)
    assert off.max() > 3.0 * on.max()
    assert envelopes.get_xlim() == (0.0, 20.0)


def test_the_reversal_is_where_the_torque_swings_most_and_within_the_window() -> None:
    quiet = DRIVES[0].copy()
    quiet["plant.T_gear"] = quiet["controller.T_driver"]
    at = (quiet["time"] > 9.5) & (quiet["time"] < 10.5)
    quiet["plant.T_gear"][at] += 80.0 * np.sin(50.0 * quiet["time"][at])
    found = reversal(quiet, (0.0, 20.0))
    assert found is not None
    assert found[0] < 9.6 < found[1]
    earlier = reversal(quiet, (0.0, 6.0))
    assert earlier is not None
    assert earlier[1] <= 6.0
    assert reversal(quiet, (0.0, 4.0)) is None


def test_a_drive_without_a_reversal_has_no_close_up(drawn: Drawn) -> None:
    figure = drawn("drive", window=(0.5, 4.0))
    assert not labelled(figure, "close-up")
    assert all(axes.get_xlim() == (0.5, 4.0) for axes in figure.axes)


@pytest.mark.parametrize("name", PLOTS)
def test_a_window_is_shown_and_nothing_is_drawn_outside(drawn: Drawn, name: str) -> None:
    for axes in drawn(name, window=(1.25, 1.5)).axes:
        assert axes.get_xlim() == (1.25, 1.5)
        for line in axes.lines:
            x = np.asarray(line.get_xdata())
            assert ((x >= 1.25 - 1e-9) & (x <= 1.5 + 1e-9)).all()


def test_a_recorded_drive_is_in_the_units_of_its_file(drawn: Drawn) -> None:
    speed, swing, *_ = drawn("without units").axes
    assert (speed.get_ylabel(), swing.get_ylabel().split("\n")[1]) == ("speed in km/h", "envelope in N·m")
    figure = drawn("replay")
    speed, swing, *close = figure.axes
    assert speed.get_ylabel() == "speed in km/h"
    recorded, simulated = (np.asarray(line.get_ydata()) for line in speed.lines)
    assert recorded == pytest.approx(3.6 * RECORDED[1])
    assert simulated == pytest.approx(3.6 * DRIVES[1]["plant.v"])
    assert swing.get_ylabel().endswith("envelope in kNm")
    assert all(axes.get_ylabel() == "gear torque\nin kNm" for axes in close)
    assert max(float(np.max(line.get_ydata())) for axes in close for line in axes.lines) < 0.3
    rms = [float(str(line.get_label()).split()[-2]) for line in swing.lines]
    assert rms[0] == pytest.approx(1e-3 * evaluate(DRIVES[0], DRIVE).gear_torque_rms, rel=0.01)


def test_many_controllers_are_shown_two_at_a_time_from_before_the_roughest_piece(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rides = {"off": DRIVES[0]} | {f"controller {k}": DRIVES[1] for k in range(5)}
    shown: list[Any] = []
    monkeypatch.setattr(replay_figure, "plot", lambda rows, *_, **__: shown.extend(panel for (panel,) in rows) or [])
    plot_replay(rides, RECORDED, "drive", tmp_path / "run")
    assert [len(panel.parts) for panel in shown if "envelope" in panel.label] == [3, 3, 2]
    start = roughest(DRIVES[0])[0][0]
    assert {panel.x.window[0] for panel in shown if panel.x} == {max(start - replay_figure.LEAD, 0.0)}


def lightness(color: Any) -> float:
    return float(np.dot((0.299, 0.587, 0.114), to_rgb(color)))


@pytest.mark.parametrize("name", PLOTS)
def test_lines_can_be_told_apart_in_a_grey_print(drawn: Drawn, name: str) -> None:
    for axes in drawn(name).axes:
        for one, other in combinations(axes.lines, 2):
            dashes = [(line.get_linestyle(), line._unscaled_dash_pattern) for line in (one, other)]  # type: ignore[attr-defined]
            lighter = abs(lightness(one.get_color()) - lightness(other.get_color()))
            assert dashes[0] != dashes[1] or lighter > 0.25, f"{one.get_label()} and {other.get_label()}"


@pytest.mark.parametrize("name", PLOTS)
def test_legends_and_notes_cover_no_curve(drawn: Drawn, name: str) -> None:
    figure = drawn(name)
    figure.draw_without_rendering()
    for axes in figure.axes:
        made = axes.get_legend()
        if made:
            box = made.get_window_extent()
            assert box.y0 >= axes.bbox.y1 - 1e-6
            assert box.x1 <= figure.bbox.width
        for text in axes.texts:
            if not isinstance(text, Annotation) and text.get_text():
                box = text.get_window_extent()
                for line in axes.lines:
                    at = axes.transData.transform(np.asarray(line.get_xydata()))
                    assert not ((at[:, 0] > box.x0) & (at[:, 1] > box.y0)).any()


@pytest.mark.slow
def test_the_same_runs_give_the_same_files_of_every_kind(tmp_path: Path) -> None:
    first, second = ([*PLOTS["replay"](tmp_path / part / "run", FigureOptions(kinds=tuple(KINDS)))] for part in "ab")
    assert [file.suffix for file in first] == [".png", ".pdf", ".svg"]
    for one, other in zip(first, second, strict=True):
        assert one.read_bytes() == other.read_bytes()
    pdf, svg = first[1].read_bytes(), first[2].read_text(encoding="utf-8")
    fonts = set(re.findall(rb"/Subtype\s*/(Type3|TrueType|Type0|Type1|CIDFontType\d)\b", pdf))
    assert fonts == {b"Type0", b"CIDFontType2"}, "TrueType, as publishers want it"
    assert b"/FontFile2" in pdf
    assert b"Date" not in pdf
    assert ET.fromstring(svg).tag == "{http://www.w3.org/2000/svg}svg"
    assert "dc:date" not in svg
    assert "<text" not in svg, "which would look for a font that may not be there"


@pytest.mark.slow
def test_nothing_but_png_and_pdf_is_written_unless_asked(tmp_path: Path) -> None:
    files = PLOTS["step"](tmp_path / "run", FigureOptions())
    assert [file.name for file in files] == ["run.png"] == [p.name for p in tmp_path.iterdir()]


@pytest.mark.parametrize("size", [8.5, 10.0])
def test_titles_and_captions_are_not_cut(size: float) -> None:
    title = "ValidationVehicle, stand on a 10 % grade under the brakes, then pull away uphill, damping on" * 2
    figure = Figure(figsize=(7.2, 4.0), layout=ConstrainedLayoutEngine())
    figure.subplots()
    titled(figure, title, "--set plant.phi_B=0.03 --vehicle 'my $cars$/van.toml' " * 4, size)
    FigureCanvasAgg(figure).draw()
    assert len(figure.texts) == 2
    for text in figure.texts:
        box = text.get_window_extent()
        assert 0.0 < box.x0 < box.x1 < figure.bbox.width
        assert 0.0 < box.y0 < box.y1 < figure.bbox.height


@pytest.mark.parametrize("begin", [1.0, 9.0, 14.0])
def test_the_close_up_of_a_replay_is_where_the_gear_torque_swings_most(begin: float) -> None:
    run = DRIVES[0].copy()
    run["plant.T_gear"] = run["controller.T_driver"]
    at = (run["time"] > begin) & (run["time"] < begin + 3.0)
    run["plant.T_gear"][at] += 20.0 * np.sin(50.0 * run["time"][at])
    first, swing = roughest(run)[0]
    assert first <= begin < begin + 3.0 <= first + PIECE
    assert swing == pytest.approx(10.0, rel=0.1)  # half of the piece swings by 20 N.m


@pytest.mark.parametrize(
    ("results", "names", "more", "labels", "window"),
    [
        (STEPS[1], [], {}, ["gear torque\nin N·m", "motor torque\nin N·m"], (0.9, 2.4)),
        (STEPS[1], ["plant.T_gear"], {"window": (1.0, 1.5)}, ["plant.T_gear\nin N·m"], (1.0, 1.5)),
        (DRIVES[1], ["plant.T_gear"], {}, ["plant.T_gear\nin N·m"], (0.0, 20.0)),
        (TWO_STEPS, [], {}, ["plant.T_gear\nin N·m", "controller.T_ref\nin N·m"], (0.9, 2.4)),
    ],
)
def test_a_program_shows_runs_in_one_line_a_step_close_up(
    monkeypatch: pytest.MonkeyPatch, results: Any, names: list[str], more: Any, labels: Any, window: Any
) -> None:
    made: list[Figure] = []
    monkeypatch.setattr(figure_style, "save", lambda figure, stem, kinds: made.append(figure) or [stem, *kinds])
    units = {"plant.T_gear": "N.m", "controller.T_ref": "N.m"}
    runs = results if isinstance(results, dict) else {"": results}
    known = {name: Results(run, units) for name, run in runs.items()}
    driveline.plot(known if len(runs) > 1 else known[""], names, file="run.svg", **more)
    (figure,) = made
    assert [axes.get_ylabel() for axes in figure.axes][: len(labels)] == labels
    assert figure.axes[0].get_xlim() == pytest.approx(window)
    assert len(figure.axes[0].lines) == (len(runs) if names or len(runs) > 1 else 3)


def test_a_run_is_shown_where_no_file_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[int] = []
    monkeypatch.setattr(pyplot, "show", lambda: shown.append(len(pyplot.get_fignums())))
    Results(STEPS[1], {}).plot()
    pyplot.close("all")
    assert shown == [1]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"names": ["T_gear"]}, "no column T_gear; did you mean plant.T_gear"),
        ({"names": "plant.T_gear"}, "names = 'plant.T_gear': it must be a list of"),
        ({"file": "run.jpg"}, "file = run.jpg: it must end in .png, .pdf, .svg"),
    ],
)
def test_what_cannot_be_shown_is_said(given: Any, message: str) -> None:
    with pytest.raises(driveline.DrivelineError, match=message):
        Results(STEPS[1], {}).plot(**given)


def test_no_run_cannot_be_shown() -> None:
    with pytest.raises(driveline.DrivelineError, match=r"results = \{\}: there must be a run to show"):
        driveline.plot({})


@pytest.mark.parametrize(
    ("unit", "text"), [("N.m", "N·m"), ("m/s3", "m/s³"), ("(N.m)^5", "(N·m)⁵"), ("1/min", "1/min"), ("kg.m2", "kg·m²")]
)
def test_units_are_printed_in_one_spelling(unit: str, text: str) -> None:
    assert printed(unit) == text
