"""`driverecords look` says how a recording was read and what is odd in it, for people and for tools."""

import json
from pathlib import Path
from typing import Any

import pytest

from driverecords.cli import main

pytestmark = pytest.mark.usefixtures("read_here")


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Of ten seconds; the torque has a spike."""
    torque = [20 + k % 7 for k in range(100)]
    torque[50] = 4000
    rows = (f"{0.1 * k:.1f},{5.0 + 0.1 * k:.2f},{torque[k]}" for k in range(100))
    path = tmp_path / "my_trip.csv"
    path.write_text("\n".join(["Time [s],Velocity [km/h],Motor Torque [Nm]", *rows]) + "\n")
    return path


def test_columns_and_findings_are_told(recording: Path, capsys, caplog) -> None:
    assert main(["look", str(recording)]) == 0
    printed = capsys.readouterr().out
    assert "km/h -> m/s" in printed
    assert "Motor Torque [Nm]" in printed
    (message,) = caplog.messages
    assert "Motor Torque [Nm] at 5 s" in message


def test_tools_get_the_same_as_one_document(recording: Path, capsys) -> None:
    assert main(["look", str(recording), "--from", "2", "--to", "4", "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)["recordings"]
    assert found["recording"] == str(recording)
    assert {column["quantity"]: column["samples"] for column in found["columns"]} == {"v": 21, "T_mot": 21}
    assert found["findings"] == []  # the spike is at 5 s


def test_a_column_can_be_named(recording: Path, capsys) -> None:
    text = recording.read_text().replace("Motor Torque [Nm]", "Signal 7")
    recording.write_text(text)
    assert main(["look", str(recording)]) == 2
    assert str(recording) in capsys.readouterr().err
    assert main(["look", str(recording), "--column", "T_mot=Signal 7 [N.m]", "--quiet"]) == 0


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (["none.csv"], "there is no recording none.csv"),
        (["none.csv", "--clumn", "v=x"], "unknown option --clumn; did you mean --column?"),
        (["none.csv", "--column", "speed=x"], "'speed' is no quantity"),
    ],
)
def test_a_mistake_is_answered_in_one_line(capsys, words: list[str], error: str) -> None:
    try:
        code: Any = main(["look", *words])
    except SystemExit as end:
        code = end.code
    assert code == 2
    assert error in capsys.readouterr().err.splitlines()[0]
