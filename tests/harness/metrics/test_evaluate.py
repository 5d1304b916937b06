"""Each metric on a signal whose answer is known."""

import pickle
from dataclasses import replace
from math import exp, pi, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from driveline.harness.loop.places import T_S
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.signals import lines
from driveline.harness.metrics.damage import damage
from driveline.harness.metrics.declaration import Absent, declared
from driveline.harness.metrics.evaluate import COLUMNS, FIRM, crossing_time, evaluate, impact_speeds
from driveline.harness.metrics.oscillation import amplitude
from driveline.harness.metrics.run_metrics import Metrics
from driveline.harness.metrics.spectrum import band_rms, own_band
from driveline.harness.metrics.step_response import response
from fmuloop.results import Ended, Results


def run(duration=6.0, interval=1e-3, **signals):
    """Results whose other signals are zero; a signal may be a function of time."""
    t = np.arange(round(duration / interval) + 1) * interval
    results = np.zeros(len(t), dtype=[(name, float) for name in COLUMNS])
    results["time"] = t
    for name, signal in signals.items():
        column = next(column for column in COLUMNS if column.endswith("." + name))
        results[column] = signal(t) if callable(signal) else signal
    return results


STEP_METRICS = ("settling_time", "response_delay", "overshoot", "damping_ratio", "withheld_time")


def without_value(metrics):
    """The metrics that are NaN, and why."""
    values = {metric.name: metric.of(metrics) for metric in declared(Metrics)}
    return {name: metrics.absent[name] for name, value in values.items() if np.isnan(value)}


def after(t, t_0=1.0):
    """Time since t_0, and whether it has come (of time in whole nanoseconds)."""
    t = np.round(t, 9)
    return np.maximum(t - t_0, 0.0), t >= t_0


def decaying(zeta, f=8.0, dT=112.0):
    """Step response of a second-order system from -12 N.m, and its decay rate in 1/s."""
    sigma = 2 * pi * f * zeta / sqrt(1 - zeta**2)

    def T_gear(t):
        s, _ = after(t)
        return -12.0 + dT * (
            1 - np.exp(-sigma * s) * (np.cos(2 * pi * f * s) + sigma / (2 * pi * f) * np.sin(2 * pi * f * s))
        )

    return T_gear, sigma


@pytest.mark.parametrize("zeta", [0.03, 0.08, 0.15])
def test_a_decaying_oscillation_has_its_damping_overshoot_and_settling_time(zeta):
    T_gear, sigma = decaying(zeta)
    metrics = evaluate(run(T_gear=T_gear), MANOEUVRES["tipin15"])
    # the line of the final value is fitted to what is left of the oscillation too
    assert abs(metrics.overshoot - exp(-pi * zeta / sqrt(1 - zeta**2))) < 5e-3
    assert metrics.damping_ratio == pytest.approx(zeta, rel=0.05)
    envelope = -np.log(0.05) / sigma  # the swing over the next 0.2 s lies at most one half period later
    assert envelope - 1 / 8 < metrics.settling_time < envelope + 1 / 8
    assert metrics.end_swing < 0.05 * 112


def test_settling_ends_one_sample_after_the_last_swing_above_5_percent_if_it_ends():
    steps = run(T_gear=lambda t: np.where(np.round(t, 9) < 2.0, 0.0, 0.11 * 112.0))
    still = run(T_gear=lambda t: np.where(np.round(t, 9) < 2.0, 0.0, 0.09 * 112.0))
    assert evaluate(steps, MANOEUVRES["tipin15"]).settling_time == pytest.approx(1.0)
    assert evaluate(still, MANOEUVRES["tipin15"]).settling_time == 0.0
    swinging = evaluate(run(T_gear=lambda t: 6.0 * np.sin(50.0 * t)), MANOEUVRES["tipin15"])
    assert "still swings" in swinging.absent["settling_time"]
    still = evaluate(run(T_gear=lambda t: 5.0 * np.sin(50.0 * t)), MANOEUVRES["tipin15"])
    assert still.settling_time == 0.0


