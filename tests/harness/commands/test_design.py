"""`driveline design`, `car` and `target export`: gains for a car, what its file makes of it, its controller in C."""

import json
import tomllib
from errno import ENOSPC
from pathlib import Path

import pytest

from driveline.fmus.building.car_entries import template
from driveline.fmus.building.parameter_files import read_parameters, read_vehicle
from driveline.harness.commands.cli import main
from driveline.harness.design.design import design
from driveline.harness.design.unknowns import not_given
from tests import ROOT
from tests.harness.commands import Capsys

VAN = ROOT / "examples" / "cars" / "van.toml"
OF_VAN = ["design", "--vehicle", str(VAN)]


def test_the_gains_of_a_car_are_printed_with_units_and_meaning_or_written(tmp_path: Path, capsys: Capsys) -> None:
    assert main(OF_VAN) == 0
    text, path = capsys.readouterr().out, tmp_path / "new" / "gains.toml"
    first, second, third, *lines = text.splitlines()
    assert first.startswith("# Gains of the DampingController for van.toml, by `driveline design` (driveline-damping")
    assert second == "# Drive train of the design model at 15 km/h: 6.95 Hz, damping ratio 0.025."
    assert third.startswith("# With control: ")
    assert lines[0].startswith("# (teeth in contact, the mode that a torque")
    assert tomllib.loads(text) == pytest.approx(design(read_vehicle(VAN)), rel=1e-5)
    assert any(line.endswith("# N.m.s/rad, damping over the speed difference") for line in lines)
    assert main([*OF_VAN, "--output", str(path)]) == 0
    assert capsys.readouterr().out == f"gains: {path}\n"
    assert read_parameters(path) == tomllib.loads(text)
    assert [file.name for file in path.parent.iterdir()] == ["gains.toml"]


def test_limits_of_a_user_are_kept(tmp_path: Path, capsys: Capsys) -> None:
    limits, more = tmp_path / "limits.toml", tmp_path / "more.toml"
    limits.write_text("T_take_max = 120\nT_add_max = 500\n", encoding="utf-8")
    assert main([*OF_VAN, "--parameters", str(limits)]) == 0
    asked = design(read_vehicle(VAN))
    assert tomllib.loads(capsys.readouterr().out) == pytest.approx(asked | {"T_take_max": 120.0}, rel=1e-5)
    more.write_text("k_d = 3\n", encoding="utf-8")
    assert main(["design", "--parameters", str(more)]) == 2
    refusal = f"driveline design: {more}: a file of limits (T_take_max and T_add_max) has no parameter k_d\n"
    assert capsys.readouterr().err == refusal
    assert main(["design", "--parameters", str(limits), "--search", str(tmp_path / "search")]) == 2
    assert "leave it out, or --search" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["T_take_max", "T_add_max"])
def test_a_limit_may_be_small_but_not_zero(name: str, tmp_path: Path, capsys: Capsys) -> None:
    limits = tmp_path / "limits.toml"
    limits.write_text(f"{name} = 1e-3\n", encoding="utf-8")
    assert main(["design", "--parameters", str(limits)]) == 0
    assert tomllib.loads(capsys.readouterr().out)[name] == 1e-3
    limits.write_text(f"{name} = 0\n", encoding="utf-8")
    assert main(["design", "--parameters", str(limits)]) == 2
    assert capsys.readouterr().err == f"driveline design: {limits}: {name} = 0: a limit must be above 0 N.m\n"


def test_nothing_depends_on_the_working_directory(tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["design"]) == 0
    stored = (ROOT / "models" / "controller" / "gains.toml").read_text(encoding="utf-8")
    assert capsys.readouterr().out == stored
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("J1 = 0.09\n", "line 1: J1 is not known"),
        (
            "T_cyc = 0.2\n",
            "T_age would be 0.113; the controller takes 0.002 to 0.1 s: the drive train swings at 7.4 Hz; "
            "T_cyc up to 0.17",
        ),
        ("tau = 0.06\n", "the motor is too slow for this car (tau = 0.06 s, drive train 7.43 Hz): the "),
    ],
)
def test_a_car_without_a_controller_is_answered_with_exit_code_2(tmp_path, capsys, text, message) -> None:
    car, gains = tmp_path / "car.toml", tmp_path / "gains.toml"
    car.write_text(text, encoding="utf-8")
    assert main(["design", "--vehicle", str(car), "--output", str(gains)]) == 2
    assert message in capsys.readouterr().err
    assert not gains.exists()


