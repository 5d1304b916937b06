"""Manoeuvres of files."""

import re
from inspect import signature
from math import atan
from pathlib import Path

import numpy as np
import pytest

from driveline.harness.manoeuvres.manoeuvre_file import read_manoeuvre
from driveline.harness.manoeuvres.parts import KINDS
from tests import ROOT
from toolground.errors import UserError

EXAMPLE = ROOT / "examples" / "manoeuvres" / "overtaking.toml"
PAGE = (ROOT / "docs" / "manoeuvres.md").read_text(encoding="utf-8")


def read(folder: Path, text: str, name: str = "mine.toml"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return read_manoeuvre(path)


def test_the_example_is_read_as_it_says_and_has_every_kind_and_key_as_the_page():
    manoeuvre = read_manoeuvre(EXAMPLE)
    assert (manoeuvre.name, manoeuvre.duration) == ("overtaking", 20.0)
    assert manoeuvre.v_0 == pytest.approx(50 / 3.6)
    assert manoeuvre.T_driver([0.0, 1.0, 4.0, 5.0, 6.1, 7.0, 8.0]) == pytest.approx([20, 80, 95, 110, 70, 110, 20])
    assert manoeuvre.T_brake([8.1, 8.2, 8.6]).tolist() == [0.0, 400.0, 0.0]
    assert manoeuvre.slope([3.0, 8.0, 9.0]) == pytest.approx([atan(0.04), 0.5 * atan(0.04), 0.0])
    assert manoeuvre.dT is None
    text = EXAMPLE.read_text(encoding="utf-8")
    assert text.partition("\n\n")[2].strip() in PAGE
    for kind, part in KINDS.items():
        assert f'kind = "{kind}"' in text
        (row,) = re.findall(rf"^\| `{kind}` \| (.*?) \|", PAGE, re.M)
        assert re.findall(r"`(\w+)`", row) == list(signature(part).parameters)


def test_the_lines_of_python_on_the_page_print_what_they_say(both_built, capsys) -> None:
    (lines,) = re.findall(r"```python\n(.*?)```", PAGE, re.S)
    exec(re.sub(r"simulate\((\w+)\)", rf"simulate(\1, folder=Path({str(both_built)!r}))", lines), {"Path": Path})
    settling, absent = capsys.readouterr().out.splitlines()
    assert 0.05 < float(settling) < 0.2
    assert absent == "the manoeuvre is no step"


def test_a_file_needs_a_duration_alone_and_is_not_too_long(tmp_path):
    manoeuvre = read(tmp_path, "duration = 2")
    assert (manoeuvre.v_0, manoeuvre.T_0, manoeuvre.dT) == (0.0, 0.0, None)
    with pytest.raises(UserError, match=r"1\.2 MB is too long; at most 1 MB"):
        read(tmp_path, "duration = 5\n" + "# " * 600_000)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "it is empty; a manoeuvre has description, duration"),
        ("# nothing", "it is empty"),
        ("duration", "not TOML"),
        ("T_driver = 5", "no duration"),
        ("duration = 5\nT_drive = 3", "T_drive is no key; did you mean T_driver"),
        ('duration = "5"', 'duration = "5" must be a number and a unit; "200 ms" is one'),
        ("duration = true", "duration = True: it must be a finite number of s"),
        ("duration = 0.0009", "duration = 0.0009: it must be 0.001 to 3600 s"),
        ("duration = 3601", "duration = 3601: it must be 0.001 to 3600 s"),
        ("duration = inf", "duration = inf: it must be a finite number"),
        ('duration = 5\nv_0 = "15 kg"', 'v_0 = "15 kg" is in kg, which does not convert into m/s'),
        ("duration = 5\ndescription = 3", "description = 3: it must be a text"),
        ("duration = 5\nT_driver = [3]", "T_driver, part 1 is 3; it must be such as { kind"),
        ('duration = 5\nT_driver = [{ kind = "stp" }]', "T_driver, part 1: kind = 'stp' is unknown; did you mean step"),
        ("duration = 5\nslope = [{ at = 1 }]", "slope, part 1: it has no kind; known are: constant"),
        (
            'duration = 5\nT_brake = [{ kind = "step", at = 1, height = 3 }, { kind = "step", at = 5, height = 1 }]',
            "T_brake, part 2, step: at = 5: the manoeuvre ends at 5 s",
        ),
        ('duration = 5\nT_driver = [{ kind = "step", at = 1 }]', "part 1, step: no height; it needs at, height"),
        (
            'duration = 5\nT_driver = [{ kind = "step", at = 1, height = 3, heigth = 4 }]',
            "step: heigth is no key; did you mean height",
        ),
        (
            'duration = 5\nT_driver = [{ kind = "points", points = [[1, 2], [0.5, 3]] }]',
            "points: the point at 0.5 s comes after that at 1 s; time must not run back",
        ),
        (
            'duration = 5\nT_driver = [{ kind = "points", points = [[1, 2, 3]] }]',
            "point 1 is .*; it must be an instant",
        ),
        ('duration = 5\nT_driver = [{ kind = "points", points = 3 }]', "points = 3: it must be a list"),
        (
            'duration = 5\nT_driver = [{ kind = "constant", value = nan }]',
            "value = nan: it must be a finite number of N.m",
        ),
        ('duration = 5\nT_driver = [{ kind = "prbs", amplitude = 3, order = 9.0 }]', "order = 9.0: it must be a whole"),
    ],
)
def test_what_is_wrong_is_said_in_one_line_with_file_key_and_value(tmp_path, text, message):
    with pytest.raises(UserError, match=message) as refusal:
        read(tmp_path, text)
    assert str(refusal.value).startswith(f"{tmp_path / 'mine.toml'}: ")
    assert str(refusal.value).isprintable()


