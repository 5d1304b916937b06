"""Logs of buses that others have recorded."""

import re
import sys
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from fmutesting.together import together

from driverecords.channels import Channels
from driverecords.clock_times import read_clock
from driverecords.drive import read_drive
from driverecords.format_detection import opened
from driverecords.source import RecordingError
from driverecords.time_base import Cut
from toolground.errors import MissingExtra

pytestmark = pytest.mark.usefixtures("read_here")

DBC = """VERSION ""
BU_: ECU
BO_ 256 Motor: 4 ECU
 SG_ Motor_Torque : 0|16@1- (0.1,0) [0|0] "Nm" ECU
 SG_ State : 16|8@1+ (1,0) [0|0] "" ECU
BO_ 2566848786 Brake: 8 ECU
 SG_ Vehicle_Speed : 7|16@0+ (0.01,-10) [0|0] "km/h" ECU
BO_ 257 Many: 3 ECU
 SG_ Which M : 0|8@1+ (1,0) [0|0] "" ECU
 SG_ Elevation m1 : 8|16@1+ (0.5,-1000) [0|0] "m" ECU
 SG_ Other m2 : 8|16@1+ (1,0) [0|0] "" ECU
VAL_ 256 State 1 "on" 0 "off" ;
"""
BRAKE = 2566848786 - (1 << 31)


def message(time: float, identifier: int, data: bytes, **others):
    import can

    return can.Message(
        timestamp=1.7e9 + time, arbitration_id=identifier, data=data, is_extended_id=identifier > 0x7FF, **others
    )


def drive(samples: int = 100) -> list:
    """Torque at 100 Hz, speed at 50 Hz, elevation in every fourth frame of many, in the order of their times."""
    frames = []
    for k in range(samples):
        torque = int(10 * (20 + k)).to_bytes(2, "little", signed=True)
        frames.append(message(0.01 * k, 256, torque + b"\x01\x00"))
        if k % 2 == 0:
            frames.append(message(0.01 * k + 0.001, BRAKE, (100 * (36 + 10)).to_bytes(2, "big") + bytes(6)))
        which = 1 if k % 4 == 0 else 2
        frames.append(message(0.01 * k + 0.002, 257, bytes([which]) + int(2 * 1500 + k).to_bytes(2, "little")))
        frames.append(message(0.01 * k + 0.003, 0x7FF, b"\x00"))
    return frames


def write(folder: Path, frames: Iterable, ending: str = "blf") -> tuple[Path, list[Path]]:
    import can

    path = folder / f"log.{ending}"
    with can.Logger(path) as log:
        for frame in frames:
            log.on_message_received(frame)
    (folder / "bus.dbc").write_text(DBC, encoding="ascii")
    return path, [folder / "bus.dbc"]


@pytest.mark.parametrize("ending", ["blf", "asc"])
def test_a_drive_is_read_from_a_log(tmp_path: Path, ending: str) -> None:
    path, databases = write(tmp_path, drive(), ending)
    recording = read_drive(path, databases=databases)
    np.testing.assert_allclose(recording.T_mot, 20.0 + np.round(100.0 * recording.time), rtol=1e-12)
    np.testing.assert_allclose(recording.v, 10.0)
    assert recording.elevation is not None
    np.testing.assert_allclose(recording.elevation[::4], 500.0 + 50.0 * recording.time[::4] - 0.1, atol=0.11)


