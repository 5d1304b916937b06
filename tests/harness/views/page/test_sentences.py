"""What the pages say and order, without a browser."""

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from driveline.harness.metrics.evaluate import T_S
from driveline.harness.studies.compare import compare_report
from driveline.harness.studies.compare.compare_report import verdict
from driveline.harness.studies.drives import replay_report
from driveline.harness.studies.drives.replay_report import PIECE, WHOLE, _densities, _figures, _worst, roughest
from driveline.harness.studies.faults.fault_report_html import _ratio, _table
from driveline.harness.studies.faults.judges import JUDGES
from driveline.harness.views.page import metric_dots
from driveline.harness.views.page.figures import figure
from driveline.harness.views.page.report import Section, write_report
from driveline.harness.views.panels import Axis, Curve, Points
from tests.harness.views.page.test_report_page import PROVENANCE


def test_the_verdict_of_a_comparison_names_the_controller_and_the_run_in_which_it_helps_least() -> None:
    pairs: Any = [SimpleNamespace(name=f"run {k}", ratio=ratio) for k, ratio in enumerate((0.3, 1.2, 0.5, np.nan))]
    text = verdict(pairs, "SpeedWashout")
    assert text.startswith("Damping by SpeedWashout lowers the oscillation of the gear torque (5-50 Hz rms) in 2 of 3")
    assert text.endswith("runs, to 50 % in the median and to 120 % where it helps least (run 1).")
    assert verdict(pairs[3:], "SpeedWashout") == "No run has an oscillation that can be compared."


def ride(rough: float, size: float) -> np.ndarray:
    """60 s in which the gear torque swings for a piece from an instant on."""
    t = T_S * np.arange(round(60.0 / T_S))
    run = np.zeros(len(t), [(name, float) for name in ("time", "plant.T_gear", "controller.T_driver")])
    run["time"], run["controller.T_driver"] = t, 20.0
    at = (t >= rough) & (t < rough + PIECE)
    run["plant.T_gear"] = 20.0 + at * size * np.sin(50.0 * t)
    return run


def test_the_worst_pieces_of_a_replay_stand_with_their_swing_and_that_without_damping() -> None:
    damped, undamped = ride(2.0 * PIECE, 3.0), ride(2.0 * PIECE, 12.0)
    rides: Any = {"without damping": (None, undamped), "with": (None, damped)}
    found = roughest(damped)
    rows = _worst(found, rides).rows
    assert len(rows) == len(found) >= 1
    name, swing, without = rows[0].cells
    assert name == f"{2.0 * PIECE:g} to {3.0 * PIECE:g} s" == rows[0].choice
    assert float(swing) == pytest.approx(3.0, rel=0.1)
    assert float(without) == pytest.approx(12.0, rel=0.1)


def test_figures_stand_below_the_heading_of_their_section(tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    empty = figure([], Axis("", (0.0, 1.0)))
    sections = [Section(name, figures=[empty]) for name in ("first", "second", "third")]
    write_report("title", "verdict", sections, PROVENANCE, path)
    body = path.read_text(encoding="utf-8").partition("<body")[2]
    order = re.findall(r"<h2>(first|second|third)|<div id=\"(figure \d)", body)
    assert [heading or root for heading, root in order] == [
        *("first", "figure 0", "second", "figure 1", "third", "figure 2"),
    ]


@pytest.mark.parametrize("judge", JUDGES, ids=lambda judge: judge.name)
def test_what_a_case_is_ordered_by_is_over_the_limit_or_for_what_must_not_be_twice(judge: Any) -> None:
    def ratio(value: float) -> float:
        outcome: Any = SimpleNamespace(measured={judge.name: value})
        return _ratio(outcome, judge.name)

    if judge.limit < 1e-6:
        assert (ratio(0.0), ratio(0.1)) == (0.0, 2.0)
    else:
        assert (ratio(-1.0), ratio(0.5 * judge.limit), ratio(3.0 * judge.limit)) == pytest.approx((0.0, 0.5, 3.0))


def test_the_density_of_a_swing_is_largest_at_its_frequency() -> None:
    panel = _densities({"with": ride(0.0, 5.0)}, {"with": ("C0",)})  # type: ignore[dict-item]
    (curve,) = panel.parts
    assert isinstance(curve, Curve)
    assert curve.x[np.argmax(curve.y)] == pytest.approx(50.0 / (2.0 * np.pi), abs=0.25)


def test_the_whole_drive_is_shown_from_its_beginning_to_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("torques", "swings", "speeds", "Panel", "_acceleration", "within", "thinned"):
        monkeypatch.setattr(replay_report, name, lambda *_: [])
    monkeypatch.setattr(replay_report, "_acceleration", lambda *_: SimpleNamespace(of=lambda _: []))
    rides: Any = {name: (None, ride(0.0, 5.0)) for name in ("without damping", "with")}
    section = next(_figures(rides, (np.zeros(2), np.zeros(2)), [30.0, 57.0]))
    end = pytest.approx(60.0 - T_S)
    windows = {WHOLE: (0.0, end), f"30 to {30.0 + PIECE:g} s": (30.0, 36.0), "57 to 63 s": (57.0, end)}
    assert section.figures[0].windows == windows


def test_a_comparison_is_written_and_draws_each_run_without_damping_with_its_own_with_damping(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    drawn: dict[str, Any] = {}
    monkeypatch.setattr(compare_report, "pair_sections", lambda pairs: drawn.update(pairs) or [])
    for name in ("verdict", "_table", "_worst", "metric_dots"):
        monkeypatch.setattr(compare_report, name, lambda *_: None)
    written: list[tuple[str, Path]] = []
    monkeypatch.setattr(compare_report, "write_report", lambda title, *others: written.append((title, others[-1])))
    rows = [SimpleNamespace(manoeuvre=name, plant="Car", control=on) for name in "ab" for on in (False, True)]
    runs: Any = [(row, f"{row.manoeuvre} {row.control}") for row in rows]
    manoeuvres: Any = {"a": "tip-in", "b": "launch"}
    compare_report.report(runs, manoeuvres, ["SpeedWashout"], {}, Path("page.html"))
    assert written == [("Without and with SpeedWashout", Path("page.html"))]
    assert {name: tuple(pair) for name, pair in drawn.items()} == {
        "a on Car": ("tip-in", "a False", "a True"),
        "b on Car": ("launch", "b False", "b True"),
    }


def test_all_columns_of_the_faults_but_the_first_are_numbers() -> None:
    first, *others = _table([]).headings
    assert not first.number
    assert all(heading.number for heading in others)


def test_of_each_pair_of_runs_the_metrics_without_and_with_damping_are_dots(monkeypatch: pytest.MonkeyPatch) -> None:
    runs: Any = [
        SimpleNamespace(manoeuvre=name, plant="car", metrics=value)
        for name, values in {"tip-in": (4.0, 1.0), "launch": (5.0, 2.0), "drive": (6.0, 3.0)}.items()
        for value in values
    ]
    shown = SimpleNamespace(of=lambda value: value), SimpleNamespace(factor=10.0, plain_heading="swing", unit="N·m")
    monkeypatch.setattr(metric_dots, "SHOWN", [shown])
    (drawn,) = metric_dots.metric_dots(runs)
    (panel,) = drawn.choices["swing, N·m"]
    off, on = (part for part in panel.parts if isinstance(part, Points))
    assert (off.x.tolist(), on.x.tolist()) == ([40.0, 50.0, 60.0], [10.0, 20.0, 30.0])
    assert [panel.ticks[y] for y in off.y] == ["tip-in on car", "launch on car", "drive on car"]
