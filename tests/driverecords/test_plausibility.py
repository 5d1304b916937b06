"""What makes a recording implausible is found with column and time, and nothing is found in one that is true."""

import re
from collections.abc import Callable
from dataclasses import replace
from itertools import product
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fmutesting.together import together

from docs.studies.town_drive import CAR
from driveline.harness.manoeuvres.catalogue import TOWN_DRIVE
from driveline.harness.manoeuvres.road_load import RoadLoad
from driverecords import channel_rules, plausibility
from driverecords.channel_rules import (
    ACCELERATION,
    BRIEF,
    CLIMB,
    LARGE,
    LONE,
    NEIGHBOURS,
    SPIKE,
    STEP,
    jumps,
    lacking,
    of_channels,
    spikes,
    uncertain,
)
from driverecords.channels import Channel, MissingSamples
from driverecords.drive import Drive, read_drive
from driverecords.file_units import FileUnit
from driverecords.findings import MOST_MARKED, Finding, Rule
from driverecords.force_balance import EVERY, LARGEST, SMALLEST, Balance, Forces, balance, forces
from driverecords.missing_values import ENDS, NINES, RESERVED, SCALED, coded, is_code
from driverecords.plausibility import (
    BEYOND,
    FOLLOWED,
    MS,
    OSCILLATION,
    QUICKEST,
    RULES,
    SHORTEST,
    SLOWEST,
    UNABLE,
    not_followed,
    of_drive,
    too_short,
)
from driverecords.source import RecordingError
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
    "counter": (
        lambda table: table.assign(alive=50 * table.index % 16),
        "counter",
        r"^line 3: alive at 0\.1 s goes from 0 to 2 within 0\.1 s, .* up to 14 .* left out \(\d+ rows\)$",
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
    spoil(pd.read_csv(TOWN_DRIVE)).to_csv(path, index=False)
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
        SPOILED[case][0](pd.read_csv(TOWN_DRIVE)).to_csv(path, index=False)
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


@pytest.mark.parametrize("path", [TOWN_DRIVE, *(TRIPS / f"bmw_i3_trip_{trip}.csv" for trip in ("a01", "a11"))])
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


@together("code", sorted(NINES | ENDS))
def test_a_code_is_found_only_far_from_all_other_values(code: float) -> None:
    range_ = 0.1 * abs(code)
    for apart, expected in ((0.501, True), (0.499, False)):
        others = np.linspace(0.0, range_, 50) + code - np.sign(code) * apart * range_ - (code > 0.0) * range_
        written = np.append(others, [code, code])
        assert coded(written).tolist() == [False] * 50 + [expected] * 2
        assert not coded(1.37 * written).any(), "it is no code"


def test_a_car_whose_speed_changes_faster_than_tyres_can_is_one_of_another_unit_of_time(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    for lasts, found in ((0.99 * 10.0 / QUICKEST, ["time too short"]), (1.01 * 10.0 / QUICKEST, [])):
        path.write_text("t [s],v [m/s],T [Nm]\n" + "".join(f"{0.25 * k * lasts},{2.5 * k},1\n" for k in range(5)))
        assert [finding.rule.name for finding in too_short(read_drive(path))] == found


def test_reserved_are_the_last_two_integers_of_each_width_with_and_without_a_sign() -> None:
    assert {254.0, 255.0, 126.0, 127.0, -127.0, -128.0, 32766.0, -32767.0} <= RESERVED
    assert not {253.0, 256.0, 125.0, 128.0, -126.0, -129.0} & RESERVED


@pytest.mark.parametrize(("last", "found"), [(169.0, True), (170.0, False)])
def test_a_code_is_more_than_half_of_the_range_away(last: float, found: bool) -> None:
    """255 is 86 from 169, whose half is 84.5, and 85 from 170, whose half it is."""
    assert coded(np.append(np.arange(last + 1.0), 255.0)).any() == found


def test_the_resolution_is_that_of_the_column_however_few_its_values_are() -> None:
    assert coded(0.3 * np.append(np.arange(12.0), 254.0)).tolist() == [False] * 12 + [True]
    assert not coded(np.append(0.3 * np.arange(12.0), 0.29 * 254.0)).any(), "no multiple of .3"


def test_a_number_that_is_nearly_0_is_a_value_like_others() -> None:
    assert not coded(np.array([0.0, 1e-310, 1.0])).any()


@together("resolution, integer", product([1.0, 0.25, 0.1, 0.05, 0.001], sorted(RESERVED)))
def test_a_reserved_integer_times_the_resolution_is_a_code(resolution: float, integer: float) -> None:
    """Of 8 to 16, 20, 24, 32, 48 and 64 bits, far from all others."""
    code = resolution * integer
    for apart, expected in ((1.01 * SCALED, True), (0.99 * SCALED, False)):
        others = code - np.sign(code) * np.linspace(apart, 1.0 + apart, 50) * 0.17 * abs(code)
        written = np.append(others, code)
        assert coded(written)[-1] == expected or is_code(code)
        assert not coded(written)[:-1].any()
        few = np.append(others[[0, -1]], code)
        assert coded(few)[-1] == is_code(code), "a channel of few values is switched"


def test_codes_of_several_kinds_are_all_found() -> None:
    written = np.append(np.linspace(-50.0, 120.0, 100), [3276.7, 3276.6, -3276.8, -999.0])
    assert coded(written).sum() == 4


@together("width, interval", product([1, 2, 3], [0.01, 0.1]))
def test_a_spike_is_what_no_tyre_can_do(width: int, interval: float) -> None:
    least = max(SPIKE, ACCELERATION * interval * width)
    for factor, expected in ((0.99, 0), (1.01, 1)):
        v = np.full(60, 10.0)
        v[30 : 30 + width] += factor * least
        v[20:25] += 1.5 * least / LONE  # so that it is no lone one
        findings = list(spikes(channel("v", v, interval, "m/s")))
        assert len(findings) == expected
        assert [finding.time for finding in findings] == pytest.approx([30 * interval] * expected)


@together("quantity, width", product(["T_mot", "T_wheel", "omega_1", "omega_2"], [1, 2, 3]))
def test_a_lone_spike_of_any_channel_is_found(quantity: str, width: int) -> None:
    """By the range of its neighbours, and by that of the channel."""
    wave = 500.0 + 100.0 * np.sin(np.arange(2000) / 300.0)
    longest = BRIEF / width if width > 1 else 0.1
    k = int(np.argmax(wave))
    around = np.ptp(np.delete(wave[k - NEIGHBOURS : k + NEIGHBOURS + width], slice(NEIGHBOURS, NEIGHBOURS + width)))
    for size, interval, expected in (
        (1.05 * LARGE * 200.0, longest, 1),
        (0.95 * LARGE * 200.0, longest, 0),
        (60.0, longest, 1),
        (60.0, 1.01 * longest, int(width == 1)),
    ):
        x = wave.copy()
        x[k : k + width] -= max(size, MOTOR_STEP if quantity == "omega_2" else 0.0) if expected else size
        assert size > LONE * around
        assert len(list(spikes(channel(quantity, x, interval, "N.m")))) == expected, (size, interval)


def test_what_its_neighbours_do_too_is_no_spike() -> None:
    for factor, expected in ((0.95, 0), (1.05, 1)):
        x = np.linspace(0.0, 1.0, 400)
        x[100:140] += 10.0 * (np.arange(40) % 8 >= 4)
        x[200:400] = 0.0
        x[300] = factor * LONE
        x[290] = x[310] = 0.0
        x[292:296] = x[304:308] = 1.0
        assert len(list(spikes(channel("T_mot", x, 0.002)))) == expected


MOTOR_STEP = 1.1 * channel_rules.MOTOR


def test_a_car_that_brakes_and_pulls_away_has_no_spike() -> None:
    time = np.arange(0.0, 20.0, 0.1)
    for acceleration in (3.0, 12.0):
        v = np.abs(np.interp(time % 8.0, [0.0, 4.0, 8.0], [0.0, 4.0 * acceleration, 0.0]))
        assert list(spikes(channel("v", v, unit="m/s"))) == []


@pytest.mark.parametrize("late", [1, 2, 3])
def test_a_message_that_comes_late_is_no_spike(late: int) -> None:
    """Speed in steps of 4.3 rad/s, as the largest in 200 drives."""
    omega = np.full(3000, 130.0)
    omega[1000 : 1000 + late] -= 4.33
    assert list(spikes(channel("omega_2", omega, 0.002, "rad/s"))) == []


@pytest.mark.parametrize("interval", [0.1, 1.0])
def test_an_elevation_jumps_where_no_road_climbs_so(interval: float) -> None:
    for factor, expected in ((0.999, 0), (1.001, 1)):
        h = np.where(np.arange(40) < 20, 500.0, 500.0 - factor * (STEP + CLIMB * interval))
        findings = list(jumps(channel("elevation", h, interval, "m")))
        assert [finding.time for finding in findings] == pytest.approx([20 * interval] * expected)


@pytest.mark.parametrize(
    ("steps", "interval", "expected"),
    [(7, 0.0159, []), (7, 0.0161, [1]), (0, 0.1, []), (9, 0.01, [1])],
    ids=["below half", "half of the period", "at rest", "goes back"],
)
def test_a_counter_may_run_over_unseen_from_half_of_its_period_on(
    steps: int, interval: float, expected: list[int]
) -> None:
    findings = list(uncertain(channel("alive", (3 + steps * np.arange(32)) % 16, interval)))
    assert [finding.time for finding in findings] == pytest.approx([k * interval for k in expected])


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


@pytest.mark.parametrize(("factor", "expected"), [(0.99, []), (1.01, ["T_max"])])
def test_not_even_one_torque_is_far_beyond_the_motor(factor: float, expected: list[str]) -> None:
    one = drive()
    T_mot = one.T_mot.copy()
    T_mot[300] = factor * UNABLE * 120.0
    (*findings,) = plausibility.beyond_T_max(replace(one, T_mot=T_mot), 120.0)
    assert [finding.rule.name for finding in findings] == expected
    assert [finding.time for finding in findings] == pytest.approx([one.time[300]] * len(expected))


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
    at = np.linspace(500, 9_500, count).astype(int)
    (finding,) = lacking(replace(channel("T_mot", np.zeros(9)), missing=[MissingSamples(-999.0, 0.1 * at, "line 502")]))
    assert (finding.samples[0], finding.samples[-1]) == pytest.approx((50.0, 950.0))
    assert finding.samples[0] == finding.time
    assert len(set(finding.samples)) == min(count, MOST_MARKED)
    assert set(np.round(10.0 * np.array(finding.samples)).astype(int)) <= {*at}


def test_every_rule_is_found_by_something_and_has_a_name_of_its_own() -> None:
    names = [rule.name for rule in RULES]
    assert len(set(names)) == len(names)
    assert {rule for _, rule, _ in SPOILED.values()} | {"cut off", "following", "hole", "time too short"} == set(names)
    rooms = (*vars(plausibility).values(), *vars(channel_rules).values())
    declared = {id(each) for each in rooms if isinstance(each, Rule)}
    assert declared == {id(rule) for rule in RULES}


def test_a_code_is_a_hole_that_is_filled_if_it_is_short(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    at(V, -999.0, 100)(pd.read_csv(TOWN_DRIVE)).to_csv(path, index=False)
    (finding,) = found(path)
    assert str(finding).startswith("line 102: Velocity [km/h] at 10 s is -999, which loggers write where there is no")
    at(V, -999.0, *range(100, 103))(pd.read_csv(TOWN_DRIVE)).to_csv(path, index=False)
    with pytest.raises(RecordingError, match=r"line 102: Velocity .* no value for 0\.4 s after 9\.9 s; holes"):
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