@pytest.mark.slow
def test_what_is_told_to_do_instead_does(tmp_path: Path, capsys: Capsys) -> None:
    """And a little less of it does not."""
    truck = {"m": 40000, "r": 0.5, "i": 22, "T_max": 1300, "F_z0": 115000, "J_1": 0.5, "J_2": 0.3, "phi_B": 0.157}
    path = tmp_path / "truck.toml"

    def refusal(C: float) -> str:
        path.write_text("".join(f"{name} = {value}\n" for name, value in {**truck, "C": C}.items()), encoding="utf-8")
        return "" if main(["design", "--vehicle", str(path), "--quiet"]) == 0 else capsys.readouterr().err

    message = refusal(117.4)
    assert "Ls_phi would be -0.1075; the controller takes -0.1 to 0.1 s: the drive train swings at 2.5 Hz; C" in message
    enough = float(message.partition("C from ")[2].split()[0])
    assert "would be -0.1" in refusal(0.95 * enough)
    assert refusal(1.005 * enough) == ""


def test_gains_of_another_car_are_not_replaced_unasked(tmp_path: Path, capsys: Capsys) -> None:
    path = tmp_path / "gains.toml"
    of_van = [*OF_VAN, "--output", str(path)]
    assert [main(of_van), main(of_van)] == [0, 0]
    before = path.read_bytes()
    assert main(["design", "--output", str(path)]) == 2
    assert f"{path} is there with another content" in capsys.readouterr().err
    assert path.read_bytes() == before
    assert main(["design", "--output", str(path), "--replace"]) == 0
    assert path.read_bytes() != before


EXPORT = ("target", "export", "--quiet")


def exported(folder: Path, *options: str) -> int:
    return main([*EXPORT, "--output", str(folder), *options])


def test_on_a_full_disk_it_writes_all_files_or_none(tmp_path, monkeypatch, capsys) -> None:
    write_text = Path.write_text

    def full(path: Path, text: str, **given: str) -> int:
        if ".c." in path.name:
            raise OSError(ENOSPC, "No space left on device")
        return write_text(path, text, **given)

    monkeypatch.setattr(Path, "write_text", full)
    assert exported(tmp_path) == 1
    source = tmp_path / "damping_controller.c"
    assert capsys.readouterr().err == f"driveline target export: {source}: No space left on device\n"
    assert list(tmp_path.iterdir()) == []


def test_it_writes_headers_and_source_with_the_car_and_its_gains(tmp_path: Path) -> None:
    gains = tmp_path / "gains.toml"
    gains.write_text("k_d = 4.0\n", encoding="utf-8")
    assert exported(tmp_path / "c", "--vehicle", str(VAN), "--parameters", str(gains)) == 0
    files = {path.name: path.read_text(encoding="utf-8") for path in (tmp_path / "c").iterdir()}
    assert sorted(files) == ["controller.h", "damping_controller.c", "damping_controller.h"]
    assert not any("double" in text for text in files.values())
    for line in (".k_d = 4.0f,", ".T_max = 250.0f,", ".phi_B = 0.314f,", ".omega_w = 3.0f,"):
        assert line in files["damping_controller.c"]


@pytest.mark.parametrize(
    ("entry", "controller", "message"),
    [
        ("J_1 = 0.05", "DampingController", "line 1: J_1 does not belong here"),
        ("k_d = 1e9", "DampingController", "k_d = 1e+09"),
        ("k_gap = 0.5", "SpeedWashout", "SpeedWashout has no parameter k_gap"),
    ],
)
def test_what_does_not_belong_to_the_controller_is_refused(entry, controller, message, tmp_path, capsys) -> None:
    gains = tmp_path / "gains.toml"
    gains.write_text(f"{entry}\n", encoding="utf-8")
    assert exported(tmp_path / "c", "--parameters", str(gains), "--controller", controller) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "c").exists()


def test_the_c_of_another_controller_stays_unless_it_is_to_be_replaced(tmp_path: Path, capsys: Capsys) -> None:
    assert exported(tmp_path) == exported(tmp_path) == 0
    before = (tmp_path / "controller.h").read_bytes()
    other = ("--controller", "SpeedWashout")
    assert exported(tmp_path, *other) == 2
    assert "controller.h is there with another content" in capsys.readouterr().err
    assert (tmp_path / "controller.h").read_bytes() == before
    assert not (tmp_path / "speed_washout.c").exists()
    assert exported(tmp_path, *other, "--replace") == 0
    assert "SpeedWashout" in (tmp_path / "controller.h").read_text(encoding="utf-8")


