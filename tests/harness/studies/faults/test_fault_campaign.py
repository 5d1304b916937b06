"""What a campaign draws and judges; tests/harness/simulation/test_many_runs.py has its workers."""

import shutil
from collections import Counter
from dataclasses import astuple
from hashlib import sha256

import numpy as np
import pytest
from fmutesting.foreign import tampered

from driveline.fmus.catalogue import EVERY
from driveline.harness.loop.places import NO_DAMPING
from driveline.harness.loop.resolved import as_given
from driveline.harness.simulation.simulate import signals, start
from driveline.harness.studies.faults import evidence, fault_catalogue
from driveline.harness.studies.faults.fault_campaign import campaign, outcome, table
from driveline.harness.studies.faults.fault_cases import PLANS, SITUATIONS, Case, Fault, case
from driveline.harness.studies.faults.fault_catalogue import FRAME, KINDS, LATE, LOCK, NOTHING, SPIN, WHEEL_SPEED
from driveline.harness.studies.faults.fault_injection import FaultRunner, with_faults
from driveline.harness.studies.faults.judges import JUDGES
from driveline.models import signal_faults
from driveline.models.controller import supervision
from fmuloop.campaign import Outcome as Answered
from fmuloop.campaign import RunResults
from fmuloop.errors import RunEnded
from fmuloop.experiment import Experiment
from fmuloop.runs import run
from toolground.collected_warnings import warn_once
from toolground.errors import UserError

PLANTS = ("TwoMassDriveline", "ValidationVehicle")


def test_whatever_happens_to_the_wheel_speed_alone_the_damping_has_to_go_on():
    assert all(kind.tolerable for kind in KINDS.values() if kind.signal == WHEEL_SPEED)


def test_sizes_are_drawn_on_both_sides_and_nothing_goes_wrong_with_nothing():
    rng = np.random.default_rng(1)
    sizes = [KINDS["motor torque ±30 %"].size(rng) for _ in range(500)]
    assert 0.7 <= min(sizes) < 0.71
    assert 1.29 < max(sizes) <= 1.3
    assert all(NOTHING not in pair for pair in PLANS["roads"].pairs)


def test_cases_follow_from_seed_and_number_for_ever_and_half_are_pairs():
    assert case(7, 1, PLANTS) == case(7, 1, PLANTS)
    assert case(7, 2, PLANTS).faults != case(7, 1, PLANTS).faults
    pairs = [each for n in range(1, 201) if len((each := case(n, 1, PLANTS)).faults) == 2]
    assert len(pairs) == 100
    assert all(first.name != second.name for first, second in (each.faults for each in pairs))
    # Whatever other campaigns are drawn from: a page of years ago names them by number.
    cases = "\n".join(str(astuple(case(n, 1, PLANTS))) for n in range(1, 1001))
    assert sha256(cases.encode()).hexdigest() == "9b1cd5a481ed7ac7b9a6e22377edb6db1331f2ec28830599ca8a78d556dc407d"


@pytest.mark.parametrize("plan", PLANS.values(), ids=PLANS)
def test_single_faults_go_through_all_kinds_and_situations_on_both_plants(plan):
    everything = 2 * len(PLANTS) * len(plan.kinds) * len(plan.situations)
    singles = [each for n in range(1, everything + 1) if len((each := case(n, 1, PLANTS, plan)).faults) == 1]
    cells = Counter((each.plant, each.situation, each.faults[0].name) for each in singles)
    assert set(cells.values()) == {1}
    assert len(cells) == everything / 2
    assert all(each.plan is plan for each in singles)


def test_on_roads_half_of_the_faults_stay_and_frames_come_late():
    cases = [case(n, 1, PLANTS, PLANS["roads"]) for n in range(1, 2001)]
    faults = [(fault, each.plan.situations[each.situation].duration) for each in cases for fault in each.faults]
    assert np.mean([fault.end > duration for fault, duration in faults]) == pytest.approx(0.52, abs=0.04)
    late = [fault.size for fault, _ in faults if (fault.kind.signal, fault.kind.number) == (FRAME, LATE)]
    assert 0.01 <= min(late) < 0.015
    assert 0.07 < max(late) <= 0.1


def test_faults_and_states_are_numbered_as_in_the_models():
    """The harness knows no models, so it declares them."""
    signals_ = "MOTOR_SPEED", "MOTOR_TORQUE", "WHEEL_SPEED", "FRAME"
    faults = "LATE", "FROZEN", "LOST", "GAIN", "OFFSET", "NOISE", "SPIKES", "NO_NUMBER", "FLAPPING", "JUMPING"
    for name in signals_ + faults:
        assert getattr(fault_catalogue, name) == getattr(signal_faults, name)
    for name in ("WITH_WHEEL_SPEED", "WITHOUT_WHEEL_SPEED", "FALLBACK"):
        assert getattr(evidence, name) == getattr(supervision, name)


def test_plants_of_the_same_name_are_refused(tmp_path):
    with pytest.raises(UserError, match="two plants are called car"):
        FaultRunner(tmp_path / "SignalFaults.fmu", {"mine/car.fmu": as_given(), "theirs/car.fmu": as_given()})


