"""What the pages say and order, without a browser."""

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.evaluate import COLUMNS, T_S
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.studies.compare import compare_report
from driveline.harness.studies.compare.compare import Outcome, cases
from driveline.harness.studies.compare.compare_report import verdict
from driveline.harness.studies.drives import replay_report
from driveline.harness.studies.drives.replay_report import PIECE, WHOLE, _densities, _figures, _worst, roughest
from driveline.harness.studies.faults.fault_report_html import _ratio
from driveline.harness.studies.faults.judges import JUDGES
from driveline.harness.views.colours import BLACK, GREEN
from driveline.harness.views.page import metric_dots
from driveline.harness.views.page.compared_runs import run_panels
from driveline.harness.views.page.figures import figure
from driveline.harness.views.page.report import Section, write_report
from driveline.harness.views.panels import Axis, Curve, Points
from driveline.harness.views.signal_lines import WITHOUT, looks_of
from tests.harness.views.page.test_report_page import PROVENANCE


def test_the_verdict_of_a_comparison_names_the_controller_and_the_run_in_which_it_helps_least() -> None:
    text = verdict({f"run {k}": ratio for k, ratio in enumerate((0.3, 1.2, 0.5, np.nan))}, "SpeedWashout")
    assert text.startswith("Damping by SpeedWashout lowers the oscillation of the gear torque (rms) in 2 of 3")
    assert text.endswith("runs, to 50 % in the median and to 120 % where it helps least (run 1).")
    assert verdict({"a": np.nan}, "Mine") == "No run with Mine has an oscillation that can be compared."


def test_curves_of_each_run_have_its_colour_and_the_others_that_which_is_declared() -> None:
    runs = {name: np.zeros(5, [(each, float) for each in COLUMNS]) for name in (WITHOUT, "ours", "theirs")}
    declared = {"demand": BLACK, "wheels, ours": BLACK, "of it added by the control": GREEN}
    curves = [part for panel in run_panels(runs) for part in panel.parts if isinstance(part, Curve)]
    for curve in curves:
        run = next((name for name in runs if name in curve.label), "")
        assert curve.color == (declared.get(curve.label) or looks_of(runs)[run][0]), curve.label
    assert sum("theirs" in curve.label for curve in curves) == 4


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
        *("first", "figure 0", "second", "figure 1", "third", "figure 2")
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


def test_a_comparison_says_of_each_controller_what_it_is_worth_and_draws_its_runs_with_that_without_damping(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    drawn: dict[str, Any] = {}
    monkeypatch.setattr(compare_report, "run_sections", lambda compared: drawn.update(compared) or [])
    written: list[Any] = []
    monkeypatch.setattr(compare_report, "write_report", lambda *given: written.append(given))
    swings = {"without damping": 10.0, "SpeedWashout": 4.0, "folder/mine.fmu": 2.0}
    nothing = dict.fromkeys((metric.name for metric in declared(Metrics)), np.nan)
    outcomes: Any = [
        Outcome(case, Metrics(**nothing | {"gear_torque_rms": swings[case.controller]}, absent={}), case.file_name)  # type: ignore[arg-type]
        for case in cases(["Car"], ["a", "b"], list(swings)[1:])
    ]
    manoeuvres: Any = {"a": "tip-in", "b": "launch"}
    compare_report.report(outcomes, manoeuvres, {}, Path("page.html"))
    title, text, (rows, worst, _), *_, path = written[0]
    assert (title, path) == ("Without and with SpeedWashout, mine", Path("page.html"))
    assert all(part in text for part in ("to 40 % in the median", "Damping by mine lowers", "to 20 % in the median"))
    assert [row.cells[2] for row in rows.table.rows] == ["off", "SpeedWashout", "mine"] * 2
    assert [row.cells[1:] for row in worst.table.rows] == [
        ["a on Car, SpeedWashout", "10.0", "4.0", "2.0"],
        ["a on Car, mine", "10.0", "4.0", "2.0"],
    ]
    assert {name: tuple(each) for name, each in drawn.items()} == {
        f"{name} on Car": (
            manoeuvres[name],
            {
                "without damping": f"Car_{name}_off",
                "SpeedWashout": f"Car_{name}_SpeedWashout",
                "mine": f"Car_{name}_mine",
            },
        )
        for name in "ab"
    }


def test_of_each_run_the_metrics_without_damping_and_with_each_controller_are_dots(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    values = {"tip-in": (4.0, 1.0, 9.0), "launch": (5.0, 2.0, 8.0), "drive": (6.0, 3.0, 7.0)}
    runs: Any = {run: dict(zip(("without damping", "A", "B"), each, strict=True)) for run, each in values.items()}
    shown = SimpleNamespace(of=lambda value: value), SimpleNamespace(factor=10.0, titled="swing, N·m")
    monkeypatch.setattr(metric_dots, "SHOWN", [shown])
    (drawn,) = metric_dots.metric_dots(runs)
    (panel,) = drawn.choices["swing, N·m"]
    dots = [part for part in panel.parts if isinstance(part, Points)]
    assert [each.x.tolist() for each in dots] == [[40.0, 50.0, 60.0], [10.0, 20.0, 30.0], [90.0, 80.0, 70.0]]
    assert len({each.color for each in dots}) == 3
    assert [panel.ticks[y] for y in dots[0].y] == ["tip-in", "launch", "drive"]
