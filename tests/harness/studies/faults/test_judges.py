"""Each judge, just below and just above its limit, on made-up runs."""

from math import inf, nan

import numpy as np
import pytest

from driveline.harness.studies.faults.evidence import Evidence
from driveline.harness.studies.faults.fault_cases import Fault
from driveline.harness.studies.faults.fault_injection import Limits, Runs
from driveline.harness.studies.faults.judges import JUDGES

T = np.arange(2001) * 0.002
BEGIN, END = 1.0, 1.5
OTHERS = ("T_ref", "T_damp", "T_driver")


def quiet():
    """A run in which nothing happens, at 400 rad/s with a message every 20 ms."""
    columns = {f"controller.{name}": np.zeros(len(T)) for name in OTHERS}
    columns |= {"controller.status": np.full(len(T), 2), "plant.T_gear": np.zeros(len(T))}
    speeds = ("plant.omega_2", "motor.omega_1_meas", "faults.omega_1_meas", "faults.omega_2_can")
    columns |= {name: np.full(len(T), 400.0) for name in speeds}
    columns |= {"faults.T_mot_est": np.zeros(len(T)), "faults.counter": np.arange(len(T)) // 10}
    columns |= {"faults.valid": np.full(len(T), True), "can.valid": np.full(len(T), True)}
    run = np.zeros(len(T), [("time", float), *((name, column.dtype) for name, column in columns.items())])
    run["time"] = T
    for name, column in columns.items():
        run[name] = column
    return run


def between(start, end):
    return (start - 1e-9 <= T) & (end - 1e-9 > T)


def with_(*changes):
    """A quiet run but for columns that have values between two times in s."""
    run = quiet()
    for column, start, end, value in changes:
        run[column][between(start, end)] = value
    return run


def clean(judge, run, healthy=None, undamped=None, kind="motor speed offset", end=END, share=1.0):
    """Whether a judge finds a run under a fault clean."""
    runs = Runs(run, quiet() if healthy is None else healthy, quiet() if undamped is None else undamped)
    seen = Evidence(runs, (Fault(kind, BEGIN, end, 1.0, 1.0),), Limits(180.0, 60.0, 100.0, 2000.0, share))
    (found,) = (each for each in JUDGES if each.name == judge)
    return found.measure(seen) <= found.limit


def test_a_quiet_run_is_clean():
    assert all(clean(judge.name, quiet()) for judge in JUDGES)


@pytest.mark.parametrize(("T_ref", "verdict"), [(-180.0, True), (180.1, False), (nan, False), (-inf, False)])
def test_T_ref_is_finite_and_limited(T_ref, verdict):
    assert clean("limited", with_(("controller.T_ref", 1.4, 1.402, T_ref))) == verdict


@pytest.mark.parametrize(
    ("T_driver", "T_damp", "verdict"),
    [(50.0, 60.0, True), (50.0, 60.1, False), (50.0, -100.0, True), (50.0, -100.1, False), (0.0, -60.1, False)],
)
def test_more_may_be_taken_from_the_demand_than_added(T_driver, T_damp, verdict):
    run = with_(("controller.T_driver", 0.0, 5.0, T_driver), ("controller.T_damp", 1.4, 1.402, T_damp))
    assert clean("authority", run) == verdict


@pytest.mark.parametrize(("error", "after", "verdict"), [(65.0, 0.05, True), (65.0, 0.052, False), (63.0, 0.5, True)])
def test_a_motor_speed_that_is_wrong_by_more_than_40_rad_s_and_6_percent_is_noticed_within_50_ms(error, after, verdict):
    run = with_(("faults.omega_1_meas", BEGIN, END, 400.0 + error), ("controller.status", BEGIN + after, END, 4))
    assert clean("noticed", run) == verdict


@pytest.mark.parametrize(("after", "verdict"), [(0.11, True), (0.114, False)])
def test_a_wheel_speed_that_becomes_known_is_heard_before_it_shows_that_the_motor_speed_is_wrong(after, verdict):
    wrong = ("faults.omega_1_meas", 0.0, END, 0.0), ("controller.status", BEGIN + after, END, 4)
    assert clean("noticed", with_(*wrong, ("faults.valid", 0.0, BEGIN, False))) == verdict


@pytest.mark.parametrize(("torque", "verdict"), [(359.9, True), (-359.9, True), (360.1, False), (-360.1, False)])
def test_a_torque_estimate_of_more_than_twice_the_largest_torque_is_noticed(torque, verdict):
    assert clean("noticed", with_(("faults.T_mot_est", BEGIN, END, torque))) == verdict


@pytest.mark.parametrize(("omega_1", "verdict"), [(0.0, True), (nan, False)])
def test_without_a_good_message_a_wrong_motor_speed_need_not_be_noticed_but_no_number_must(omega_1, verdict):
    run = with_(("faults.valid", 0.0, 5.0, False), ("faults.omega_1_meas", BEGIN, END, omega_1))
    assert clean("noticed", run) == verdict


@pytest.mark.parametrize(("after", "verdict"), [(0.15, True), (0.152, False)])
def test_a_message_that_is_not_valid_does_not_count_for_long(after, verdict):
    run = with_(("faults.valid", BEGIN, END, False), ("controller.status", BEGIN + after, END, 3))
    assert clean("stale", run) == verdict


@pytest.mark.parametrize(
    ("kind", "start", "verdict"),
    [
        ("motor speed offset", 1.998, True),
        ("motor speed offset", 2.0, False),
        ("motor speed offset", 0.998, False),
        ("wheel speed offset", 1.2, False),
        ("motor torque ±30 %", 1.2, False),
        ("wheel lock on ice", 1.2, False),
    ],
)
def test_fallback_is_for_faults_of_motor_signals_alone_and_ends_with_them(kind, start, verdict):
    assert clean("false alarm", with_(("controller.status", start, start + 0.002, 4)), kind=kind) == verdict


@pytest.mark.parametrize(("drift", "verdict"), [(19.0, True), (21.0, False)])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_nothing_tells_whether_motor_or_wheel_speed_is_wrong_that_drift_apart(side, drift, verdict):
    """But messages that leap are themselves to be doubted."""
    wheels = "faults.omega_2_can"
    leaps = (wheels, BEGIN, END, 400.0 + 40.0 * side), (wheels, BEGIN + 0.02, END, 400.0 + (40.0 + drift) * side)
    run = with_(*leaps, ("controller.status", BEGIN + 0.02, END + 0.5, 4))
    assert clean("false alarm", run, kind="wheel speed offset") == verdict


@pytest.mark.parametrize(("known", "verdict"), [(BEGIN, True), (0.0, False)])
def test_messages_that_are_wrong_from_the_first_have_not_leapt(known, verdict):
    wrong = ("faults.omega_2_can", BEGIN, END, 460.0), ("controller.status", BEGIN, END + 0.5, 4)
    run = with_(*wrong, ("faults.valid", 0.0, known, False))
    assert clean("false alarm", run, kind="wheel speed offset") == verdict


@pytest.mark.parametrize(("omega_1", "verdict"), [(1999.0, False), (-1999.0, False), (2001.0, True), (-2001.0, True)])
def test_a_motor_that_turns_faster_than_is_plausible_is_not_believed(omega_1, verdict):
    run = with_(("motor.omega_1_meas", BEGIN, END, omega_1), ("controller.status", BEGIN, END + 0.5, 4))
    assert clean("false alarm", run, kind="wheel spin on ice") == verdict


def test_it_need_not_be_back_while_the_motor_turns_too_fast():
    run = with_(("controller.status", BEGIN, 3.0, 4))
    assert not clean("back", run)
    run["motor.omega_1_meas"][between(BEGIN, 2.51)] = 2001.0
    assert clean("back", run)


@pytest.mark.parametrize("status", [3, 4])
@pytest.mark.parametrize(("end", "verdict"), [(END + 0.5, True), (END + 0.502, False)])
def test_everything_is_as_before_within_half_a_second(status, end, verdict):
    assert clean("back", with_(("controller.status", BEGIN, end, status))) == verdict


@pytest.mark.parametrize(("T_damp", "verdict"), [(1.9, True), (2.1, False), (-2.1, False)])
def test_no_kick_after_the_return(T_damp, verdict):
    run = with_(("controller.status", BEGIN, END + 0.2, 4), ("controller.T_damp", END + 0.25, END + 0.3, T_damp))
    assert clean("kick", run) == verdict
    run["plant.T_gear"][between(END + 0.1, END + 0.24)] = 0.2
    assert clean("kick", run)


def test_a_wheel_speed_that_is_valid_one_message_later_than_without_the_fault_is_back_at_once():
    """The controller answers with the next sample."""
    later = ("can.valid", 0.0, 2.3, False), ("faults.valid", 0.0, 2.3, False)
    run = with_(*later, ("controller.status", 0.0, 2.302, 3))
    assert clean("back", run)
    run["controller.status"][between(0.0, 2.304)] = 3
    assert not clean("back", run)


@pytest.mark.parametrize(("T_damp", "verdict"), [(20.0, True), (22.1, False), (-1.9, True), (-2.1, False)])
def test_less_than_is_added_without_the_fault_is_no_kick(T_damp, verdict):
    run = with_(("controller.status", BEGIN, END + 0.2, 4), ("controller.T_damp", END + 0.25, END + 0.3, T_damp))
    assert clean("kick", run, healthy=with_(("controller.T_damp", 0.0, 5.0, 20.0))) == verdict


@pytest.mark.parametrize(("swing", "verdict"), [(4.9, True), (5.1, False)])
def test_no_oscillation_is_left(swing, verdict):
    run = quiet()
    run["plant.T_gear"] = np.where(T > 3.5, swing, 0.0) * np.sin(50.0 * T)
    assert clean("settled", run) == verdict


@pytest.mark.parametrize(
    ("kind", "end", "verdict"),
    [
        ("motor speed NaN", 5.0, True),
        ("motor speed NaN", 3.9, False),
        ("wheel speed NaN", 5.0, False),
    ],
)
def test_where_a_motor_signal_stays_wrong_the_drive_train_may_swing_as_without_control(kind, end, verdict):
    run, off = quiet(), quiet()
    run["plant.T_gear"] = off["plant.T_gear"] = 20.0 * np.sin(50.0 * T)
    assert clean("settled", run, undamped=off, kind=kind, end=end) == verdict


@pytest.mark.parametrize("judge", ["rms", "swing"])
@pytest.mark.parametrize("undamped", [0.0, 20.0])
@pytest.mark.parametrize(("ratio", "verdict"), [(1.19, True), (1.21, False)])
def test_the_drive_train_swings_little_more_than_without_control(judge, undamped, ratio, verdict):
    least = {"rms": 1.0 * np.sqrt(2.0), "swing": 5.0}[judge]
    run, off = quiet(), quiet()
    wave = np.sin(2.0 * np.pi * 10.0 * (T - 0.9))
    run["plant.T_gear"] = ratio * max(undamped, least) * wave
    off["plant.T_gear"] = undamped * wave
    assert clean(judge, run, undamped=off) == verdict


@pytest.mark.parametrize(
    ("judge", "limit"), [("kick", 2.0), ("settled", 5.0), ("rms", 1.2 * 2**0.5), ("swing", 1.2 * 5.0)]
)
@pytest.mark.parametrize(("factor", "verdict"), [(0.99, True), (1.01, False)])
def test_a_motor_of_ten_times_the_torque_may_leave_ten_times_as_much(judge, limit, factor, verdict):
    run, height = quiet(), 10.0 * factor * limit
    run["plant.T_gear"] = (judge != "kick") * height * np.sin(2.0 * np.pi * 10.0 * (T - 0.9))
    run["controller.T_damp"][between(END + 0.75, END + 0.8)] = (judge == "kick") * height
    assert clean(judge, run, share=10.0) == verdict
    assert clean(judge, run, share=11.0)


@pytest.mark.parametrize(("ratio", "verdict"), [(1.19, True), (1.21, False)])
def test_a_swing_that_is_there_without_the_fault_is_not_its_doing(ratio, verdict):
    """Damping may swing later than the free drive train, and then more from the fault on."""
    run, well = quiet(), quiet()
    wave = np.sin(2.0 * np.pi * 10.0 * (T - 0.9))
    run["plant.T_gear"], well["plant.T_gear"] = ratio * 20.0 * wave, 20.0 * wave
    assert clean("swing", run, healthy=well) == verdict
