"""The FMU that sends its frames over a bus sends those of a run."""

from pathlib import Path
from typing import Any

import pytest

from driveline.harness.exchange.bus.database import messages, telegrams
from driveline.harness.exchange.bus.log import frames
from driveline.models.wheel_speed_can import FRAME
from tests import ROOT
from tests.fmus.bus import Node, frame_in

VAN = ROOT / "examples" / "cars" / "van.toml"
STEP = 1e-3


def fed(node: Node, results: Any, stride: int, size: float) -> list[tuple[float, int, bytes]]:
    """Time, identifier and data of the frames that a node sends with the wheel speeds of a run.

    Args:
        stride: rows of the run in a communication step.
        size: of that in s.
    """
    node.start(
        loss=0.1,
        omega_wheel_L=float(results["plant.omega_wheel_L"][0]),
        omega_wheel_R=float(results["plant.omega_wheel_R"][0]),
    )
    node.flush()
    found = []
    for k in range(0, len(results) - stride, stride):
        row = results[k]
        if node.step(size, row["plant.omega_wheel_L"], row["plant.omega_wheel_R"]):
            found += [(node.time, *frame_in(operation)) for operation in node.events()]
    return found


def test_its_frames_are_those_of_the_log_of_the_same_run(sender: Path, results: Any, tmp_path: Path) -> None:
    sent = telegrams({})
    (expected,) = (
        list(frames(telegram, message, results))
        for telegram, message in zip(sent, messages(sent), strict=True)
        if telegram.frame is FRAME
    )
    found = fed(Node(sender, tmp_path), results, 1, STEP)
    assert [frame[1:] for frame in found] == [frame[1:] for frame in expected]
    assert [frame[0] for frame in found] == pytest.approx([frame[0] for frame in expected], abs=1e-9)
    assert len(found) > 100
