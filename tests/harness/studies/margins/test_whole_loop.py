"""The whole analysis as a program asks for it."""

from pathlib import Path
from typing import Any

import pytest

import driveline
from driveline.harness.studies.margins import whole_loop


def test_car_controller_and_settings_reach_every_plant(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(whole_loop, "analysis", asked.append)
    driveline.analyse(["ValidationVehicle"], "SpeedWashout", {"m": 1900.0, "k_v": 2.0}, folder="here")
    ((plant, given),) = asked[0].items()
    assert plant == given.plant == "ValidationVehicle"
    assert (given.folder, given.controller) == (Path("here"), "SpeedWashout")
    assert given.parameters.items() >= {"plant.m": 1900.0, "controller.k_v": 2.0}.items()
    assert given.parameters["plant.F_z0"] == pytest.approx(8500.0 * 1900.0 / 1450.0, rel=1e-5), "which follows"


def test_a_single_plant_is_refused_and_not_ignored() -> None:
    changes: Any = {"plant": "ValidationVehicle"}
    with pytest.raises(TypeError, match="analyse takes plants"):
        driveline.analyse(**changes)
