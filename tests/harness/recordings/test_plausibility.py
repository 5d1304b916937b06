"""What makes a recording implausible is found with column and time, and nothing is found in one that is true."""

import re
from collections.abc import Callable
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from driveline.harness.manoeuvres.road_load import RoadLoad
from driveline.harness.manoeuvres.town_drive import CAR, PATH
from driveline.harness.recordings import plausibility
from driveline.harness.recordings.channels import Channel
from driveline.harness.recordings.drive import Drive, read_drive
from driveline.harness.recordings.file_units import FileUnit
from driveline.harness.recordings.force_balance import EVERY, LARGEST, SMALLEST, Balance, Forces, balance, forces
from driveline.harness.recordings.missing_values import ENDS, NINES, is_code
from driveline.harness.recordings.plausibility import (
    ACCELERATION,
    BEYOND,
    CLIMB,
    FOLLOWED,
    MOST_MARKED,
    MS,
    OSCILLATION,
    RULES,
    SHORTEST,
    SLOWEST,
    SPIKE,
    STEP,
    Finding,
    codes,
    jumps,
    not_followed,
    of_channels,
    of_drive,
    spikes,
)
from driveline.harness.recordings.source import RecordingError
from tests import ROOT

T_MAX = 180.0
TRIPS = ROOT.parent / "shared" / "data"
T, V, H = "Motor Torque [Nm]", "Velocity [km/h]", "Elevation [m]"

Table = pd.DataFrame
Spoil = Callable[[Table], Table]


def scaled(column: str, factor: float) -> Spoil:
    return lambda table: table.assign(**{column: factor * table[column]})


def at(column: str, value: float, *rows: int) -> Spoil:
    return lambda table: table.assign(**{column: table[column].mask(table.index.isin(rows), value)})


SPOILED: dict[str, tuple[Spoil, str, str]] = {
    "sign": (scaled(T, -1.0), "sign of torque", r"^Motor Torque \[Nm\] at 34\.4 s pushes when the car slows down"),
    "wheel side": (
        scaled(T, 9.0),
        "ratio of torque",
        r"^Motor Torque \[Nm\] at \S+ s gives 9\.1 times what the motion",
    ),
    "kN.m": (scaled(T, 1e-3), "ratio of torque", r"kN\.m called N\.m \(--column T_mot='Motor Torque \[kNm\]'"),
    "five seconds late": (
        lambda table: table.assign(**{T: table[T].shift(50, fill_value=0.0)}),
        "other torque",
        r"^Motor Torque \[Nm\] at \S+ s has nothing to do with what drives the car \(correlation -?0\.[0-2]\d\): it",
    ),
    "no torque": (
        scaled(T, 0.0),
        "other torque",
        r"^Motor Torque \[Nm\] at \S+ s has nothing to do .*correlation 0\.00",
    ),
    "T_max": (scaled(T, 1.6), "T_max", r"^Motor Torque \[Nm\] at 33\.2 s is 200 N\.m; \S+% of the samples lie beyond"),
    "1 Hz": (
        lambda table: table.iloc[::10],
        "rate",
        r"^Motor Torque \[Nm\] at 0 s has a sample every 1 s: .* 4\.0% of",
    ),
    "code": (at(T, -999.0, 100, 200), "code", r"^line 102: Motor Torque \[Nm\] at 10 s is -999, .* \(2 samples\)$"),
    "code of height": (at(H, -999.0, 300), "code", r"^line 302: Elevation \[m\] at 30 s is -999, which loggers write"),
    "spike": (at(V, 80.0, 100), "spike", r"^line 102: Velocity \[km/h\] at 10 s is \+47\.4 km/h off its neighbours"),
    "jump": (
        lambda table: table.assign(**{H: table[H] + 80.0 * (table.index >= 300)}),
        "jump",
        r"^line 302: Elevation \[m\] at 30 s jumps by \+80 m within 0\.1 s",
    ),
    "km/h called m/s": (
        lambda table: table.rename(columns={V: "Velocity [m/s]"}),
        "unit of speed",
        r"^Velocity \[m/s\] at \S+ s changes as if .* 3\.4 times .* \(--column v='Velocity \[km/h\]'\)",
    ),
    "ms called s": (
        scaled("Time [s]", 1e3),
        "unit of time",
        r"^Time \[s\] at 0 s goes on by 100 s a sample, .* --column time='Time \[ms\]'",
    ),
}
"""What is done to the drive in town, the rule that finds it, and what is said."""


def found(path: Path, **columns: str) -> list[Finding]:
    return of_drive(read_drive(path, columns), CAR, T_MAX)


