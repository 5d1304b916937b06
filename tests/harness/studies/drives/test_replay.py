"""Recorded drives through the simulated vehicle."""

import csv
import json
import sys
from dataclasses import replace
from functools import cache
from itertools import islice, product
from shutil import copyfile

import numpy as np
import pytest
from fmutesting.foreign import tampered
from fmutesting.slow import slow

import driveline
from driveline.harness.commands.cli import main
from driveline.harness.loop.places import STEP_SIZE, T_S
from driveline.harness.loop.resolved import as_given, resolve
from driveline.harness.manoeuvres.catalogue import TOWN_DRIVE
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.road_load import RoadLoad, Track
from driveline.harness.manoeuvres.signals import NOTHING, Lines
from driveline.harness.manoeuvres.speed_following import drive, needed_force
from driveline.harness.metrics.spectrum import band_rms
from driveline.harness.simulation.simulate import _offered, simulate
from driveline.harness.studies.drives import recorded_drive
from driveline.harness.studies.drives.replay import CLOSE, followed, replay, signals_of, speed_error, write
from driverecords.drive import read_drive
from fmuloop.errors import WiringError
from fmuloop.system import Connection
from tests import ROOT
from toolground.errors import MissingExtra, UserError

DATA = ROOT.parent / "shared" / "data"
TRIPS = {"bmw_i3_trip_a01": (165.0, 260.0), "bmw_i3_trip_a11": (1005.0, 1060.0)}
"""Recorded drives, and stretches of them in s with stops and hills."""

PLANTS = ("TwoMassDriveline", "ValidationVehicle")


@pytest.fixture(scope="module")
def short_drive(tmp_path_factory):
    """The first eight seconds of the bundled drive."""
    path = tmp_path_factory.mktemp("recording") / "short.csv"
    with TOWN_DRIVE.open(encoding="utf-8") as file:
        path.write_text("".join(islice(file, 82)), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def settings(native):
    return as_given("ValidationVehicle", folder=native.parent, build="native")


@pytest.fixture(scope="module")
def load(settings):
    return RoadLoad.of(settings)


@pytest.fixture(scope="module")
def replayed(settings, load, short_drive, tmp_path_factory):
    """Rides of the short drive, two with the same controller, and the folder with their files."""
    folder = tmp_path_factory.mktemp("replay")
    track = Track.of(read_drive(short_drive))
    controllers = {"DampingController": settings, "Again": settings}
    rides = replay(track, load, controllers, held=0.5)
    write(rides, track, "ValidationVehicle", folder)
    return rides, folder


def test_a_program_gets_the_same_rides(replayed, short_drive, settings):
    rides = driveline.replay(
        driveline.read_drive(short_drive), held=0.5, folder=settings.settings.folder, build="native"
    )
    assert [ride.controller for ride in rides] == ["without damping", "DampingController"]
    for ride, expected in zip(rides, replayed[0], strict=False):
        assert np.array_equal(ride.signals, expected.signals)
    metrics = driveline.frame({ride.controller: ride.metrics for ride in rides})
    assert metrics.gear_torque_rms.DampingController < metrics.gear_torque_rms["without damping"]


@pytest.mark.parametrize(("bits", "interval"), [(4, 0.01), (8, 0.1), (16, 0.1)])
def test_what_a_bus_tells_reaches_a_controller_that_has_an_input_for_it(
    bits, interval, short_drive, settings, load, tmp_path
):
    """Held from row to row, and the counter goes on, also where it runs over; not where a block of the loop tells
    it."""
    t, *signals = np.loadtxt(short_drive, delimiter=",", skiprows=1).T
    rows, first = np.round(np.arange(0.0, t[-1], interval), 9), 2**bits - 6
    counter = (first + np.round(rows / 0.002)) % 2**bits
    told = [rows, *(np.interp(rows, t, x) for x in signals), counter, (rows >= 1.0) & (rows < 2.0)]
    header, path = short_drive.read_text(encoding="utf-8").splitlines()[0], tmp_path / "told.csv"
    np.savetxt(path, np.column_stack(told), delimiter=",", header=f"{header},alive,slip_control", comments="")
    track = Track.of(read_drive(path))
    manoeuvre = replace(drive(track, load, needed_force(track, load)), duration=3.0)
    results = simulate(manoeuvre, settings)
    active, t = results["controller.slip_control"], results["time"]
    assert (t[active.argmax()], np.count_nonzero(active) * STEP_SIZE) == pytest.approx((1.0, 1.0))
    assert results["controller.alive"].tolist() == [first + k // 2 for k in range(len(t))]
    assert results["controller.status"].max() < 4
    fitted, target = as_given(settings).fit, "controller.slip_control"
    assert set(_offered(manoeuvre, fitted)) == {"controller.alive", target}
    system = replace(fitted.system, connections=(*fitted.system.connections, Connection("can.valid", target)))
    assert set(_offered(manoeuvre, fitted._replace(system=system))) == {"controller.alive"}
    assert _offered(replace(manoeuvre, offered={"other": NOTHING}), fitted) == {}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"controllers": []}, "there is no controller to drive with"),
        ({"controllers": ["A.fmu", "b/A.fmu"]}, "two controllers are called A"),
        ({"held": 0.0}, "a demand that is held for 0 s"),
        ({"controller": "SpeedWashout"}, "replay takes controllers"),
    ],
)
def test_what_a_program_cannot_replay_is_refused(short_drive, given, message):
    with pytest.raises((driveline.DrivelineError, TypeError), match=message):
        driveline.replay(driveline.read_drive(short_drive), **given)


