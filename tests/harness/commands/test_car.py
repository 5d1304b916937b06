"""`driveline car`: what a vehicle file makes of a car, and a template of one."""

import json
from pathlib import Path

from driveline.fmus.building.car_entries import template
from driveline.harness.commands.cli import main
from tests import ROOT
from tests.harness.commands import Capsys

VAN = str(ROOT / "examples" / "cars" / "van.toml")


def test_the_table_has_each_entry_and_what_comes_of_them(capsys: Capsys) -> None:
    assert main(["car", VAN]) == 0
    text = capsys.readouterr().out
    rows = {line.split()[0]: line for line in text.splitlines() if line.strip()}
    assert "150 N.m/rad   set" in rows["C"]
    assert "52333.7 N.m/rad   follows (C)" in rows["k_s"]
    assert "design plant, vehicle, bus" in rows["i"]
    assert "backlash at the wheel: 3.00 degrees" in text
    assert "takes up to 188.378 N.m from the demand and adds up to 83.3333 N.m, of T_max = 250 N.m" in text
    assert rows["TwoMassDriveline"].split()[1] == "6.95"
    assert rows["ValidationVehicle"].split()[1] == "7.50"


def test_tools_get_one_document(tmp_path: Path, capsys: Capsys) -> None:
    gains = tmp_path / "gains.toml"
    gains.write_text("k_d = 3.469\nT_add_max = 40\n", encoding="utf-8")
    assert main(["car", VAN, "--parameters", str(gains), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    k_s = next(entry for entry in found["entries"] if entry["name"] == "k_s")
    assert (k_s["origin"], k_s["source"], k_s["blocks"]) == ("follows", "C", ["ValidationVehicle"])
    assert found["properties"]["added"] == 40.0
    for plant in found["properties"]["plants"]:
        assert plant["damping_ratio"] < 0.06 < 0.3 < plant["damped"]["damping_ratio"]


def test_a_car_without_a_controller_has_no_damped_mode(tmp_path: Path, capsys: Capsys) -> None:
    car = tmp_path / "car.toml"
    car.write_text("T_cyc = 0.2\n", encoding="utf-8")
    assert main(["car", str(car), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["gains"].startswith("no gains: T_age would be 0.113; the controller takes")
    assert [plant["damped"] for plant in found["properties"]["plants"]] == [None, None]


def test_the_template_is_printed_or_written_and_no_other_file_is_replaced(tmp_path: Path, capsys: Capsys) -> None:
    assert main(["car", "--template"]) == 0
    assert capsys.readouterr().out == template()
    path = tmp_path / "car.toml"
    assert main(["car", "--template", "--output", str(path)]) == 0
    assert path.read_text(encoding="utf-8") == template()
    path.write_text("mine", encoding="utf-8")
    assert main(["car", "--template", "--output", str(path)]) != 0
    assert path.read_text(encoding="utf-8") == "mine"


def test_shafts_that_contradict_the_stiffness_are_refused_with_both_numbers(tmp_path: Path, capsys: Capsys) -> None:
    car = tmp_path / "car.toml"
    car.write_text("C = 220.0\nk_s = 25800.0\n", encoding="utf-8")
    assert main(["car", str(car)]) == 2
    assert capsys.readouterr().err == (
        f"driveline car: {car}: C = 220 N.m/rad and k_s = 25800 N.m/rad disagree: with that C would be 117.4 N.m/rad; "
        "leave one of them out, and it follows\n"
    )
