"""Recorded drives through the simulated vehicle."""

import csv
import json
import sys
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from harness.cli import main
from harness.cosimulation.interface import Interface
from harness.errors import MissingExtra, WiringError
from harness.manoeuvres.recording import read_recording
from harness.manoeuvres.road import HELD_MIN, RoadLoad, road
from harness.manoeuvres.town_drive import PATH
from harness.replay import replay, ride, write
from tests import ROOT

TRIP = ROOT.parent / "shared" / "data" / "bmw_i3_trip_a01.csv"


@pytest.fixture(scope="module")
def short_drive(tmp_path_factory):
    """The first eight seconds of the bundled drive."""
    path = tmp_path_factory.mktemp("recording") / "short.csv"
    with PATH.open(encoding="utf-8") as file:
        path.write_text("".join(islice(file, 82)), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def replayed(built, short_drive, tmp_path_factory):
    """Folder of a replay of the short drive."""
    folder = tmp_path_factory.mktemp("replay")
    recording = read_recording(short_drive)
    manoeuvre = road(recording, RoadLoad.of_plant(Interface(built / "ValidationVehicle.fmu")), held=0.5)
    rides = replay(manoeuvre, recording, "ValidationVehicle", folder=built)
    write(rides, recording, "ValidationVehicle", folder)
    return folder


def test_a_demand_is_not_held_for_less_than_a_step(built, short_drive):
    recording, load = read_recording(short_drive), RoadLoad.of_plant(Interface(built / "ValidationVehicle.fmu"))
    assert road(recording, load, held=HELD_MIN).duration == road(recording, load).duration
    for held in (0.999 * HELD_MIN, 1e-300, float("nan")):
        with pytest.raises(WiringError, match=r"it must be 0\.001 s or more"):
            road(recording, load, held)


def test_damping_lowers_oscillation_and_damage(replayed):
    with (replayed / "short_metrics.csv").open(newline="", encoding="utf-8") as file:
        off, on = csv.DictReader(file)
    assert (off["recording"], off["control"], on["control"]) == ("short", "0", "1")
    for quantity in ("gear_torque_rms_N_m", "gear_damage_N5_m5", "jerk_rms_m_per_s3"):
        assert float(on[quantity]) < 0.9 * float(off[quantity])


def test_as_a_document_it_has_both_rides(built, short_drive, tmp_path, capsys):
    given = ["--fmus", str(built), "--output", str(tmp_path), "--set", "plant.m=1900"]
    assert main(["replay", str(short_drive), *given, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert [run["control"] for run in document["runs"]] == [False, True]
    assert all(run["gear_torque_rms_N_m"] > 0.0 for run in document["runs"])
    assert str(tmp_path / "short_metrics.csv") in document["files"]


def test_figure_and_signals_every_10_ms_are_written(replayed):
    assert {path.name for path in replayed.iterdir()} == {
        "short_metrics.csv", "short_off.csv", "short_on.csv", "short.png", "short.pdf"
    }  # fmt: skip
    with (replayed / "short_on.csv").open(encoding="utf-8") as file:
        times = [float(row["time"]) for row in csv.DictReader(file)]
    assert times == pytest.approx(np.arange(801) * 0.01)


def test_the_vehicle_follows_a_drive_that_suits_it_and_stands_where_it_stands(built):
    recording = read_recording(PATH)
    manoeuvre = road(recording, RoadLoad.of_plant(Interface(built / "TwoMassDriveline.fmu")))
    result = ride(manoeuvre, recording, "TwoMassDriveline", control=False, folder=built)
    # the brakes leave out 300 N, so the car stops a little later than the recorded one
    assert result.metrics.speed_error_rms < 0.25 * np.sqrt(np.mean(recording.v**2))
    at_the_light = (result.signals["time"] > 29.0) & (result.signals["time"] < 32.5)
    assert np.abs(result.signals["plant.v"][at_the_light]).max() < 1e-3


@pytest.mark.skipif(not TRIP.exists(), reason=f"recorded drive {TRIP} is not on this machine")
def test_a_real_car_pulls_away_in_simulation_too(built):
    recording = read_recording(TRIP)
    load = RoadLoad.of_plant(Interface(built / "ValidationVehicle.fmu"))
    manoeuvre = replace(road(recording, load), duration=10.0)
    signals = ride(manoeuvre, recording, "ValidationVehicle", control=False, folder=built).signals
    assert np.abs(signals["plant.v"][signals["time"] < 2.0]).max() < 1e-3
    assert signals["plant.v"][-1] > 1.0


def test_a_missing_recording_is_named(capsys):
    assert main(["replay", "nowhere.csv"]) != 0
    assert "nowhere.csv" in capsys.readouterr().err


def test_without_the_counting_package_the_extra_is_named_before_the_run(short_drive, monkeypatch):
    monkeypatch.setitem(sys.modules, "rainflow", None)
    recording = read_recording(short_drive)
    load = RoadLoad(i=9.0, r=0.29, m=1450.0, g=9.81, c_rr=0.012, c_wa=0.42)
    with pytest.raises(MissingExtra, match="extra `replay`"):
        replay(road(recording, load), recording, "ValidationVehicle")