def test_a_controller_that_is_not_built_is_named_before_the_rides(short_drive, settings):
    given = {
        "controllers": ["DampingController", "SpeedWashout"],
        "folder": settings.settings.folder,
        "build": "native",
    }
    missing = r"there is no FMU .*SpeedWashout\.fmu; `driveline build SpeedWashout --build native --output "
    with pytest.raises(driveline.DrivelineError, match=missing) as refused:
        driveline.replay(driveline.read_drive(short_drive), **given)
    assert refused.value.__cause__ is None


def test_a_mapping_is_for_the_controllers_that_have_its_names(short_drive, settings, tmp_path, monkeypatch):
    ours = settings.settings.folder / "native" / "DampingController.fmu"
    theirs = tampered(ours, tmp_path / "Mine.fmu", lambda xml: xml.replace('"T_ref"', '"out"'))
    given = {"controllers": ["DampingController", theirs], "folder": settings.settings.folder, "build": "native"}
    found = {}
    monkeypatch.setattr(recorded_drive, "rides", lambda track, load, loops, held: found.update(loops))
    monkeypatch.setattr(recorded_drive, "followed_speed", lambda drive, rides: [])
    recording = driveline.read_drive(short_drive)
    driveline.replay(recording, mapping={"controller.T_ref": "out"}, **given)
    assert [loop.settings.mapping for loop in found.values()] == [{}, {"controller.T_ref": "out"}]
    with pytest.raises(driveline.DrivelineError, match=r"in Mine\.fmu nowhere does not exist"):
        driveline.replay(recording, mapping={"controller.T_ref": "nowhere"}, **given)


def town():
    return Track.of(read_drive(TOWN_DRIVE), T_max=180.0)


def hilly():
    """The town drive by another car on another road: its torques and climbs do not fit its speeds."""
    flat = town()
    return replace(flat, T_driver=0.8 * flat.T_driver - 4.0 * (flat.v > 1.0), slope=0.06 * np.cos(flat.t / 9.0))


def stretch(name):
    """Part of a real drive."""
    path = DATA / f"{name}.csv"
    if not path.exists():
        pytest.skip(f"recorded drive {path} is not on this machine")
    recording, (begin, end) = read_drive(path), TRIPS[name]
    part = (recording.time - recording.time[0] >= begin) & (recording.time - recording.time[0] <= end)
    names = ("time", "v", "elevation", "T_mot")
    return Track.of(replace(recording, **{name: getattr(recording, name)[part] for name in names}), T_max=180.0)


