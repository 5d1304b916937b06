"""Delays between channels are found as they were made."""

import numpy as np
import pytest

from driveline.harness.recordings.delays import estimated
from tests.harness.recordings.car import drive
from tests.harness.recordings.conftest import Read


def late(name: str, time: float) -> dict[str, np.ndarray]:
    one = drive()
    return one | {name: np.interp(one["time"] - time, one["time"], one[name])}


def delays(signals: dict[str, np.ndarray]) -> dict[str, float]:
    return {delay.of: delay.time for delay in estimated(0.002, signals)}


@pytest.mark.parametrize("time", [-0.01, 0.0, 0.02, 0.05])
def test_the_delay_of_the_wheel_speed(time: float) -> None:
    without, found = delays(late("omega_2", 0.0))["omega_2"], delays(late("omega_2", time))["omega_2"]
    assert without == pytest.approx(0.0, abs=2e-3)
    assert found - without == pytest.approx(time, abs=1e-3)


@pytest.mark.parametrize("time", [-0.004, 0.004, 0.01])
def test_the_load_is_late_by_what_is_added_to_what_the_wheels_take(time: float) -> None:
    without, found = delays(drive())["T_load"], delays(late("T_load", time))["T_load"]
    assert found - without == pytest.approx(time, abs=2e-4)


def test_a_wheel_speed_in_messages_is_late_by_their_age() -> None:
    one = drive()
    sent = np.floor(one["time"] / 0.02 + 1e-9) * 0.02 - 0.02
    held = one | {"omega_2": np.interp(sent, one["time"], one["omega_2"])}
    assert delays(held)["omega_2"] == pytest.approx(0.029, abs=2e-3), "20 ms, and between 0 and 18 ms until the next"


def test_what_fits_badly_has_no_delay() -> None:
    noise = np.random.default_rng(1).standard_normal(len(drive()["time"]))
    assert delays(drive() | {"omega_2": 130.0 + noise, "T_load": noise}) == {}


def test_delays_are_told_with_the_recording(read: Read) -> None:
    assert [(delay.of, delay.behind) for delay in read(drive()).delays] == [("omega_2", "omega_1"), ("T_load", "T_mot")]
