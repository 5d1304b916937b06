"""Headings, aliases and units."""

from pathlib import Path

import numpy as np
import pytest

from driveline.harness.recordings.headings import after_underscores, split
from driveline.harness.recordings.measurement import read_measurement
from driveline.harness.recordings.quantities import QUANTITIES, aliases
from driveline.harness.recordings.recording_units import factor_to, is_unit
from driveline.harness.recordings.source import RecordingError
from tests.harness.recordings.car import RADIUS, RATIO, drive
from tests.harness.recordings.conftest import Write


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
    ],
)
def test_a_unit_in_brackets_or_parentheses(heading: str, name: str, unit: str | None) -> None:
    assert split(heading) == (name, unit)


def test_a_unit_after_underscores() -> None:
    assert list(after_underscores("v_km_h")) == [("v_km", "h"), ("v", "km/h")]
    assert list(after_underscores("speed")) == []


@pytest.mark.parametrize(
    ("unit", "wanted", "factor"),
    [
        ("rpm", "rad/s", np.pi / 30.0),
        ("U/min", "rad/s", np.pi / 30.0),
        ("min^-1", "rad/s", np.pi / 30.0),
        ("deg/s", "rad/s", np.pi / 180.0),
        ("°/s", "rad/s", np.pi / 180.0),
        ("km/h", "m/s", 1.0 / 3.6),
        ("kmh", "m/s", 1.0 / 3.6),
        ("mph", "m/s", 0.44704),
        ("N·m", "N.m", 1.0),
        ("N*m", "N.m", 1.0),
        ("N m", "N.m", 1.0),
        ("kNm", "N.m", 1e3),
        ("g", "m/s2", 9.80665),
        ("m/s²", "m/s2", 1.0),
        ("g", "kg", 1e-3),
        ("%", "1", 0.01),
        ("-", "1", 1.0),
        ("ms", "s", 1e-3),
        ("µs", "s", 1e-6),
        ("\u03bcs", "s", 1e-6),
        ("Grad", "rad", np.pi / 180.0),
    ],
)
def test_units_as_files_write_them(unit: str, wanted: str, factor: float) -> None:
    assert factor_to(wanted, unit) == pytest.approx(factor, rel=1e-12)
    assert is_unit(unit)


@pytest.mark.parametrize(
    ("unit", "wanted"), [("Hz", "rad/s"), ("1/s", "rad/s"), ("km", "m/s"), ("quux", "s"), ("", "s"), ("m0", "m")]
)
def test_a_unit_that_does_not_convert_is_refused(unit: str, wanted: str) -> None:
    with pytest.raises(ValueError, match=f"wanted is {wanted}"):
        factor_to(wanted, unit)


def test_every_quantity_has_a_name_of_ours() -> None:
    assert all(aliases()[quantity] for quantity in QUANTITIES)
    assert aliases().keys() == QUANTITIES.keys()


def columns() -> dict[str, np.ndarray]:
    one = drive()
    return {
        "Time [s]": one["time"],
        "n_EM1 [rad/s]": one["omega_1"],
        "M_EM1 [Nm]": one["T_mot"],
        "omega_2 [rad/s]": one["omega_2"],
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
        ("omega_1 = [", r"names\.toml is not TOML: Invalid value"),
    ],
)
def test_a_file_of_names_that_is_refused(tmp_path: Path, content: str, message: str) -> None:
    path = tmp_path / "names.toml"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(RecordingError, match=message):
        aliases(path)
    with pytest.raises(RecordingError, match=r"there is no file of names .*none\.toml"):
        aliases(tmp_path / "none.toml")


def test_a_column_that_is_said_to_be_there_and_is_not(write: Write) -> None:
    with pytest.raises(RecordingError, match=r"no column n_EM2, which --column gives for omega_1; did you mean n_EM1"):
        read_measurement(write(columns()), RATIO, RADIUS, {"omega_1": "n_EM2"})