@pytest.mark.parametrize("plant", PLANTS)
def test_the_injector_without_a_fault_changes_nothing(injector, loops, plant):
    manoeuvre = SITUATIONS["gap"].manoeuvre
    plain = loops[plant].system
    direct, through = (
        run(system, Experiment(1.3, inputs=signals(manoeuvre), parameters=start(manoeuvre)))
        for system in (plain, with_faults(plain, injector))
    )
    assert all(np.array_equal(direct[name], through[name]) for name in direct.dtype.names or ())


def test_a_controller_that_tells_neither_status_nor_torque_is_judged_by_the_rest(
    injector, loops, native_builder, tmp_path, caplog
):
    warn_once.cache_clear()
    native_builder(EVERY[NO_DAMPING], loops["TwoMassDriveline"].settings.folder)

    def change(xml):
        for name in ("status", "T_damp", "enable"):
            xml = xml.replace(f'name="{name}"', f'name="my_{name}"')
        return xml

    of_ours = loops["TwoMassDriveline"]
    mine = tampered(of_ours.settings.folder / "native" / "DampingController.fmu", tmp_path / "mine.fmu", change)
    theirs, ours = (
        campaign(FaultRunner(injector, {"TwoMassDriveline": each}), [1, 3], 1, workers=1)
        for each in (of_ours.replace(controller=mine), of_ours)
    )
    silent = {judge.name for judge in JUDGES if judge.of_status}
    for their, our in zip(theirs, ours, strict=True):
        told = {name: value for name, value in our.measured.items() if name not in silent}
        assert {name: their.measured[name] for name in told} == pytest.approx(told, rel=1e-9, abs=1e-9)
    assert "mine.fmu has no output status; not judged: noticed, stale, false alarm, back" in caplog.text


def test_a_case_that_an_fmu_ends_is_not_clean(caplog):
    ended = RunResults([Answered(None, RunEnded("plant (car.fmu) ended the run at 2 s"))])
    warn_once.cache_clear()
    each = case(1, 1, PLANTS)
    found = outcome(object.__new__(FaultRunner), each, ended)
    assert found.failed == tuple(judge.name for judge in JUDGES if judge.name not in each.plan.excused)
    cells = [str(cell) for cell in table(1, PLANTS).cells(each, found)]
    assert table(1, PLANTS).parsed(cells) == (each, found)
    assert caplog.messages == [f"case {each}: plant (car.fmu) ended the run at 2 s"]


def test_runs_that_are_kept_hold_what_is_read_of_them_alone(injector, loops):
    fault = Fault("motor speed NaN", 1.0, 1.5, 1.0, 1.0)
    runs = FaultRunner(injector, loops).runs(Case(1, "TwoMassDriveline", "coasting", (fault,), 1))
    for run_ in (runs.healthy, runs.undamped):
        assert run_.nbytes < 24 * len(runs.faulty)
        assert run_.base is None


@pytest.mark.parametrize(
    ("plant", "least", "most"), [("TwoMassDriveline", 0.25, 1.1), ("ValidationVehicle", 0.05, 1.5)]
)
def test_on_ice_the_wheels_lock_and_spin(injector, loops, plant, least, most):
    runner = FaultRunner(injector, loops)

    def speed_of_the_wheels(kind, size):
        """Over that of rolling."""
        fault = Fault(kind, 1.0, 1.5, size, 1.0)
        undamped = runner.runs(Case(1, plant, "coasting", (fault,), 1)).undamped
        return undamped["plant.omega_2"] / (undamped["plant.v"] * 9.0 / 0.29)

    assert speed_of_the_wheels(LOCK, 4000.0).min() < least
    assert speed_of_the_wheels(SPIN, 80.0).max() > most


@pytest.mark.parametrize("T_max", [100.0, 1300.0])
def test_a_car_with_another_motor_is_asked_for_its_share(injector, loops, T_max):
    """In all three runs, and when the wheels are made to spin."""
    made = loops["TwoMassDriveline"].with_parameters({f"{block}.T_max": T_max for block in ("motor", "controller")})
    runner = FaultRunner(injector, {"TwoMassDriveline": made})
    fault = Fault(SPIN, 1.5, 1.7, 80.0, 1.0)
    demand = runner.runs(Case(1, "TwoMassDriveline", "gap", (fault,), 1)).undamped["controller.T_driver"]
    assert runner.limits("TwoMassDriveline").share == T_max / 180.0
    assert demand.max() == pytest.approx((100.0 + 80.0) * T_max / 180.0)


@pytest.mark.parametrize("plant", PLANTS)
def test_on_a_hill_of_ice_the_wheels_spin_without_a_fault(injector, loops, plant):
    """While the driver pushes; the design model has slip in the place of a limit of friction."""
    fault = Fault(NOTHING.name, 2.0, 3.0, 1.0, 1.0)
    found = FaultRunner(injector, loops).runs(Case(1, plant, "ice_hill", (fault,), 1)).faulty
    assert found["time"][-1] == SITUATIONS["ice_hill"].duration
    assert (found["plant.omega_2"] / 9.0 * 0.29 - found["plant.v"]).max() > 0.4


def test_an_fmu_that_was_changed_since_is_refused(injector, loops, tmp_path):
    mine = shutil.copy(injector, tmp_path / "SignalFaults.fmu")
    runner = FaultRunner(mine, loops)
    mine.write_bytes((loops["TwoMassDriveline"].settings.folder / "native" / "WheelSpeedCan.fmu").read_bytes())
    with pytest.raises(UserError, match=r"SignalFaults\.fmu is not the one that the campaign was begun with"):
        campaign(runner, [1], 3, workers=1)
