"""Lost trust comes back in the loop, and damping on a late motor speed does not last, however the foot moves."""

from dataclasses import replace

import numpy as np
import pytest

from driveline.harness.loop.places import T_S
from driveline.harness.manoeuvres.catalogue import MANOEUVRES
from driveline.harness.manoeuvres.manoeuvre import Manoeuvre
from driveline.harness.manoeuvres.signals import lines
from driveline.harness.metrics.evaluate import at_samples
from driveline.harness.metrics.spectrum import band_rms
from driveline.harness.simulation.simulate import signals, start
from driveline.harness.studies.faults.fault_campaign import campaign
from driveline.harness.studies.faults.fault_cases import PLANS
from driveline.harness.studies.faults.fault_injection import FaultRunner, with_faults
from driveline.models.controller import causes, supervision
from driveline.models.signal_faults import GAIN, LATE, MOTOR_SPEED, MOTOR_TORQUE, NO_NUMBER, WHEEL_SPEED
from fmuloop.experiment import Experiment
from fmuloop.runs import run

ACTING = supervision.WITH_WHEEL_SPEED, supervision.WITHOUT_WHEEL_SPEED
PLANTS = ("TwoMassDriveline", "ValidationVehicle")
LOCKED = Manoeuvre(
    "wheels lock on snow", "", 4.0, 15.0, lines((0.0, 0.0)), lines((1.0, 0.0), (1.0, 2500.0), (2.0, 2500.0), (2.0, 0.0))
)
BACKWARDS = Manoeuvre("pulls away backwards", "", 4.0, 0.0, lines((1.0, 0.0), (1.2, -80.0)))
REVERSAL = Manoeuvre("turns round without a rest", "", 4.0, 1.0, lines((0.5, 0.0), (0.5, -150.0)))
COASTING = Manoeuvre("brakes out of coasting", "", 6.0, 12.0, lines((2.0, 0.0), (2.0, -40.0)))
CREEPING = Manoeuvre("creeps, then backwards", "", 4.0, 0.0, lines((1.0, 0.0), (1.0, 5.0), (1.03, 5.0), (1.03, -80.0)))


def faulty(injector, loop, manoeuvre, *faults, control=True, plant=None):
    """The samples of a run with faults: the kind, signal, begin, end and size of each."""
    parameters = start(manoeuvre, 1)
    for k, fault in enumerate(faults, 1):
        given = zip(("kind", "signal", "begin", "end", "size"), fault, strict=True)
        parameters |= {f"faults.{name}_{k}": value for name, value in given}
    parameters |= {f"plant.{name}": value for name, value in (plant or {}).items()}
    inputs = signals(manoeuvre, control)
    experiment = Experiment(manoeuvre.duration, inputs=inputs, parameters=parameters)
    return at_samples(run(with_faults(loop.system, injector), experiment))


@pytest.mark.parametrize("signal", [MOTOR_SPEED, MOTOR_TORQUE])
@pytest.mark.parametrize(
    ("plant", "manoeuvre", "road", "begin"),
    [
        ("ValidationVehicle", LOCKED, {"mu": 0.2}, 1.8),
        ("ValidationVehicle", LOCKED, {"mu": 0.2}, 2.017),
        *((plant, BACKWARDS, {}, 1.02) for plant in PLANTS),
    ],
)
def test_a_signal_that_was_lost_while_the_direction_is_new_heals(
    injector, loops, plant, manoeuvre, road, begin, signal
):
    """Wheels that lock throw the motor back, and a motor that has hardly moved has not told where it goes."""
    for lasting in (0.05, 0.1, 0.3):
        fault = (NO_NUMBER, signal, begin, begin + lasting, 1.0)
        y = faulty(injector, loops[plant], manoeuvre, fault, plant=road)
        late = y["time"] > begin + lasting + 0.25
        assert [supervision.FALLBACK in y["controller.status"][k] for k in (~late, late)] == [True, False]


def late(demand, end):
    """A demand that is not there before its end in s."""
    return lambda t: np.where(np.asarray(t) < end - 1e-9, 0.0, demand(t))