def test_a_table_whose_first_column_is_a_date_is_no_log(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("date of day;Velocity [km/h]\n0;1\n1;2\n", encoding="utf-8")
    assert [column.name for column in opened(path).columns] == ["date of day", "Velocity"]


def test_values_with_names_are_numbers_and_multiplexed_signals_have_their_own_times(tmp_path: Path) -> None:
    path, databases = write(tmp_path, drive())
    source = opened(path, databases)
    names = [column.name for column in source.columns]
    state, elevation, other = source.read([names.index(name) for name in ("State", "Elevation", "Other")])
    assert set(state.values) == {1.0}
    assert (len(elevation.values), len(other.values)) == (25, 75)
    assert elevation.time is not None
    np.testing.assert_allclose(np.diff(elevation.time), 0.04, atol=1e-6)


def test_signals_of_two_channels_are_told_apart(tmp_path: Path) -> None:
    frames = [message(0.01 * k, 256, bytes([k, 0, 0, 0]), channel=c) for k in range(50) for c in (0, 1)]
    path, databases = write(tmp_path, frames)
    assert [column.heading for column in opened(path, databases).columns][::2] == [
        "Motor_Torque, Motor, channel 0",
        "Motor_Torque, Motor, channel 1",
    ]
    with pytest.raises(RecordingError, match=r"could each be T_mot .*--column T_mot="):
        Channels(path, databases=databases).read("T_mot")
    columns = {"T_mot": "Motor_Torque, Motor, channel 1"}
    assert len(Channels(path, columns, databases=databases).read("T_mot")["T_mot"].time) == 50


def test_error_frames_and_remote_frames_hold_no_signals(tmp_path: Path) -> None:
    odd = [message(0.5, 256, b"", is_remote_frame=True), message(0.51, 256, b"", is_error_frame=True)]
    path, databases = write(tmp_path, [*drive(50), *odd, message(0.52, 256, bytes(4))])
    assert len(opened(path, databases).read([0])[0].values) == 51


@pytest.mark.parametrize(
    ("frames", "expected"),
    [
        ([], "has no frames"),
        ([message(0.0, 0x123, b"\x00")], r"no frame is in .*bus\.dbc; there are 0x123"),
        (
            [*drive(20), message(0.2, 256, b"\x01"), message(0.21, 256, bytes(4))],
            r"frame at 0\.2 s: 01 is no Motor \(0x100\) of 4 bytes",
        ),
        ([*drive(20), message(0.2, 256, b"\x01"), message(0.3, 0x123, b"\x00")], r"01 is no Motor"),
        ([*drive(20), *drive(3)], "does not come after"),
        ([*drive(20), message(0.9, 256, bytes(4))], "gap of"),
    ],
    ids=["empty", "unknown", "short", "short, then unknown", "backwards", "gap"],
)
def test_a_bad_log_is_refused_in_one_line(tmp_path: Path, frames: list, expected: str) -> None:
    path, databases = write(tmp_path, frames)
    with pytest.raises(RecordingError, match=expected) as refusal:
        Channels(path, databases=databases).read("T_mot")
    assert str(path) in str(refusal.value)
    assert str(refusal.value).isprintable()


@pytest.mark.parametrize("ending", ["blf", "asc"])
def test_a_log_that_was_cut_off_is_refused_or_ends_there(tmp_path: Path, ending: str) -> None:
    path, databases = write(tmp_path, drive(), ending)
    whole = path.read_bytes()
    for size in (50, 150, 300, len(whole) // 2, len(whole) - 9):
        path.write_bytes(whole[:size])
        with suppress(RecordingError):
            assert read_drive(path, databases=databases).time[-1] < 1.0


@pytest.mark.parametrize("text", ["", "BO_ 1 x", "\x00\x01", "VERSION"])
def test_a_bad_database_is_named(tmp_path: Path, text: str) -> None:
    path, databases = write(tmp_path, drive(20))
    databases[0].write_text(text, encoding="ascii")
    with pytest.raises(RecordingError, match=r"bus\.dbc"):
        opened(path, databases)
    with pytest.raises(RecordingError, match=r"there is no database nothing\.dbc"):
        opened(path, [Path("nothing.dbc")])


def test_a_database_is_for_a_log_alone(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("Time [s],Velocity [km/h]\n0,1\n1,2\n", encoding="utf-8")
    with pytest.raises(RecordingError, match=r"is no log of a bus \(BLF, ASC, .*\), which bus\.dbc is for"):
        opened(path, [Path("bus.dbc")])


@pytest.mark.parametrize("package", ["can", "cantools"])
def test_without_the_extra_it_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, package: str) -> None:
    path, databases = write(tmp_path, drive(20))
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(MissingExtra, match=r"the extra `formats`, as in pip install"):
        opened(path, databases)


def test_a_drive_without_the_speed_of_the_vehicle_takes_that_of_the_wheels_over_ground(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    path.write_text("t [s],Torque [Nm],Wheel Speed [km/h]\n" + "".join(f"{k},1,{3.6 * k}\n" for k in range(5)))
    np.testing.assert_allclose(read_drive(path).v, range(5))
    path.write_text("t [s],Torque [Nm],Wheel Speed [rad/s]\n0,1,2\n1,1,2\n")
    with pytest.raises(RecordingError, match=r"no speed of the vehicle, and Wheel Speed \[rad/s\] is none over ground"):
        read_drive(path)


ASC_HEAD = """date Mon Jan 5 10:15:30.500 am 2026
base hex  timestamps {times}
internal events logged
Begin TriggerBlock Mon Jan 5 10:15:30.500 am 2026
   0.000000 Start of measurement
"""


def asc(line: str, stamps: Iterable[str] = (), times: str = "absolute") -> str:
    stamps = list(stamps) or [f"{0.01 * k:.6f}" for k in range(100)]
    rows = [f"   {stamp} {line.format(data=f'{k:02x} 00 00 00')}" for k, stamp in enumerate(stamps)]
    return ASC_HEAD.format(times=times) + "\n".join(rows) + "\nEnd TriggerBlock\n"


CLASSIC = "1  100             Rx   d 4 {data}"
LINES = [f"{k:02X}000000" for k in range(100)]
TEXTS = {
    "ASC": asc(CLASSIC),
    "ASC, relative": asc(CLASSIC, ["0.000000", *["0.010000"] * 99], "relative"),
    "ASC, decimal comma": asc(CLASSIC, [f"{0.01 * k:.6f}".replace(".", ",") for k in range(100)]),
    "ASC, BOM": "\ufeff" + asc(CLASSIC),
    "ASC, no date": asc(CLASSIC).partition("\n")[2],
    "ASC, a date that nobody can read, and a late frame": asc(CLASSIC)
    .replace("Mon Jan", "Some Day")
    .replace("\n   0.06", "\n   0.045 1  101             Rx   d 1 00\n   0.06", 1),
    "ASC, nothing but the base": "base hex timestamps absolute\n" + asc(CLASSIC).partition("logged\n")[2],
    "ASC, comments above": "// of a tool\n" + asc(CLASSIC),
    "ASC, frames by name": asc(CLASSIC.replace(" 100 ", " Motor ") + "  ID = 256"),
    "ASC, frames by a name of hexadecimal digits": asc(CLASSIC.replace(" 100 ", " DCDC ") + "  ID = 256"),
    "ASC, frames by name and number": asc(CLASSIC + "  Length = 10 BitCount = 4 ID = 256"),
    "ASC, requests to send": asc(CLASSIC).replace("\n   0.05", "\n   0.045 1  100 TxRq d 4 01 00 00 00\n   0.05", 1),
    "ASC, CAN FD": asc("CANFD   1 Rx  100  Motor   1 0 4  4 {data}   130000  130 303000"),
    "ASC, CAN FD without names": asc("CANFD   1 Rx  100   1 0 4  4 {data}   130000  130 303000"),
    "ASC, empty CAN FD": asc("CANFD   1 Rx  100   1 0 4  4 {data}").replace(
        "End Trigger", "   0.995000 CANFD   1 Rx   7FF   1 0 0 0\nEnd Trigger"
    ),
    "ASC, events": asc(CLASSIC).replace("\n   0.05", "\n   0.045 CAN 1 Status:chip status error active\n   0.05", 1),
    "candump -l": "\n".join(f"({1.7e9 + 0.01 * k:.6f}) can0 100#{data}" for k, data in enumerate(LINES)),
    "candump -L, Rx": "\n".join(f"({1.7e9 + 0.01 * k:.6f}) can0 100#{data} R" for k, data in enumerate(LINES)),
    "candump, CAN FD": "\n".join(f"({1.7e9 + 0.01 * k:.6f}) can0 100##1{data}" for k, data in enumerate(LINES)),
    "candump -t a": "\n".join(
        f" ({1.7e9 + 0.01 * k:.6f})  can0  100   [4]  {k:02X} 00 00 00" for k in range(100)
    ),
    "candump -t d -x": "\n".join(
        f" (000.{10000 * (k > 0):06})  can0  RX - -  100   [4]  {k:02X} 00 00 00" for k in range(100)
    ),
    "candump -t z, a coarse clock": "\n".join(
        f" (000.{10 * (k // 2):03}000)  can0  {100 + k % 2}   [4]  {k // 2:02X} 00 00 00" for k in range(200)
    ),
    "candump, comment above, cut off": "# can0\n"
    + "\n".join(f"({1.7e9 + 0.01 * k:.6f}) can0 100#{data}" for k, data in enumerate([*LINES, "0"])),
    "candump, cut off in the time": "\n".join(
        [*(f"({1.7e9 + 0.01 * k:.6f}) can0 100#{data}" for k, data in enumerate(LINES)), "(17000"]
    ),
    "candump -t A -a": "\n".join(
        f" (2026-01-05 10:15:{30.0 + 0.01 * k:09.6f})  can0  100   [4]  {k:02X} 00 00 00   '....'" for k in range(100)
    ),
    "TRC 1.0": ";##########################################\n;   Message\n"
    + "\n".join(f"{k + 1:6}) {10 * k:8}      0100  4  {k:02X} 00 00 00" for k in range(100)),
    "TRC 1.1": ";$FILEVERSION=1.1\n;$STARTTIME=46027.4275\n"
    + "\n".join(f"{k + 1:6}) {10 * k:10.1f}  Rx         0100  4  {k:02X} 00 00 00" for k in range(100)),
    "TRC 2.1": ";$FILEVERSION=2.1\n;$STARTTIME=46027.4275\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n"
    + "\n".join(f"{k + 1:7} {10 * k:13.3f} DT  1      0100 Rx -  4    {k:02X} 00 00 00" for k in range(100)),
}  # fmt: skip


@together("name", TEXTS)
def test_a_log_of_every_kind_is_read(tmp_path: Path, name: str) -> None:
    path, databases = write(tmp_path, [])
    path.write_text(TEXTS[name], encoding="utf-8")
    torque = Channels(path, databases=databases).read("T_mot")["T_mot"]
    np.testing.assert_allclose(torque.time, 0.01 * np.arange(100), atol=1e-6)
    np.testing.assert_allclose(torque.values, 0.1 * np.arange(100), atol=1e-9)


def test_a_second_measurement_in_a_log_goes_on_by_its_date(tmp_path: Path) -> None:
    path, databases = write(tmp_path, [])
    second = asc(CLASSIC).replace("10:15:30", "10:15:40").partition("logged\n")[2]
    path.write_text(asc(CLASSIC) + second, encoding="utf-8")
    with pytest.raises(RecordingError, match=r"gap of 9\.01 s after 0\.99 s; .* --from (0 --to 0\.99|10 --to 10\.99)$"):
        Channels(path, databases=databases).read("T_mot")
    late = Channels(path, databases=databases, cut=Cut(read_clock("2026-01-05 10:15:40"))).read("T_mot")["T_mot"]
    assert (late.time[0], late.time[-1]) == (10.0, pytest.approx(10.99))


DATABASES = {
    "byte-order mark": DBC.encode("utf-8-sig"),
    "UTF-8": DBC.replace('"Nm"', '"N·m"').encode(),
    "Latin-1": DBC.replace('"Nm"', '"N·m"').encode("latin-1"),
    "no flag of an extended identifier": DBC.replace("BO_ 2566848786", f"BO_ {BRAKE}").encode(),
}


@together("name", DATABASES)
def test_a_database_of_every_tool_is_read(tmp_path: Path, name: str) -> None:
    path, databases = write(tmp_path, drive())
    databases[0].write_bytes(DATABASES[name])
    recording = read_drive(path, databases=databases)
    np.testing.assert_allclose(recording.T_mot, 20.0 + np.round(100.0 * recording.time), rtol=1e-12)
    np.testing.assert_allclose(recording.v, 10.0)


@pytest.mark.parametrize(
    ("old", "new", "differs"),
    [
        ("(0.1,0)", "(0.2,0)", r"scale of Motor_Torque \(0\.1 and 0\.2\)"),
        ("0|16@1- (0.1,0)", "0|15@1- (0.1,0)", "length of Motor_Torque"),
        ("0|16@1- (0.1,0)", "0|16@1+ (0.1,0)", "is signed of Motor_Torque"),
        ('"Nm"', '"kNm"', r"unit of Motor_Torque \(Nm and kNm\)"),
        ("Motor_Torque", "Torque", "signal Motor_Torque, which only one has"),
        ("Motor: 4", "Motor: 8", "its length"),
        ('1 "on"', '2 "on"', "the named values of State"),
        ("ECU", "OTHER", ""),
        ("BO_ 257 Many: 3 ECU\n SG_ Which M : 0|8@1+ (1,0)", "BO_ 258 Many: 3 ECU\n SG_ Which M : 0|8@1+ (1,0)", ""),
    ],
)
def test_what_two_databases_declare_differently_is_refused_with_both_names(
    tmp_path: Path, old: str, new: str, differs: str
) -> None:
    path, (first,) = write(tmp_path, drive())
    second = tmp_path / "body.dbc"
    second.write_text(DBC.replace(old, new), encoding="ascii")
    for databases in ([first, second], [second, first]):
        if differs:
            with pytest.raises(
                RecordingError, match=r"\.dbc and .*\.dbc both know frame 0x100, and differ in "
            ) as said:
                opened(path, databases)
            assert {"bus.dbc", "body.dbc"} <= set(str(said.value).replace("/", " ").split())
            assert databases == [second, first] or re.search(differs, str(said.value))
        else:
            assert len(read_drive(path, databases=databases).time) > 50


def test_a_named_value_of_a_signal_with_a_unit_is_none(tmp_path: Path) -> None:
    path, databases = write(tmp_path, drive())
    databases[0].write_text(DBC + 'VAL_ 256 Motor_Torque 500 "SNA" 300 "Init" ;\n', encoding="ascii")
    torque = Channels(path, databases=databases).read("T_mot")["T_mot"]
    np.testing.assert_allclose(torque.values, 20.0 + np.round(100.0 * torque.time))  # they are filled
    assert [missing.times.tolist() for missing in torque.missing] == [pytest.approx([0.1, 0.3], abs=1e-6)]
