"""Diagnostics name what is likely to be wrong, or is not told, in words of the car; and only that."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from fmutesting.together import together
from scipy.signal import lfilter

from driveline.harness.identification.diagnostics import (
    CLOSE,
    COLOURED,
    CROWD,
    DEMAND_LATE,
    FLANK,
    LACKING,
    LAG_OFF,
    LOAD_GAIN,
    LONELY,
    MODEL_GAIN,
    OF_TYRE,
    OUTLIER,
    SKEWED,
    SURELY,
    TOGETHER,
    ZERO,
    diagnose_excitation,
    diagnose_model,
    diagnose_offsets,
    diagnose_outliers,
    diagnose_parameters,
    diagnose_spectrum,
    diagnose_torque_loop,
    is_coloured,
)
from driveline.harness.identification.drive_train import State
from driveline.harness.identification.estimator import UNTOLD, Z_95, Found
from driveline.harness.identification.model_inputs import LATEST
from driveline.harness.identification.prediction import Predicted
from driveline.harness.identification.priors import PRIORS
from driveline.harness.identification.torque_loop import ANSWERS, FittedLoop, TorqueLoop
from tests.harness.identification.simulated import NOISE, T_S, P, found, simulated

CAR = P._replace(g_T=1.0, g_L=1.0)


class Known(Found):
    """With deviations that are given, all told by the motor speed."""

    given: dict[str, float]

    @property
    def deviations(self) -> dict[str, float]:  # type: ignore[override]
        return self.given

    def told_by(self, name: str) -> str:
        unit = getattr(self.p, name) if PRIORS[name].positive else 1.0
        return "" if self.given[name] > UNTOLD * PRIORS[name].deviation * unit else "motor speed"


def known(deviations: dict[str, float] | None = None, phi: np.ndarray | None = None, **values: float) -> Found:
    """The car with other values, surely or as surely as is given."""
    given = {"J_2": 1e-4, "C": 1e-2, "phi_B": 1e-4, "g_T": 1e-4, "g_L": 1e-4, "late_T": 1e-5, "late_L": 1e-5}
    predicted = found().predicted if phi is None else through(np.ones(len(phi)), phi=phi)
    one = Known(**{**vars(found()), "p": CAR._replace(lack_1=0.0, lack_L=0.0, **values), "predicted": predicted})
    object.__setattr__(one, "given", given | (deviations or {}))
    object.__setattr__(one, "free", tuple(one.given))
    return one


def text(messages: Iterator[str]) -> str:
    """Of the one message; empty if there is none."""
    every = list(messages)
    assert len(every) <= 1
    return every[0] if every else ""


def test_nothing_is_said_of_a_drive_that_is_as_it_should_be() -> None:
    one = known()
    for messages in (diagnose_parameters(one), diagnose_model(one, 92.0), diagnose_excitation(one)):
        assert list(messages) == []


@pytest.mark.parametrize(("name", "channel"), [("late_T", "motor torque"), ("late_L", "load torque")])
@pytest.mark.parametrize("deviation", [1e-5, SKEWED])
@pytest.mark.parametrize(("sign", "word"), [(1.0, "late"), (-1.0, "early")])
def test_a_skew_is_named_from_its_thresholds_on(
    name: str, channel: str, deviation: float, sign: float, word: str
) -> None:
    least = sign * max(SKEWED, SURELY * deviation)
    assert text(diagnose_parameters(known({name: deviation}, None, **{name: 0.999 * least}))) == ""
    message = text(diagnose_parameters(known({name: deviation}, None, **{name: 1.001 * least})))
    assert message.startswith(f"{channel} comes {1.001e3 * abs(least):.1f} ms {word}, against motor speed,")


@pytest.mark.parametrize(("apart", "both"), [(0.99, True), (1.01, False)])
def test_both_torques_late_alike_are_a_motor_speed_that_is_early(apart: float, both: bool) -> None:
    messages = list(diagnose_parameters(known(late_T=-0.0009, late_L=-0.0009 - apart * TOGETHER)))
    assert len(messages) == (1 if both else 2)
    if both:
        assert messages[0].startswith("motor speed comes 1.0 ms late (or both torques 1.0 ms early),")


@pytest.mark.parametrize("name", ["J_2", "C"])
def test_no_cause_is_named_where_the_drive_train_is_hardly_known(name: str) -> None:
    for factor, named in ((0.99, True), (1.01, False)):
        hardly = known({name: factor * CLOSE * getattr(P, name) / Z_95}, late_T=0.001, g_L=1.3)
        assert bool(list(diagnose_parameters(hardly))) == named


def test_a_skew_as_long_as_is_looked_at_may_be_longer() -> None:
    assert " comes 6.0 ms or more late," in text(diagnose_parameters(known(late_L=LATEST)))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("lack", [0.0, 1.1 * LACKING * NOISE.omega_1])
def test_a_motor_torque_that_is_scaled_is_named_and_what_else_it_may_be(sign: float, lack: float) -> None:
    """By more than what the model may lack, where it does not explain the car."""
    least = sign * (MODEL_GAIN if lack else SURELY * 1e-3)
    for factor, named in ((0.999, False), (1.001, True)):
        one = known({"g_T": 1e-3}, g_T=1.0 + factor * least)
        one = replace(one, p=one.p._replace(lack_1=lack))
        object.__setattr__(one, "given", {"g_T": 1e-3, "g_L": 1e-4, "late_T": 1e-5, "late_L": 1e-5})
        assert bool(text(diagnose_parameters(one))) == named
    assert f"or J_1 = 0.055 kg.m2 should be {0.055 * (1.0 + 1.001 * least):.4g}" in text(diagnose_parameters(one))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("deviation", [1e-4, LOAD_GAIN])
def test_a_load_torque_that_is_scaled_is_named(deviation: float, sign: float) -> None:
    least = sign * max(LOAD_GAIN, SURELY * deviation)
    for factor, named in ((0.999, False), (1.001, True)):
        assert bool(text(diagnose_parameters(known({"g_L": deviation}, g_L=1.0 + factor * least)))) == named


@pytest.mark.parametrize(
    ("name", "noise", "channel"),
    [("lack_1", NOISE.omega_1, "motor speed has"), ("lack_L", NOISE.T_load, "load torque has")],
)
def test_a_car_that_the_model_does_not_explain_is_named(name: str, noise: float, channel: str) -> None:
    for factor, named in ((0.99, False), (1.01, True)):
        one = known()
        one = replace(one, p=one.p._replace(**{name: factor * LACKING * noise}))
        message = text(diagnose_model(one, 92.0))
        assert bool(message) == named
    assert f"explain all of this car: {channel} more" in message


def test_a_load_torque_that_is_no_tyre_is_named() -> None:
    assert text(diagnose_model(known(), 1.01 * OF_TYRE)) == ""
    assert "not that of a tyre with a vehicle behind it (30 % explained)" in text(
        diagnose_model(known(), OF_TYRE - 0.1)
    )


@pytest.mark.parametrize(("side", "word"), [(-1.0, "drive"), (1.0, "brake")])
@pytest.mark.parametrize(("samples", "named"), [(FLANK * 1000, False), (FLANK * 1000 - 1, True)])
def test_teeth_must_spend_a_share_of_the_time_on_either_flank(
    side: float, word: str, samples: float, named: bool
) -> None:
    phi = np.full(1000, side * (P.phi_B + 0.1))
    phi[: round(samples)] *= -1.0
    assert (f"the teeth never {word}" in text(diagnose_excitation(known(phi=phi)))) == named


@pytest.mark.parametrize("name", ["J_2", "C", "phi_B"])
def test_what_is_hardly_known_or_not_told_is_named(name: str) -> None:
    value = getattr(P, name)
    untold, wide = UNTOLD * PRIORS[name].deviation * value, CLOSE * value / Z_95
    assert text(diagnose_excitation(known({name: 0.999 * wide}))) == ""
    assert text(diagnose_excitation(known({name: 1.001 * wide}))).startswith(
        f"{name}: 95 % interval wider than +- 10 %"
    )
    message = text(diagnose_excitation(known({name: 1.001 * untold})))
    assert f"({name}): there the answer is what is known of cars" in message


def through(size: np.ndarray, phi: np.ndarray | None = None, o_T: float = 0.0, o_L: float = 0.0) -> Predicted:
    at, n = State._make(range(len(State._fields))), len(size)
    x = np.zeros((n, len(State._fields)))
    x[:, at.phi] = 0.0 if phi is None else phi
    x[-1, at.o_T], x[-1, at.o_L] = o_T, o_L
    return Predicted(np.vstack([size, np.ones(n)]), np.zeros((2, n)), x, np.arange(100, n))


def test_a_zero_that_is_off_is_named_from_its_threshold_on() -> None:
    size = np.ones(1000)
    assert text(diagnose_offsets(through(size, o_T=0.99 * ZERO, o_L=-0.99 * ZERO), CAR)) == ""
    assert "motor torque looks 5.05 N.m too large" in text(diagnose_offsets(through(size, o_T=-1.01 * ZERO), CAR))
    assert "load torque looks 5.05 N.m too small" in text(diagnose_offsets(through(size, o_L=-1.01 * ZERO), CAR))


@pytest.mark.parametrize("others", [1.0, 2.0 * OUTLIER / LONELY])
def test_a_sample_that_is_off_alone_is_named_with_its_time(others: float) -> None:
    least = max(OUTLIER, LONELY * others)
    size = np.full(1000, others)
    for factor, named in ((0.99, False), (1.01, True)):
        size[499] = -factor * least
        message = text(diagnose_outliers(through(size), T_S))
        assert bool(message) == named
    assert f"{500 * T_S:.4g} s after the start is {-1.01 * least:+.3g} rad/s off:" in message


def test_two_outliers_are_counted_and_neither_a_crowd_nor_the_beginning_is_one() -> None:
    size = np.ones(1000)
    size[[300, 700]] = 50.0, 60.0
    message = text(diagnose_outliers(through(size), T_S))
    assert f"{701 * T_S:.4g} s after the start is +60 rad/s off and 1 more:" in message
    size[: 100 + CROWD] = 50.0
    assert text(diagnose_outliers(through(size), T_S)) == ""
    size = np.ones(1000)
    size[99] = 100.0
    assert text(diagnose_outliers(through(size), T_S)) == ""


def test_a_motor_speed_that_was_interpolated_is_named() -> None:
    sampled = simulated(seed=6).omega_1
    at = np.arange(0.0, len(sampled) - 1, 0.25)
    assert text(diagnose_spectrum(sampled, T_S)) == ""
    assert text(diagnose_spectrum(np.interp(at, np.arange(len(sampled)), sampled), T_S / 4))
    assert text(diagnose_spectrum(np.repeat(sampled, 4), T_S / 4))


@pytest.mark.parametrize("noise", [0.005, 0.03, 0.15, 0.3])
def test_a_motor_speed_as_it_was_sampled_is_not_named_however_good_the_sensor(noise: float) -> None:
    """Of a light motor on a soft shaft: what it does at 60 to 120 Hz is a hundred times the noise of the best one."""
    soft = P._replace(J_1=0.03, C=60.0)
    for seed in (1, 2):
        omega_1 = simulated(seed, p=soft, noise=NOISE._replace(omega_1=noise)).omega_1
        assert text(diagnose_spectrum(omega_1, T_S)) == ""
        assert text(diagnose_spectrum(0.5 * (omega_1[1:] + omega_1[:-1]), T_S))


@pytest.mark.parametrize(
    ("noise", "times"), [*product([0.15], [1.5, 2.0, 3.0, 5.0, 10.0]), *product([0.03], [1.5, 3.0, 5.0, 10.0])]
)
def test_a_motor_speed_on_a_finer_raster_is_named_whatever_the_ratio(noise: float, times: float) -> None:
    omega_1 = simulated(seed=6, noise=NOISE._replace(omega_1=noise)).omega_1
    at = np.arange(0.0, len(omega_1) - 1, 1.0 / times)
    assert text(diagnose_spectrum(np.interp(at, np.arange(len(omega_1)), omega_1), T_S / times))


@pytest.mark.parametrize("share", [0.2, 0.3, 0.5])
def test_a_motor_speed_through_a_low_pass_is_named(share: float) -> None:
    for seed in (1, 2, 3):
        omega_1 = simulated(seed).omega_1
        filtered = np.asarray(lfilter([share], [1.0, share - 1.0], omega_1 - omega_1[0]))
        assert text(diagnose_spectrum(filtered[100:], T_S))


@together("size, frequency", product([0.5, 1.0, 5.0], [0.45, 0.67, 0.9]))
def test_the_ripple_of_a_motor_is_no_interpolation(size: float, frequency: float) -> None:
    """Beside white noise, at frequencies over that of Nyquist."""
    white = np.random.default_rng(2).standard_normal(5000)
    assert not is_coloured(white + size * np.sqrt(2.0) * np.sin(np.pi * frequency * np.arange(5000)), T_S)


@pytest.mark.parametrize(("count", "most"), [(20, 0), (99, 0), (100, 5), (500, 0)])
def test_white_noise_is_hardly_ever_named_however_short_the_piece_is(count: int, most: int) -> None:
    pieces = np.random.default_rng(3).standard_normal((50, count))
    assert sum(is_coloured(piece, T_S) for piece in pieces) <= most


@pytest.mark.parametrize(("T_s", "named"), [(0.004, False), (0.002, True)])
def test_what_the_drive_train_does_is_not_taken_for_the_noise_of_a_slow_recording(T_s: float, named: bool) -> None:
    """White noise, and ten times as much in the second quarter of the band: up to 62 Hz, and up to 125 Hz."""
    spectrum = np.fft.rfft(np.random.default_rng(1).standard_normal(2**15))
    below = np.arange(len(spectrum)) < 0.47 * len(spectrum)
    assert bool(text(diagnose_spectrum(np.fft.irfft(np.where(below, 10.0, 1.0) * spectrum), T_s))) == named


def test_a_falling_spectrum_is_interpolated_where_its_noise_is_uneven_too() -> None:
    """Hits at up to 59 Hz, and above them noise that is white but for the last quarter of the band: of slow samples."""
    spectrum = np.fft.rfft(np.random.default_rng(1).standard_normal(2**15))
    at = np.linspace(0.0, 0.5, len(spectrum))
    for share, named in ((0.9 * COLOURED, True), (1.1 * COLOURED, False)):
        shape = np.where(at < 0.235, 10.0, np.where(at < 0.37, share**-0.5, 1.0))
        assert bool(text(diagnose_spectrum(np.fft.irfft(shape * spectrum), 0.004))) == named


def test_noise_counts_as_white_down_to_its_threshold() -> None:
    """White noise, and in the last quarter of its band so much of it as is asked for."""
    spectrum = np.fft.rfft(np.random.default_rng(1).standard_normal(2**15))
    for share, named in ((0.8 * COLOURED, True), (1.2 * COLOURED, False)):
        shaped = spectrum * np.where(np.arange(len(spectrum)) > 0.7 * len(spectrum), np.sqrt(share), 1.0)
        assert bool(text(diagnose_spectrum(np.fft.irfft(shaped), T_S))) == named


def loop(tau: float = 0.003, delay: float = 0.0, explained: float = 1.0) -> FittedLoop:
    return FittedLoop(TorqueLoop(tau, delay=delay), {}, 0.3, explained, np.zeros(1), np.zeros(1, bool))


@pytest.mark.parametrize(("sign", "word"), [(1.0, "after"), (-1.0, "before")])
def test_a_demand_that_is_shifted_is_named(sign: float, word: str) -> None:
    delay = sign * DEMAND_LATE * T_S
    assert text(diagnose_torque_loop(loop(delay=0.999 * delay), T_S, 0.003)) == ""
    message = text(diagnose_torque_loop(loop(delay=1.01 * delay), T_S, 0.003))
    assert message.startswith(f"the motor torque comes 1.01 ms {word} its demand")


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_wrong_lag_is_named(sign: float) -> None:
    assert text(diagnose_torque_loop(loop(0.003 * (1.0 + sign * 0.999 * LAG_OFF)), T_S, 0.003)) == ""
    tau = 0.003 * (1.0 + sign * 1.001 * LAG_OFF)
    message = f"tau = 0.003 s of the vehicle file looks wrong: motor control has {tau:.4g} s"
    assert text(diagnose_torque_loop(loop(tau), T_S, 0.003)) == message


def test_a_demand_that_is_not_that_of_the_motor_torque_is_named_alone() -> None:
    assert text(diagnose_torque_loop(loop(explained=1.001 * ANSWERS), T_S, 0.003)) == ""
    message = text(diagnose_torque_loop(loop(0.03, 0.01, 0.999 * ANSWERS), T_S, 0.003))
    assert message.startswith("the torque demand explains 90 % of the motor torque only")
