"""Channels of different rates on one time base."""

import numpy as np
import pytest

from driverecords.alignment import aligned
from driverecords.channels import Channel
from driverecords.file_units import FileUnit
from driverecords.source import RecordingError


def channel(quantity: str, time: np.ndarray, values: np.ndarray) -> Channel:
    return Channel(quantity, quantity, "N.m", time, values, lambda k: f"sample {k + 1}", FileUnit("N.m"))


FAST, SLOW = np.arange(0.0, 1.0, 0.002), np.arange(0.001, 1.0, 0.004)


def wave(t: np.ndarray) -> np.ndarray:
    return np.sin(2.0 * np.pi * 8.0 * t)


def test_what_was_sampled_together_is_left_as_it_is() -> None:
    values = np.random.default_rng(1).standard_normal((2, len(FAST)))
    channels = {"omega_1": channel("omega_1", FAST, values[0]), "T_mot": channel("T_mot", FAST, values[1])}
    time, on_base = aligned(channels, "omega_1")
    assert time is FAST
    assert on_base["T_mot"] is channels["T_mot"].values


def test_a_slower_channel_is_interpolated_by_cubics_and_not_by_lines() -> None:
    channels = {"omega_1": channel("omega_1", FAST, wave(FAST)), "T_load": channel("T_load", SLOW, wave(SLOW))}
    time, on_base = aligned(channels, "omega_1")
    inner = slice(3, -3)
    cubic = np.abs(on_base["T_load"] - wave(time))[inner].max()
    lines = np.abs(np.interp(time, SLOW, wave(SLOW)) - wave(time))[inner].max()
    assert cubic < 1e-4 < 3e-3 < lines


def test_the_time_is_what_all_have_in_common() -> None:
    channels = {"omega_1": channel("omega_1", FAST, wave(FAST)), "T_load": channel("T_load", SLOW + 0.5, wave(SLOW))}
    time, _ = aligned(channels, "omega_1")
    assert time[0] >= 0.501
    assert time[-1] == FAST[-1]


def test_a_message_counts_from_the_sample_at_which_it_has_arrived() -> None:
    messages = np.array([0.0, 0.1, 0.1005, 0.3])
    channels = {
        "omega_1": channel("omega_1", FAST, wave(FAST)),
        "omega_2": channel("omega_2", messages, np.array([1.0, 2.0, 3.0, 4.0])),
    }
    time, on_base = aligned(channels, "omega_1", received={"omega_2"})
    assert len(time) == len(FAST), "the last message holds to the end"
    for t, value in ((0.0, 1.0), (0.098, 1.0), (0.1, 2.0), (0.102, 3.0), (0.298, 3.0), (0.3, 4.0), (0.998, 4.0)):
        assert on_base["omega_2"][round(t / 0.002)] == value, t


def test_channels_that_were_not_recorded_together_are_refused() -> None:
    channels = {"omega_1": channel("omega_1", FAST, wave(FAST)), "T_load": channel("T_load", SLOW + 9.0, wave(SLOW))}
    with pytest.raises(RecordingError, match=r"not recorded together: omega_1 0 to 0\.998 s, T_load 9\.001 to"):
        aligned(channels, "omega_1")
