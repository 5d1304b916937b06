"""Recorded drives: what is read, what is refused and where, and the road made of them."""

import math
import os
import re
import shlex
from dataclasses import replace

import numpy as np
import pytest

from driveline.harness.loop.resolved import as_given
from driveline.harness.manoeuvres.road_load import RoadLoad, Track
from driveline.harness.manoeuvres.speed_following import drive, needed_force
from driverecords.drive import read_drive
from driverecords.source import RecordingError
from tests import ROOT

HEADER = "Time [s],Velocity [km/h],Elevation [m],Throttle [%],Motor Torque [Nm]"
LOAD = RoadLoad(i=9.0, r=0.29, m=1450.0, g=9.81, c_rr=0.012, c_wa=0.42)
TRIP = ROOT.parent / "shared" / "data" / "bmw_i3_trip_a01.csv"


@pytest.fixture
def write(tmp_path):
    def write(*lines, header=HEADER):
        path = tmp_path / "trip.csv"
        path.write_text("\n".join((header, *lines)) + "\n", encoding="utf-8")
        return path

    return write


def manoeuvre_of(track):
    return drive(track, LOAD, needed_force(track, LOAD))


def rows(count):
    return [f"{0.1 * k:.1f},36,{500 + k},3,{k}" for k in range(count)]


def test_columns_are_found_by_name_and_turned_into_si_units(write):
    path = write("0,10,1,x,0.02", "200,11,2,x,0.03", header="t [ms],SPEED [m/s],Altitude [km],Note, Torque [kNm]")
    recording = read_drive(path)
    assert recording.time.tolist() == [0.0, 0.2]
    assert recording.v.tolist() == [10.0, 11.0]
    assert recording.elevation is not None
    assert recording.elevation.tolist() == [1000.0, 2000.0]
    assert recording.T_mot.tolist() == [20.0, 30.0]


def test_it_is_known_how_the_file_writes_speed_and_torque(write):
    path = write("0,36,1", "1,36,2", header="Time [s],Velocity [km/h],M [kNm]")
    file_units = read_drive(path, {"T_mot": "-M"}).file_units
    assert {name: str(each) for name, each in file_units.items()} == {"v": "in km/h", "T_mot": "in kNm"}
    assert file_units["v"].factor == pytest.approx(1.0 / 3.6)
    assert file_units["T_mot"].factor == 1e3, "a sign that was turned is no unit"


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("Time [s],Velocty [km/h],Elevation [m],Motor Torque [Nm]", r"no column Velocity.*did you mean Velocty"),
        (
            "Time [s],x [km/h],Elevation [m],Torque [Nm]",
            r"no column Velocity.*the file has: Time, x, Elevation, Torque",
        ),
        (
            "Time [s],Velocity [km],Elevation [m],Motor Torque [Nm]",
            r"Velocity \[km\] is in km, .* as in the heading Velocity \[km/h\]",
        ),
        (
            "Time [s],Velocity,Elevation [m],Motor Torque [Nm]",
            r"Velocity has no unit; write one into the heading, as in [^(]*, or .* with --column v='Velocity \[km/h\]'",
        ),
        (
            "Time,Velocity [km/h],Elevation [m],Motor Torque [Nm]",
            r"Time has no unit; .* \(a time of day needs none, such as .*\), or give it with --column time='Time",
        ),
        ("Time [s],Speed [m/s],x,Speed [m/s],Torque [Nm]", r"2 columns are called Speed \[m/s\]; rename all but one"),
    ],
)
def test_a_header_that_does_not_fit_is_explained(write, header, message):
    with pytest.raises(RecordingError, match=message):
        read_drive(write("0,1,2,3", header=header))


def test_of_two_columns_that_one_is_taken_that_is_said_to_be_meant(write):
    path = write("0,1,2,3,4", "1,1,2,3,4", header="Time [s],Velocity [m/s],Speed [m/s],Torque [Nm],Height [m]")
    with pytest.raises(RecordingError, match=r"Velocity \[m/s\] and Speed \[m/s\] could each be v") as refusal:
        read_drive(path)
    *_, advice = shlex.split(str(refusal.value))
    quantity, _, heading = advice.partition("=")
    assert read_drive(path, {quantity: heading}).v.tolist() == [1.0, 1.0]


def test_what_a_refused_cell_holds_is_shown_in_one_short_line(write):
    path = write("0,36,500,3,1", '0.1,"\x1b[31m' + 500 * "\n7" + '",501,3,1')
    with pytest.raises(RecordingError, match="Velocity") as refusal:
        read_drive(path)
    assert str(refusal.value).isprintable()
    assert len(str(refusal.value)) < 200 + len(str(path))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty"),
        (b"\xff\xfe", "is empty"),
        (b"\xff\xfex", "no column"),
        (b'Time [s],"' + 200_000 * b"x", "is no CSV file"),
        (b"Time [s]\xff,\n", "no column Time"),
        (b"0.0,36,500,1\n0.1,36,500,1\n", "line 1: there is no line of names"),
    ],
)
def test_what_is_no_text_or_no_csv_is_refused(tmp_path, content, message):
    path = tmp_path / "trip.csv"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=message):
        read_drive(path)


