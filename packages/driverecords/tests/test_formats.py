"""One recording, as many files: whatever tool wrote it, the same drive is read."""

import inspect
import sys
from itertools import product
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest
from fmutesting.together import together

from driverecords.channels import Channels
from driverecords.drive import Drive, read_drive
from driverecords.source import RecordingError
from toolground.errors import MissingExtra

from .variants import TEXTS, Columns, recording, write_arrow, write_mdf

pytestmark = pytest.mark.usefixtures("read_here")

DRIVE = recording()


def as_read(drive: Columns) -> Drive:
    """What reading must give."""
    time, v, elevation, T_mot = (values for values, _ in drive.values())
    return Drive("drive", time, v / 3.6, elevation, T_mot, {})


def require_same(recording: Drive, expected: Drive) -> None:
    for name in ("time", "v", "elevation", "T_mot"):
        np.testing.assert_allclose(
            getattr(recording, name), getattr(expected, name), rtol=1e-9, atol=1e-9, err_msg=name
        )


@together("variant", TEXTS)
def test_the_same_drive_is_read_from_every_text(tmp_path: Path, variant: str) -> None:
    path = tmp_path / "drive.csv"
    path.write_bytes(TEXTS[variant](DRIVE))
    require_same(read_drive(path), as_read(DRIVE))


@together("variant, cell", product(TEXTS, ["x", "inf", ""]))
def test_a_bad_cell_is_named_with_its_line_in_every_text(tmp_path: Path, variant: str, cell: str) -> None:
    """Without a value it is filled, and so is said."""
    path = tmp_path / "drive.csv"
    text = TEXTS[variant](DRIVE)
    encodings = {"UTF-32 without": "utf-32-be", "UTF-32": "utf-32", "UTF-16 without": "utf-16-le", "UTF-16": "utf-16"}
    encoding = next((encoding for name, encoding in encodings.items() if name in variant), "latin-1")
    lines = text.decode(encoding).split("\n")
    separator = next(s for s in "\t;," if s in lines[-2])
    quote = '"' if lines[-2].startswith('"') else ""
    cells = lines[-4].split(f"{quote}{separator}{quote}")
    cells[1] = cell
    lines[-4] = f"{quote}{separator}{quote}".join(cells)
    path.write_bytes("\n".join(lines).encode(encoding))
    if cell:
        with pytest.raises(RecordingError, match=rf"line {len(lines) - 3}, column .?[Vv]elocity.*: {cell} is"):
            read_drive(path)
    else:
        recording = read_drive(path)
        assert len(recording.time) == 200
        assert [missing.place for missing in recording.channels["v"].missing] == [f"line {len(lines) - 3}"]


@pytest.mark.parametrize("name", ["drive.parquet", "drive.feather"])
@pytest.mark.parametrize("units_beside", [False, True])
def test_the_same_drive_is_read_from_parquet_and_feather(tmp_path: Path, name: str, units_beside: bool) -> None:
    write_arrow(DRIVE, tmp_path / name, units_beside)
    require_same(read_drive(tmp_path / name), as_read(DRIVE))


def test_what_the_file_is_called_does_not_matter(tmp_path: Path) -> None:
    write_arrow(DRIVE, tmp_path / "drive.parquet")
    (tmp_path / "drive.parquet").rename(tmp_path / "drive.csv")
    require_same(read_drive(tmp_path / "drive.csv"), as_read(DRIVE))


def test_groups_of_an_mdf_file_with_other_rates_come_onto_the_time_of_the_torque(tmp_path: Path) -> None:
    write_mdf(DRIVE, tmp_path / "drive.mf4")
    recording, expected = read_drive(tmp_path / "drive.mf4"), as_read(DRIVE)
    assert recording.time.tolist() == expected.time[:-1].tolist(), "the time that both groups have in common"
    assert recording.T_mot.tolist() == expected.T_mot[:-1].tolist(), "nothing is done to the base"
    np.testing.assert_allclose(recording.v[::2], expected.v[:-1:2], rtol=1e-14, err_msg="nor to a sample that is there")
    np.testing.assert_allclose(recording.v, expected.v[:-1], atol=3e-3)  # between them, rounded to 0.01 km/h


def test_a_bad_value_of_a_binary_file_is_named_with_its_row(tmp_path: Path) -> None:
    drive = recording()
    drive["Velocity"][0][6] = np.inf
    for name, place in (("drive.parquet", "row 7"), ("drive.mf4", "sample 4 at 0.06 s")):
        (write_mdf if name.endswith("mf4") else write_arrow)(drive, tmp_path / name)
        with pytest.raises(RecordingError, match=rf"{place}, column Velocity.*: inf is not a finite number"):
            read_drive(tmp_path / name)