def test_response_delay_and_final_value_are_found_on_stairs_and_lines():
    stairs = run(T_gear=lambda t: np.select([t < 0.999, t < 1.0499, t < 1.0999], [0.0, 44.0, 46.0], 50.0))
    assert evaluate(stairs, MANOEUVRES["tipin15"]).response_delay == pytest.approx(0.05)
    drifting = run(T_gear=lambda t: np.where(after(t)[1], 100.0 - 3.0 * after(t)[0], 0.0))
    metrics = evaluate(drifting, MANOEUVRES["tipin15"])
    assert metrics.response_delay == 0.0
    assert metrics.overshoot < 1e-9


@given(st.integers(1, 40))
def test_the_time_withheld_by_a_pure_delay_is_the_delay(samples):
    tau = samples * T_S
    results = run(
        T_gear=decaying(0.1)[0],
        T_driver=MANOEUVRES["tipin15"].T_driver,
        T_ref=lambda t: MANOEUVRES["tipin15"].T_driver(np.round(t - tau - T_S, 9)),
    )
    metrics = evaluate(results, MANOEUVRES["tipin15"])
    assert metrics.withheld_time == pytest.approx(tau)
    assert metrics.added_torque_peak == 112.0
    assert metrics.stationary_torque_change == 0.0


@pytest.mark.parametrize("name", ["tipin15", "tipout"])
def test_the_computation_delay_is_not_counted_nor_makes_it_a_negative_zero(name):
    T_driver = MANOEUVRES[name].T_driver
    results = run(T_gear=decaying(0.1)[0], T_driver=T_driver, T_ref=lambda t: T_driver(np.round(t - T_S, 9)))
    metrics = evaluate(results, MANOEUVRES[name])
    assert (str(metrics.withheld_time), metrics.stationary_torque_change) == ("0.0", 0.0)
    assert (metrics.added_torque_rms, metrics.added_torque_peak) == (0.0, 0.0)


def test_stationary_change_and_plateau_swing_are_those_of_the_end_and_the_plateaus():
    results = run(duration=12.0, T_ref=lambda t: np.where(np.round(t, 9) >= 11.0, 0.7, 9.0))
    assert evaluate(results, MANOEUVRES["creep"]).stationary_torque_change == pytest.approx(0.7)
    results = run(duration=20.0, T_gear=lambda t: 50.0 + 2.0 * t + 0.3 * np.sin(2 * pi * 20.0 * t))
    assert evaluate(results, MANOEUVRES["drive"]).plateau_swing == pytest.approx(0.3, rel=0.05)


@pytest.mark.parametrize(("changes", "is_stationary"), [(10.498, True), (10.502, False), (11.7, False)])
def test_what_still_fades_after_a_change_of_the_demand_is_not_stationary(changes, is_stationary):
    results = run(duration=12.0, T_driver=lambda t: np.where(np.round(t, 9) >= changes, 20.0, 10.0))
    metrics = evaluate(results, MANOEUVRES["creep"])
    assert ("stationary_torque_change" in metrics.absent) != is_stationary
    if not is_stationary:
        assert metrics.absent["stationary_torque_change"] == "the demand is not constant in the last 1.5 s"


@given(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0))
def test_a_straight_line_has_no_band_rms(offset, slope):
    t = np.arange(2000) * T_S
    assert band_rms(offset + slope * t, T_S) < 1e-9
    assert band_rms(offset + slope * t, T_S, derivative=True) < 1e-7


@given(st.integers(21, 199), st.floats(0.1, 100.0))
def test_band_rms_of_a_sine_in_the_band(cycles, amplitude):
    n = 2000
    f = cycles / (n * T_S)
    x = amplitude * np.sin(2 * pi * cycles * np.arange(n) / n)
    # the line from the first to the last sample takes a little away, as the record is periodic, not closed
    assert band_rms(x, T_S) == pytest.approx(amplitude / sqrt(2), rel=0.02)
    assert band_rms(x, T_S, derivative=True) == pytest.approx(2 * pi * f * amplitude / sqrt(2), rel=0.05)


