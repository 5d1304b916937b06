"""Delays between channels are found as they were made."""

import numpy as np
import pytest

from driveline.harness.recordings.delays import EARLIEST, LATEST, _fitted, estimated
from driveline.harness.recordings.filters import low
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


@pytest.mark.parametrize(("interval", "frequency"), [(0.005, 5.0), (0.002, 15.0)])
def test_the_deviation_of_a_delay_is_the_scatter_of_what_is_found(interval: float, frequency: float) -> None:
    """Over recordings with noise of their own, as slow as the signal: of its power over 2 f T independent values, and
    the slope of the signal."""
    random, n, fine, share = np.random.default_rng(8), 1000, 5, 0.2
    compared = slice(round(LATEST / interval), n + round(EARLIEST / interval))
    T = n * interval - LATEST + EARLIEST
    off, ratios = [], []
    for _ in range(50):
        signal, noise = (low(random.standard_normal(fine * n), interval / fine, frequency) for _ in range(2))
        slope = np.gradient(signal, interval / fine)[::fine][compared].std()
        noise = (share * signal.std() / noise.std() * noise)[::fine]
        late = np.roll(signal, 17)[::fine] + noise
        found, deviation, _ = _fitted(interval, frequency, late, [signal[::fine]])
        off.append((found - 3.4 * interval) / deviation)
        ratios.append(deviation * slope * np.sqrt(2.0 * frequency * T) / noise[compared].std())
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.06)
    assert np.std(off) < 1.1, "no smaller than the scatter"
