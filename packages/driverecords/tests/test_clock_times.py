"""Times of day in the column of time."""

from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from driverecords.clock_times import is_clock_time, seconds
from driverecords.drive import read_drive
from driverecords.source import RecordingError

FORMS: dict[str, Callable[[datetime], str]] = {
    "ISO 8601": lambda at: at.isoformat(timespec="milliseconds"),
    "ISO 8601, blank": lambda at: at.isoformat(" ", timespec="milliseconds"),
    "ISO 8601, UTC": lambda at: at.isoformat(timespec="milliseconds") + "Z",
    "ISO 8601, zone": lambda at: at.isoformat(timespec="milliseconds") + "+01:00",
    "slashes": lambda at: f"{at:%Y/%m/%d %H:%M:%S}.{at.microsecond // 1000:03}",
    "German": lambda at: f"{at:%d.%m.%Y %H:%M:%S},{at.microsecond // 1000:03}",
    "time of day": lambda at: f"{at:%H:%M:%S}.{at.microsecond // 1000:03}",
    "time of day, half": lambda at: f"{at:%I:%M:%S}.{at.microsecond // 1000:03} {at:%p}",
    "time of day, German half": lambda at: (
        f"{at:%I:%M:%S}.{at.microsecond // 1000:03} {'vorm' if at.hour < 12 else 'nachm'}"
    ),
}


@pytest.mark.parametrize("form", FORMS)
@settings(max_examples=20)
@given(
    begin=st.datetimes(datetime(1970, 1, 1), datetime(2100, 1, 1)),
    steps=st.lists(st.integers(1, 3_600_000), min_size=1, max_size=8),
)
def test_every_form_gives_the_time_since_the_first_row(form: str, begin: datetime, steps: list[int]) -> None:
    start = begin.replace(microsecond=begin.microsecond // 1000 * 1000)
    since = np.concatenate(([0], np.cumsum(steps))) * 1e-3
    texts = [FORMS[form](start + timedelta(milliseconds=round(1e3 * t))) for t in since]
    assert all(map(is_clock_time, texts))
    np.testing.assert_allclose(seconds(texts)[0], since, atol=1e-6)


@pytest.mark.parametrize(
    "text", ["", "10", "10:15", "10:61:00", "2026-02-30T10:00:00", "30 Foo 2026 10:00:00", "2026111T10:00:00", "x"]
)
def test_what_is_no_time(text: str) -> None:
    assert not is_clock_time(text)
    assert np.isnan(seconds(["10:15:30", text])[0]).tolist() == [False, True]


def written(tmp_path: Path, *times: str, heading: str = "Time") -> Path:
    path = tmp_path / "drive.csv"
    rows = [f"{time};{k};{k}" for k, time in enumerate(times)]
    path.write_text("\n".join([f"{heading};v [m/s];Torque [Nm]", *rows, ""]), encoding="utf-8")
    return path


@pytest.mark.parametrize("heading", ["Time", "Time [s]", "Time [hh:mm:ss]", "Timestamp"])
def test_a_column_of_times_needs_no_unit(tmp_path: Path, heading: str) -> None:
    path = written(tmp_path, "23:59:59.5", "23:59:59.75", "00:00:00", heading=heading)
    assert read_drive(path).time.tolist() == [0.0, 0.25, 0.5]
    assert read_drive(path, {"time": heading}).time.tolist() == [0.0, 0.25, 0.5]


@pytest.mark.parametrize("heading", ["Date", "DATUM", "DateTime", "Date_Time", "Date/Time", "Uhrzeit"])
def test_a_date_with_the_time_of_day_is_the_time_where_nothing_else_is(tmp_path: Path, heading: str) -> None:
    path = written(tmp_path, "2026-11-22 10:00:00", "2026-11-22 10:00:01", "2026-11-22 10:00:03", heading=heading)
    assert read_drive(path).time.tolist() == [0.0, 1.0, 3.0]
    rows = ("2026-11-22 10:00:00,5,1,1", "2026-11-22 10:00:01,7,2,2")
    path.write_text("\n".join((f"{heading},Time [s],v [m/s],Torque [Nm]", *rows)))
    assert read_drive(path).time.tolist() == [5.0, 7.0]


def test_a_row_without_a_time_is_named(tmp_path: Path) -> None:
    for first, odd, last in (
        ("10:00:00", "soon", "10:00:02"),
        ("2026-11-22T10:00:00", "10:00:01", "2026-11-22T10:00:02"),
    ):
        with pytest.raises(
            RecordingError, match=rf"line 3, column Time: {odd} is not a finite number, nor a time such as"
        ):
            read_drive(written(tmp_path, first, odd, last))


@pytest.mark.parametrize(
    ("first", "last", "step"),
    [
        ("11/12/2026 23:59:59.5", "11/13/2026 00:00:00.5", 1.0),
        ("11/12/2026 23:59:59.5", "12/12/2026 00:00:00.5", 1.0),
        ("22. Dezember 2026 10:15:30,5", "22. Dezember 2026 10:15:31,5", 1.0),
        ("Nov 22, 2026 10:15:30 am", "Nov 22, 2026 10:15:31 am", 1.0),
        ("0 days 00:00:00.1", "1 days 00:00:00.2", 86400.1),
    ],
)
def test_dates_and_durations(first: str, last: str, step: float) -> None:
    """Of 11/12/2026 the day is what makes the shorter recording."""
    assert is_clock_time(first)
    times, _ = seconds([first, "", last])
    assert times[2] - times[0] == pytest.approx(step, abs=1e-6)
    assert np.isnan(times[1])
