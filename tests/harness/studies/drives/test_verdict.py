"""What `driveline replay` says of a recording that cannot be true, and that it says nothing of others."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import driveline
from docs.studies.plausible_drives import Judged, cases, judged
from driveline.harness.commands.cli import main
from driveline.harness.loop.places import PLANTS
from driveline.harness.loop.resolved import as_given
from driveline.harness.manoeuvres.catalogue import TOWN_DRIVE
from driveline.harness.studies.drives.replay import CLOSE
from driveline.harness.views.terminal import print_rides

FEW = 52

PUSHES = "Motor Torque [Nm] at "


@pytest.fixture
def turned(tmp_path: Path) -> Path:
    """Eight seconds of the drive in town with the torque of the other sign."""
    path = tmp_path / "turned.csv"
    table = pd.read_csv(TOWN_DRIVE)[20:100]
    table.assign(**{"Motor Torque [Nm]": -table["Motor Torque [Nm]"]}).to_csv(path, index=False)
    return path


@pytest.fixture
def given(native: Path, tmp_path: Path) -> list[str]:
    return ["--fmus", str(native.parent), "--output", str(tmp_path / "results")]


@pytest.mark.slow
def test_it_is_said_on_stderr_and_marked_in_table_report_and_document(turned, given, tmp_path, capsys, caplog) -> None:
    report = tmp_path / "report.html"
    assert main(["replay", str(turned), *given, "--json", "--report", str(report)]) == 0
    document = json.loads(capsys.readouterr().out)
    finding, unkept = document["findings"]
    assert (finding["rule"], unkept["rule"]) == ("sign of torque", "following")
    assert finding["column"] == "Motor Torque [Nm]"
    assert finding["text"].startswith(PUSHES)
    assert caplog.messages == [f"{turned}: {each['text']}" for each in document["findings"]]
    table = (tmp_path / "results" / "turned_table.md").read_text(encoding="utf-8")
    assert f"\nnot plausible: {finding['text']}\n" in table
    page = report.read_text(encoding="utf-8")
    assert "The recording is not plausible (2 findings); if it is true, DampingController takes" in page
    assert "Is the recording plausible?" in page


def test_a_program_is_told_too_and_a_table_has_it_below(turned, native, caplog, capsys) -> None:
    rides = driveline.replay(driveline.read_drive(turned), folder=native.parent, build="native")
    assert [text for text in caplog.messages if text.startswith(f"turned: {PUSHES}")]
    print_rides({ride.controller: ride.metrics for ride in rides}, "turned", ["not plausible: x"])
    assert "\nnot plausible: x\n" in capsys.readouterr().out


def test_strict_refuses_before_anything_is_run_or_written(turned, given, tmp_path, capsys) -> None:
    for look in ([], ["--look"]):
        assert main(["replay", str(turned), *given, "--strict", *look]) == 2
        assert "turned.csv is not plausible (sign of torque), which --strict refuses" in capsys.readouterr().err
        assert not (tmp_path / "results").exists()
    assert main(["replay", str(turned), *given, "--strict", "--look", "--column", "T_mot=-Motor Torque [Nm]"]) == 0


def test_a_look_runs_nothing_and_shows_what_was_read(turned, given, tmp_path, capsys, caplog) -> None:
    assert main(["replay", str(turned), *given, "--look"]) == 0
    printed = capsys.readouterr().out
    for text in ("Velocity [km/h]", "km/h -> m/s", "Nm -> N.m", "80"):
        assert text in printed
    assert any(PUSHES in text for text in caplog.messages)
    assert [path.name for path in (tmp_path / "results").iterdir()] == ["turned_look.png"]
    assert main(["replay", str(turned), *given, "--look", "--json", "--figures", "svg"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert [finding["rule"] for finding in document["findings"]] == ["sign of torque"]
    assert document["columns"][0] == {
        "quantity": "v", "column": "Velocity [km/h]", "unit": "km/h", "si_unit": "m/s", "samples": 80,
        "interval_s": pytest.approx(0.1), "begin_s": 2.0, "end_s": 9.9, "least": pytest.approx(0.0),
        "largest": pytest.approx(34.91, abs=0.1),
    }  # fmt: skip
    assert document["files"] == [str(tmp_path / "results" / "turned_look.svg")]


def test_of_a_drive_that_is_true_a_look_finds_nothing_and_it_has_no_report(given, capsys, caplog: Any) -> None:
    assert main(["replay", str(TOWN_DRIVE), *given, "--look", "--strict"]) == 0
    assert "nothing is odd" in capsys.readouterr().out
    assert caplog.messages == []
    assert main(["replay", str(TOWN_DRIVE), *given, "--look", "--report", "page.html"]) == 2
    assert "--look runs nothing, so that there is nothing to --report" in capsys.readouterr().err


@pytest.mark.slow
def test_nothing_is_odd_in_drives_of_our_own_and_they_are_followed(native: Path) -> None:
    """All manoeuvres on both plants, with and without damping, with cars and sensors that are drawn at random;
    `docs.studies.plausible_drives` has all 200."""
    loops = {plant: as_given(plant, folder=native.parent, build="native") for plant in PLANTS}
    found: list[Judged] = [judged(case, damped, loops[case.plant], follow=False) for case, damped in cases(FEW)]
    assert [str(finding) for one in found for finding in one.findings] == []
    assert sum(one.balance.fits for one in found) > FEW / 2, "most are judged"
    assert sum(channel.named for one in found for channel in one.channels) == 0
    for plant, made in loops.items():
        driven = [judged(case, damped, made) for case, damped in cases(26) if case.plant == plant][::3]
        assert [str(finding) for each in driven for finding in each.findings] == []
        assert np.max([each.speed_error for each in driven]) < 2.0 * CLOSE
