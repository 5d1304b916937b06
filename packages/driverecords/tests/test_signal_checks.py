"""Every defect of a channel is named; what is just good enough is read."""

from pathlib import Path

import numpy as np
import pytest

from driverecords.channel_rules import CUT_OFF
from driverecords.channels import Channel
from driverecords.file_units import FileUnit
from driverecords.quantities import QUANTITIES
from driverecords.signal_checks import SHORTEST, check_signal
from driverecords.source import RecordingError

from .car import drive
from .conftest import Read


def cut(samples: int, stride: int = 1) -> dict[str, np.ndarray]:
    return {name: values[: samples * stride : stride].copy() for name, values in drive().items()}


def test_a_drive_without_defects_is_read_without_a_word(read: Read) -> None:
    assert read(drive()).warnings == []


def test_the_shortest_recording(read: Read) -> None:
    samples = round(SHORTEST / 0.002) + 1
    assert len(read(cut(samples)).time) == samples
    with pytest.raises(RecordingError, match=r"omega_1 \[rad/s\] is 1\.998 s long; 2 s or more are needed"):
        read(cut(samples - 1))
    with pytest.raises(RecordingError, match=r"1\.998 s long"):
        read(cut(samples - 1) | {"time": 100.0 + cut(samples - 1)["time"]})


@pytest.mark.parametrize(
    ("name", "slowest"), [("T_mot", 0.01), ("omega_1", 0.01), ("T_wheel", 0.01), ("T_ref", 0.1), ("omega_wheel", 0.1)]
)
def test_how_slow_each_channel_may_be(name: str, slowest: float) -> None:
    for share in (1.0, 1.01):
        time = np.arange(0.0, 10.0, share * slowest)
        values = 100.0 * np.sin(time)
        channel = Channel(name, name, QUANTITIES[name].unit, time, values, str, FileUnit("N.m"))
        if share == 1.0:
            check_signal(Path("measured.csv"), channel)
        else:
            with pytest.raises(RecordingError, match="or less are needed to identify anything"):
                check_signal(Path("measured.csv"), channel)


@pytest.mark.parametrize("name", ["T_mot", "T_ref", "omega_1", "T_load", "omega_2"])
def test_a_channel_that_hardly_varies(name: str) -> None:
    least = QUANTITIES[name].least_swing
    wave = np.sin(drive()["time"])

    def channel(swing: float) -> Channel:
        values = 100.0 + swing * (wave - wave.min()) / np.ptp(wave)
        return Channel(name, name, QUANTITIES[name].unit, drive()["time"], values, str, FileUnit("N.m"))

    check_signal(Path("measured.csv"), channel(least + 1e-6))
    with pytest.raises(RecordingError, match=rf"{name} varies by .*; more than {least:g} .* are needed"):
        check_signal(Path("measured.csv"), channel(max(least - 1e-6, 0.0)))


@pytest.mark.parametrize("name", ["omega_1", "T_load"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_channel_that_was_cut_off_is_named(read: Read, name: str, sign: float) -> None:
    signals = drive()
    values = sign * signals[name]
    top = int(np.argmax(values[50:-50])) + 50
    for length in (int(CUT_OFF) - 1, int(CUT_OFF)):
        flat = values.copy()
        flat[top : top + length] = values[top]
        warnings = read(signals | {name: sign * flat}).warnings
        if length < CUT_OFF:
            assert warnings == []
        else:
            word = "largest" if sign > 0.0 else "smallest"
            assert [f"line {top + 2}: {name} " in text and word in text for text in warnings] == [True]


def test_the_torque_of_a_binary_demand_is_not_cut_off(read: Read) -> None:
    signals = drive()
    assert read(signals | {"T_mot": np.clip(signals["T_mot"], -19.0, 39.0)}).warnings == []