def test_texts_in_a_binary_file_are_read_with_decimal_commas_and_thousands(tmp_path: Path) -> None:
    import pyarrow as pa
    from pyarrow.parquet import write_table

    def read(speeds: list[str]) -> np.ndarray:
        table = pa.table({"Time [s]": 0.1 * np.arange(len(speeds)), "Motor Speed [rad/s]": speeds})
        write_table(table, tmp_path / "drive.parquet")
        return Channels(tmp_path / "drive.parquet").read("omega_1")["omega_1"].values

    assert read(["99,5", "100", "100,5"]).tolist() == [99.5, 100.0, 100.5]
    assert read(["998", "1,001", "1,003"]).tolist() == [998.0, 1001.0, 1003.0]


@pytest.mark.parametrize("name", ["drive.parquet", "drive.feather", "drive.mf4"])
def test_a_file_that_was_cut_off_is_refused_in_one_line(
    tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (write_mdf if name.endswith("mf4") else write_arrow)(DRIVE, tmp_path / name)
    whole = (tmp_path / name).read_bytes()
    for size in (12, 100, len(whole) // 2, len(whole) - 9):
        (tmp_path / name).write_bytes(whole[:size])
        with pytest.raises(RecordingError, match=r"damaged|no column|samples|gap") as refusal:
            read_drive(tmp_path / name)
        assert str(refusal.value).isprintable()
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("version", ["2.14", "3.30", "4.10"])
def test_every_version_of_mdf_is_read(tmp_path: Path, version: str) -> None:
    from asammdf import MDF, Signal

    path, time = tmp_path / "drive.mdf", DRIVE["Time"][0]
    with MDF(version=version) as file:
        file.append([Signal(x, time, name=name, unit=unit) for name, (x, unit) in list(DRIVE.items())[1:]])
        path = file.save(path, overwrite=True)
    require_same(read_drive(path), as_read(DRIVE))


def test_times_of_an_mdf_file_in_another_unit(tmp_path: Path) -> None:
    from asammdf import MDF, Signal

    time = 1e3 * DRIVE["Time"][0]
    with MDF(version="4.10") as file:
        file.append([Signal(x, time, name=name, unit=unit) for name, (x, unit) in list(DRIVE.items())[1:]])
        file.groups[0].channels[0].unit = "ms"
        path = file.save(tmp_path / "drive.mf4", overwrite=True)
    require_same(read_drive(path), as_read(DRIVE))


NO_VALUE = {
    "a text for a value": {"val_0": 65535, "text_0": b"SNA", "default_addr": {"a": 0.01, "b": 0.0}},
    "a text for a range": {"lower_0": 65534, "upper_0": 65535, "text_0": b"SNA", "default_addr": {"a": 0.01, "b": 0.0}},
    "no text, but all bits set": {"a": 0.01, "b": 0.0},
}


@pytest.mark.parametrize("name", NO_VALUE)
def test_what_a_conversion_says_to_be_no_value_is_none(tmp_path: Path, name: str) -> None:
    from asammdf import MDF, Signal

    raw = np.round(100.0 * DRIVE["Velocity"][0]).astype(np.uint16)
    raw[:50] = 65535
    raw[100] = 65535
    time = DRIVE["Time"][0]
    with MDF(version="4.10") as file:
        torque = Signal(DRIVE["Motor Torque"][0], time, name="Motor Torque", unit="Nm")
        file.append([Signal(raw, time, name="Velocity", unit="km/h", conversion=NO_VALUE[name]), torque])
        path = file.save(tmp_path / "drive.mf4", overwrite=True)
    recording = read_drive(path)
    assert recording.time.tolist() == time[50:].tolist()
    np.testing.assert_allclose(recording.v, DRIVE["Velocity"][0][50:] / 3.6, atol=2e-2)
    assert sum(len(missing.times) for missing in recording.channels["v"].missing) == (51 if "bits" in name else 1)


@pytest.mark.parametrize(("name", "package"), [("drive.parquet", "pyarrow.parquet"), ("drive.mf4", "asammdf")])
def test_without_the_extra_it_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, package: str
) -> None:
    (write_mdf if name.endswith("mf4") else write_arrow)(DRIVE, tmp_path / name)
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(MissingExtra, match=r"the extra `formats`, as in pip install"):
        inspect.unwrap(read_drive)(tmp_path / name)  # in this process, whose packages are hidden


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (("xl/workbook.xml", "[Content_Types].xml"), "an Excel workbook"),
        (("drive.csv",), "a ZIP archive"),
        (b"PK\x03\x04 cut off", "a ZIP archive"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600), "an Excel workbook or another document"),
        (b"\x89HDF\r\n\x1a\n" + bytes(90), "an HDF5 file"),
        (b"MATLAB 5.0 MAT-file, Platform", "a MATLAB file"),
    ],
)
def test_what_is_no_recording_is_called_by_its_name(
    tmp_path: Path, content: bytes | tuple[str, ...], message: str
) -> None:
    path = tmp_path / "drive.csv"
    if isinstance(content, bytes):
        path.write_bytes(content)
    else:
        with ZipFile(path, "w") as archive:
            for name in content:
                archive.writestr(name, "x")
    with pytest.raises(RecordingError, match=rf"drive\.csv is {message}.*, which is not read; save .* as a text file"):
        read_drive(path)