def test_without_elevation_the_road_is_level(write):
    drive = read_drive(write("0,36,1", "1,36,2", header="Time [s],Velocity [km/h],Motor Torque [Nm]"))
    assert drive.elevation is None
    assert Track.of(drive).slope.tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("0.1,721,501,3,1", r"line 3: Velocity \[km/h\] is 200\.278 m/s; at most 200 m/s"),
        ("0.1,36,-10001,3,1", r"line 3: Elevation \[m\] is -10001 m; at most 10000 m"),
        ("0.1,36,501,3,10001", r"line 3: Motor Torque \[Nm\] is 10001 N\.m; at most 10000 N\.m"),
    ],
)
def test_what_no_car_can_have_recorded_is_refused_with_its_line(write, line, message):
    with pytest.raises(RecordingError, match=message):
        read_drive(write(*rows(1), line))


def test_the_largest_values_that_can_be_are_taken(write):
    recording = read_drive(write(*rows(1), "0.1,720,10000,3,-10000"))
    assert recording.elevation is not None
    assert (recording.v[-1], recording.elevation[-1], recording.T_mot[-1]) == (200.0, 1e4, -1e4)


@pytest.mark.parametrize(("interval", "shown"), [("1e300", "1e+300"), ("1e-320", "9.99989e-321"), ("9e-7", "9e-07")])
def test_a_sample_interval_that_no_recording_has_is_refused(write, interval, shown):
    lines = (f"{k * float(interval)!r},10,10" for k in range(40))
    path = write(*lines, header="time [s],v [m/s],T_mot [N.m]")
    with pytest.raises(
        RecordingError, match=rf"sample interval is {re.escape(shown)} s; 1e-06 to 1e\+06 s are allowed"
    ):
        read_drive(path)


def test_blank_lines_do_not_shift_the_line_numbers(write):
    with pytest.raises(RecordingError, match="line 6"):
        read_drive(write(*rows(2), "", "", "0.05,36,500,3,1"))


@pytest.mark.parametrize("lines", [[], rows(1)])
def test_a_file_without_a_drive_is_refused(write, lines):
    with pytest.raises(RecordingError, match="needs at least two"):
        read_drive(write(*lines))


def test_the_demand_is_the_recorded_torque_within_the_limits_of_the_motor(write):
    lines = [f"{k},36,500,0,{T}" for k, T in ((5, 10), (6, 20), (7, 300))]
    manoeuvre = manoeuvre_of(Track.of(read_drive(write(*lines)), T_max=180.0))
    assert manoeuvre.T_driver([0.0, 0.5, 1.0, 2.0]) == pytest.approx([10, 15, 20, 180])
    assert manoeuvre.v_0 == pytest.approx(10.0)
    assert manoeuvre.duration == pytest.approx(2.0)


def test_a_steady_climb_has_its_slope(write):
    lines = [f"{k / 10},72,{500 + 0.04 * 2.0 * k},0,0" for k in range(1200)]
    assert Track.of(read_drive(write(*lines))).slope[600] == pytest.approx(0.04, rel=1e-3)


def test_the_brakes_know_the_vehicle_as_the_run_sets_it(built):
    vehicle = as_given("ValidationVehicle", folder=built, build="python")
    given = vehicle.with_parameters({"plant.m": 1900.0, "can.r": 0.4})
    assert RoadLoad.of(given) == replace(RoadLoad.of(vehicle), m=1900.0)


def test_the_limit_is_that_of_the_motor_as_the_run_sets_it(built):
    loop = as_given(folder=built, build="python")
    assert loop.T_max == 180.0
    assert loop.with_parameters({"motor.T_max": 250.0, "controller.T_max": 90.0}).T_max == 250.0
    assert loop.value("can.T_max", math.inf) == math.inf


def test_what_is_mapped_is_in_the_units_of_the_loop(built):
    # as if somebody else had given the mass in tonnes
    theirs, ours = (as_given("ValidationVehicle", folder=built, build="python") for _ in range(2))
    theirs.fit.interfaces["plant"].factors["m"] = 1000.0
    assert RoadLoad.of(theirs).m == 1000.0 * RoadLoad.of(ours).m


@pytest.mark.skipif(not TRIP.exists(), reason=f"recorded drive {TRIP} is not on this machine")
def test_a_real_drive_gives_a_drivable_road():
    manoeuvre = manoeuvre_of(Track.of(read_drive(TRIP), T_max=180.0))
    t = np.arange(0.0, manoeuvre.duration, 0.05)
    assert manoeuvre.duration == pytest.approx(1008.9)
    assert manoeuvre.v_0 == 0.0
    assert 0.005 < np.abs(manoeuvre.slope(t)).max() < 0.2
    assert 0.0 <= manoeuvre.T_brake(t).min() < manoeuvre.T_brake(t).max() <= 1160.0


def test_what_is_no_file_is_no_recording(tmp_path):
    pipe = tmp_path / "trip.csv"
    os.mkfifo(pipe)
    absent = tmp_path / "nothing.csv"
    for path, message in (
        (pipe, f"{pipe} is no file; a file is needed"),
        (tmp_path, f"{tmp_path} is a folder; a file is needed"),
        (absent, f"there is no recording {absent}"),
    ):
        with pytest.raises(RecordingError, match=re.escape(message)):
            read_drive(path)
