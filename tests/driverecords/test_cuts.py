"""Parts of recordings, by seconds and by clocks."""

from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from fmutesting.together import together

from driverecords.arguments import instant
from driverecords.drive import read_drive
from driverecords.measurement import PIECE, read_measurement
from driverecords.source import RecordingError
from driverecords.time_base import Cut
from packages.driverecords.tests.car import RADIUS, RATIO, drive
from packages.driverecords.tests.conftest import Write
from packages.driverecords.tests.test_bus_log import CLASSIC, DBC, asc
from packages.driverecords.tests.variants import recording, table, write_arrow, write_mdf

pytestmark = pytest.mark.usefixtures("read_here")

BEGIN = datetime(2026, 1, 5, 23, 59, 59, 500_000)


def stamps(form: str) -> list[str]:
    return [(BEGIN + timedelta(seconds=0.01 * k)).strftime(form) for k in range(200)]


def of_text(path: Path, form: str = "") -> None:
    columns = recording()
    rows = table(columns).splitlines()
    if form:
        rows = [rows[0].replace(" [s]", "")] + [
            f"{stamp},{row.partition(',')[2]}" for stamp, row in zip(stamps(form), rows[1:], strict=True)
        ]
    path.write_text("\n".join(rows), encoding="utf-8")


def of_dates(path: Path) -> None:
    import pyarrow as pa
    from pyarrow import parquet

    write_arrow(recording(), path.with_suffix(".parquet"))
    drive = parquet.read_table(path.with_suffix(".parquet"))
    dates = pa.array([BEGIN + timedelta(seconds=0.01 * k) for k in range(200)])
    parquet.write_table(drive.set_column(0, "Time", dates), path)


FILES: dict[str, Callable[[Path], None]] = {
    "seconds": of_text,
    "time of day": lambda path: of_text(path, "%H:%M:%S.%f"),
    "date": lambda path: of_text(path, "%Y-%m-%dT%H:%M:%S.%f"),
    "date with a zone": lambda path: of_text(path, "%Y-%m-%dT%H:%M:%S.%f+01:00"),
    "German date": lambda path: of_text(path, "%d.%m.%Y %H:%M:%S.%f"),
    "Parquet": of_dates,
}


@pytest.mark.parametrize("form", FILES)
@together(
    "begin, end, first, last",
    [
        ("0.5", "1.2", 0.5, 1.2),
        (None, "1.2", 0.0, 1.2),
        ("0.5", None, 0.5, 1.99),
        ("00:00:00", "00:00:00.7", 0.5, 1.2),
        ("23:59:59.7", "00:00:00.7", 0.2, 1.2),
        ("2026-01-06 00:00:00", "2026-01-06 00:00:00.7", 0.5, 1.2),
        ("0:00", None, 0.5, 1.99),
    ],
)
def test_a_part_is_read_from_one_instant_to_another(
    tmp_path: Path, form: str, begin: str | None, end: str | None, first: float, last: float
) -> None:
    path = tmp_path / "drive.csv"
    FILES[form](path)
    cut = Cut(begin and instant(begin), end and instant(end))  # type: ignore[arg-type]
    if form == "seconds" and ":" in f"{begin}{end}":
        with pytest.raises(RecordingError, match="it has no times of day; --from and --to must be seconds"):
            read_drive(path, cut=cut)
        return
    part = read_drive(path, cut=cut)
    assert (part.time[0], part.time[-1]) == pytest.approx((first, last), abs=1e-6)
    whole = read_drive(path)
    kept = (whole.time > first - 1e-6) & (whole.time < last + 1e-6)
    np.testing.assert_array_equal(part.T_mot, whole.T_mot[kept])


