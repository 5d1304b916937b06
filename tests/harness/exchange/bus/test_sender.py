"""The FMU that sends its frames over a bus sends those of a run."""

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmutesting.bus import Node, frame_in

from driveline.harness.commands.cli import main
from driveline.harness.exchange.bus.database import messages, telegrams
from driveline.harness.exchange.bus.log import frames
from driveline.models.wheel_speed_can import FRAME, Parameters
from fmublocks.description.terminal import FOLDER, TERMINAL

P = Parameters()


def fed(node: Node, results: Any, **parameters: float) -> list[tuple[float, int, bytes]]:
    """Time, identifier and data of the frames that a node sends with the wheel speeds of a run."""
    speeds = np.column_stack([results["plant.omega_wheel_L"], results["plant.omega_wheel_R"]]).tolist()
    node.start(loss=0.1, omega_wheel_L=speeds[0][0], omega_wheel_R=speeds[0][1], **parameters)
    node.flush()
    found = []
    for inputs in speeds[:-1]:
        if node.step(1e-3, *inputs):
            found += [(node.time, *frame_in(operation)) for operation in node.events()]
    return found


def of_wheel_speed(values: dict[str, float]) -> tuple[Any, Any]:
    """The telegram and its message for a car."""
    sent = telegrams(dict.fromkeys(("can", "motor"), values))
    return next(pair for pair in zip(sent, messages(sent), strict=True) if pair[0].frame is FRAME)


def received(node: Node) -> float:
    """In rad/s, motor side."""
    return node.fmu.getFloat64([node.references["omega_2_can"]])[0]


def test_its_frames_are_those_of_the_log_and_its_database_stays_true(
    sender: Path, results: Any, tmp_path: Path
) -> None:
    expected = list(frames(*of_wheel_speed({}), results))
    found = fed(Node(sender, tmp_path), results)
    assert [frame[1:] for frame in found] == [frame[1:] for frame in expected]
    assert [frame[0] for frame in found] == pytest.approx([frame[0] for frame in expected], abs=1e-9)
    assert len(found) > 100
    with zipfile.ZipFile(sender) as archive:
        assert archive.read(f"{FOLDER}/{TERMINAL}.dbc") == sender.with_name("driveline.dbc").read_bytes()
    node = Node(sender, tmp_path)
    last = of_wheel_speed({})[1].decode(fed(node, results, q_v=0.001)[-1][2])
    assert last["Wheel_Speed"] == pytest.approx(3.6 * received(node) * P.r / P.i, abs=0.03125 / 2)


def test_a_car_with_other_wheels_and_a_finer_bus_has_its_own_layout(results: Any, tmp_path: Path) -> None:
    """The speed has 17 bits, so that validity and counter stand elsewhere."""
    car = tmp_path / "car.toml"
    car.write_text("q_v = 0.004\nr = 0.35\n")
    assert main(["bus", "--fmu", "--vehicle", str(car), "--output", str(tmp_path), "--quiet"]) == 0
    telegram, message = of_wheel_speed({"q_v": 0.004, "r": 0.35})
    assert telegram.signals[0].bits == 17
    node = Node(tmp_path / "WheelSpeedCan.fmu", tmp_path / "unpacked")
    last = message.decode(fed(node, results)[-1][2])
    assert last["Wheel_Speed_Valid"] == 1
    assert last["Wheel_Speed_Counter"] == node.fmu.getInt32([node.references["counter"]])[0] % 256
    assert last["Wheel_Speed"] == pytest.approx(3.6 * received(node) * 0.35 / P.i, rel=1e-9)


def test_without_a_compiler_nothing_is_written(tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.setenv("CC", "no-such-compiler")
    assert main(["bus", "--fmu", "--output", str(tmp_path)]) != 0
    assert "there is no C compiler" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
