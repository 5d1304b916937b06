"""The whole analysis as a program asks for it."""

import pytest

import driveline
from driveline.harness.studies.margins import whole_loop


def test_car_controller_and_settings_reach_every_plant(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(whole_loop, "analysis", lambda *given: asked.append(given))
    driveline.analyse(["ValidationVehicle"], "SpeedWashout", {"m": 1900.0, "k_v": 2.0}, folder="here")
    ((plants, controller, settings),) = asked
    assert (plants, controller) == (["ValidationVehicle"], "SpeedWashout")
    given = settings["ValidationVehicle"]
    assert (given["folder"], given["controller"]) == ("here", "SpeedWashout")
    assert given["parameters"] == {"plant.m": 1900.0, "controller.k_v": 2.0}
