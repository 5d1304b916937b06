"""The record of the settings of a run."""

from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from fmutesting.foreign import build_car

from driveline.fmus.building.builds import build_fmus
from driveline.harness.loop.arguments import ARGUMENTS
from driveline.harness.loop.places import PLACES, PLANTS
from driveline.harness.loop.resolved import as_given, frequency_of_plant, resolve_all
from driveline.harness.loop.settings import Changes, Settings, own_frequency, settings
from fmuloop.errors import WiringError
from fmuloop.system import Scheme
from tests import ROOT


def test_settings_are_given_as_a_record_a_plant_or_keyword_arguments_which_are_its_fields() -> None:
    made = Settings(plant="ValidationVehicle", seed=7)
    assert (
        settings("ValidationVehicle", seed=7) == settings(plant="ValidationVehicle", seed=7) == settings(made) == made
    )
    assert settings(made, seed=1) == Settings(plant="ValidationVehicle")
    assert settings() == Settings()
    given: dict[str, Any] = {"scheme": "jacobi", "folder": "build/van", "parameters": None, "mapping": None}
    made = settings(**given)
    assert (made.scheme, made.folder, made.parameters, made.mapping) == (Scheme.JACOBI, Path("build/van"), {}, {})
    names = {field.name for field in fields(Settings)}
    assert names == set(Changes.__annotations__) == set(ARGUMENTS)


@pytest.mark.parametrize("place", PLACES)
def test_none_in_a_place_is_the_usual_block(place: str) -> None:
    none: dict[str, Any] = {place: None}
    assert Settings(**none) == Settings(**none).replace(**none) == Settings()


def test_the_parameters_of_a_record_do_not_change_with_what_it_was_made_from_or_added_to() -> None:
    before = Settings(parameters={"plant.J_1": 0.06, "plant.m": 1300.0})
    after = before.with_parameters({"plant.m": 1500.0})
    assert after.parameters == {"plant.J_1": 0.06, "plant.m": 1500.0}
    assert before.parameters["plant.m"] == 1300.0
    parameters = {"plant.m": 1300.0}
    made = Settings(parameters=parameters)
    parameters["plant.m"] = 1500.0
    assert made.parameters == {"plant.m": 1300.0}


def test_what_no_run_has_is_refused() -> None:
    unknown: dict[str, Any] = {"sed": 2}
    with pytest.raises(TypeError, match="sed"):
        settings(**unknown)
    with pytest.raises(TypeError, match="plant"):
        settings("ValidationVehicle", plant="TwoMassDriveline")
    with pytest.raises(WiringError, match="seed = 'two': it must be a whole number"):
        settings(seed="two")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"^there is no setting sed; did you mean seed\?$"):
        settings(sed=2)  # type: ignore[call-arg]


@pytest.mark.parametrize("value", [0.0, -1.0, float("inf"), "8"])
def test_a_frequency_is_a_number_of_hertz(value: Any) -> None:
    assert Settings(frequency=2.5).frequency == 2.5
    with pytest.raises(WiringError, match=r"frequency = .*: it must be a number of Hz above 0, or None"):
        Settings(frequency=value)


def test_the_frequency_of_a_car_is_that_of_its_two_masses_on_their_spring() -> None:
    car = {"C": 117.4, "J_1": 0.055, "J_2": 0.3}
    assert own_frequency(car) == pytest.approx(7.999, abs=5e-4)
    for name in car:
        assert own_frequency({key: value for key, value in car.items() if key != name}) is None


def test_fmus_tell_the_frequency_of_the_car_that_they_were_built_with(
    built: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    van = ROOT / "examples" / "cars" / "van.toml"
    list(build_fmus(PLANTS, tmp_path, "python", vehicle=van))
    usual = {(plant, "DampingController"): Settings(plant, folder=built, build="python") for plant in PLANTS}
    for before, given in zip(usual.values(), resolve_all(usual, van).values(), strict=True):
        assert frequency_of_plant(as_given(before)) is None
        assert frequency_of_plant(as_given(before, folder=tmp_path)) == given.frequency
    assert caplog.text == ""
    theirs = build_car(tmp_path / "theirs")
    assert frequency_of_plant(as_given(theirs, folder=built, build="python")) is None
    assert "tells no C, J_1 and J_2: the band of the metrics is that of the default car" in caplog.text
