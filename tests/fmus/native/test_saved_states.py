"""What only a native build has in a saved state: the outputs, and the rates of change of the inputs."""

import math

import pytest

from fmus.catalogue import FMUS
from fmus.signal_faults import FMU as FAULTS
from models.signal_faults import MOTOR_SPEED, NO_NUMBER
from tests.fmus.forged import forged
from tests.fmus.host import opened


def serialized(host):
    return bytes(host.fmu.serializeFMUstate(host.fmu.getFMUstate()))


def restore(host, saved):
    host.fmu.setFMUstate(host.fmu.deSerializeFMUstate(saved))


@pytest.fixture
def motor(native, tmp_path):
    """The loop of the motor after a step, with T_mot at 40 N.m."""
    with opened(native / "MotorTorqueLoop.fmu", tmp_path / "motor") as host:
        host.initialize(T_ref=40.0)
        host.step(0.0, 0.01)
        yield host


@pytest.fixture
def faulty(native_builder, tmp_path):
    """SignalFaults while it makes the motor speed no number."""
    with opened(native_builder(FAULTS, tmp_path), tmp_path / "faulty") as host:
        host.initialize(kind_1=NO_NUMBER, signal_1=MOTOR_SPEED, begin_1=0.0, end_1=0.02, omega_1_sent=50.0)
        host.step(0.0, 0.01)
        yield host


def test_a_state_with_an_output_that_is_meant_to_be_no_number_is_as_good_as_any(faulty):
    assert math.isnan(faulty.get("omega_1_meas"))
    saved = serialized(faulty)
    faulty.step(0.01, 0.02)
    assert faulty.get("omega_1_meas") == 50.0
    restore(faulty, saved)
    assert math.isnan(faulty.get("omega_1_meas"))
    faulty.step(0.01, 0.02)
    assert faulty.get("omega_1_meas") == 50.0


def test_the_bytes_of_a_state_do_not_depend_on_who_has_looked_at_the_outputs(motor):
    motor.set(T_ref=30.0)
    before = serialized(motor)
    motor.outputs()
    assert serialized(motor) == before
    restore(motor, before)
    assert serialized(motor) == before


@pytest.mark.parametrize("value", [math.nan, 12345.0])
def test_outputs_in_the_bytes_of_a_state_are_not_believed(motor, value):
    expected = motor.outputs()
    restore(motor, forged(serialized(motor), "output", value, FMUS["MotorTorqueLoop"].block))
    assert motor.outputs() == expected


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_rate_of_an_input_that_is_no_number_is_refused(motor, value):
    saved = forged(serialized(motor), "rate", value, FMUS["MotorTorqueLoop"].block)
    said = motor.refuses(restore, motor, saved)
    assert said == f"the FMU state is refused: du.T_ref = {value!r} in it; allowed is any finite number"
