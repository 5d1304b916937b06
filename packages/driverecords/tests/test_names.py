"""Headings, aliases and units."""

from pathlib import Path

import numpy as np
import pytest

from driverecords.channels import Channels
from driverecords.drive import read_drive
from driverecords.headings import split, without_brackets
from driverecords.measurement import read_measurement
from driverecords.quantities import QUANTITIES, aliases
from driverecords.source import RecordingError
from toolground.unit_conversion import factor

from .car import RADIUS, RATIO, drive
from .conftest import Write


@pytest.mark.parametrize(
    ("heading", "name", "unit"),
    [
        ("Motor Speed [rpm]", "Motor Speed", "rpm"),
        ("Motor Speed (1/min)", "Motor Speed", "1/min"),
        ("Speed (filtered) [km/h]", "Speed (filtered)", "km/h"),
        ("C (N.m/(rad))", "C", "N.m/(rad)"),
        ("omega_1", "omega_1", None),
        ("Speed []", "Speed", None),
        ("Speed [km/h", "Speed", "km/h"),
        ("v/(km/h)", "v", "km/h"),
        ("Drehmoment in [Nm]", "Drehmoment", "Nm"),
    ],
)
def test_a_unit_in_brackets_or_parentheses(heading: str, name: str, unit: str | None) -> None:
    assert split(heading) == (name, unit)


@pytest.mark.parametrize(
    ("heading", "readings"),
    [
        ("v_km_h", [("v_km", "h"), ("v", "km/h")]),
        ("T..km.h.", [("T_km", "h"), ("T", "km/h")]),
        ("T / Nm", [("T", "Nm")]),
        ("T|Nm", [("T", "Nm")]),
        ("v/km/h", [("v", "km/h")]),
        ("T in Nm", [("T", "Nm")]),
        ("speed", []),
        ("inside", []),
    ],
)
def test_a_unit_without_brackets(heading: str, readings: list[tuple[str, str]]) -> None:
    assert list(without_brackets(heading)) == readings


def test_every_quantity_has_a_name_of_ours() -> None:
    assert all(aliases()[quantity] for quantity in QUANTITIES)
    assert aliases().keys() == QUANTITIES.keys()


def columns() -> dict[str, np.ndarray]:
    signals = drive()
    return {
        "Time [s]": signals["time"],
        "n_EM1 [rad/s]": signals["omega_1"],
        "M_EM1 [Nm]": signals["T_mot"],
        "omega_2 [rad/s]": signals["omega_2"],
    }


def test_names_of_a_file_are_known_beside_ours(write: Write, tmp_path: Path) -> None:
    path, names = write(columns()), tmp_path / "names.toml"
    with pytest.raises(RecordingError, match="no column Motor Speed"):
        read_measurement(path, RATIO, RADIUS)
    names.write_text('omega_1 = ["N em1"]\nT_mot = ["M_EM1"]\n', encoding="utf-8")
    assert read_measurement(path, RATIO, RADIUS, names=[names]).omega_1[0] == pytest.approx(drive()["omega_1"][0])


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("omega1 = ['n']", "omega1 is no quantity; did you mean omega_1"),
        ("omega_1 = 'n'", "omega_1 = n; it must be a list"),
        ("omega_1 = ['']", "it must be a list"),
        ("omega_1 = ['Torque']", "Torque names both T_mot and omega_1"),
        ("omega_1 = [", r"names\.toml: not TOML: Invalid value"),
    ],
)
def test_a_file_of_names_that_is_refused(tmp_path: Path, content: str, message: str) -> None:
    path = tmp_path / "names.toml"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(RecordingError, match=message):
        aliases(path)
    with pytest.raises(RecordingError, match=r"none\.toml: there is no such file"):
        aliases(tmp_path / "none.toml")


def test_a_column_that_is_said_to_be_there_and_is_not(write: Write) -> None:
    with pytest.raises(RecordingError, match=r"no column n_EM2, which --column gives for omega_1; did you mean n_EM1"):
        read_measurement(write(columns()), RATIO, RADIUS, {"omega_1": "n_EM2"})


UNITS = ("Nm", "N·m", "kNm", "NM", "lb-ft")
FORMS = ("{} [{}]", "{} ({})", "{}/{}", "{} / {}", "{} in {}", "{} in [{}]", "{}/({})")


@pytest.mark.parametrize("name", ["Drehmoment", "Motor Torque", "T", "M", "motor_torque"])
def test_every_name_takes_every_unit_in_every_form(tmp_path: Path, name: str) -> None:
    for unit in UNITS:
        for form in FORMS:
            path = tmp_path / "drive.csv"
            path.write_text(f"t [s];v [m/s];{form.format(name, unit)}\n0;10;1\n1;10;2\n", encoding="utf-8")
            assert read_drive(path).T_mot.tolist() == [factor(unit, "N.m"), 2.0 * factor(unit, "N.m")], form


