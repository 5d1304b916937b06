"""The database of the bus says what the blocks declare."""

from pathlib import Path
from typing import Any

import pytest

from driveline.fmus.building.parameter_files import read_vehicle
from driveline.harness.commands.cli import main
from driveline.harness.exchange.bus.database import telegrams, write_dbc
from driveline.models.motor_torque_loop import FRAMES
from driveline.models.wheel_speed_can import FRAME, OMEGA_MAX, Parameters
from fmuloop.errors import WiringError
from tests import ROOT

VAN = ROOT / "examples" / "cars" / "van.toml"


def loaded(path: Path) -> Any:
    import cantools

    return cantools.database.load_file(path)


def made(folder: Path, **values: float) -> Any:
    path = folder / "bus.dbc"
    write_dbc(telegrams(dict.fromkeys(("can", "motor"), values)), path)
    return loaded(path)


def speed_in(database: Any) -> Any:
    return database.get_message_by_name(FRAME.name).get_signal_by_name("Wheel_Speed")


def test_cantools_reads_the_wheel_speed_as_the_block_declares_it(tmp_path: Path) -> None:
    p = Parameters()
    message = made(tmp_path).get_message_by_name(FRAME.name)
    assert (message.frame_id, message.is_extended_frame, message.senders) == (FRAME.identifier, False, [FRAME.sender])
    assert message.cycle_time == round(1e3 * p.T_cyc)
    speed = message.get_signal_by_name("Wheel_Speed")
    assert (speed.unit, speed.length, speed.is_signed, speed.offset, speed.minimum) == ("km/h", 16, False, 0, 0)
    assert speed.scale == pytest.approx(0.5 * 3.6 * p.q_v, rel=1e-12)
    assert speed.maximum == pytest.approx(3.6 * p.r * OMEGA_MAX)
    assert [message.get_signal_by_name(f"Wheel_Speed_{what}").length for what in ("Valid", "Counter")] == [1, 8]


@pytest.mark.parametrize(
    ("values", "cycle", "scale"), [({"T_cyc": 0.01}, 10, 0.03125), ({"T_cyc": 0.05, "q_v": 0.5 / 3.6}, 50, 0.25)]
)
def test_another_cycle_and_resolution_are_in_the_database(tmp_path: Path, values, cycle: int, scale: float) -> None:
    message = made(tmp_path, **values).get_message_by_name(FRAME.name)
    assert message.cycle_time == cycle
    assert message.get_signal_by_name("Wheel_Speed").scale == scale


def test_the_range_is_that_of_the_wheels_and_a_finer_resolution_takes_more_bits_until_there_are_none(
    tmp_path: Path,
) -> None:
    assert main(["bus", "--vehicle", str(VAN), "--output", str(tmp_path), "--quiet"]) == 0
    speed = speed_in(loaded(tmp_path / "driveline.dbc"))
    assert speed.maximum == pytest.approx(3.6 * read_vehicle(VAN)["r"] * OMEGA_MAX)
    largest = Parameters().r * OMEGA_MAX
    for bits in (16, 17, 32):
        finest = 2.0 * largest / (2**bits - 1)
        speed = speed_in(made(tmp_path, q_v=finest))
        assert speed.length == bits
        assert speed.maximum / speed.scale <= 2**bits
    for q_v in (0.99 * finest, 0.0):
        with pytest.raises(WiringError, match=r"Wheel_Speed in steps of .* km/h: 32 bits do not hold 522 km/h"):
            telegrams({"can": {"q_v": q_v}})


def test_what_the_motor_says_is_in_single_precision_and_has_its_meaning(tmp_path: Path) -> None:
    database = made(tmp_path)
    for frame in FRAMES:
        message = database.get_message_by_name(frame.name)
        assert (message.frame_id, message.cycle_time) == (frame.identifier, 2)
        for signal in message.signals:
            assert (signal.is_float, signal.length) == (True, 32)
            assert signal.comment
    assert len({message.frame_id for message in database.messages}) == 3
    before = (tmp_path / "bus.dbc").read_bytes()
    made(tmp_path)
    assert (tmp_path / "bus.dbc").read_bytes() == before