@pytest.mark.parametrize("f", [2.0, 60.0])
def test_band_rms_leaves_out_what_is_outside_the_band(f):
    assert band_rms(np.sin(2 * pi * f * np.arange(2001) * T_S), T_S) < 0.02


def test_jerk_is_the_derivative_of_the_acceleration():
    t = np.arange(6001) * 1e-3
    results = run(T_gear=decaying(0.1)[0], a_body=np.sin(2 * pi * 10.0 * t))
    metrics = evaluate(results, MANOEUVRES["tipin15"])
    assert metrics.jerk_rms == pytest.approx(2 * pi * 10.0 / sqrt(2), rel=0.02)
    assert metrics.jerk_rms == pytest.approx(metrics.jerk_rms_to_50_Hz, rel=0.02)


def test_swing_needs_a_complete_piece():
    x = np.r_[np.zeros(100), np.ones(100)]
    swing = amplitude(x, T_S)
    assert len(swing) == 101
    assert swing[[0, 1, 99, 100]].tolist() == [0.0, 0.5, 0.5, 0.0]


def test_impact_speed_is_the_speed_of_the_twist_when_the_torque_leaves_zero():
    """At the moment to which the rise of the torque leads back: 3/4, then 1/2 of an interval after the last zero."""
    T_gear = np.array([-1.0, 0.0, 0.0, 1.0, 5.0, 0.0, 0.0, -2.0, -6.0])
    speed = np.array([50.0, 10.0, 20.0, 99.0, 99.0, 4.0, 8.0, -12.0, 6.0])
    results = run(duration=8e-3, T_gear=T_gear, omega_1=100.0 + speed, omega_2=100.0)
    assert impact_speeds(results, 0.0).tolist() == [27.5, 10.0]
    assert impact_speeds(results, 0.003).tolist() == [10.0]
    assert impact_speeds(results, 0.1).tolist() == []


@pytest.mark.parametrize("interval", [1e-3, 1e-4])
def test_impact_speed_does_not_depend_on_the_rows(interval):
    """The twist speeds up by 2000 rad/s2 from one flank to the other, where a spring takes it up."""
    t = np.arange(round(0.1 / interval) + 1) * interval
    moving = np.clip(t - 0.0503, 0.0, None)
    meeting = np.sqrt(2.0 * 0.4 / 2000.0)
    twist, speed = np.minimum(1000.0 * moving**2, 0.4), np.minimum(2000.0 * moving, 2000.0 * meeting)
    into = 2000.0 * meeting * np.clip(moving - meeting, 0.0, None)
    assert twist.max() == 0.4
    results = run(duration=0.1, interval=interval, T_gear=200.0 * into, omega_1=100.0 + speed, omega_2=100.0)
    assert impact_speeds(results, 0.0) == pytest.approx([2000.0 * meeting], rel=0.001)


def test_nine_of_ten_impacts_do_not_exceed_their_quantile():
    """Eleven impacts at 1, 2, ... 11 rad/s, 20 ms apart."""
    t = np.arange(501) * 1e-3
    k = np.arange(501) % 40
    together = (k < 20) & (t < 0.43)
    speed = np.where(together, 0.0, 1.0 + np.floor(np.arange(501) / 40.0))
    results = run(duration=0.5, T_gear=np.where(together, 5.0, 0.0), omega_1=100.0 + speed, omega_2=100.0)
    found = impact_speeds(results, 0.0)
    metrics = evaluate(results, replace(MANOEUVRES["creep"], t_0=0.0))
    assert metrics.impact_speed == found.max()
    assert metrics.impact_speed_90 == np.quantile(found, 0.9) < found.max()
    assert evaluate(run(), MANOEUVRES["creep"]).impact_speed_90 == 0.0


