"""Diagnostics name what is likely to be wrong, or is not determined; and only that."""

from dataclasses import replace

import numpy as np
import pytest

from driveline.harness.identification.diagnostics import (
    CHANNELS,
    CLOSE,
    COLOURED,
    CROWD,
    DEMAND_LATE,
    FLANK,
    LAG_OFF,
    LONELY,
    OUTLIER,
    SKEWED,
    SURELY,
    ZERO,
    diagnose_damping,
    diagnose_delays,
    diagnose_demand,
    diagnose_excitation,
    diagnose_innovations,
    diagnose_load_gain,
    diagnose_motor_gain,
    diagnose_offsets,
    diagnose_outliers,
    diagnose_spectrum,
    diagnose_tyre,
    is_determined,
)
from driveline.harness.identification.drive_train_response import Tyre
from driveline.harness.identification.identify import backward_elimination
from driveline.harness.identification.maximum_likelihood import maximise
from driveline.harness.identification.model_inputs import Drive
from driveline.harness.identification.prediction import Filtered, Predictor, filtered
from driveline.harness.identification.quality import Z_95
from driveline.harness.identification.time_shifts import MOST
from driveline.harness.identification.torque_loop import ANSWERS, FittedLoop, TorqueLoop
from tests.harness.identification.simulated import NOISE, T_S, P, simulated

FREE = ("J_2", "C", "phi_B", "g_L")
SHARP = {"J_2": 1e-4, "C": 1e-2, "phi_B": 1e-4}


def twist(drive: Drive) -> np.ndarray:
    return filtered(drive, P, NOISE).states[:, 2]


CAR = P._replace(g_T=1.0, d=0.0)
TRUE = P._replace(g_T=1.0, g_L=1.0)


def test_nothing_is_said_of_a_drive_that_is_as_it_should_be() -> None:
    drive = simulated(seed=6)
    assert diagnose_delays(P, {}, explained=True) == []
    assert diagnose_excitation(twist(drive), P, SHARP, FREE) == []


@pytest.mark.parametrize("name", CHANNELS)
@pytest.mark.parametrize(("sign", "word", "side"), [(1.0, "late", "after"), (-1.0, "early", "before")])
def test_a_channel_that_is_late_or_early_is_named(name: str, sign: float, word: str, side: str) -> None:
    (text,) = diagnose_delays(P._replace(**{name: sign * 0.00151}), {name: 1e-5}, explained=True)
    others = "both torques" if name == "late_1" else "the motor speed"
    assert text.startswith(f"the {CHANNELS[name]} looks {word}: it is recorded 1.51 +- 0.02 ms {side} {others},")


def test_torques_that_are_late_each_for_itself_are_named_both() -> None:
    texts = diagnose_delays(P._replace(late_T=0.0005, late_L=-0.0007), {}, explained=True)
    assert [text.partition(":")[0] for text in texts] == ["the motor torque looks late", "the load torque looks early"]


@pytest.mark.parametrize("name", CHANNELS)
@pytest.mark.parametrize("deviation", [0.0, SKEWED])
def test_a_delay_is_named_from_its_thresholds_on(name: str, deviation: float) -> None:
    least = max(SKEWED, SURELY * deviation)
    for late, named in ((0.999 * least, False), (1.001 * least, True), (-1.001 * least, True)):
        assert bool(diagnose_delays(P._replace(**{name: late}), {name: deviation}, explained=True)) == named


def test_a_delay_that_is_as_long_as_is_looked_at_may_be_longer() -> None:
    (text,) = diagnose_delays(P._replace(late_L=MOST), {"late_L": 1e-5}, explained=True)
    assert "recorded 6.00 ms or more after the motor speed" in text


def test_a_delay_of_a_car_that_two_masses_do_not_explain_may_be_what_they_lack() -> None:
    for explained in (True, False):
        (text,) = diagnose_delays(P._replace(late_L=0.0007), {}, explained)
        assert ("what the two masses lack looks so" in text) != explained


