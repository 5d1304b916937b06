"""Wrong signs, wrong units and exchanged channels show in what the channels have to do with each other."""

import numpy as np
import pytest
from scipy.optimize import root_scalar

from driverecords.relations import FAST, LINK, OPPOSED, OTHERS, RATIO, SIZE, SLOW, band, links, low
from driverecords.source import RecordingError

from .car import drive
from .conftest import Read

INTERVAL = 0.002


@pytest.mark.parametrize("names", [("omega_1", "omega_2"), ("T_mot", "T_load")])
def test_exchanged_channels_are_named(read: Read, names: tuple[str, str]) -> None:
    signals, (a, b) = drive(), names
    with pytest.raises(RecordingError, match=rf"are {a} \[.*\] and {b} \[.*\] exchanged\?"):
        read(signals | {a: signals[b], b: signals[a]})


def test_channels_are_only_exchanged_if_it_is_certain(read: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a wide gap the teeth hit hard, and the motor feels what the wheels feel."""
    correlations = {("T_mot", "omega_1"): 0.4, ("T_load", "omega_1"): -0.99 * OTHERS}
    monkeypatch.setattr("driverecords.relations.links", lambda *_: correlations)
    read(drive())
    correlations["T_load", "omega_1"] = -1.01 * OTHERS
    with pytest.raises(RecordingError, match=r"exchanged\?"):
        read(drive())


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("omega_1", r"omega_1 .*follows T_mot .*correlation -.*one of them has the wrong sign"),
        ("T_mot", r"omega_1 .*follows T_mot .*correlation -.*one of them has the wrong sign"),
        ("omega_2", "turn against each other"),
        ("T_load", r"T_load .*acts with T_mot .*its sign is wrong"),
        ("T_ref", r"T_ref .* asks for the opposite of T_mot .*one of them has the wrong sign"),
    ],
)
def test_a_channel_of_the_wrong_sign_is_named(read: Read, name: str, message: str) -> None:
    with pytest.raises(RecordingError, match=message):
        read(drive() | {name: -drive()[name]})


def test_the_demand_of_a_fast_motor_is_not_taken_for_its_torque(read: Read) -> None:
    signals, noise = drive(), np.random.default_rng(1).standard_normal(len(drive()["time"]))
    read(signals | {"T_mot": signals["T_mot"] + noise, "T_ref": signals["T_mot"]})


@pytest.mark.parametrize("unit", [60.0 / (2.0 * np.pi), 1.0 / 3.6, 9.0])
def test_a_speed_in_another_unit_than_is_said_is_named(read: Read, unit: float) -> None:
    with pytest.raises(RecordingError, match=r"omega_1 .* is .* times what omega_2"):
        read(drive() | {"omega_1": unit * drive()["omega_1"]})


def test_the_ratio_of_the_speeds_just_inside_and_just_outside(read: Read) -> None:
    signals = drive()
    ratio = float(signals["omega_1"] @ signals["omega_2"] / (signals["omega_2"] @ signals["omega_2"]))
    for side in (1.0, -1.0):
        read(signals | {"omega_1": (1.0 + side * (RATIO - 1e-4)) / ratio * signals["omega_1"]})
        with pytest.raises(RecordingError, match="times what"):
            read(signals | {"omega_1": (1.0 + side * (RATIO + 1e-4)) / ratio * signals["omega_1"]})


@pytest.mark.parametrize("name", ["T_load", "T_ref"])
def test_the_size_of_a_slow_torque_just_inside_and_just_outside(read: Read, name: str) -> None:
    signals = drive()
    size = np.std(low(signals[name], INTERVAL, SLOW)) / np.std(low(signals["T_mot"], INTERVAL, SLOW))
    for factor, odd in ((SIZE, 1.001), (1.0 / SIZE, 0.999)):
        read(signals | {name: factor / odd / size * signals[name]})
        with pytest.raises(RecordingError, match=rf"{name} .* times as large as T_mot"):
            read(signals | {name: factor * odd / size * signals[name]})


def test_the_correlation_of_the_load_just_inside_and_just_outside(read: Read) -> None:
    signals = drive()
    T, other = low(signals["T_mot"], INTERVAL, SLOW), np.sin(0.9 * signals["time"])
    T, other = T - T.mean(), other - other.mean()
    other -= T * (T @ other) / (T @ T)
    for correlation in (OPPOSED - 0.02, OPPOSED + 0.02):
        mixed = correlation * T / np.std(T) + np.sqrt(1.0 - correlation**2) * other / np.std(other)
        if correlation < OPPOSED:
            read(signals | {"T_load": 5.0 * mixed})
        else:
            with pytest.raises(RecordingError, match="its sign is wrong"):
                read(signals | {"T_load": 5.0 * mixed})


def test_the_link_of_torque_and_speed_just_inside_and_just_outside(read: Read) -> None:
    """A torque of the wrong sign, in noise that hides it more and more."""
    signals = drive()
    noise = np.random.default_rng(1).standard_normal(len(signals["time"]))

    def link(size: float) -> float:
        return links(INTERVAL, {"T_mot": size * noise - signals["T_mot"], "omega_1": signals["omega_1"]})[
            "T_mot", "omega_1"
        ]

    hidden = root_scalar(lambda size: link(size) + LINK, bracket=(0.0, 200.0), xtol=1e-3).root
    alone = {name: values for name, values in signals.items() if name not in ("T_load", "T_ref")}
    read(alone | {"T_mot": (hidden + 0.1) * noise - signals["T_mot"]})
    with pytest.raises(RecordingError, match="wrong sign"):
        read(alone | {"T_mot": (hidden - 0.1) * noise - signals["T_mot"]})


def test_a_car_that_stands_has_no_ratio_of_speeds(read: Read) -> None:
    signals = drive()
    read(
        signals
        | {name: signals[name] - 130.0 for name in ("omega_1", "omega_2")}
        | {"omega_2": 0.1 * np.sin(signals["time"])}
    )


def test_the_band_lets_through_what_lies_in_it() -> None:
    time = drive()["time"]
    for frequency, passes in ((5.0, 0.0), (35.0, 1.0), (150.0, 0.0)):
        wave = np.sin(2.0 * np.pi * frequency * time)
        assert np.std(band(wave, INTERVAL, FAST)[500:-500]) / np.std(wave) == pytest.approx(passes, abs=0.1)