def test_a_table_is_read_as_straight_lines_with_jumps_and_gaps(tmp_path):
    rows = ("2000,-0.012,0,36", "3000,-0.012,0,36", "3000,0.1,0,36", "8000,0.1,0,40")
    text = "\n".join(("Time [ms],T_driver [kNm],Slope [%],Speed [km/h]", *rows, ""))
    manoeuvre = read(tmp_path, text, "mine.csv")
    assert (manoeuvre.duration, manoeuvre.v_0, manoeuvre.t_0, manoeuvre.dT) == (6.0, 10.0, 1.0, 112.0)
    assert manoeuvre.T_driver([0.0, 0.999, 1.0, 6.0]).tolist() == [-12.0, -12.0, 100.0, 100.0]
    steep = read(tmp_path, text.replace(",0,40", ",5,40"), "mine.csv")
    assert steep.slope([1.0, 6.0]) == pytest.approx([0.0, atan(0.05)])
    assert steep.dT is None, "the slope changes"
    manoeuvre = read(tmp_path, "t [s];T_driver [N.m];T_brake [N.m]\n0;1;0\n0,1;1;0\n100;1;500\n", "mine.csv")
    assert (manoeuvre.duration, manoeuvre.v_0) == (100.0, 0.0)
    assert manoeuvre.T_brake(100.0) == 500.0
    np.testing.assert_array_equal(manoeuvre.slope(np.arange(3.0)), 0.0)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ("0,1\n2,3\n1,4\n", "line 4: time 1 s does not come after 2 s"),
        ("0,1\n2,nan\n3,1\n", "line 3: T_driver .* has no value"),
        ("0,1\n", "1 samples; a drive needs at least two"),
        ("1,1\n1,2\n", "it lasts 0 s; it must be 0.001 to 3600 s"),
        ("0,1\n3601,2\n", "it lasts 3601 s"),
    ],
)
def test_a_bad_table_is_refused(tmp_path, rows, message):
    with pytest.raises(UserError, match=message):
        read(tmp_path, f"Time [s],T_driver [Nm]\n{rows}", "mine.csv")
