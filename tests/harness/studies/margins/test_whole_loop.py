"""The whole analysis as a program asks for it, its sensitivities and its figures."""

from math import isnan, nan
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import driveline
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.studies.margins import whole_loop
from driveline.harness.studies.margins.linear_figures import bode
from driveline.harness.studies.margins.sensitivity import SHOWN, sensitivity, varied
from driveline.harness.views.panels import Curve, Points


def test_car_controller_and_settings_reach_every_plant_but_no_single_one(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(whole_loop, "analysis", asked.append)
    driveline.analyse(["ValidationVehicle"], "SpeedWashout", {"m": 1900.0, "k_v": 2.0}, folder="here")
    ((plant, loop),) = asked[0].items()
    given = loop.settings
    assert plant == given.plant == "ValidationVehicle"
    assert (given.folder, given.controller) == (Path("here"), "SpeedWashout")
    assert given.parameters.items() >= {"plant.m": 1900.0, "controller.k_v": 2.0}.items()
    assert given.parameters["plant.F_z0"] == pytest.approx(8500.0 * 1900.0 / 1450.0, rel=1e-5), "which follows"
    changes: Any = {"plant": "ValidationVehicle"}
    with pytest.raises(TypeError, match="analyse takes plants"):
        driveline.analyse(**changes)


def metrics(value: float) -> Metrics:
    return Metrics(**{metric.name: value for metric in declared(Metrics)})  # type: ignore[arg-type]


def test_sensitivities_are_relative_changes_of_car_and_controller_apart() -> None:
    found = sensitivity("plant", "tipin15", "plant.C", [metrics(0.9**2), metrics(1.0), metrics(1.1**2)])
    assert found.changes == pytest.approx(dict.fromkeys(SHOWN, 2.0))
    assert found.largest == pytest.approx(2.0)
    found = sensitivity("plant", "tipin15", "plant.C", [metrics(1.0), metrics(0.0), metrics(1.0)])
    assert all(isnan(change) for change in found.changes.values())
    assert found.largest == 0.0
    found = varied("TwoMassDriveline", "DampingController", {"plant.C": 100.0, "controller.k_gap": 3.9})
    assert found["plant.C"] == 100.0
    assert found["controller.C"] == 117.4
    assert "controller.k_gap" not in found, "1.1 times 3.9 is beyond 4"
    assert "plant.v_0" not in found, "the manoeuvre sets it"
    assert "motor.o_T" not in found, "10 % of nothing is nothing"


MARKED = "delay margin"


@pytest.mark.parametrize("count", [1, 3])
def test_each_loop_has_its_magnitude_and_phase(count: int) -> None:
    """L = 2/(1 + i f/10 Hz): 6 dB at low frequencies, 90 degrees late at high ones, and 1 at sqrt(3) 10 Hz."""
    loop = SimpleNamespace(gain=lambda f: 2.0 / (1.0 + 0.1j * f))
    margin = SimpleNamespace(gain_frequency=nan, delay_frequency=10.0 * np.sqrt(3.0))
    loops: Any = {f"loop {k}": (loop, margin) for k in range(count)}
    drawn = [panel for (panel,) in bode(loops, "loops").rows]
    for panel, ends, at in zip(drawn, ((6.0, -21.9), (-3.0, -87.7)), (0.0, -60.0), strict=True):
        curves = [part for part in panel.parts if isinstance(part, Curve)]
        points = [part for part in panel.parts if isinstance(part, Points)]
        assert [curve.label for curve in curves] == list(loops)
        assert [point.label for point in points] == [MARKED if panel is drawn[0] else "", *[""] * (count - 1)]
        assert len({curve.color for curve in curves}) == len(points) == count
        for curve, point in zip(curves, points, strict=True):
            assert (curve.y[0], curve.y[-1]) == pytest.approx(ends, abs=0.2)
            assert point.y == pytest.approx(at, abs=0.1)
