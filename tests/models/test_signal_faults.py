"""Each fault does to its signal what it says, from its begin to its end, and nothing to the others."""

from typing import Any

import numpy as np
import pytest

from driveline.models import signal_faults as faults
from driveline.models.signal_faults import BLOCK, T_S, Input, Parameters, Signals
from fmublocks.block.runner import SampledRunner

BEGIN, END = 0.1, 0.2
FIELD = {faults.MOTOR_SPEED: "omega_1_meas", faults.MOTOR_TORQUE: "T_mot_est", faults.WHEEL_SPEED: "omega_2_can"}


def sent(k):
    """What the sensors send in sample k: ramps, and a message in every tenth sample."""
    message = k // 10
    return Input(float(k), 1000.0 + k, 2000.0 + 10.0 * message, True, message)


def passed(samples=150, **given: Any) -> list[Any]:
    """What goes out in each sample, as one array a signal, and what was sent."""
    p = Parameters(**given)
    runner = SampledRunner(BLOCK, sent(0), p)
    out = []
    for k in range(samples):
        out.append(Signals(*runner.output(sent(k))))
        runner.advance(sent(k), T_S)
    arrays: Any = np.array
    return [Signals(*map(arrays, zip(*rows, strict=True))) for rows in (out, [sent(k) for k in range(samples)])]


def fault(kind, signal, size=1.0, share=1.0):
    return {"kind_1": kind, "signal_1": signal, "begin_1": BEGIN, "end_1": END, "size_1": size, "share_1": share}


NOW = slice(round(BEGIN / T_S), round(END / T_S))
"""The samples in which the fault acts."""

ALL_KINDS = (
    faults.LATE,
    faults.FROZEN,
    faults.LOST,
    faults.GAIN,
    faults.OFFSET,
    faults.NOISE,
    faults.SPIKES,
    faults.NO_NUMBER,
)


@pytest.mark.parametrize("signal", FIELD)
@pytest.mark.parametrize("kind", ALL_KINDS)
def test_before_and_after_and_all_other_signals_are_as_they_were_sent(kind, signal):
    out, true = passed(**fault(kind, signal, size=0.02))
    for name in Signals._fields:
        got, right = (getattr(signals, name).copy() for signals in (out, true))
        whole_message = (
            signal == faults.WHEEL_SPEED and kind in (faults.LATE, faults.LOST) and name in ("valid", "counter")
        )
        if name == FIELD[signal] or whole_message:
            got[NOW] = right[NOW]
        assert (got == right).all(), name


@pytest.mark.parametrize(
    ("signal", "delay", "rest"),
    [
        *((each, 8, 0.0) for each in FIELD),
        *((faults.MOTOR_SPEED, delay, rest) for delay in (1, 2, 8) for rest in (-0.49, 0.49)),
    ],
)
def test_a_late_signal_is_what_was_sent_so_long_before(signal, delay, rest):
    """A message is late as a whole; a time between two samples counts as the nearer one."""
    out, true = passed(**fault(faults.LATE, signal, size=(delay + rest) * T_S))
    before = slice(NOW.start - delay, NOW.stop - delay)
    for name in (FIELD[signal], "counter") if signal == faults.WHEEL_SPEED else (FIELD[signal],):
        assert (getattr(out, name)[NOW] == getattr(true, name)[before]).all()


@pytest.mark.parametrize("second", FIELD)
def test_of_two_faults_that_are_late_the_second_has_no_value_of_another_signal(second):
    both = fault(faults.LATE, faults.MOTOR_SPEED, size=0.02) | {
        "kind_2": faults.LATE,
        "signal_2": second,
        "size_2": 0.04,
    }
    out, true = passed(**both, begin_2=BEGIN, end_2=END)
    assert (out.omega_1_meas[NOW] == true.omega_1_meas[NOW.start - 10 : NOW.stop - 10]).all()
    for name in set(FIELD.values()) - {"omega_1_meas"}:
        assert (getattr(out, name) == getattr(true, name)).all()


@pytest.mark.parametrize(("kind", "before"), [(faults.LATE, 8), (faults.FROZEN, None), (faults.LOST, None)])
def test_a_frame_fails_with_speed_and_torque_and_without_the_message(kind, before):
    out, true = passed(**fault(kind, faults.FRAME, size=8 * T_S))
    sources = slice(NOW.start - before, NOW.stop - before) if before else NOW.start - 1
    for name in ("omega_1_meas", "T_mot_est"):
        assert (getattr(out, name)[NOW] == getattr(true, name)[sources]).all()
        assert (np.delete(getattr(out, name), NOW) == np.delete(getattr(true, name), NOW)).all()
    for name in ("omega_2_can", "valid", "counter"):
        assert (getattr(out, name) == getattr(true, name)).all()


def test_no_number_is_nan():
    for signal in (*FIELD, faults.FRAME):
        out, _ = passed(**fault(faults.NO_NUMBER, signal))
        names = ("omega_1_meas", "T_mot_est") if signal == faults.FRAME else (FIELD[signal],)
        assert all(np.isnan(getattr(out, name)[NOW]).all() for name in names)