DRIVES = {"town": town, "hilly": hilly, **{name: lambda name=name: stretch(name) for name in TRIPS}}


@pytest.fixture(scope="module")
def runs(settings, load):
    """Of a drive by name on a plant: its track, and the signals without and with damping."""

    @cache
    def run(name, plant):
        track = DRIVES[name]()
        made = settings.replace(plant=plant)
        manoeuvre, undamped = followed(track, load, made)
        return track, undamped, signals_of(manoeuvre, made)

    return run


def rolled_back(signals):
    """Farthest in m that a car was behind where it had been."""
    x = np.cumsum(signals["plant.v"]) * T_S
    return (np.maximum.accumulate(x) - x).max()


def standing(track, signals):
    """When the recorded car has stood for a second, and will for another half."""
    at = np.interp(signals["time"], track.t, track.v == 0.0) == 1.0
    steps = round(1.0 / T_S), round(0.5 / T_S)
    counted = np.concatenate(([0], np.cumsum(~at)))
    k = np.arange(len(at))
    begin, end = np.maximum(k - steps[0], 0), np.minimum(k + steps[1], len(at))
    return counted[end] == counted[begin]


QUICK = ("town", "ValidationVehicle"), ("hilly", "TwoMassDriveline"), ("bmw_i3_trip_a11", "ValidationVehicle")


@pytest.mark.parametrize(("name", "plant"), slow(product(DRIVES, PLANTS), but=QUICK))
def test_the_car_keeps_the_recorded_speed_stands_where_it_stood_and_never_rolls_back(runs, name, plant):
    track, *both = runs(name, plant)
    for signals in both:
        assert speed_error(signals, track) < 1.5 * CLOSE
        assert rolled_back(signals) < 0.05  # tyres and mounts give way as far as that
        still = standing(track, signals)
        assert np.count_nonzero(still) * T_S > 1.0
        assert np.abs(signals["plant.v"][still]).max() < 0.05


def test_from_the_recording_alone_a_car_of_other_inertia_does_not_keep_the_speed(runs, settings, load):
    """Why the force along the road is found by driving."""
    track = runs("town", "TwoMassDriveline")[0]
    signals = signals_of(
        drive(track, load, needed_force(track, load)), settings.replace(plant="TwoMassDriveline", control=False)
    )
    assert speed_error(signals, track) > 5.0 * CLOSE


@pytest.mark.parametrize("plant", PLANTS)
@pytest.mark.parametrize(("begin", "end"), [(3.0, 18.0), (34.0, 50.0)])
def test_what_damping_is_worth_is_the_same_as_on_a_level_road_without_it(settings, load, plant, begin, end):
    whole = town()
    part = (whole.t >= begin) & (whole.t <= end)
    t = whole.t[part] - whole.t[part][0]
    track = replace(whole, t=t, v=whole.v[part], T_driver=whole.T_driver[part], slope=whole.slope[part])
    level = Manoeuvre("level", "", float(t[-1]), float(track.v[0]), Lines(t, track.T_driver))
    made = settings.replace(plant=plant)
    manoeuvre, undamped = followed(track, load, made)
    pairs = (
        (undamped, signals_of(manoeuvre, made)),
        tuple(signals_of(level, made.replace(control=control)) for control in (False, True)),
    )
    for signal, derivative in (("plant.T_gear", False), ("plant.a_body", True)):
        with_it, without_it = (
            band_rms(on[signal], T_S, derivative=derivative) / band_rms(off[signal], T_S, derivative=derivative)
            for off, on in pairs
        )
        assert with_it == pytest.approx(without_it, rel=0.08, abs=0.012), "of the swing without control"


