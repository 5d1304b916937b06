"""Panels as data: what is cut, and that every part is drawn in a file and is data of a page."""

from base64 import b64decode
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from matplotlib.figure import Figure

from driveline.harness.views.figure_options import FigureOptions
from driveline.harness.views.figure_style import plot
from driveline.harness.views.page.document import HERE
from driveline.harness.views.page.figures import Arrays, panel_data
from driveline.harness.views.panels import (
    DRAWN,
    MOST_SPANS,
    PIECES,
    Arrow,
    Axis,
    Band,
    Bars,
    Curve,
    Level,
    Panel,
    Part,
    Points,
    Spans,
    seen,
    within,
)

KIT = HERE / "kit.js"

T = np.linspace(0.0, 4.0, 5)
X = Axis("time in s", (0.0, 4.0))
PARTS: dict[type, Part] = {
    Curve: Curve(T, T, "a curve", held=True),
    Points: Points(T, T, "points", marker="square"),
    Band: Band(T, T - 1.0, T + 1.0, "a band"),
    Bars: Bars(T, T, 0.5, "bars"),
    Spans: Spans(T[:2], T[:2] + 0.5, "spans"),
    Level: Level(2.0, upright=True),
    Arrow: Arrow(1.0, 2.0, 3.0),
}


@pytest.mark.parametrize("kind", get_args(Part))
def test_every_part_is_drawn_in_a_file_and_on_a_page(
    kind: type, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, path, **_: (drawn.append(figure), path.touch()))
    panel = Panel("a quantity in N·m", [PARTS[kind]])
    plot([[panel]], X, "title", tmp_path / "figure", FigureOptions(kinds=("png",)))
    (axes,) = drawn[0].axes
    assert [*axes.lines, *axes.patches, *axes.collections, *axes.texts]
    (part,) = panel_data(panel, Arrays())["parts"]
    assert f"  {part['kind']}(ctx, part" in KIT.read_text(encoding="utf-8")


def test_outside_of_a_window_nothing_is_left_but_the_gaps_between_curves() -> None:
    x = np.array([0.0, 1.0, np.nan, 2.0, 3.0])
    panel = Panel("y", [Curve(x, x), PARTS[Level], Spans(np.array([0.0, 1.5]), np.array([1.2, 9.0]))])
    curve, level, spans = within([panel], 1.0, 2.0)[0].parts
    assert isinstance(curve, Curve)
    assert isinstance(spans, Spans)
    np.testing.assert_array_equal(curve.x, [1.0, np.nan, 2.0])
    assert level is PARTS[Level]
    np.testing.assert_array_equal(spans.x, [1.0, 1.5])
    np.testing.assert_array_equal(spans.end, [1.2, 2.0])


def test_of_a_long_curve_the_extremes_of_each_piece_within_the_window_are_drawn() -> None:
    x = np.linspace(0.0, 100.0, 100_001)
    y = np.sin(x)
    y[[50_000, 70_000]] = 7.0, -9.0
    all_of_it, half, brief = (seen(Curve(x, y), *window) for window in ((0.0, 100.0), (40.0, 60.0), (50.0, 51.0)))
    assert isinstance(all_of_it, Curve)
    assert isinstance(half, Curve)
    assert isinstance(brief, Curve)
    assert len(all_of_it.x) == len(all_of_it.y) <= 2 * PIECES
    assert (all_of_it.y.min(), all_of_it.y.max()) == (-9.0, 7.0)
    assert (half.x[0], half.x[-1], half.y.max()) == (40.0, 60.0, 7.0)
    np.testing.assert_array_equal(brief.y, y[50_000:51_001])
    assert brief.y.base is None, "it does not keep the rest"


def test_a_short_curve_is_drawn_as_it_is() -> None:
    x = np.arange(float(DRAWN))
    curve = Curve(x, x)
    assert seen(curve, 10.0, 20.0) is curve
    cut = seen(Curve(np.append(x, DRAWN), np.append(x, 0.0)), 10.0, 20.0)
    assert isinstance(cut, Curve)
    np.testing.assert_array_equal(cut.x, np.arange(10.0, 21.0))


def test_a_long_band_is_drawn_as_wide_as_it_is() -> None:
    x = np.linspace(0.0, 1.0, DRAWN + 1)
    band = seen(Band(x, -x, x), 0.0, 1.0)
    assert isinstance(band, Band)
    assert len(band.x) <= PIECES
    assert (band.low.min(), band.high.max()) == (-1.0, 1.0)


def test_of_many_spans_those_that_nobody_can_tell_apart_are_one() -> None:
    near = np.arange(MOST_SPANS + 1) * 1e-4
    spans = Spans(np.append(near, 5.0), np.append(near + 5e-5, 6.0))
    found = seen(spans, 0.0, 10.0)
    assert isinstance(found, Spans)
    np.testing.assert_array_equal(found.x, [0.0, 5.0])
    np.testing.assert_array_equal(found.end, [near[-1] + 5e-5, 6.0])
    few = spans._replace(x=spans.x[-MOST_SPANS:], end=spans.end[-MOST_SPANS:])
    assert seen(few, 0.0, 10.0) is few


def test_on_a_page_what_is_the_same_is_there_once_and_gaps_keep_their_place() -> None:
    arrays = Arrays()
    x = np.array([0.0, 1.0, np.nan, 2.0])
    panels = [Panel("a", [Curve(T, T), Points(T[::-1], T)]), Panel("b", [Band(T.copy(), T, T), Curve(x, x)])]
    a, b = (panel_data(panel, arrays)["parts"] for panel in panels)
    assert a[0]["x"] == a[0]["y"] == a[1]["x"] == b[0]["x"] == b[0]["low"]
    assert read(arrays, a[1]["y"]) == pytest.approx(T[::-1])
    assert read(arrays, b[1]["x"]) == pytest.approx([0.0, 1.0, 1.0, 2.0])
    assert read(arrays, b[1]["y"]) == pytest.approx(x, nan_ok=True)


def read(arrays: Arrays, place: int) -> np.ndarray:
    return np.frombuffer(b64decode(arrays.texts[place]), dtype="<f4")


def test_a_legend_is_told_once_and_a_label_not_broken_on_a_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, path, **_: (drawn.append(figure), path.touch()))
    one, other = (Panel("gear torque\nin N·m", [Curve(T, T, name)]) for name in ("one", "other"))
    plot([[one], [one], [other]], X, "title", tmp_path / "figure", FigureOptions(kinds=("png",)))
    assert [bool(axes.get_legend()) for axes in drawn[0].axes] == [True, False, True]
    assert [axes.get_xlabel() for axes in drawn[0].axes] == ["", "", "time in s"]
    assert panel_data(one, Arrays())["label"] == "gear torque in N·m"