def crossings(*apart, t_0=0.0):
    """The crossing time of a run of 2 s in which the teeth are apart between these instants in ms."""
    T_gear = np.full(2001, 5.0)
    for begin, end in apart:
        T_gear[begin:end] = 0.0
    return 1e3 * crossing_time(run(duration=2.0, T_gear=T_gear), t_0)


def test_a_crossing_lasts_from_where_the_teeth_part_to_where_they_meet_for_good():
    firm = round(1e3 * FIRM)
    assert crossings() == 0.0
    assert crossings((500, 560)) == pytest.approx(60.0)
    assert crossings((500, 560), (560 + firm, 570 + firm)) == pytest.approx(60.0)
    assert crossings((500, 560), (559 + firm, 570 + firm)) == pytest.approx(70.0 - 1.0 + firm + 1.0), "a bounce"
    assert crossings((100, 400), (500, 520), t_0=0.45) == pytest.approx(20.0), "before t_0 none counts"
    assert crossings((400, 520), t_0=0.5) == pytest.approx(20.0), "apart at t_0"
    assert crossings((500, 520), (1000, 2001)) == pytest.approx(20.0), "one that has not ended"


@pytest.mark.parametrize(("frequency", "band"), [(None, (5.0, 50.0)), (7.999, (5.0, 50.0)), (2.5, (1.6, 15.6))])
def test_the_band_of_the_rms_follows_from_the_frequency_of_the_car(frequency, band):
    """Of two sines of 1 N.m, within it and below it, the first one counts."""
    assert own_band(frequency) == band
    t = np.arange(6001) * 1e-3
    x = np.sin(2 * pi * 1.1 * band[0] * t) + np.sin(2 * pi * 0.6 * band[0] * t)
    results = Results(run(T_gear=x), {})
    results.frequency = frequency
    assert evaluate(results, MANOEUVRES["creep"]).gear_torque_rms == pytest.approx(1.0 / sqrt(2), rel=0.1)
    assert pickle.loads(pickle.dumps(results)).frequency == frequency


def test_metrics_of_a_step_are_not_given_for_a_drive_or_a_pulse():
    assert without_value(evaluate(run(duration=20.0), MANOEUVRES["drive"])) == dict.fromkeys(
        STEP_METRICS, "the manoeuvre is no step"
    )
    demand = lines((1.0, -12.0), (1.0, 100.0), (1.5, 100.0), (1.5, -12.0))
    pulse = replace(MANOEUVRES["tipin15"], T_driver=demand)
    found = without_value(evaluate(run(T_gear=decaying(0.1)[0]), pulse))
    assert {found[name] for name in STEP_METRICS} == {"the demand does not stay at the height of its step"}
    late = replace(MANOEUVRES["tipin15"], T_driver=lines((0.5, -12.0), (0.5, 5.0), (1.0, 5.0), (1.0, 100.0)))
    found = without_value(evaluate(run(T_gear=decaying(0.1)[0]), late))
    assert {found[name] for name in STEP_METRICS} == {"the demand is not constant before its step"}


def test_a_torque_that_does_not_follow_has_no_response():
    held = without_value(evaluate(run(T_gear=lambda t: 11.0 * after(t)[1]), MANOEUVRES["tipin15"]))
    assert {name for name, why in held.items() if "hardly follows" in why} == {
        "overshoot", "damping_ratio", "response_delay"
    }  # fmt: skip
    follows = without_value(evaluate(run(T_gear=lambda t: 11.3 * after(t)[1]), MANOEUVRES["tipin15"]))
    assert set(follows) == {"plateau_swing"}