def test_all_drive_on_the_same_road_and_damping_lowers_oscillation_and_damage(replayed):
    undamped, *damped = replayed[0]
    for ride in damped:
        for signal in ("time", "plant.T_brake", "plant.slope", "controller.T_driver"):
            np.testing.assert_array_equal(ride.signals[signal], undamped.signals[signal])
    with (replayed[1] / "short_metrics.csv").open(newline="", encoding="utf-8") as file:
        off, on, again = csv.DictReader(file)
    assert (off["recording"], off["control"], off["controller"]) == ("short", "0", "without damping")
    assert [(run["control"], run["controller"]) for run in (on, again)] == [("1", "DampingController"), ("1", "Again")]
    for quantity in ("gear_torque_rms_N_m", "gear_damage_N5_m5", "jerk_rms_m_per_s3"):
        assert float(on[quantity]) < 0.9 * float(off[quantity])
        assert on[quantity] == again[quantity]


def test_a_demand_is_not_held_for_less_than_a_step(load, short_drive):
    track = Track.of(read_drive(short_drive))
    F = needed_force(track, load)
    assert drive(track, load, F, held=STEP_SIZE).duration == drive(track, load, F).duration
    for held in (0.999 * STEP_SIZE, 1e-300, float("nan")):
        with pytest.raises(WiringError, match=r"it must be 0\.001 s or more"):
            drive(track, load, F, held)


def test_a_drive_is_as_long_as_a_swing_is_looked_for_in(settings, load):
    def driven(duration):
        t = np.array([0.0, duration])
        track = Track("short", duration, t, *np.broadcast_to([[10.0], [20.0], [0.0]], (3, 2)))
        return replay(track, load, {"DampingController": settings})

    with pytest.raises(UserError, match=r"short: the recording lasts 0\.199 s; at least 0\.2 s are needed"):
        driven(0.199)
    assert len(driven(0.2)) == 2


def test_figure_and_signals_every_10_ms_are_written(replayed):
    folder = replayed[1]
    assert {path.name for path in folder.iterdir()} == {
        "short_metrics.csv", "short_table.md", "short_off.csv", "short_DampingController.csv", "short_Again.csv",
        "short.png",
    }  # fmt: skip
    table = (folder / "short_table.md").read_text(encoding="utf-8").splitlines()
    assert [row.split(" | ")[0] for row in table] == [
        "| short on ValidationVehicle", "| ---", "| without damping", "| DampingController", "| Again"
    ]  # fmt: skip
    assert all(row.count("(1.000)") == (k == 2) * (row.count("|") - 2) for k, row in enumerate(table))
    with (folder / "short_Again.csv").open(encoding="utf-8") as file:
        times = [float(row["time"]) for row in csv.DictReader(file)]
    assert times == pytest.approx(np.arange(801) * 0.01)


@pytest.mark.slow
def test_as_a_document_it_has_the_rides_of_all_controllers(native, short_drive, tmp_path, capsys):
    mine = tmp_path / "Mine.fmu"
    copyfile(native / "DampingController.fmu", mine)
    given = ["--fmus", str(native.parent), "--output", str(tmp_path), "--set", "plant.m=1900"]
    both = ["--controller", "DampingController", "--controller", str(mine), "--controller", "DampingController"]
    assert main(["replay", str(short_drive), *given, *both, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    controllers = [run["controller"] for run in document["runs"]]
    assert controllers == ["without damping", "DampingController", "Mine"]
    assert [run["control"] for run in document["runs"]] == [False, True, True]
    assert all(run["gear_torque_rms_N_m"] > 0.0 for run in document["runs"])
    assert document["runs"][1]["jerk_rms_m_per_s3"] == document["runs"][2]["jerk_rms_m_per_s3"]
    assert {str(tmp_path / "short_metrics.csv"), str(tmp_path / "short_Mine.csv")} <= set(document["files"])
    assert main(["replay", str(short_drive), *given, "--quiet"]) == 2
    assert "is of another run (controllers: ['DampingController', 'Mine'] there" in capsys.readouterr().err


def test_without_the_counting_package_the_extra_is_named_before_the_run(short_drive, monkeypatch):
    monkeypatch.setitem(sys.modules, "rainflow", None)
    load = RoadLoad(i=9.0, r=0.29, m=1450.0, g=9.81, c_rr=0.012, c_wa=0.42)
    with pytest.raises(MissingExtra, match="extra `replay`"):
        replay(Track.of(read_drive(short_drive)), load, {"DampingController": resolve()})
