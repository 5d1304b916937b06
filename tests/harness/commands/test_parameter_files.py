"""A car and its gains on the command line: where the entries of the files go, and what is refused."""

import pytest
from fmutesting.foreign import SMALLEST_CONTROLLER, build_car, build_relay, tampered

from driveline.fmus.errors import ParameterFileError
from driveline.harness.commands.cli import main
from driveline.harness.commands.settings import all_loops, resolved
from driveline.harness.loop import built_fmus
from driveline.harness.loop.places import PLANTS
from fmuloop.errors import WiringError
from tests import ROOT
from tests.harness.commands import given as record
from toolground.errors import UserError

VAN = str(ROOT / "examples" / "cars" / "van.toml")


@pytest.fixture
def given(built):
    """What options of `driveline simulate` give the loop as parameters."""

    def parameters(*options, plant="TwoMassDriveline", controller="DampingController"):
        run = ["simulate", "--plant", str(plant), "--fmus", str(built), "--build", "python"]
        return resolved(record(*run, *options), str(plant), controller).settings.parameters

    return parameters


@pytest.fixture
def gains(tmp_path):
    path = tmp_path / "gains.toml"
    path.write_text("k_d = 3.6\nT_take_max = 80\n", encoding="utf-8")
    return str(path)


def test_the_entries_reach_every_block_that_has_them_unless_they_are_set(given, gains):
    parameters = given("--vehicle", VAN, "--parameters", gains)
    of_i = {name: value for name, value in parameters.items() if name.endswith(".i")}
    of_T_max = {name: value for name, value in parameters.items() if name.endswith(".T_max")}
    assert of_i == {"plant.i": 12.0, "can.i": 12.0}
    assert of_T_max == {"motor.T_max": 250.0, "controller.T_max": 250.0}
    assert (parameters["controller.k_d"], parameters["controller.T_take_max"]) == (3.6, 80.0)
    assert "plant.k_s" not in parameters
    parameters = given("--vehicle", VAN, plant="ValidationVehicle")
    assert parameters["plant.k_s"] == pytest.approx(52333.7)
    assert "plant.C" not in parameters
    assert parameters["controller.C"] == 150.0
    parameters = given("--vehicle", VAN, "--parameters", gains, "--set", "plant.i=10", "--set", "controller.k_d=1")
    assert (parameters["plant.i"], parameters["can.i"], parameters["controller.k_d"]) == (10.0, 12.0, 1.0)
    assert given("--set", "plant.i=10") == {"plant.i": 10.0}


def test_a_file_of_a_car_with_gains_or_for_another_controller_is_refused(given, gains, tmp_path):
    with pytest.raises(ParameterFileError, match=r"gains\.toml, line 1: k_d does not belong here"):
        given("--vehicle", gains)
    assert main(["build", "NoDamping", "--build", "python", "--output", str(tmp_path), "--quiet"]) == 0
    controller = str(tmp_path / "NoDamping.fmu")
    with pytest.raises(UserError, match=r"gains\.toml: NoDamping\.fmu has no parameter k_d$"):
        given("--parameters", gains, controller=controller)
    path = tmp_path / "of_both.toml"
    path.write_text("T_take_max = 80\n", encoding="utf-8")
    assert given("--parameters", str(path), controller=controller) == {"controller.T_take_max": 80.0}


def test_a_file_for_a_controller_that_is_not_built_is_refused(capsys, gains, tmp_path):
    options = ("--parameters", gains, "--build", "python", "--output", str(tmp_path / "made"))
    assert main(["build", "WheelSpeedCan", "NoDamping", *options]) == 2
    assert capsys.readouterr().err == f"driveline build: {gains}: WheelSpeedCan or NoDamping has no parameter k_d\n"
    assert not (tmp_path / "made").exists()


def test_somebody_elses_plant_may_have_parameters_of_its_own(given, tmp_path):
    plant = build_car(tmp_path / "car", m=("mass", "kg", 1.0))
    (tmp_path / "car.toml").write_text("mass = 2200\nJ_1 = 0.09\n", encoding="utf-8")
    parameters = given("--vehicle", str(tmp_path / "car.toml"), plant=plant)
    assert parameters == {"plant.mass": 2200.0, "controller.J_1": 0.09}


def test_what_somebody_elses_plant_takes_of_a_file_is_said(given, tmp_path, caplog):
    plant = build_car(tmp_path / "car")
    (tmp_path / "car.toml").write_text("m = 2200\nJ_1 = 0.09\n", encoding="utf-8")
    given("--vehicle", str(tmp_path / "car.toml"), plant=plant)
    assert "has no parameter J_1, c_slip: it takes m, and the rest stays its own: it may be another car" in caplog.text


def test_gains_are_missed_where_a_controller_has_some_and_the_file_is_there(given, tmp_path, caplog):
    (tmp_path / "car.toml").write_text("m = 2200\n", encoding="utf-8")
    given("--vehicle", str(tmp_path / "car.toml"), controller=str(build_relay(tmp_path, SMALLEST_CONTROLLER)))
    with pytest.raises(ParameterFileError, match="there is no such file"):
        given("--vehicle", str(tmp_path / "none.toml"))
    assert "the gains of the default car" not in caplog.text
    given("--vehicle", str(tmp_path / "car.toml"))
    assert "the gains of the default car" in caplog.text
    caplog.clear()
    (tmp_path / "car.toml").write_text("# nothing yet\n", encoding="utf-8")
    given("--vehicle", str(tmp_path / "car.toml"))
    assert "car.toml has no parameter: the car is the default one" in caplog.text
    assert "the gains" not in caplog.text


