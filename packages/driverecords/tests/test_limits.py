"""What a file may take: attacks are refused in one line, recordings are read."""

import os
import signal
import sys
import zlib
from pathlib import Path
from struct import pack
from typing import Any

import numpy as np
import pytest
from fmutesting.together import together

from driverecords import bounded_reading, format_detection, text_file
from driverecords.drive import read_drive
from driverecords.source import RecordingError
from toolground import file_limits as limits
from toolground.interruption import stoppable

from .test_bus_log import drive as frames
from .test_bus_log import write as write_log
from .variants import TEXTS, recording, table, write_arrow, write_mdf

HEADING = "Time [s],Velocity [km/h],Motor Torque [Nm]\n"


def refusal(path: Path, **how: Any) -> str:
    with pytest.raises(RecordingError) as refused:
        read_drive(path, **how)
    message = str(refused.value)
    assert message.startswith(str(path))
    assert message.isprintable(), message
    return message.removeprefix(str(path)).lstrip(" :,")


def written(folder: Path, text: str) -> Path:
    path = folder / "drive.csv"
    path.write_text(text, encoding="utf-8")
    return path


def rows(count: int) -> str:
    return HEADING + "".join(f"{0.01 * k:.2f},50,{k % 7}\n" for k in range(count))


@together("variant", TEXTS)
def test_a_text_in_many_pieces_is_read_as_in_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, variant: str) -> None:
    path = tmp_path / "drive.csv"
    path.write_bytes(TEXTS[variant](recording()))
    whole = read_drive(path)
    with monkeypatch.context() as patch:
        patch.setattr(text_file, "PIECE", 1000)
        in_pieces = read_drive(path)
    for name in ("time", "v", "elevation", "T_mot"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(in_pieces, name))


def test_a_bad_cell_of_a_later_piece_is_named_with_its_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text_file, "PIECE", 100)
    lines = [*rows(200).splitlines(), "", "2.01,50,true"]
    message = refusal(written(tmp_path, "\n".join(lines)))
    assert message.startswith("line 203, column Motor Torque [Nm]: true is not a finite number; the longest piece")
    message = refusal(written(tmp_path, "\n".join([*lines[:-1], '2.01,50,"7', '"', *lines[-1:]])))
    assert 'line 203, column Motor Torque [Nm]: "7' in message


