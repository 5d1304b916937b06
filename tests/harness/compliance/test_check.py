"""The compliance checks: nothing to find in our FMUs, every planted fault found."""

import re
import tempfile
from itertools import islice
from zipfile import ZipFile

import pytest

from harness.compliance.check import FILE_CHECKS, check
from harness.cosimulation.system import PLANTS
from harness.errors import DrivelineError
from tests.foreign import RELAY, build_relay, tampered

PLANT = f"{PLANTS[0]}.fmu"


def findings(path):
    return [problem for verdict in check(path) for problem in verdict.problems]


def file_findings(path):
    """Those that need no run of the FMU."""
    verdicts = islice(check(path), 1 + len(FILE_CHECKS))
    return "\n".join(problem for verdict in verdicts for problem in verdict.problems)


@pytest.mark.parametrize(
    "name",
    [PLANT, "ValidationVehicle.fmu", "MotorTorqueLoop.fmu", "WheelSpeedCan.fmu", "DampingController.fmu"],
)
def test_our_fmus_have_no_findings(built, name):
    assert findings(built / name) == []


@pytest.mark.parametrize(
    ("pattern", "replacement", "finding"),
    [
        (r' unit="m/s2"', "", "a_body has no unit"),
        (r'<Unknown index="\d+" dependencies="[^"]*"', lambda m: m[0].split(" dep")[0], "its dependencies"),
        (r"<InitialUnknowns>.*?</InitialUnknowns>", "", "InitialUnknowns"),
        (r' description="speed of the motor"', "", "omega_1 has no description"),
        (r'min="-2000.0" ', 'min="1.0" ', r"T_mot starts at .* out of \[1\.0"),
        (r'name="T_brake"', 'name="T_mot"', "not unique"),
        (r"<DefaultExperiment[^>]*>", "", "DefaultExperiment"),
        (r' fmiVersion="2.0"', ' fmiVersion="1.5"', "cannot be read|FMI 1.5"),
    ],
)
def test_a_fault_in_the_description_is_found(built, tmp_path, pattern, replacement, finding):
    def change(xml):
        return re.sub(pattern, replacement, xml, count=1, flags=re.DOTALL)

    faulty = tampered(built / PLANT, tmp_path / "faulty.fmu", change)
    assert re.search(finding, file_findings(faulty))


@pytest.mark.parametrize(
    ("path", "finding"),
    [
        ("resources\\model.txt", "backslash"),
        ("resources/__pycache__/model.pyc", "leftover"),
        ("../escape.txt", "leaves the folder"),
    ],
)
def test_a_fault_in_the_archive_is_found(built, tmp_path, path, finding):
    faulty = tampered(built / PLANT, tmp_path / "faulty.fmu", str, **{path: b"x"})
    assert finding in file_findings(faulty)


def test_missing_pages_are_found(built, tmp_path):
    with ZipFile(built / PLANT) as source, ZipFile(tmp_path / "bare.fmu", "w") as target:
        for name in source.namelist():
            if not name.startswith("documentation/") and name != "model.png":
                target.writestr(name, source.read(name))
    found = file_findings(tmp_path / "bare.fmu")
    assert "documentation/index.html is missing" in found
    assert "model.png is missing" in found


FAULTS = {
    "not_finite": ("t = current_time + step_size", "t = float('nan')", "t is nan"),
    "shared": (
        "self.t = current_time + step_size",
        "self.t = Relay.total = getattr(Relay, 'total', 0.0) + step_size",
        "beside another instance",
    ),
    "crash": ("self._pass_on()\n        self.t", "import os; os._exit(3)\n        self.t", "exit code 3"),
    "refusal": ("step_size):", "step_size):\n        assert step_size < 5e-3", "answered fmi2DoStep"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_in_the_behaviour_is_found_and_leaves_nothing_behind(tmp_path, fault, monkeypatch):
    old, new, finding = FAULTS[fault]
    script = tmp_path / "relay.py"
    text = RELAY.read_text()
    assert old in text
    script.write_text(text.replace(old, new))
    relay = build_relay(tmp_path, script)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    assert finding in "\n".join(findings(relay))
    assert list(temporary.iterdir()) == []


def test_a_binary_that_is_not_there_is_found(tmp_path):
    faulty = tampered(
        build_relay(tmp_path),
        tmp_path / "faulty.fmu",
        lambda xml: xml.replace('modelIdentifier="Relay"', 'modelIdentifier="Other"'),
    )
    assert "cannot be instantiated" in "\n".join(findings(faulty))


def test_what_cannot_be_read_gets_one_finding(tmp_path):
    path = tmp_path / "text.fmu"
    path.write_text("no archive")
    assert len(findings(path)) == 1
    with pytest.raises(DrivelineError, match="there is no FMU"):
        findings(tmp_path / "none.fmu")
