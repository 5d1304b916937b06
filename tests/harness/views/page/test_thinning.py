"""What a page shows of long runs: fewer rows, and nothing of what matters is lost."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from driveline.harness.views.page.thinning import MOST_ROWS, VALUES, extremes, most_rows, thinned
from driveline.harness.views.panels import Curve, Level, Panel
from driveline.harness.views.replay_figure import PIECE, PIECES, roughest

SIGNALS = st.integers(1, 400).flatmap(
    lambda length: arrays(float, length, elements=st.floats(-1e6, 1e6) | st.sampled_from([0.0, np.nan]))
)


@given(SIGNALS, st.integers(4, 60))
def test_the_first_the_last_and_the_extreme_samples_stay(signal: np.ndarray, rows: int) -> None:
    x = np.arange(float(len(signal)))
    seen = extremes({"x": x, "y": signal}, rows)
    assert len(seen["x"]) == len(seen["y"]) <= max(rows, 4)
    np.testing.assert_equal(seen["y"][[0, -1]], signal[[0, -1]])
    assert (seen["x"][0], seen["x"][-1]) == (0.0, len(signal) - 1.0)
    for extreme in (np.nanmin, np.nanmax) if not np.isnan(signal).all() else ():
        assert extreme(seen["y"]) == extreme(signal)


@given(SIGNALS, st.integers(4, 60))
def test_no_sample_is_outside_of_what_is_seen_about_its_time(signal: np.ndarray, rows: int) -> None:
    """The pieces cover all, in order: what is seen within a piece of a sample reaches at least as far as it."""
    x = np.arange(float(len(signal)))
    seen = extremes({"x": x, "y": signal}, rows)
    assert (np.diff(seen["x"]) >= 0.0).all()
    piece = len(signal) // ((rows - 2) // 2) + 1
    for k in np.flatnonzero(~np.isnan(signal)):
        near = seen["y"][np.abs(seen["x"] - k) <= piece]
        assert np.nanmin(near) <= signal[k] <= np.nanmax(near)


def test_no_page_holds_more_values_than_it_may() -> None:
    assert most_rows(2, 10) == MOST_ROWS
    runs, columns = 40, 10
    assert runs * columns * most_rows(runs, columns) <= VALUES
    panels = [Panel("y", [Curve(np.arange(10_000.0) + k, np.zeros(10_000))]) for k in range(5)]
    drawn = [part for panel in thinned(panels, runs) for part in panel.parts if isinstance(part, Curve)]
    assert runs * sum(curve.x.size + curve.y.size for curve in drawn) <= VALUES


@pytest.mark.parametrize("length", [MOST_ROWS, MOST_ROWS + 1])
def test_what_is_short_stays_as_it_is(length: int) -> None:
    curve = Curve(np.arange(float(length)), np.arange(float(length)))
    (drawn,) = thinned([Panel("y", [curve, Level(1.0)])])[0].parts[:1]
    assert isinstance(drawn, Curve)
    assert (drawn.y is curve.y) == (length <= MOST_ROWS)


@pytest.mark.parametrize("duration", [17.8, 18.0, 23.9])
def test_the_roughest_piece_is_found_at_the_end_of_a_drive(duration: float) -> None:
    t = 0.002 * np.arange(round(duration / 0.002) + 1)
    run = np.zeros(len(t), [(name, float) for name in ("time", "plant.T_gear", "controller.T_driver")])
    run["time"] = t
    run["plant.T_gear"][-250:] = 30.0 * np.sin(50.0 * t[-250:])
    pieces = [start for start, _ in roughest(run)]
    assert pieces[0] + PIECE == pytest.approx(duration, abs=0.2)
    assert len(pieces) <= PIECES
    assert all(abs(a - b) > PIECE - 1e-6 for k, a in enumerate(pieces) for b in pieces[:k])
