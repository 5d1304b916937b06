"""A car entry by entry, and the template of a vehicle file."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmutesting.together import together

from driveline.fmus.building.car_entries import (
    DEFAULT,
    ESTIMATED,
    FOLLOWS,
    SET,
    SOURCES,
    car,
    car_entries,
    template,
    vehicle_text,
)
from driveline.fmus.building.one_car import FOLLOW, MEASURED, of_one_car
from driveline.fmus.building.parameter_files import read_vehicle
from driveline.fmus.errors import ParameterFileError
from toolground.toml_file import toml_entries


def test_each_entry_says_where_it_is_from_and_who_takes_it() -> None:
    entries = {entry.name: entry for entry in car_entries({"C": 150.0, "T_cyc": 0.05})}
    assert (entries["C"].origin, entries["C"].value, entries["C"].unit) == (SET, 150.0, "N.m/rad")
    assert entries["C"].blocks == ("TwoMassDriveline", "DampingController")
    assert entries["T_cyc"].blocks == ("WheelSpeedCan",)
    assert (entries["k_s"].origin, entries["k_s"].source) == (FOLLOWS, "C")
    assert entries["k_s"].value == of_one_car({"C": 150.0}, FOLLOW)["k_s"]
    assert (entries["J_w"].origin, entries["J_w"].source, entries["J_w"].value) == (DEFAULT, "", 1.8)


def test_the_other_way_round_the_stiffness_follows() -> None:
    entries = {entry.name: entry for entry in car_entries({"k_s": 40000.0})}
    assert (entries["C"].origin, entries["C"].source) == (FOLLOWS, "k_s, k_g, k_p")
    assert (entries["k_g"].origin, entries["k_g"].source) == (FOLLOWS, "k_s")


def test_what_is_set_comes_first_and_all_of_a_car_is_there() -> None:
    entries = car_entries({"m": 1900.0})
    origins = [entry.origin for entry in entries]
    assert origins == sorted(origins, key=[SET, FOLLOWS, ESTIMATED, DEFAULT].index)
    names = {entry.name for entry in entries}
    assert names >= {*FOLLOW, "J_1", "tau", "T_cyc", "mu"}
    assert names.isdisjoint({"k_d", "v_0", "T_0", "seed", "recorded_load", "T_take_max"})


def test_what_a_data_sheet_lacks_is_estimated_from_what_it_has() -> None:
    entries = {entry.name: entry for entry in car_entries({"m": 2900.0, "T_max": 360.0, "i": 12.0, "gap": 0.03})}
    found = {name: (entries[name].origin, entries[name].source) for name in ("J_1", "J_2", "C", "c_slip")}
    assert found == {
        "J_1": (ESTIMATED, "T_max"),
        "J_2": (ESTIMATED, "i"),
        "C": (ESTIMATED, "T_max, i"),
        "c_slip": (ESTIMATED, "m"),
    }
    assert (entries["phi_B"].origin, entries["phi_B"].source, entries["phi_B"].value) == (FOLLOWS, "gap", 0.18)
    assert (entries["gap"].origin, entries["gap"].unit, entries["gap"].blocks) == (SET, "rad", ())


def test_all_that_follows_tells_from_what() -> None:
    assert set(SOURCES) == {"C", *FOLLOW}


def test_a_car_has_all_its_entries() -> None:
    assert car({"m": "1887kg"}) == car({"m": "1.887 t"}) == car({"m": 1887.0})
    assert car()["k_s"] == 25800.0
    assert car({"m": 2900.0})["F_z0"] == 17000.0
    with pytest.raises(ParameterFileError, match=r"C = 300 N\.m/rad: the frequency of the drive train would"):
        car({"C": 300.0})


@together(
    "entries, message",
    [
        ({"ks": 30000.0}, "ks is not known; did you mean k_s"),
        ({"C": "150"}, 'C = "150": a number in N.m/rad stands without quotes'),
        ({"m": True}, "m = True: it must be a finite number"),
        ({"T_max": -5.0}, "T_max = -5: MotorTorqueLoop takes 1 to 2000 N.m"),
        ({"k_d": 2.0}, "k_d does not belong here: "),
        ({"v_0": 2.0}, "v_0 does not belong here: the manoeuvre sets it"),
    ],
)
def test_what_no_vehicle_file_could_have_is_refused(entries: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterFileError) as refused:
        car(entries)
    assert str(refused.value).startswith(message)


@together("given", [3, 0, "van.toml", [("m", 1900.0)]])
def test_a_car_that_is_no_mapping_is_refused(given: Any) -> None:
    with pytest.raises(ParameterFileError) as refused:
        car(given)
    assert str(refused.value).startswith(
        f"the car {given!r} must be the entries of a vehicle file, as {{'m': 1900.0}}, or what "
    )


def test_the_numbers_of_numpy_are_numbers() -> None:
    assert car({"m": np.float32(1900.0), "i": np.int64(9)}) == car({"m": 1900.0})


def test_the_template_is_the_default_car(tmp_path: Path) -> None:
    path = tmp_path / "car.toml"
    path.write_text(template(), encoding="utf-8")
    assert car(read_vehicle(path)) == car()
    assert of_one_car(read_vehicle(path), FOLLOW) == read_vehicle(path), "and nothing follows"


def test_what_is_written_as_a_vehicle_file_is_read_back(tmp_path: Path) -> None:
    path, entries = tmp_path / "car.toml", {"C": 117.4, "mine": True, "theirs": False}
    path.write_text(vehicle_text(["A car.", "", "of words " * 20], entries), encoding="utf-8")
    assert toml_entries(path) == entries
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[:2] == ["# A car.", "#"]
    assert max(map(len, lines)) <= 120


def test_every_line_of_the_template_can_be_set(tmp_path: Path) -> None:
    path = tmp_path / "car.toml"
    lines = [line.removeprefix("# ") if " = " in line.partition(";")[0] else line for line in template().splitlines()]
    measured = [line for line in lines if line.partition(" = ")[0] in MEASURED]
    path.write_text("\n".join(line for line in lines if line not in measured), encoding="utf-8")
    assert read_vehicle(path) == car()
    path.write_text("\n".join(measured), encoding="utf-8")
    assert read_vehicle(path).keys() == MEASURED.keys()
