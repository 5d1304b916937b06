"""The table of the effects of the detailed vehicle: each run is made with its effect, and in its place."""

from functools import partial
from pathlib import Path

import pytest

from docs.studies import vehicle_model_page
from docs.studies.vehicle_model_page import EFFECTS, RUNS, Run, make, measured
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.simulation.simulate import simulate

USUAL = dict.fromkeys((metric.name for metric in declared(Metrics)), 1.0)
SLOW = ("motor.dT_max", 1000.0)


def test_a_row_tells_each_metric_without_and_with_damping(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    of = {Run(SLOW, False): 0.41, Run(SLOW, True): 0.42}
    found = [Metrics(**USUAL | {"overshoot": of.get(run, 0.5)}) for run in RUNS]  # type: ignore[arg-type]
    monkeypatch.setattr(vehicle_model_page, "run_many", lambda _one, _runs: found)
    make(tmp_path)
    text = (tmp_path / "vehicle_model.md").read_text(encoding="utf-8")
    table = text.partition("<!-- effects")[2].partition("<!-- end -->")[0]
    same = "1.0 / 1.0"
    for name, overshoot in (("nothing", "50 / 50"), ("`motor.dT_max=1000`", "41 / 42")):
        assert f"| {name} | 1000 / 1000 | {overshoot} | {same} | {same} | {same} | 1000 / 1000 |\n" in table
    assert table.count("1000 / 1000 |\n") == len(EFFECTS)


def test_a_slow_motor_delays_the_torque_and_damping_takes_the_overshoot(
    native: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = partial(simulate, folder=native.parent, build="native")
    monkeypatch.setattr(vehicle_model_page, "simulate", here)
    usual, slow, damped = map(measured, (Run(None, False), Run(SLOW, False), Run(None, True)))
    assert slow.response_delay > 2.0 * usual.response_delay
    assert damped.overshoot < 0.5 * usual.overshoot