def test_the_longest_delay_is_half_a_second():
    given = fault(faults.LATE, faults.MOTOR_SPEED, size=0.5) | {"begin_1": 0.6, "end_1": 0.7}
    out, true = passed(samples=330, **given)
    assert (out.omega_1_meas[300:330] == true.omega_1_meas[50:80]).all()


@pytest.mark.parametrize("signal", FIELD)
def test_a_frozen_signal_stays_what_it_was_before(signal):
    """While its messages keep coming."""
    out, true = passed(**fault(faults.FROZEN, signal))
    assert (getattr(out, FIELD[signal])[NOW] == getattr(true, FIELD[signal])[NOW.start - 1]).all()
    assert (out.counter == true.counter).all()


@pytest.mark.parametrize(("share", "kept"), [(0.0, 1.0), (0.4, 0.6), (1.0, 0.0)])
def test_of_a_lost_signal_the_rest_arrives_and_the_last_stays(share, kept):
    given = fault(faults.LOST, faults.MOTOR_SPEED, share=share) | {"begin_1": 0.1, "end_1": 2.1}
    out, true = passed(samples=1100, **given)
    arrived = out.omega_1_meas[50:1050] == true.omega_1_meas[50:1050]
    assert arrived.mean() == pytest.approx(kept, abs=0.05)
    assert (np.diff(out.omega_1_meas[49:1050])[~arrived] == 0.0).all()


def test_a_lost_message_leaves_a_hole_in_the_counter():
    given = fault(faults.LOST, faults.WHEEL_SPEED, share=0.5) | {"begin_1": 0.1, "end_1": 2.1}
    out, true = passed(samples=1100, **given)
    arrived = np.unique(out.counter[50:1050])
    assert 30 <= len(arrived) <= 70
    assert (out.omega_2_can == 2000.0 + 10.0 * out.counter).all()
    assert set(arrived) <= set(true.counter)


@pytest.mark.parametrize("signal", FIELD)
def test_gain_and_offset(signal):
    right = getattr(passed()[1], FIELD[signal])[NOW]
    for size in (0.0, -1.0, 1.3):
        assert (getattr(passed(**fault(faults.GAIN, signal, size))[0], FIELD[signal])[NOW] == size * right).all()
    assert (getattr(passed(**fault(faults.OFFSET, signal, -30.0))[0], FIELD[signal])[NOW] == right - 30.0).all()


@pytest.mark.slow
def test_noise_has_its_standard_deviation_and_follows_from_the_seed():
    given = fault(faults.NOISE, faults.MOTOR_SPEED, size=1.5) | {"end_1": 8.0}
    one, same, other = (passed(samples=4000, seed=seed, **given) for seed in (1, 1, 2))
    noise = one[0].omega_1_meas[50:] - one[1].omega_1_meas[50:]
    assert noise.std() == pytest.approx(1.5, rel=0.05)
    assert abs(noise.mean()) < 0.1
    assert (one[0].omega_1_meas == same[0].omega_1_meas).all()
    assert (one[0].omega_1_meas != other[0].omega_1_meas)[50:].all()


def test_spikes_of_either_sign_come_in_their_share_of_the_samples():
    out, true = passed(samples=4000, **fault(faults.SPIKES, faults.MOTOR_TORQUE, size=77.0, share=0.1) | {"end_1": 8.0})
    spikes = (out.T_mot_est - true.T_mot_est)[50:]
    assert set(spikes) == {-77.0, 0.0, 77.0}
    assert (spikes != 0.0).mean() == pytest.approx(0.1, abs=0.02)


def test_a_flag_that_flaps_is_turned_over_and_back():
    out, _ = passed(**fault(faults.FLAPPING, faults.WHEEL_SPEED, size=3 * T_S))
    assert out.valid[NOW.start : NOW.start + 12].tolist() == 2 * [False, False, False, True, True, True]
    assert out.valid[NOW.stop :].all()


def test_a_counter_jumps_in_its_share_of_the_samples():
    out, true = passed(samples=4000, **fault(faults.JUMPING, faults.WHEEL_SPEED, share=0.3) | {"end_1": 8.0})
    assert (out.counter != true.counter)[50:].mean() == pytest.approx(0.3, abs=0.03)
    assert (out.omega_2_can == true.omega_2_can).all()
    assert out.counter.max() < faults.COUNTERS


def test_two_faults_act_at_a_time():
    second = {"kind_2": faults.OFFSET, "signal_2": faults.MOTOR_SPEED, "begin_2": 0.0, "end_2": 1.0, "size_2": 5.0}
    out, true = passed(**fault(faults.GAIN, faults.MOTOR_SPEED, 2.0), **second)
    assert (out.omega_1_meas[NOW] == 2.0 * true.omega_1_meas[NOW] + 5.0).all()
    assert (out.omega_1_meas[: NOW.start] == true.omega_1_meas[: NOW.start] + 5.0).all()