def test_a_parameter_of_the_same_name_in_another_unit_is_refused_unless_it_is_mapped(given, tmp_path):
    plant = build_car(tmp_path / "car", m=("m", "t", 1e3))
    with pytest.raises(
        WiringError, match=r"plant\.m is in t; the file gives it in kg \(--map plant\.m=m converts it\)"
    ):
        given("--vehicle", VAN, plant=plant)
    assert given("--vehicle", VAN, "--map", "plant.m=m", plant=plant)["plant.m"] == 3500.0
    odd = build_car(tmp_path / "metres", m=("m", "m", 1.0))
    for mapped in ([], ["--map", "plant.m=m"]):
        with pytest.raises(
            WiringError, match=r"plant\.m is in m, which does not convert into kg, the unit of the file"
        ):
            given("--vehicle", VAN, *mapped, plant=odd)


def test_of_several_controllers_a_value_and_a_mapping_are_for_those_that_have_them(native, tmp_path, caplog):
    mine = build_relay(tmp_path, SMALLEST_CONTROLLER)
    run = ["compare", "--plant", "TwoMassDriveline", "--fmus", str(native.parent), "--build", "native"]
    both = ["--controller", str(mine), "--controller", "DampingController", "--map", "controller.T_ref=T_ref"]

    def parameters(*options):
        args = record(*run, *both, *options)
        found = all_loops(args, args.plant, args.controller)
        return {name: (loop.settings.parameters, loop.settings.mapping) for (_, name), loop in found.items()}

    given = parameters("--set", "controller.k_d=1.2", "--set", "motor.tau=0.004", "--set", "controller.k_d@1=2")
    common = {"motor.tau": 0.004}
    assert given["SmallestController"] == (common, {"controller.T_ref": "T_ref"})
    assert given["DampingController"] == ({"controller.k_d": 1.2, "controller.k_d@1": 2.0, **common}, {})
    assert "--set controller.k_d: SmallestController has no such parameter and runs without it" in caplog.text
    with pytest.raises(
        WiringError, match=r"(?s)SmallestController\.fmu has no parameter k_e; it has none.*did you mean"
    ):
        parameters("--set", "controller.k_e=1")
    with pytest.raises(WiringError, match=r"controller\.k_d = 1e\+06: DampingController\.fmu takes"):
        parameters("--set", "controller.k_d=1e6")
    renamed = tampered(mine, tmp_path / "Renamed.fmu", lambda xml: xml.replace('name="T_ref"', 'name="out"'))
    both = ["--controller", str(mine), "--controller", str(renamed)]
    given = parameters("--map", "controller.T_ref=out", "--map", "motor.seed=seed")
    assert given["Renamed"][1] == {"motor.seed": "seed", "controller.T_ref": "out"}
    assert given["SmallestController"][1] == {"motor.seed": "seed"}
    with pytest.raises(WiringError, match=r"in SmallestController\.fmu nowhere does not exist"):
        parameters("--map", "controller.T_ref=nowhere")


def test_what_several_loops_need_is_built_at_once(both_built, monkeypatch):
    needed = []
    monkeypatch.setattr(built_fmus, "BUILD", both_built)
    monkeypatch.setattr(built_fmus, "_in_cache", lambda each: needed.append(each) or (both_built, []))
    all_loops(record("compare", "--fmus", str(both_built)), (), ["DampingController"])
    assert [set(PLANTS) <= set(each["native"]) for each in needed] == [True]


@pytest.mark.slow
def test_a_comparison_gives_each_plant_its_own(both_built, tmp_path):
    options = ("--vehicle", VAN, "--manoeuvre", "tipin15", "--fmus", str(both_built), "--output", str(tmp_path))
    assert main(["compare", *options, "--quiet"]) == 0
    assert len(list((tmp_path / "runs").glob("*.csv"))) == len(list((tmp_path / "runs").glob("*.json"))) == 4


@pytest.mark.parametrize("command", [["simulate"], ["compare"], ["replay", "trip.csv"], ["build"]])
def test_every_command_that_runs_or_builds_the_loop_takes_both_files(command, gains):
    args = record(*command, "--vehicle", VAN, "--parameters", gains)
    assert (str(args.vehicle), str(args.parameters)) == (VAN, gains)


@pytest.mark.slow
def test_what_a_vehicle_file_does_not_reach_is_said(both_built, tmp_path, capsys, caplog) -> None:
    """Somebody else's plant without J_1, whatever its name, keeps its own, while the controller's model takes that of
    the file."""
    car, gains = tmp_path / "car.toml", tmp_path / "gains.toml"
    car.write_text("J_1 = 0.06\n")
    gains.write_text("k_d = 2.0\n")
    theirs = build_car(tmp_path / "theirs", m=("m", "kg", 1.0)).rename(tmp_path / "TwoMassDriveline.fmu")
    options = ["simulate", "--vehicle", str(car), "--fmus", str(both_built), "--quiet", "--output", str(tmp_path)]
    assert main([*options, "--plant", str(theirs)]) == 0
    assert "has no parameter J_1: the file reaches the other blocks alone" in caplog.text
    assert "the gains of the default car" in caplog.text
    caplog.clear()
    assert main([*options, "--parameters", str(gains), "--replace"]) == 0
    assert caplog.text == ""