def test_names_in_german(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    for height in ("Höhe", "H\u006f\u0308he", "HÖHE", "Hoehe"):
        path.write_text(f"Zeit in s;Geschwindigkeit in km/h;Drehmoment / Nm;{height} / m\n0;36;1;500\n1;36;2;501\n")
        drive = read_drive(path)
        assert drive.elevation is not None
        assert (drive.v[0], drive.T_mot[1], drive.elevation[1]) == (10.0, 2.0, 501.0)


def test_a_unit_decides_what_a_name_leaves_open(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("T [degC],Speed [rpm],Speed [km/h],t [s],T [Nm]\n9,1,36,0,1\n9,2,36,1,2\n", encoding="utf-8")
    channels = Channels(path).read("v", "omega_1", "T_mot")
    assert {q: channel.heading for q, channel in channels.items()} == {
        "v": "Speed [km/h]", "omega_1": "Speed [rpm]", "T_mot": "T [Nm]"
    }  # fmt: skip
    assert channels["T_mot"].time.tolist() == [0.0, 1.0]


@pytest.mark.parametrize(
    "header", ["Time [s],v [m/s],T,Motor Torque [Nm]", "Time [s],v [m/s],M [Nm],Motor Torque [Nm]"]
)
def test_an_open_name_does_not_stand_against_a_sure_one(tmp_path: Path, header: str) -> None:
    path = tmp_path / "drive.csv"
    path.write_text(f"{header}\n0,10,1,7\n1,10,2,8\n", encoding="utf-8")
    assert read_drive(path).T_mot.tolist() == [7.0, 8.0]


def test_an_open_name_without_a_unit_is_nobodys(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("Time [s],v [m/s],T\n0,10,1\n1,10,2\n", encoding="utf-8")
    with pytest.raises(RecordingError, match=r"no column Motor Torque.*; --column T_mot=HEADING says which one it is"):
        read_drive(path)


@pytest.mark.parametrize("given", ["T / Nm", "T", "T [Nm]"])
def test_a_heading_with_a_unit_behind_a_slash_can_be_given(tmp_path: Path, given: str) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("Time [s],v [m/s],T / Nm\n0,10,1\n1,10,2\n", encoding="utf-8")
    assert read_drive(path, {"T_mot": f"-{given}"}).T_mot.tolist() == [-1.0, -2.0]


@pytest.mark.parametrize(
    ("header", "given"),
    [
        ("Time [s],v [m/s],x [Nm]", "T_mot=x [Nm]"),
        ("Time [s],v,T [Nm]", "v=v [m/s]"),
        ("Time [s],v [m],T [Nm]", "v=v [m/s]"),
        ("Time [s],v [m/s],Speed [m/s],T [Nm]", "v=Speed [m/s]"),
        ("Time [s],Wheel Speed [rad/s],x [m/s],T [Nm]", "v=x [m/s]"),
    ],
)
def test_a_refusal_names_the_option_that_mends_it(tmp_path: Path, header: str, given: str) -> None:
    path = tmp_path / "drive.csv"
    rows = [",".join(["0", *["1"] * header.count(",")]), ",".join(["1", *["2"] * header.count(",")])]
    path.write_text("\n".join([header, *rows, ""]), encoding="utf-8")
    quantity, _, heading = given.partition("=")
    with pytest.raises(RecordingError, match=rf"--column {quantity}="):
        read_drive(path)
    assert len(read_drive(path, {quantity: heading}).v) == 2


@pytest.mark.parametrize(
    "path",
    [
        "Request/",
        "DriverRequest/",
        "Limits/",
        "MaxValues/",
        "TorqueDemand.",
        "Desired/",
        "Command/",
        "Driver_Request\\",
    ],
)
def test_a_torque_that_is_demanded_or_a_limit_is_not_that_of_the_motor(tmp_path: Path, path: str) -> None:
    file = tmp_path / "drive.csv"
    rows = "0,10,1\n1,10,2\n"
    file.write_text(f"Time [s],v [m/s],{path}Motor Torque [Nm]\n{rows}", encoding="utf-8")
    with pytest.raises(RecordingError, match="no column Motor Torque"):
        read_drive(file)
    file.write_text(f"Time [s],v [m/s],Powertrain/Motor Torque [Nm]\n{rows}", encoding="utf-8")
    assert read_drive(file).T_mot.tolist() == [1.0, 2.0]
