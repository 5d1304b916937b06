"""FMUs built for a car of one's own: the start values are those of its files, and it runs as if they had been set."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy import read_model_description
from fmutesting.host import opened
from fmutesting.slow import slow
from fmutesting.together import together

from driveline.fmus.building.builds import build_fmus
from driveline.fmus.building.one_car import of_one_car
from driveline.fmus.building.parameter_files import for_instances, read_files
from driveline.fmus.catalogue import FMUS
from driveline.harness.loop.places import NATIVE
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.simulation.simulate import simulate
from fmublocks.block.declaration import variables
from fmublocks.errors import BuildError
from fmublocks.python.packaging import build
from tests import ROOT
from tests.fmus.native.test_page import EXAMPLE

CAR = ROOT / "examples" / "cars" / "mid_size.toml"
GAINS = "k_d = 4.0\nT_gap = 70.0\n"


@pytest.fixture(scope="module")
def gains(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("gains") / "gains.toml"
    path.write_text(GAINS, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def of_python(gains: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the FMUs for the car that run Python."""
    folder = tmp_path_factory.mktemp("car")
    list(build_fmus((), folder, "python", vehicle=CAR, parameters=gains))
    return folder


@pytest.fixture(scope="module")
def compiled(gains: Path, native_builder: object, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the native FMUs for the car in its folder native."""
    folder = tmp_path_factory.mktemp("native_car")
    list(build_fmus((), folder, "native", vehicle=CAR, parameters=gains))
    return folder


def start_values(path: Path) -> dict[str, float]:
    described = read_model_description(str(path)).modelVariables
    return {v.name: float(v.start or "nan") for v in described if v.causality == "parameter" and v.type == "Real"}


def loop_parameters(gains: Path) -> dict[str, Any]:
    places = {"plant": 0, "motor": 2, "can": 3, "controller": 4}
    blocks = [fmu.block.Parameters._fields for fmu in FMUS.values()]
    return for_instances(read_files(CAR, gains), {place: blocks[k] for place, k in places.items()})


@pytest.mark.parametrize(("made", "folder"), [("of_python", "."), ("compiled", NATIVE)])
def test_start_values_are_those_of_the_files(request: Any, gains: Path, made: str, folder: str) -> None:
    values = read_files(CAR, gains)
    for name, fmu in FMUS.items():
        declared = {v.name: v.start for v in variables(fmu.block.Parameters)}
        found, own = start_values(request.getfixturevalue(made) / folder / f"{name}.fmu"), of_one_car(values, declared)
        assert found == {key: own.get(key, declared[key]) for key in found}, name
        assert any(key in values for key in found), name


@pytest.mark.parametrize(
    ("made", "build"), slow([("of_python", "python"), ("compiled", NATIVE)], but=[("compiled", NATIVE)])
)
def test_the_loop_for_the_car_is_that_of_the_default_with_the_parameters_set_bit_by_bit(
    request: Any, both_built: Path, gains: Path, made: str, build: str
) -> None:
    tipin, folder, default = MANOEUVRES["tipin15"], request.getfixturevalue(made), both_built
    own = simulate(tipin, folder=folder, build=build)
    same = simulate(tipin, folder=default, build=build, parameters=loop_parameters(gains))
    other = simulate(tipin, folder=default, build=build)
    assert np.array_equal(own, same)
    assert not np.array_equal(own["plant.T_gear"], other["plant.T_gear"])


def test_fmus_for_two_cars_live_in_one_process(of_python: Path, built: Path, tmp_path: Path) -> None:
    name = "MotorTorqueLoop"
    with (
        opened(of_python / f"{name}.fmu", tmp_path / "own") as own,
        opened(built / f"{name}.fmu", tmp_path / "default") as default,
    ):
        assert (own.get("tau"), default.get("tau")) == (0.0025, 0.003)
        own.initialize(T_ref=1000.0)
        default.initialize(T_ref=1000.0)
        assert (own.get("T_mot"), default.get("T_mot")) == (250.0, 180.0)


def test_the_same_files_give_the_same_bytes_and_no_files_the_default(of_python: Path, built: Path, gains: Path) -> None:
    name = "WheelSpeedCan"
    again = build(FMUS[name].started_with(read_files(CAR, gains)), of_python / "again")
    assert again.read_bytes() == (of_python / f"{name}.fmu").read_bytes()
    assert FMUS[name].started_with({}) == FMUS[name]
    default = build(FMUS[name].started_with({"k_d": 4.0}), of_python / "default")
    assert default.read_bytes() == (built / f"{name}.fmu").read_bytes(), "which has no such parameter"


@together("option", ["vehicle", "parameters"])
def test_a_refused_file_builds_nothing(option: str, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.toml"
    wrong.write_text("mass = 3\n", encoding="utf-8")
    files: dict[str, Any] = {option: wrong}
    with pytest.raises(BuildError, match="line 1: mass is not known"):
        list(build_fmus(["MotorTorqueLoop"], tmp_path / "out", "python", **files))
    assert not (tmp_path / "out").exists()


def test_a_block_of_the_users_own_takes_its_start_values_too(native_builder: object, tmp_path: Path) -> None:
    (tmp_path / "my_vehicle.py").write_text(EXAMPLE, encoding="utf-8")
    (tmp_path / "car.toml").write_text("i = 12.0\nd = 0.25\n", encoding="utf-8")
    (made,) = build_fmus([str(tmp_path / "my_vehicle.py")], tmp_path, vehicle=tmp_path / "car.toml")
    found = start_values(made)
    assert (found["i"], found["d"], found["m"]) == (12.0, 0.25, 1450.0)