def test_a_log_of_a_bus_and_an_mdf_file_know_times_of_day(tmp_path: Path) -> None:
    path, database = tmp_path / "log.asc", tmp_path / "bus.dbc"
    path.write_text(asc(CLASSIC), encoding="utf-8")
    database.write_text(DBC, encoding="ascii")
    from driverecords.channels import Channels

    part = Channels(path, databases=[database], cut=Cut(instant("10:15:31"), instant("10:15:31.2"))).read("T_mot")
    assert part["T_mot"].time.tolist() == pytest.approx(np.arange(50, 71) * 0.01)
    write_mdf(recording(), tmp_path / "drive.mf4")
    from asammdf import MDF

    with MDF(tmp_path / "drive.mf4") as file:
        start = file.start_time
    at = (start + timedelta(seconds=0.5)).strftime("%Y-%m-%d %H:%M:%S.%f")
    assert read_drive(tmp_path / "drive.mf4", cut=Cut(instant(at))).time[0] == pytest.approx(0.5, abs=0.02)


def test_what_is_outside_of_the_part_is_not_looked_at(tmp_path: Path) -> None:
    lines = table(recording()).splitlines()
    lines[11] = lines[11].replace(",", ",x", 1)
    lines[190] = "1.9,900,9,9"
    path = tmp_path / "drive.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    for cut in (Cut(0.11, 1.8), Cut(instant("0.11"), instant("1.88"))):
        assert read_drive(path, cut=cut).time[0] == pytest.approx(0.11)
    with pytest.raises(RecordingError, match=r"line 12, column Velocity .*; the longest .* --from 0\.11 --to 1\.88$"):
        read_drive(path)


@pytest.mark.parametrize("cut", [Cut(2.0), Cut(None, -0.01), Cut(1.2, 1.0), Cut(0.501, 0.509)])
def test_a_part_without_a_sample_is_refused(tmp_path: Path, cut: Cut) -> None:
    path = tmp_path / "drive.csv"
    of_text(path)
    with pytest.raises(RecordingError, match=r"no sample is within --.*; it goes from 0 to 1\.99 s"):
        read_drive(path, cut=cut)


@pytest.mark.parametrize(("last", "pieces"), [(PIECE - 0.002, 2), (PIECE, 3)])
def test_of_a_test_drive_with_gaps_all_pieces_that_are_long_enough_are_used(
    write: Write, last: float, pieces: int
) -> None:
    """From 0 to 3 s, 3.5 to 8 s less a torque that none is, and so long at the end."""
    one = drive()
    kept = (one["time"] <= 3.0) | ((one["time"] >= 3.5) & (one["time"] <= 8.0)) | (one["time"] >= 10.0 - last - 1e-9)
    torque = np.where(one["time"] == 5.0, 20e3, one["T_mot"])
    names = {"time [s]": one["time"], "T_mot [N.m]": torque, "T_load [N.m]": one["T_load"]}
    names |= {f"{name} [rad/s]": one[name] for name in ("omega_1", "omega_2")}
    found = read_measurement(write({name: values[kept] for name, values in names.items()}), RATIO, RADIUS)
    used = kept & (one["time"] != 5.0) & ((one["time"] <= 8.0) | (pieces == 3))
    np.testing.assert_allclose(found.time, one["time"][used])
    np.testing.assert_allclose(found.omega_1, one["omega_1"][used], rtol=1e-8)
    (warning,) = found.warnings
    assert "gap of 0.5 s after 3 s; at most 0.006 s (3 times the median step) is allowed;" in warning
    assert warning.endswith(f"{pieces + 1} pieces are used, each of 1 s or more")


def test_a_part_of_a_test_drive_is_that_part(write: Write) -> None:
    one = drive()
    units = {"time": "s", "T_ref": "N.m", "T_mot": "N.m", "T_load": "N.m"}
    path = write({f"{name} [{units.get(name, 'rad/s')}]": values for name, values in one.items()})
    part = read_measurement(path, RATIO, RADIUS, cut=Cut(2.0, 6.0))
    np.testing.assert_allclose(part.time, one["time"][1000:3001])
    np.testing.assert_allclose(part.omega_1, one["omega_1"][1000:3001], rtol=1e-8)