@pytest.mark.parametrize("plant", PLANTS)
@pytest.mark.parametrize("name", ["tipin15", "one_pedal_soft"])
@pytest.mark.parametrize(("first", "sign"), [(0.002, 0.0), (0.05, 0.0), (0.004, -1.0), (0.09, -1.0)])
def test_a_start_with_first_samples_that_are_not_those_of_the_car_heals(injector, loops, plant, name, first, sign):
    """Nothing, with a negative demand one sample before the speeds, which looks like a car that is pushed backwards out
    of rest; or a motor that seems to turn backwards, for less than t_apart."""
    drive = MANOEUVRES[name]
    manoeuvre = replace(drive, duration=1.0, T_driver=late(drive.T_driver, first) if sign == 0.0 else drive.T_driver)
    end = first + 0.002
    faults = [(GAIN, MOTOR_SPEED, 0.0, end, sign), (GAIN, WHEEL_SPEED, 0.0, end, abs(sign))]
    y = faulty(injector, loops[plant], manoeuvre, *faults)
    assert np.isin(y["controller.status"], ACTING)[y["time"] > end + 0.5].all()


@pytest.mark.parametrize("plant", PLANTS)
def test_a_wrong_sign_while_the_car_pulls_away_out_of_rest_is_not_taken_for_its_direction(injector, loops, plant):
    """A rest that was seen tells where the demand pushes; the sign is right again after 0.3 s."""
    y = faulty(injector, loops[plant], MANOEUVRES["launch"], (GAIN, MOTOR_SPEED, 1.071, 1.365, -1.0))
    fallback = y["time"][y["controller.status"] == supervision.FALLBACK]
    assert 1.3 < fallback.max() < 1.365 + 0.5
    assert np.abs(y["plant.T_gear"]).max() < 200.0


@pytest.mark.slow
def test_cases_of_the_campaign_of_starts_are_clean(injector, loops):
    outcomes = campaign(FaultRunner(injector, loops), range(1, 55), 3, workers=1, plan=PLANS["starts"])
    assert not [outcome for outcome in outcomes if outcome.failed]


@pytest.mark.parametrize("plant", PLANTS)
def test_a_car_that_turns_round_without_a_rest_is_trusted_and_a_fault_meanwhile_heals(injector, loops, plant):
    healthy = faulty(injector, loops[plant], REVERSAL, (NO_NUMBER, MOTOR_SPEED, 9.0, 9.1, 1.0))
    assert supervision.FALLBACK not in healthy["controller.status"]
    turned = float(healthy["time"][np.argmax(healthy["plant.omega_1"] < -3.0)])
    for after in (0.02, 0.06, 0.09, 0.15):
        fault = (NO_NUMBER, MOTOR_SPEED, turned + after, turned + after + 0.05, 1.0)
        y = faulty(injector, loops[plant], REVERSAL, fault)
        fallback = y["time"][y["controller.status"] == supervision.FALLBACK]
        assert 0.0 < fallback.max() - turned - after < 0.3


@pytest.mark.parametrize("plant", PLANTS)
def test_a_car_that_coasts_under_a_motor_speed_of_zero_is_not_at_rest(injector, loops, plant):
    """A demand does not say where it goes: trust is back after the fault."""
    y = faulty(injector, loops[plant], COASTING, (GAIN, MOTOR_SPEED, 1.0, 3.0, 0.0))
    fallback = y["time"][y["controller.status"] == supervision.FALLBACK]
    assert 3.0 <= fallback.max() < 3.3


@pytest.mark.parametrize("plant", PLANTS)
def test_a_wrong_sign_is_found_where_the_demand_has_changed_its_sign_since_rest(injector, loops, plant):
    y, off = (
        faulty(injector, loops[plant], CREEPING, (GAIN, MOTOR_SPEED, 0.0, 9.0, -1.0), control=control)
        for control in (True, False)
    )
    assert y["controller.status"][-1] == supervision.FALLBACK
    assert band_rms(y["plant.T_gear"], T_S) < 0.6 * band_rms(off["plant.T_gear"], T_S)


@pytest.mark.parametrize("plant", PLANTS)
@pytest.mark.parametrize("late", [0.03, 0.062])
def test_a_late_motor_speed_is_not_excused_by_every_change_of_the_demand(injector, loops, plant, late):
    fault = (LATE, MOTOR_SPEED, 1.0, 99.0, late)
    on, off = (
        band_rms(faulty(injector, loops[plant], MANOEUVRES["prbs"], fault, control=control)["plant.T_gear"], T_S)
        for control in (True, False)
    )
    assert on < 1.2 * off


def test_a_healthy_drive_with_many_steps_keeps_its_damping(injector, loops):
    for plant in PLANTS:
        y = faulty(injector, loops[plant], MANOEUVRES["prbs"], (LATE, MOTOR_SPEED, 99.0, 99.0, 0.0))
        assert np.mean(y["controller.cause"] != causes.NONE) == 0.0