def test_a_text_has_so_many_bytes_at_the_most(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(tmp_path, rows(100))
    monkeypatch.setattr(text_file, "LARGEST_TEXT", path.stat().st_size)
    assert len(read_drive(path).time) == 100
    monkeypatch.setattr(text_file, "LARGEST_TEXT", path.stat().st_size - 1)
    assert "a text is read up to" in refusal(path)


@pytest.mark.parametrize("line", [1, 2, 151])
def test_a_line_has_so_many_characters_at_the_most(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, line: int) -> None:
    lines = rows(200).splitlines()
    lines[line - 1] += ","
    lines[line - 1] = lines[line - 1].ljust(3000)
    path = written(tmp_path, "\n".join(lines))
    monkeypatch.setattr(text_file, "LONGEST_LINE", 3000)
    assert len(read_drive(path).time) == 200
    monkeypatch.setattr(text_file, "LONGEST_LINE", 2999)
    assert refusal(path) == f"line {line} has more than 2999 characters"


def test_a_line_has_so_many_cells_at_the_most(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text_file, "MOST_COLUMNS", 100)
    wide = [HEADING.strip(), *(f"{k},50,7" for k in range(150))]
    wide[140] += "," * 97
    assert len(read_drive(written(tmp_path, "\n".join(wide))).time) == 150
    wide[140] += ","
    assert refusal(written(tmp_path, "\n".join(wide))) == "line 141 has 101 cells; at most 100 are read"
    names = HEADING.strip() + "".join(f",x{k}" for k in range(98))
    assert refusal(written(tmp_path, f"{names}\n0,50,7\n1,50,8\n")) == "line 1 has 101 cells; at most 100 are read"


def test_a_record_beside_a_file_is_read_up_to_a_megabyte(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("Time,Velocity,Motor Torque\n0,50,7\n1,50,8\n")
    note = '{"files": ["drive.csv"], "units": {"Time": "s", "Velocity": "km/h", "Motor Torque": "N.m"}}'
    (tmp_path / "drive.json").write_text(note.ljust(limits.LARGEST_NOTE))
    assert len(read_drive(path).time) == 2
    (tmp_path / "drive.json").write_text(note.ljust(limits.LARGEST_NOTE + 1))
    assert "has no unit" in refusal(path)


@pytest.mark.parametrize("unit", ["h200.min-200.km/h", "h99999999.min-99999999", ".".join(["m"] * 3000)])
def test_a_unit_with_powers_is_no_unit_of_a_speed(tmp_path: Path, unit: str) -> None:
    assert "is not a known unit" in refusal(written(tmp_path, rows(3).replace("km/h", unit)))


linux = pytest.mark.skipif(sys.platform != "linux", reason="only Linux limits the memory of a process")


@pytest.mark.slow
@linux
def test_a_parquet_file_that_unpacks_to_gigabytes_is_refused(tmp_path: Path) -> None:
    pa, pq = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    names = HEADING.strip().split(",")
    some = pa.table({name: np.zeros(2_000_000) for name in names})
    path = tmp_path / "bomb.parquet"
    with pq.ParquetWriter(path, some.schema) as file:
        for _ in range(100):  # 4.8 GB
            file.write_table(some)
    assert path.stat().st_size < 3_000_000
    assert refusal(path) == "takes more than 1500 MB of memory to read"


@pytest.mark.slow
@linux
def test_a_container_of_a_log_that_unpacks_to_gigabytes_is_refused(tmp_path: Path) -> None:
    path, databases = write_log(tmp_path, frames())
    packer = zlib.compressobj(9)
    content = b"".join(packer.compress(bytes(10_000_000)) for _ in range(100)) + packer.flush()
    head = pack("<4sHHLL", b"LOBJ", 16, 1, 32 + len(content), 10) + pack("<H6xL4x", 2, 0)
    path.write_bytes(path.read_bytes() + head + content)
    assert refusal(path, databases=databases) == "takes more than 1500 MB of memory to read"


def test_what_takes_long_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "drive.parquet"
    write_arrow(recording(), path)
    monkeypatch.setattr(bounded_reading, "PATIENCE", 0.01)
    assert refusal(path) == "takes more than 0.01 s to read"


@linux
def test_what_would_never_end_is_refused_unread(tmp_path: Path) -> None:
    endless, pipe = Path("/proc/kmsg"), tmp_path / "pipe"
    os.mkfifo(pipe)
    assert refusal(endless) == "is empty"
    assert refusal(pipe) == "is no file; a file is needed"
    log, _ = write_log(tmp_path, frames())
    for database, problem in ((endless, "is empty"), (pipe, "is no file; a file is needed")):
        with pytest.raises(RecordingError, match=f"^{database} {problem}$"):
            read_drive(log, databases=[database])


@linux
def test_a_file_that_does_not_open_is_waited_for_so_long(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As on a disk of a network that is gone: another process has been promised to be asked first."""
    import fcntl

    path = written(tmp_path, rows(3))
    holder = os.open(path, os.O_RDWR)
    before = signal.signal(signal.SIGIO, signal.SIG_IGN)
    try:
        fcntl.fcntl(holder, fcntl.F_SETLEASE, fcntl.F_WRLCK)
        monkeypatch.setattr(format_detection, "SECONDS", 0.1)
        assert refusal(path) == "takes more than 0.1 s to read"
    finally:
        os.close(holder)
        signal.signal(signal.SIGIO, before)
    monkeypatch.undo()
    assert len(read_drive(path).time) == 3


def test_a_damaged_file_is_named_and_no_copy_of_it_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, temporary = tmp_path / "drive.mf4", tmp_path / "temporary"
    write_mdf(recording(), path)
    whole = path.read_bytes()
    temporary.mkdir()
    monkeypatch.setenv("TMPDIR", str(temporary))
    monkeypatch.setattr("tempfile.tempdir", None)
    # the flags of what the logger did not finish: asammdf mends a copy
    unfinished = b"UnFinMF " + whole[8:60] + b"\x01\x00\x00\x00" + whole[64 : len(whole) // 2]
    path.write_bytes(unfinished)
    with pytest.raises(RecordingError, match=r"drive\.mf4 is a damaged MDF file"):
        read_drive(path)
    assert list(temporary.iterdir()) == []
    path.write_bytes(whole[:64])
    with pytest.raises(RecordingError, match=r"damaged MDF file: 'drive\.mf4' is not a valid MDF file"):
        read_drive(path)


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_a_crash_of_a_package_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "drive.mf4"
    write_mdf(recording(), path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    (tmp_path / "asammdf.py").write_text("import os\nos.abort()\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert refusal(path) == f"ended the process that read it: exit code {-signal.SIGABRT}"


def test_large_texts_and_packed_files_are_read_by_a_process_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = written(tmp_path, table(recording()))
    monkeypatch.setattr(bounded_reading, "SMALL_TEXT", path.stat().st_size)
    monkeypatch.setattr(bounded_reading, "_alone", lambda *_: pytest.fail("in a process of its own"))
    whole = read_drive(path)
    monkeypatch.undo()
    monkeypatch.setattr(bounded_reading, "SMALL_TEXT", path.stat().st_size - 1)
    with stoppable():
        alone = read_drive(path)
    np.testing.assert_array_equal(whole.T_mot, alone.T_mot)
    assert alone.file_units == whole.file_units


@pytest.mark.parametrize("ending", ["mf4", "parquet", "blf"])
@pytest.mark.slow
def test_a_process_of_its_own_reads_what_this_one_does(tmp_path: Path, ending: str) -> None:
    path, databases = tmp_path / f"drive.{ending}", []
    if ending == "blf":
        path, databases = write_log(tmp_path, frames())
    else:
        (write_mdf if ending == "mf4" else write_arrow)(recording(), path)
    here = read_drive.__wrapped__(path, databases=databases)  # type: ignore[attr-defined]
    there = read_drive(path, databases=databases)
    for name in ("time", "v", "elevation", "T_mot"):
        np.testing.assert_array_equal(getattr(here, name), getattr(there, name))
    assert here.file_units == there.file_units