def test_the_table_has_each_entry_and_what_comes_of_them(capsys: Capsys) -> None:
    assert main(["car", str(VAN), "--all"]) == 0
    text = capsys.readouterr().out
    rows = {line.split()[0]: line for line in text.splitlines() if line.strip()}
    assert rows["C"].split()[1:4] == ["150", "N·m/rad", "set"]
    assert rows["k_s"].split()[1:5] == ["52333.7", "N·m/rad", "follows", "(C)"]
    assert "design plant, vehicle, bus" in rows["i"]
    assert "backlash at the wheel: 3.00 degrees" in text
    assert "takes up to 188 N·m from the demand and adds up to 83.3, of T_max = 250 N·m" in text
    assert rows["TwoMassDriveline"].split()[1] == "6.95"
    assert rows["ValidationVehicle"].split()[1] == "7.50"


@pytest.mark.slow
def test_what_a_data_sheet_lacks_is_said_with_what_it_costs(tmp_path: Path, capsys: Capsys) -> None:
    """By runs; a car that is told costs nothing, and what is told is not named."""
    sheet = tmp_path / "sheet.toml"
    sheet.write_text('m = "1815 kg"\nT_max = 310\ni = 11.53\nr = "34 cm"\nJ_1 = 0.11\n', encoding="utf-8")
    assert main(["car", str(sheet)]) == 0
    screen = capsys.readouterr().out.splitlines()
    assert len(screen) < 44
    rows = {line.split()[0]: line.split() for line in screen if line.strip()}
    assert rows["J_1"][1:4] == ["0.11", "kg·m²", "set"]
    settling, overshoot = map(int, rows["C"][-2:])
    assert 50 < settling < 500
    assert 5 < overshoot < 50
    assert main(["design", "--vehicle", str(sheet), "--output", str(tmp_path / "gains.toml")]) == 0
    line = capsys.readouterr().out.splitlines()[-1]
    assert line.startswith("not in sheet.toml, and what half or twice of it costs in settling and overshoot (tipin15, ")
    assert f"C = 158 N·m/rad (estimated) {settling} ms, {overshoot} %" in line
    assert [part.split()[0] for part in line.partition("): ")[2].split("; ")][:2] == ["C", "phi_B"]
    assert "J_1" not in line


def test_a_car_that_tells_what_decides_lacks_nothing() -> None:
    told = {"J_1": 0.06, "J_2": 0.3, "frequency": 7.0, "gap": 0.03, "c_slip": 1e5, "tau": 0.003}
    assert not_given(told) == []
    left_out = {name: {**told} for name in told}
    for name, others in left_out.items():
        del others[name]
        (lacking,) = not_given(others)
        assert lacking.name == {"frequency": "C", "gap": "phi_B"}.get(name, name)


def test_tools_get_one_document(tmp_path: Path, capsys: Capsys) -> None:
    gains = tmp_path / "gains.toml"
    gains.write_text("k_d = 3.469\nT_add_max = 40\n", encoding="utf-8")
    assert main(["car", str(VAN), "--parameters", str(gains), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    k_s = next(entry for entry in found["entries"] if entry["name"] == "k_s")
    assert (k_s["origin"], k_s["source"], k_s["blocks"]) == ("follows", "C", ["ValidationVehicle"])
    assert found["properties"]["added"] == 40.0
    for plant in found["properties"]["plants"]:
        assert plant["damping_ratio"] < 0.06 < 0.3 < plant["damped"]["damping_ratio"]


def test_a_car_without_a_controller_has_no_damped_mode_and_contradictory_shafts_are_refused(
    tmp_path: Path, capsys: Capsys
) -> None:
    car = tmp_path / "car.toml"
    car.write_text("T_cyc = 0.2\n", encoding="utf-8")
    assert main(["car", str(car), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["gains"].startswith("no gains: T_age would be 0.113; the controller takes")
    assert [plant["damped"] for plant in found["properties"]["plants"]] == [None, None]
    car = tmp_path / "car.toml"
    car.write_text("C = 220.0\nk_s = 25800.0\n", encoding="utf-8")
    assert main(["car", str(car)]) == 2
    assert capsys.readouterr().err == (
        f"driveline car: {car}, line 1: C = 220 N.m/rad and k_s = 25800 N.m/rad disagree: with that C would be "
        "117.4 N.m/rad; leave one of them out, and it follows\n"
    )


def test_the_template_is_printed_or_written_and_no_other_file_is_replaced(tmp_path: Path, capsys: Capsys) -> None:
    assert main(["car", "--template"]) == 0
    assert capsys.readouterr().out == template()
    path = tmp_path / "car.toml"
    assert main(["car", "--template", "--output", str(path)]) == 0
    assert path.read_text(encoding="utf-8") == template()
    path.write_text("mine", encoding="utf-8")
    assert main(["car", "--template", "--output", str(path)]) != 0
    assert path.read_text(encoding="utf-8") == "mine"