@pytest.mark.parametrize("dT", [112.0, -112.0])
def test_the_response_of_a_torque_that_goes_the_other_way_is_the_same(dT):
    """Whichever way it goes, and whichever way was demanded."""
    results = run(T_gear=decaying(0.1)[0])
    up, down = (response(results["time"], side * results["plant.T_gear"], 1.0, dT) for side in (1.0, -1.0))
    assert down.z == pytest.approx(up.z)
    assert down.y == pytest.approx(up.y)
    assert (down.overshoot, down.delay) == pytest.approx((up.overshoot, up.delay))


@pytest.mark.parametrize("duration", [0.002, 0.1, 0.7, 1.1, 1.8])
@pytest.mark.parametrize("name", ["tipin15", "drive", "creep"])
def test_a_run_that_is_too_short_has_no_metrics_of_its_end(name, duration):
    found = without_value(evaluate(run(duration=duration, T_gear=decaying(0.1)[0]), MANOEUVRES[name]))
    assert set(STEP_METRICS) <= found.keys()
    assert all(found.values())


@pytest.mark.parametrize("rows", [1, 2001])
def test_a_run_that_an_fmu_has_ended_has_no_metrics(rows):
    ended = Results(run()[:rows], {})
    ended.ended = Ended("plant (car.fmu)", 2.0)
    metrics = evaluate(ended, MANOEUVRES["tipin15"])
    assert metrics.absent == {metric.name: "the run ended at 2 s" for metric in declared(Metrics)}


def test_the_peak_of_the_gear_torque_is_that_after_a_step_and_else_of_the_whole_run():
    def torque(t):
        return np.where(t < 0.5, -150.0, np.where(t < 2.0, -120.0, 100.0))

    assert evaluate(run(T_gear=torque), MANOEUVRES["tipin15"]).gear_torque_peak == 120.0
    assert evaluate(run(T_gear=torque), MANOEUVRES["creep"]).gear_torque_peak == 150.0


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("column", ["T_gear", "a_body", "T_ref", "omega_1"])
def test_metrics_of_what_is_not_finite_are_absent_and_never_zero(column, value):
    signal = np.zeros(6001)
    signal[2500:] = value
    signals: dict[str, Any] = {column: signal}
    metrics = evaluate(run(**signals), MANOEUVRES["tipin15"])
    found = without_value(metrics)
    assert found.keys() == {metric.name for metric in declared(Metrics)}
    assert all(f"{column} is not finite at 2.5 s" in why for why in found.values())


def test_a_plant_without_backlash_has_no_impact():
    T_gear = np.sin(np.arange(6001) * 0.05 + 0.01)
    found = evaluate(run(T_gear=T_gear, omega_1=30.0), MANOEUVRES["tipin15"])
    assert "no backlash" in found.absent["impact_speed"]
    T_gear[1130] = 0.0  # between both flanks
    assert T_gear[1129] * T_gear[1131] < 0.0
    assert evaluate(run(T_gear=T_gear, omega_1=30.0), MANOEUVRES["tipin15"]).impact_speed == 30.0


def test_only_samples_of_the_controller_count_and_must_be_there():
    T_gear, _ = decaying(0.08)
    coarse = evaluate(run(T_gear=T_gear, interval=2e-3), MANOEUVRES["tipin15"])
    fine = evaluate(run(T_gear=T_gear, interval=5e-4), MANOEUVRES["tipin15"])
    for name in ("settling_time", "overshoot", "gear_torque_rms", "damping_ratio"):
        assert getattr(fine, name) == pytest.approx(getattr(coarse, name))
    with pytest.raises(ValueError, match=r"3 ms apart.*2 ms"):
        evaluate(run(interval=3e-3), MANOEUVRES["tipin15"])


def test_damage_counts_ranges_to_the_fifth_power_of_what_is_finite():
    T_gear = np.array([0.0, 10.0, 0.0, 10.0, 0.0])
    assert damage(T_gear) == pytest.approx(2 * 10.0**5)
    assert damage(2.0 * T_gear) == pytest.approx(32 * damage(T_gear))
    with pytest.raises(Absent, match="not finite"):
        damage(np.array([0.0, 10.0, np.nan, 0.0]))
