"""What is likely to be wrong, or is not determined, is said; and only that."""

from dataclasses import replace

import numpy as np
import pytest

from harness.identification.doubts import (
    CLOSE,
    DEMAND_LATE,
    FLANK,
    LAG_OFF,
    LIKELY,
    Cause,
    causes,
    of_demand,
    undetermined,
)
from harness.identification.drive_train import Parameters
from harness.identification.driven import Drive
from harness.identification.maximum_likelihood import maximise
from harness.identification.prediction import Filtered, Predictor
from harness.identification.torque_loop import FittedLoop, TorqueLoop
from tests.harness.identification.simulated import NOISE, T_S, P, simulated

FREE = ("J_2", "C", "phi_B", "g_L")
SHARP = {"J_2": 1e-4, "C": 1e-2, "phi_B": 1e-4}


def looked_for(drive: Drive, p: Parameters = P, free: tuple[str, ...] = FREE) -> list[Cause]:
    return causes(drive, maximise(Predictor(free), drive, p, NOISE, most=12), NOISE)


def test_nothing_is_said_of_a_drive_that_is_as_it_should_be() -> None:
    drive = simulated(seed=6)
    assert looked_for(drive) == []
    assert undetermined(drive, P, NOISE, SHARP, True, FREE) == []


@pytest.mark.parametrize(("samples", "word"), [(2, "late"), (-2, "early")])
def test_a_load_torque_that_is_4_ms_late_or_early_is_named(samples: int, word: str) -> None:
    drive = simulated(seed=6)
    shifted = replace(drive, T_load=np.roll(drive.T_load, samples, axis=0))
    text = looked_for(shifted)[0].text
    assert text == f"the load torque looks {word}: shifted by 4 ms the recording is explained better"


@pytest.mark.parametrize(("factor", "said"), [(1.03, "2.9 % too large"), (0.97, "3.1 % too small")])
def test_a_wrong_motor_inertia_is_named(factor: float, said: str) -> None:
    wrong = P._replace(J_1=factor * P.J_1)
    text = looked_for(simulated(seed=6), wrong)[0].text
    assert text.startswith(f"J_1 = {wrong.J_1:g} kg.m2 looks ")
    number, word = said.split(" % ")
    assert f"% {word}, or the motor torque has a gain: with J_1 = 0.05" in text
    assert float(text.split("looks ")[1].split(" %")[0]) == pytest.approx(float(number), abs=0.5)


def test_a_motor_inertia_that_was_free_is_not_doubted() -> None:
    assert looked_for(simulated(seed=6), P._replace(J_1=1.03 * P.J_1), ("J_1", *FREE)) == []


def test_the_likeliest_cause_comes_first_and_none_below_the_threshold(monkeypatch: pytest.MonkeyPatch) -> None:
    drive = simulated(seed=6)
    shifted = replace(drive, T_load=np.roll(drive.T_load, 2, axis=0))
    found = maximise(Predictor(FREE), shifted, P._replace(J_1=1.03 * P.J_1), NOISE, most=12)
    gains = [cause.gain for cause in causes(shifted, found, NOISE)]
    assert len(gains) > 1
    assert gains == sorted(gains, reverse=True)
    assert min(gains) > LIKELY
    monkeypatch.setattr("harness.identification.doubts.LIKELY", gains[0] - 1e-6)
    assert len(causes(shifted, found, NOISE)) == 1
    monkeypatch.setattr("harness.identification.doubts.LIKELY", gains[0])
    assert causes(shifted, found, NOISE) == []


@pytest.mark.parametrize(("mean", "side"), [(120.0, "brake"), (-120.0, "drive")])
def test_a_drive_that_never_crosses_the_gap_is_named(mean: float, side: str) -> None:
    drive = simulated(seed=6, n=750, mean=mean)
    (text,) = undetermined(drive, P, NOISE, SHARP, True, FREE)
    assert text == (
        f"phi_B is not determined: the teeth never {side}, so that the gap is not crossed; excite about zero torque"
    )


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize(("samples", "named"), [(FLANK * 1000, False), (FLANK * 1000 - 1, True)])
def test_teeth_must_spend_a_share_of_the_time_on_either_flank(
    monkeypatch: pytest.MonkeyPatch, side: float, samples: float, named: bool
) -> None:
    twists = np.full(1000, 1.1 * P.phi_B)
    twists[: int(samples)] *= -1.0
    states = np.zeros((1000, 5))
    states[:, 2] = side * twists
    through = Filtered(states, np.zeros(1000), np.zeros(1000))
    monkeypatch.setattr("harness.identification.doubts.filtered", lambda *_: through)
    assert bool(undetermined(simulated(seed=6, n=100), P, NOISE, SHARP, True, FREE)) == named


def said(deviations: dict[str, float], messages: bool = True, free: tuple[str, ...] = FREE) -> list[str]:
    return undetermined(simulated(seed=6, n=750), P, NOISE, {**SHARP, **deviations}, messages, free)


@pytest.mark.parametrize("name", ["J_2", "C", "phi_B"])
def test_a_wide_interval_is_named(name: str) -> None:
    close = CLOSE * getattr(P, name)
    assert said({name: 0.999 * close}) == []
    assert said({name: 1.001 * close}) == [f"{name}: standard deviation of more than 5 %; excite more or longer"]


def test_several_wide_intervals_are_named_together() -> None:
    assert said({"J_2": 0.1, "C": 20.0})[0].startswith("J_2, C: standard deviation")


def test_damping_that_messages_tell_poorly_is_named() -> None:
    close = CLOSE * P.d
    assert said({"d": 0.999 * close}) == []
    assert said({"d": 1.001 * close}, messages=False) == []
    (text,) = said({"d": 1.001 * close})
    assert text.startswith("d is determined poorly, as the wheel speed is known from messages only")


def test_a_scale_that_only_the_load_torque_sets_is_named() -> None:
    assert said({}, free=(*FREE, "J_1")) == []
    assert said({}, free=(*FREE, "g_T")) == []
    (text,) = said({}, free=(*FREE, "J_1", "g_T"))
    assert text.startswith("J_1 and the gain of the motor torque are both free")


def fitted(tau: float = 0.003, delay: float = 0.0) -> FittedLoop:
    return FittedLoop(TorqueLoop(tau, delay=delay), {}, 0.3, 1.0)


@pytest.mark.parametrize(("sign", "word"), [(1.0, "after"), (-1.0, "before")])
def test_a_demand_that_is_shifted_is_named(sign: float, word: str) -> None:
    delay = sign * DEMAND_LATE * T_S
    assert of_demand(fitted(delay=0.999 * delay), T_S, 0.003) == []
    (text,) = of_demand(fitted(delay=1.01 * delay), T_S, 0.003)
    assert text.startswith(f"the motor torque comes 1.01 ms {word} its demand")


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_wrong_lag_is_named(sign: float) -> None:
    assert of_demand(fitted(0.003 * (1.0 + sign * 0.999 * LAG_OFF)), T_S, 0.003) == []
    tau = 0.003 * (1.0 + sign * 1.001 * LAG_OFF)
    assert of_demand(fitted(tau), T_S, 0.003) == [
        f"tau = 0.003 s of the vehicle file looks wrong: motor control has {tau:.4g} s"
    ]