@pytest.mark.parametrize(
    ("g_L", "deviation", "message"),
    [
        (1.09, 0.01, ""),
        (1.11, 0.01, "1.11 times the true one"),
        (0.5, 0.01, "0.5 times the true one"),
        (1.25, 0.09, ""),
    ],
)
def test_a_load_torque_that_is_scaled_is_named(g_L: float, deviation: float, message: str) -> None:
    texts = diagnose_load_gain(P._replace(g_L=g_L), {"g_L": deviation})
    assert [message in text for text in texts] == ([True] if message else [])


def test_without_a_load_torque_its_gain_is_not_spoken_of() -> None:
    assert diagnose_load_gain(P._replace(g_L=1.0), {}) == []


@pytest.mark.parametrize(("correlation", "message"), [(0.24, False), (-0.24, False), (0.26, True), (-0.26, True)])
def test_innovations_that_are_not_white_are_named(correlation: float, message: bool) -> None:
    assert bool(diagnose_innovations(correlation)) == message


@pytest.mark.parametrize(("d", "message"), [(-2.9, False), (-3.1, True)])
def test_negative_damping_is_named_if_it_is_surely_so(d: float, message: bool) -> None:
    texts = diagnose_damping(P._replace(d=d), {"d": 1.0})
    assert any("negative" in text for text in texts) == message


@pytest.mark.parametrize("factor", [1.03, 0.97])
def test_a_motor_inertia_that_is_3_percent_wrong_is_named(factor: float) -> None:
    """As the gain of the motor torque, which the data ask for: both cannot be told apart."""
    drive = simulated(seed=6, p=CAR)
    wrong = CAR._replace(J_1=factor * CAR.J_1)
    found = maximise(Predictor((*FREE, "d", "g_T")), drive, wrong, NOISE, most=12)
    best = backward_elimination(drive, found, NOISE, (), lambda _: None)
    p, surely = best.p, {"g_T": float(np.sqrt(best.covariance[best.free.index("g_T"), best.free.index("g_T")]))}
    assert p.g_T == pytest.approx(1.0 / factor, abs=0.005)
    (text,) = diagnose_motor_gain(p, surely)
    assert text.startswith(f"the recorded motor torque looks {p.g_T:.4g} times the true one")
    assert f"or J_1 = {wrong.J_1:g} kg.m2 should be {p.g_T * wrong.J_1:.4g} (--free J_1)" in text
    assert p.g_T * wrong.J_1 == pytest.approx(CAR.J_1, rel=0.005)


def test_the_data_ask_for_neither_gain_nor_damping_where_there_is_none() -> None:
    drive = simulated(seed=6, p=CAR)
    found = maximise(Predictor((*FREE, "d", "g_T")), drive, CAR, NOISE, most=12)
    best = backward_elimination(drive, found, NOISE, (), lambda _: None)
    assert best.free == FREE
    assert best.p.d == 0.0
    assert best.p.g_T == 1.0
    assert backward_elimination(drive, found, NOISE, ("d", "g_T"), lambda _: None) is found
    assert diagnose_motor_gain(best.p, {}) == []
    assert diagnose_motor_gain(P._replace(g_T=1.0029), {"g_T": 1e-3}) == []
    assert diagnose_motor_gain(P._replace(g_T=1.0031), {"g_T": 1e-3})


def test_the_data_ask_for_damping_where_there_is_some() -> None:
    drive = simulated(seed=6, p=CAR._replace(d=P.d))
    found = maximise(Predictor((*FREE, "d", "g_T")), drive, CAR, NOISE, most=12)
    damped = backward_elimination(drive, found, NOISE, (), lambda _: None)
    assert "d" in damped.free
    assert damped.p.d == pytest.approx(P.d, rel=0.1)


