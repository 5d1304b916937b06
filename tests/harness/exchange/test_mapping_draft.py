"""A draft of a mapping finds what names say, marks what they leave open and names what is missing; runs take it."""

from pathlib import Path
from typing import Any

import pytest
from fmutesting.foreign import SMALLEST_CONTROLLER, build_relay, tampered

from driveline.harness.commands.cli import main
from driveline.harness.exchange.mapping_draft import as_toml, draft, words
from driveline.harness.loop.places import PLACES
from driveline.harness.loop.settings import settings
from fmuloop.errors import WiringError
from fmuloop.interface import Interface
from fmuloop.mapping import parsed, read

NAMES = {
    "T_mot": "tqMot", "T_brake": "BrakeTorque", "slope": "grade", "v_0": "v0", "T_0": "tq_init", "omega_1": "nMot",
    "omega_2": "nWhl", "omega_wheel_L": "nWhlLeft", "omega_wheel_R": "WheelSpeedRight", "T_gear": "Shaft.tau",
    "v": "vVeh", "a_body": "VehAccel",
}  # fmt: skip


@pytest.fixture
def theirs(native: Path, tmp_path: Path) -> Path:
    """The design model by other names, some without a unit."""

    def change(xml: str) -> str:
        for ours, other in NAMES.items():
            xml = xml.replace(f'name="{ours}"', f'name="{other}"')
        return xml.replace(' unit="rad"', "", 1)

    return tampered(native / "TwoMassDriveline.fmu", tmp_path / "theirs.fmu", change)


def test_names_of_other_schools_are_found(theirs: Path) -> None:
    assert {each.port.variable: each.theirs for each in draft(Interface(theirs), "plant")} == NAMES


@pytest.mark.parametrize("place", PLACES)
def test_our_own_fmus_are_sure_of_themselves(native: Path, place: str) -> None:
    proposals = draft(Interface(native / f"{PLACES[place][0]}.fmu"), place)
    assert [(each.port.variable, True) for each in proposals] == [(each.theirs, each.sure) for each in proposals]


@pytest.mark.parametrize(("name", "proposed"), [("brake", True), ("brake_fluid", False)])
def test_half_of_the_words_are_enough_for_a_proposal(name: str, proposed: bool, native: Path, tmp_path: Path) -> None:
    """Of torque and brake the first has half, and with another word the second has a third."""
    path = tampered(native / "TwoMassDriveline.fmu", tmp_path / "b.fmu", lambda xml: xml.replace("T_brake", name))
    found = {each.port.variable: (each.theirs, each.sure) for each in draft(Interface(path), "plant")}
    assert found["T_brake"] == (name if proposed else None, False)


def test_a_unit_that_the_fmu_does_not_tell_is_named_as_what_it_is_taken_for(theirs: Path) -> None:
    text = as_toml(draft(Interface(theirs), "plant"), theirs.name, "plant")
    assert 'slope = "grade"  # the FMU tells no unit, taken as rad\n' in text
    assert 'T_mot = "tqMot"  # in N.m' in text


def test_what_is_not_sure_is_marked_and_what_is_missing_is_named(native: Path, tmp_path: Path) -> None:
    def change(xml: str) -> str:
        return xml.replace('name="T_ref"', 'name="command"').replace('name="T_driver"', 'name="torque_request_raw"')

    other = tampered(native / "DampingController.fmu", tmp_path / "c.fmu", change)
    text = as_toml(draft(Interface(other), "controller"), other.name, "controller")
    assert '\n# T_driver = "torque_request_raw"  # in N.m, NOT SURE: take the first # away if it is\n' in text
    (file := tmp_path / "c.toml").write_text(text, encoding="utf-8")
    assert "controller.T_driver" not in read(file), "a guess that nobody has read does not run"
    assert 'T_ref = "command"' not in text, "T_damp and others fit as well"
    assert "# missing, and no run goes without: T_ref" in text
    assert "optional" not in text


def test_the_last_output_that_fits_is_proposed(tmp_path: Path) -> None:
    script = tmp_path / "other.py"
    script.write_text(SMALLEST_CONTROLLER.read_text(encoding="utf-8").replace("T_ref", "out"), encoding="utf-8")
    proposals = draft(Interface(build_relay(tmp_path, script)), "controller")
    found = {each.port.variable: (each.theirs, each.sure) for each in proposals if each.theirs}
    assert found == {"T_driver": ("T_driver", True), "omega_1_meas": ("omega_1_meas", True), "T_ref": ("out", False)}


def test_a_draft_is_what_runs_take(theirs: Path, native: Path, tmp_path: Path, capsys: Any) -> None:
    file = tmp_path / "theirs.toml"
    assert main(["map", str(theirs), "--output", str(file)]) == 0
    given = ["--manoeuvre", "tipin15", "--plant", str(theirs), "--build", "native", "--fmus", str(native.parent)]
    assert main(["simulate", *given, "--map", str(file), "--output", str(tmp_path / "out"), "--quiet"]) == 0
    assert settings(mapping=str(file)).mapping == parsed([str(file)]) == {f"plant.{a}": b for a, b in NAMES.items()}
    wrong = ["--map", "plant.T_geer=Shaft.tau", "--map", "plant.x=y", "--output", str(tmp_path / "none")]
    capsys.readouterr()
    assert main(["simulate", *given, "--map", str(file), *wrong]) == 2
    err = capsys.readouterr().err
    assert "plant.T_geer=Shaft.tau: nothing in the loop is called plant.T_geer; did you mean T_gear" in err
    assert "plant.x=y: nothing in the loop is called plant.x; known are T_mot, omega_1, " in err
    controller = str(build_relay(tmp_path, SMALLEST_CONTROLLER))
    assert main(["map", controller, "--place", "can", "--output", str(tmp_path / "none")]) == 2
    assert "nothing in it fits a can, which has omega_wheel_L, " in capsys.readouterr().err
    bus = str(native.parent / "native" / "WheelSpeedCan.fmu")  # has a seed as the motor does, which no run needs
    assert main(["map", bus, "--place", "motor", "--output", str(tmp_path / "none")]) == 2
    assert not (tmp_path / "none").exists()
    assert main(["map", str(tmp_path / "no.fmu")]) == 2
    assert capsys.readouterr().err.endswith(f"driveline map: there is no FMU {tmp_path / 'no.fmu'}\n")


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("T_gear = 'a'", r"T_gear = 'a'; it must be a table such as \[plant\]"),
        ("[plant]\nT_gear = 3", r"plant\.T_gear = 3; it must be a name of the FMU in quotes"),
        ("[plant", "toml: not TOML"),
        (None, "toml: there is no such file"),
    ],
)
def test_a_file_that_is_no_mapping_is_refused(tmp_path: Path, text: str | None, complaint: str) -> None:
    file = tmp_path / "theirs.toml"
    if text is not None:
        file.write_text(text)
    with pytest.raises(WiringError, match=complaint):
        read(file)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("tqMotAct", {"torque", "motor", "measured"}),
        ("v0", {"speed", "body", "start"}),
        ("WHEEL_SPEED", {"wheel", "speed"}),
    ],
)
def test_a_name_is_taken_apart_into_words(name: str, expected: set[str]) -> None:
    assert words(name) == expected