@pytest.mark.parametrize("case", SPOILED)
def test_what_is_wrong_with_a_drive_is_named_with_column_and_time(tmp_path: Path, case: str) -> None:
    spoil, rule, message = SPOILED[case]
    path = tmp_path / "drive.csv"
    spoil(pd.read_csv(PATH)).to_csv(path, index=False)
    (finding,) = (each for each in found(path) if each.rule.name == rule)
    assert re.search(message, str(finding))
    assert str(finding).isprintable()
    assert finding.document() == {
        "rule": rule, "column": finding.column, "time_s": finding.time, "text": str(finding)
    }  # fmt: skip
    others = {each.rule.name for each in found(path)} - {rule}
    assert others <= {"wheel side": {"T_max"}, "code of height": {"jump"}}.get(case, set())


def test_what_is_said_to_mend_it_mends_it(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    for case, given in (
        ("sign", {"T_mot": f"-{T}"}),
        ("kN.m", {"T_mot": "Motor Torque [kNm]"}),
        ("km/h called m/s", {"v": "Velocity [km/h]"}),
        ("ms called s", {"time": "Time [ms]"}),
    ):
        SPOILED[case][0](pd.read_csv(PATH)).to_csv(path, index=False)
        assert found(path, **given) == []


@pytest.mark.parametrize(("longer", "tried"), [(1.001, True), (0.999, False)])
def test_ms_are_not_tried_where_no_recording_is_that_fast(
    monkeypatch: pytest.MonkeyPatch, longer: float, tried: bool
) -> None:
    durations: list[float] = []

    def noted(time: np.ndarray, *others: Any) -> Forces:
        durations.append(float(time[-1]))
        return forces(time, *others)

    monkeypatch.setattr(plausibility, "forces", noted)
    monkeypatch.setattr(plausibility, "balance", lambda *_: Balance(0.0, judged=True, together=0.0))
    time = longer * SHORTEST / MS * np.arange(20.0)
    assert not list(plausibility.unbalanced(Drive("drive", time, time, None, time, {}), CAR))
    assert (pytest.approx(MS * time[-1]) in durations) == tried


@pytest.mark.parametrize("path", [PATH, *(TRIPS / f"bmw_i3_trip_{trip}.csv" for trip in ("a01", "a11"))])
def test_nothing_is_odd_in_drives_that_were_driven(path: Path) -> None:
    if not path.exists():
        pytest.skip(f"recorded drive {path} is not on this machine")
    drive = read_drive(path)
    assert of_drive(drive, CAR, T_MAX) == []
    turned = replace(drive, T_mot=-drive.T_mot)
    assert [finding.rule.name for finding in of_drive(turned, CAR, T_MAX)] == ["sign of torque"]


def channel(
    quantity: str, values: np.ndarray, interval: float = 0.1, unit: str = "N.m", factor: float = 1.0
) -> Channel:
    time = interval * np.arange(len(values))
    return Channel(quantity, quantity, unit, time, values, "sample {}".format, FileUnit("its own", factor))


def test_codes_are_those_of_loggers() -> None:
    assert all(map(is_code, (-999.0, 999.0, 9999.9, -99999.0, 255.0, 65535.0, -32768.0, 4294967295.0)))
    assert not any(map(is_code, (0.0, 100.0, 998.0, -998.9, 99.0, 256.0, 65534.0)))


@pytest.mark.parametrize("code", sorted(NINES | ENDS))
def test_a_code_is_found_in_the_units_of_the_file_and_only_far_from_all_other_values(code: float) -> None:
    range_ = 0.1 * abs(code)
    for apart, expected in ((0.501, 1), (0.499, 0)):
        others = np.linspace(0.0, range_, 50) + code - np.sign(code) * apart * range_ - (code > 0.0) * range_
        values = 1e3 * np.append(others, [code, code])
        assert len(list(codes(channel("T_mot", values, factor=1e3)))) == expected
        assert len(list(codes(channel("T_mot", values)))) == 0, "in N.m it is no code"


@pytest.mark.parametrize("width", [1, 2, 3])
@pytest.mark.parametrize("interval", [0.01, 0.1])
def test_a_spike_is_what_no_tyre_can_do(width: int, interval: float) -> None:
    least = max(SPIKE, ACCELERATION * interval * width)
    for factor, expected in ((0.99, 0), (1.01, 1)):
        v = np.full(60, 10.0)
        v[30 : 30 + width] += factor * least
        findings = list(spikes(channel("v", v, interval, "m/s")))
        assert len(findings) == expected
        assert [finding.time for finding in findings] == pytest.approx([30 * interval] * expected)


def test_a_car_that_brakes_and_pulls_away_has_no_spike() -> None:
    time = np.arange(0.0, 20.0, 0.1)
    for acceleration in (3.0, 12.0):
        v = np.abs(np.interp(time % 8.0, [0.0, 4.0, 8.0], [0.0, 4.0 * acceleration, 0.0]))
        assert list(spikes(channel("v", v, unit="m/s"))) == []
    assert list(spikes(channel("omega_wheel", 50.0 * (time == 10.0), unit="rad/s"))) == [], "no speed over ground"


@pytest.mark.parametrize("interval", [0.1, 1.0])
def test_an_elevation_jumps_where_no_road_climbs_so(interval: float) -> None:
    for factor, expected in ((0.999, 0), (1.001, 1)):
        h = np.where(np.arange(40) < 20, 500.0, 500.0 - factor * (STEP + CLIMB * interval))
        findings = list(jumps(channel("elevation", h, interval, "m")))
        assert [finding.time for finding in findings] == pytest.approx([20 * interval] * expected)


def drive(interval: float = 0.1, mass: float = 1.0, T_peak: float = 100.0) -> Drive:
    """A level road without brakes; the car has a share of the mass of CAR."""
    time = np.arange(0.0, 60.0, interval)
    T_mot = T_peak * (0.4 + 0.6 * np.sin(0.8 * time))
    v = np.empty_like(time)
    v[0] = 12.0
    for k in range(len(time) - 1):
        force = CAR.motor_force(T_mot[k]) / mass - CAR.m * CAR.g * CAR.c_rr - CAR.c_wa * v[k] ** 2
        v[k + 1] = v[k] + interval * force / CAR.inertia
    return Drive("drive", time, v, None, T_mot, {})


def test_the_rate_must_leave_something_of_a_step() -> None:
    for factor, expected in ((1.0, []), (1.01, ["rate"])):
        assert [finding.rule.name for finding in of_drive(drive(factor * SLOWEST), CAR, T_MAX)] == expected


def test_a_ramp_leaves_of_the_swing_after_a_step_what_the_rule_says() -> None:
    """The swing of an undamped oscillator after a ramp over that after a step is |sin(pi f h)|/(pi f h)."""
    t = np.linspace(0.0, 1.0, 200_001)
    worst = 0.0
    for h in np.linspace(0.8, 1.2, 21) * SLOWEST:
        rate = np.where(t < h, 1.0 / h, 0.0)
        wave = np.exp(-2j * pi * OSCILLATION * t)
        worst = max(worst, h * pi * OSCILLATION * abs(np.trapezoid(rate * wave, t)))
    assert worst == pytest.approx(1.0, abs=0.01)


def test_a_share_of_torques_beyond_the_motor() -> None:
    one = drive()
    torques = np.sort(np.abs(one.T_mot))
    for share, expected in ((0.99 * BEYOND, []), (1.5 * BEYOND, ["T_max"])):
        limit = float(torques[round((1.0 - share) * len(torques)) - 1])
        assert [finding.rule.name for finding in of_drive(one, CAR, limit)] == expected


def test_the_ratio_of_the_forces_and_its_bounds() -> None:
    assert balance(forces(drive().time, drive().v, drive().T_mot, CAR)).ratio == pytest.approx(1.0, abs=0.02)
    for ratio, expected in (
        (0.95 * LARGEST, []),
        (1.05 * LARGEST, ["unit of speed"]),
        (10.0 * LARGEST, ["ratio of torque"]),
        (100.0 * LARGEST, ["ratio of torque"]),
        (1.05 * SMALLEST, []),
        (0.95 * SMALLEST, ["ratio of torque"]),
    ):
        one = drive(T_peak=170.0)
        assert [f.rule.name for f in of_drive(replace(one, T_mot=one.T_mot / ratio), CAR, 1e4)] == expected, ratio


@pytest.mark.parametrize("interval", [0.49 * EVERY, 0.001])
def test_the_balance_of_a_fast_recording_is_that_of_its_means(interval: float) -> None:
    """Every so many samples alone would take what is faster for slow: here 50 Hz of 500 N.m."""
    slow, fast = drive(0.1), drive(interval)
    disturbed = replace(fast, T_mot=fast.T_mot + 500.0 * np.cos(2.0 * pi * fast.time / EVERY))
    along = forces(disturbed.time, disturbed.v, disturbed.T_mot, CAR)
    assert EVERY / 2.0 < np.diff(along.time).max() <= 1.001 * EVERY
    expected = balance(forces(slow.time, slow.v, slow.T_mot, CAR))
    found = balance(along)
    assert (found.ratio, found.together) == pytest.approx((expected.ratio, expected.together), abs=0.03)


def test_the_forces_of_a_drive_are_computed_once_and_once_more_for_another_unit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made: list[int] = []

    def noted(time: np.ndarray, *others: Any) -> Forces:
        made.append(len(time))
        return forces(time, *others)

    monkeypatch.setattr(plausibility, "forces", noted)
    for torque, v, count in ((1.0, 1.0, 1), (1e-3, 1.0, 1), (1.0, 3.6, 2)):
        made.clear()
        one = drive(T_peak=170.0)
        list(plausibility.unbalanced(replace(one, T_mot=torque * one.T_mot, v=v * one.v), CAR))
        assert len(made) == count


def test_a_car_that_stands_or_coasts_tells_nothing_of_the_torque() -> None:
    one = drive()
    noise = np.random.default_rng(1).normal(0.0, 1.0, len(one.time))
    for v, T_mot in ((0.0 * one.v, -one.T_mot), (np.linspace(20.0, 0.0, len(noise)), noise)):
        assert of_drive(replace(one, v=v, T_mot=T_mot), CAR, T_MAX) == []


def test_a_brake_is_no_wrong_sign() -> None:
    one = drive()
    braked = np.where((one.time > 30.0) & (one.time < 33.0), one.v - 3.0 * (one.time - 30.0), one.v)
    braked = np.where(one.time >= 33.0, one.v - 9.0, braked)
    assert of_drive(replace(one, v=np.maximum(braked, 0.0)), CAR, T_MAX) == []


def test_brakes_and_hills_are_no_other_torque() -> None:
    """All braking by friction, and a road that rises and falls by up to 10 %."""
    one = drive()
    hills = CAR.m * CAR.g * 0.1 * np.sin(2.0 * pi * one.time / 20.0) * CAR.r / CAR.i
    for T_mot in (np.maximum(one.T_mot, 0.0), one.T_mot + hills):
        assert of_drive(replace(one, T_mot=T_mot), CAR, 10.0 * T_MAX) == []


def test_a_speed_that_is_not_followed() -> None:
    one = replace(drive(), time=5.0 + drive().time)
    for error, expected in ((0.99 * FOLLOWED, []), (1.01 * FOLLOWED, ["following"])):
        v = one.v - error * np.sqrt(2.0) * np.sin(2.0 * pi * one.time / 6.0)
        findings = not_followed(one, one.time - one.time[0], v)
        assert [finding.rule.name for finding in findings] == expected
        assert all(
            "v at" in str(f) and f.time == pytest.approx(one.time[np.argmax(np.abs(v - one.v))]) for f in findings
        )


@pytest.mark.parametrize("count", [3, MOST_MARKED, MOST_MARKED + 1, 5000])
def test_all_samples_that_are_odd_are_marked_or_many_of_them(count: int) -> None:
    values = np.zeros(10_000)
    at = np.linspace(500, 9_500, count).astype(int)
    values[at] = -999.0
    (finding,) = codes(channel("T_mot", values))
    assert (finding.samples[0], finding.samples[-1]) == pytest.approx((50.0, 950.0))
    assert finding.samples[0] == finding.time
    assert len(set(finding.samples)) == min(count, MOST_MARKED)
    assert set(np.round(10.0 * np.array(finding.samples)).astype(int)) <= {*at}


def test_every_rule_is_found_by_something_and_has_a_name_of_its_own() -> None:
    names = [rule.name for rule in RULES]
    assert len(set(names)) == len(names)
    assert {rule for _, rule, _ in SPOILED.values()} | {"cut off", "following"} == set(names)
    declared = {id(each) for each in vars(plausibility).values() if isinstance(each, plausibility.Rule)}
    assert declared == {id(rule) for rule in RULES}


def test_a_speed_beyond_all_cars_is_refused_as_the_code_that_it_is(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    at(V, -999.0, 100)(pd.read_csv(PATH)).to_csv(path, index=False)
    with pytest.raises(
        RecordingError, match=r"line 102: Velocity \[km/h\] is -277\.5 m/s; .*, and -999 is what loggers"
    ):
        read_drive(path)


def test_the_mean_of_two_rates_is_judged_as_sampled() -> None:
    """A spike of a channel of its own rate would be a wave after the resampling."""
    v = np.full(30, 10.0)
    v[10] = 30.0
    (finding,) = of_channels([channel("v", v, 0.5, "m/s"), channel("T_mot", np.arange(300.0), 0.05)])
    assert (finding.rule.name, finding.time, finding.place) == ("spike", 5.0, "sample 10")


def test_another_car_is_judged_by_its_own_mass() -> None:
    lorry = RoadLoad(i=CAR.i, r=CAR.r, m=3.2 * CAR.m, g=CAR.g, c_rr=CAR.c_rr, c_wa=CAR.c_wa)
    heavy = drive(mass=3.2, T_peak=320.0)
    assert of_drive(heavy, lorry, 1e4) == []
    assert [finding.rule.name for finding in of_drive(heavy, CAR, 1e4)] == ["ratio of torque"]