@pytest.mark.parametrize(("name", "neutral"), [("d", 0.0), ("g_T", 1.0)])
def test_damping_and_gain_are_asked_for_from_a_likelihood_on(
    name: str, neutral: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each while the other is free in any case."""
    drive, others = simulated(seed=6, p=CAR), {"d", "g_T"} - {name}
    found = maximise(Predictor((*FREE, "d", "g_T")), drive, CAR, NOISE, most=12)
    k = found.free.index(name)
    gain_of_likelihood = (getattr(found.p, name) - neutral) ** 2 / found.covariance[k, k]
    for threshold, asks in ((0.999 * gain_of_likelihood, True), (1.001 * gain_of_likelihood, False)):
        monkeypatch.setattr("driveline.harness.identification.identify.LIKELY", threshold)
        best = backward_elimination(drive, found, NOISE, tuple(others), lambda _: None)
        assert (name in best.free) == asks
        assert (getattr(best.p, name) == neutral) != asks


@pytest.mark.parametrize(("mean", "side"), [(120.0, "brake"), (-120.0, "drive")])
def test_a_drive_that_never_crosses_the_gap_is_named(mean: float, side: str) -> None:
    drive = simulated(seed=6, n=750, mean=mean)
    (text,) = diagnose_excitation(twist(drive), P, SHARP, FREE)
    assert text == (
        f"phi_B is not determined: the teeth never {side}, so that the gap is not crossed; excite about zero torque"
    )


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize(("samples", "named"), [(FLANK * 1000, False), (FLANK * 1000 - 1, True)])
def test_teeth_must_spend_a_share_of_the_time_on_either_flank(side: float, samples: float, named: bool) -> None:
    twists = np.full(1000, 1.1 * P.phi_B)
    twists[: int(samples)] *= -1.0
    assert bool(diagnose_excitation(side * twists, P, SHARP, FREE)) == named


def message(deviations: dict[str, float], free: tuple[str, ...] = FREE) -> list[str]:
    return diagnose_excitation(twist(simulated(seed=6, n=750)), P, {**SHARP, **deviations}, free)


@pytest.mark.parametrize("name", ["J_2", "C", "phi_B"])
def test_what_is_known_badly_or_not_at_all_is_named(name: str) -> None:
    value = getattr(P, name)
    wide = [f"{name}: 95 % interval wider than +- 9.8 %; excite more or longer"]
    assert message({name: 0.999 * CLOSE * value}) == []
    assert message({name: 1.001 * CLOSE * value}) == wide
    assert message({name: 0.999 * value / Z_95}) == wide
    assert message({name: 1.001 * value / Z_95}) == [f"{name}: not determined; excite more or longer"]


def test_several_of_them_are_named_together() -> None:
    unknown, wide = message({"J_2": 0.1, "C": 100.0, "d": P.d})
    assert unknown.startswith("C, d: not determined")
    assert wide.startswith("J_2: 95 % interval")


def test_a_gap_that_is_not_crossed_is_named_once() -> None:
    texts = diagnose_excitation(np.full(1000, 2.0 * P.phi_B), P, {**SHARP, "phi_B": 10.0}, FREE)
    assert [text.partition(":")[0] for text in texts] == ["phi_B is not determined"]


def test_damping_is_known_as_well_as_a_tenth_of_the_critical_one() -> None:
    """A car without damping has none, to within a share of nothing."""
    critical = 2.0 * np.sqrt(P.C / (1.0 / P.J_1 + 1.0 / P.J_2))
    phi = twist(simulated(seed=6, n=750))
    for share, named in ((0.999, False), (1.001, True)):
        texts = diagnose_excitation(phi, P._replace(d=0.0), {**SHARP, "d": share * 0.1 * critical / Z_95}, FREE)
        assert texts == ["d: not determined; excite more or longer"] * named


@pytest.mark.parametrize(("deviation", "named"), [(0.29, False), (0.31, True), (1e4, True)])
def test_a_load_torque_that_tells_nothing_is_named(deviation: float, named: bool) -> None:
    texts = message({"g_L": deviation * P.g_L})
    assert ["load torque tells nothing" in text for text in texts] == [True] * named


@pytest.mark.parametrize("name", ["J_2", "C"])
def test_causes_are_told_where_inertia_and_stiffness_would_be_known_without_damping_and_delays(name: str) -> None:
    free, limit = (name, "late_L"), CLOSE * getattr(P, name)
    for share, determined in ((0.999, True), (1.001, False)):
        alone = np.diag([(share * limit) ** 2, 1e-8])
        assert is_determined(P, alone, free) == determined
    collinear = np.array([[1.0, 0.999], [0.999, 1.0]])
    scale = np.array([10.0 * limit, 1e-4])
    assert is_determined(P, collinear * np.outer(scale, scale), free)


@pytest.mark.parametrize(
    ("c_t", "d_t", "explained", "odd"),
    [(480.0, 30.0, 0.81, False), (480.0, 30.0, 0.79, True), (-480.0, 30.0, 0.9, True), (480.0, -30.0, 0.9, True)],
)
def test_a_load_torque_that_is_no_tyre_is_named(c_t: float, d_t: float, explained: float, odd: bool) -> None:
    assert bool(diagnose_tyre(Tyre(c_t, d_t, 1.5, explained))) == odd


def test_a_scale_that_only_the_load_torque_sets_is_named() -> None:
    assert message({}, free=(*FREE, "J_1")) == []
    assert message({}, free=(*FREE, "g_T")) == []
    (text,) = message({}, free=(*FREE, "J_1", "g_T"))
    assert text.startswith("J_1 and the gain of the motor torque are both free")


def fitted(tau: float = 0.003, delay: float = 0.0, explained: float = 1.0) -> FittedLoop:
    return FittedLoop(TorqueLoop(tau, delay=delay), {}, 0.3, explained)


@pytest.mark.parametrize(("sign", "word"), [(1.0, "after"), (-1.0, "before")])
def test_a_demand_that_is_shifted_is_named(sign: float, word: str) -> None:
    delay = sign * DEMAND_LATE * T_S
    assert diagnose_demand(fitted(delay=0.999 * delay), T_S, 0.003) == []
    (text,) = diagnose_demand(fitted(delay=1.01 * delay), T_S, 0.003)
    assert text.startswith(f"the motor torque comes 1.01 ms {word} its demand")


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_wrong_lag_is_named(sign: float) -> None:
    assert diagnose_demand(fitted(0.003 * (1.0 + sign * 0.999 * LAG_OFF)), T_S, 0.003) == []
    tau = 0.003 * (1.0 + sign * 1.001 * LAG_OFF)
    assert diagnose_demand(fitted(tau), T_S, 0.003) == [
        f"tau = 0.003 s of the vehicle file looks wrong: motor control has {tau:.4g} s"
    ]


def test_a_demand_that_is_not_that_of_the_motor_torque_is_named_alone() -> None:
    assert diagnose_demand(fitted(explained=1.001 * ANSWERS), T_S, 0.003) == []
    (text,) = diagnose_demand(fitted(0.03, 0.01, 0.999 * ANSWERS), T_S, 0.003)
    assert text.startswith("the torque demand explains 90 % of the motor torque only")


def test_a_damper_that_drives_is_named() -> None:
    assert diagnose_damping(P._replace(d=0.0), SHARP) == []
    (text,) = diagnose_damping(P._replace(d=-0.01), SHARP)
    assert text == "d = -0.01 N.m.s/rad is negative, which no damper is: something else is wrong"


def through(size: np.ndarray, *offsets: float) -> Filtered:
    states = np.zeros((len(size), 5))
    states[-1, 3:] = offsets or (0.0, 0.0)
    return Filtered(size, np.zeros(len(size)), slice(100, None), likelihood=False, states=states)


def test_a_zero_that_is_off_is_named_from_its_threshold_on() -> None:
    size = np.ones(1000)
    assert diagnose_offsets(through(size, 0.99 * ZERO, -0.99 * ZERO), TRUE) == []
    (motor,) = diagnose_offsets(through(size, -1.01 * ZERO, 0.0), TRUE)
    (load,) = diagnose_offsets(through(size, 0.0, 1.01 * ZERO), TRUE)
    assert "motor torque looks 5.05 N.m too large" in motor
    assert "load torque looks 5.05 N.m too small" in load


def test_the_filter_finds_an_offset_as_recorded() -> None:
    drive = simulated(seed=6)
    warned = [
        diagnose_offsets(filtered(replace(drive, T_mot=drive.T_mot + zero), P, NOISE), P) for zero in (20.0, 50.0)
    ]
    first, second = (
        float(message.removeprefix("the recorded motor torque looks ").split()[0]) for (message,) in warned
    )
    assert second - first == pytest.approx(30.0, abs=0.11)


@pytest.mark.parametrize("others", [1.0, 2.0 * OUTLIER / LONELY])
def test_a_sample_that_is_off_alone_is_named_with_its_time(others: float) -> None:
    least = max(OUTLIER, LONELY * others)
    size = np.full(1000, others)
    for factor, named in ((0.99, False), (1.01, True)):
        size[499] = -factor * least
        message = diagnose_outliers(through(size), T_S)
        assert bool(message) == named
    assert f"{500 * T_S:.4g} s after the start is {-1.01 * least:+.3g} rad/s off:" in message[0]


def test_two_outliers_are_counted_and_a_crowd_is_none() -> None:
    size = np.ones(1000)
    size[[300, 700]] = 50.0, 60.0
    (message,) = diagnose_outliers(through(size), T_S)
    assert f"{701 * T_S:.4g} s after the start is +60 rad/s off and 1 more:" in message
    size[: 100 + CROWD] = 50.0
    assert diagnose_outliers(through(size), T_S) == []


def test_what_comes_before_the_filter_has_settled_is_no_outlier() -> None:
    size = np.ones(1000)
    size[99] = 100.0
    assert diagnose_outliers(through(size), T_S) == []


def test_a_motor_speed_that_was_interpolated_is_named() -> None:
    sampled = simulated(seed=6).omega_1
    at = np.arange(0.0, len(sampled) - 1, 0.25)
    assert diagnose_spectrum(sampled, T_S) == []
    assert diagnose_spectrum(np.interp(at, np.arange(len(sampled)), sampled), T_S / 4)
    assert diagnose_spectrum(np.repeat(sampled, 4), T_S / 4)


@pytest.mark.parametrize(("T_s", "named"), [(0.004, False), (0.002, True)])
def test_what_the_drive_train_does_is_not_taken_for_the_noise_of_a_slow_recording(T_s: float, named: bool) -> None:
    """White noise, and ten times as much in the second quarter of the band: up to 62 Hz, and up to 125 Hz."""
    spectrum = np.fft.rfft(np.random.default_rng(1).standard_normal(2**15))
    below = np.arange(len(spectrum)) < 0.47 * len(spectrum)
    assert bool(diagnose_spectrum(np.fft.irfft(np.where(below, 10.0, 1.0) * spectrum), T_s)) == named


def test_noise_counts_as_white_down_to_its_threshold() -> None:
    """White noise, and in the last quarter of its band so much of it as is asked for."""
    spectrum = np.fft.rfft(np.random.default_rng(1).standard_normal(2**15))
    for share, named in ((0.8 * COLOURED, True), (1.2 * COLOURED, False)):
        shaped = spectrum * np.where(np.arange(len(spectrum)) > 0.7 * len(spectrum), np.sqrt(share), 1.0)
        assert bool(diagnose_spectrum(np.fft.irfft(shaped), T_S)) == named
