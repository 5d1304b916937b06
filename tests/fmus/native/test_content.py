"""What a saved state may hold: all that an instance can have come to, and nothing else."""

import math
import struct
import sys

import pytest
from fmutesting.forged import HEAD, forged, with_number
from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS

SEED = 123457
OUTPUTS_KNOWN = 2
"""Its place in a state, in numbers from the end; it is one that Python builds do not have."""


def saved(host):
    return bytes(host.fmu.serializeFMUstate(host.fmu.getFMUstate()))


def restore(host, state):
    host.fmu.setFMUstate(host.fmu.deSerializeFMUstate(state))


def with_seed(state, seed):
    return with_number(state, state.index(struct.pack("=d", SEED)), struct.pack("=d", seed))


@pytest.fixture
def motor(native, tmp_path):
    with opened(native / "MotorTorqueLoop.fmu", tmp_path) as host:
        host.initialize(seed=SEED)
        yield host


@together(
    "seed, message",
    [
        (1_000_001.0, "seed = 1000001 is refused"),
        (-1.0, "seed = -1 is refused"),
        (1_000_000.5, "seed = 1000000.5 is refused"),
        (1.5, "its bytes are damaged"),
    ],
)
def test_a_parameter_is_what_could_have_been_set(motor, seed, message):
    assert message.removesuffix(" is refused") in motor.refuses(restore, motor, with_seed(saved(motor), seed))


@pytest.mark.parametrize("seed", [0.0, 1_000_000.0])
def test_a_parameter_may_be_at_its_bounds(motor, seed):
    restore(motor, with_seed(saved(motor), seed))
    assert motor.get("seed") == seed


@pytest.mark.parametrize("T_ref", [-2000.0, 2000.0])
def test_an_input_may_be_at_its_bounds_and_a_rate_as_large_as_a_number_can_be(motor, T_ref):
    motor.set(T_ref=T_ref)
    motor.fmu.setRealInputDerivatives([motor.variables["T_ref"].valueReference], [1], [sys.float_info.max])
    restore(motor, saved(motor))
    assert motor.get("T_ref") == T_ref


def test_a_run_may_start_and_stop_at_the_last_time_that_there_is(motor):
    motor.fmu.reset()
    motor.initialize(start_time=sys.float_info.max, stop_time=sys.float_info.max)
    restore(motor, saved(motor))


def test_a_state_that_is_no_number_is_refused_after_the_end_of_the_run_too(motor):
    motor.fmu.terminate()
    states = len(FMUS["MotorTorqueLoop"].block.State._fields)
    assert "x.T_mot = nan" in motor.refuses(restore, motor, forged(saved(motor), "state", math.nan, states=states))


def test_outputs_that_are_known_are_numbers(motor):
    first_output = HEAD + 8 * motor.variables["T_mot"].valueReference
    state = saved(motor)
    state = with_number(state, len(state) - 8 * OUTPUTS_KNOWN, struct.pack("=q", 1))
    restore(motor, with_number(state, first_output, struct.pack("=d", sys.float_info.max)))
    assert motor.get("T_mot") == sys.float_info.max
    message = motor.refuses(restore, motor, with_number(state, first_output, struct.pack("=d", math.inf)))
    assert "T_mot = inf" in message


def test_outputs_that_were_asked_for_are_not_computed_again(motor):
    motor.get("T_mot")
    first_output = HEAD + 8 * motor.variables["T_mot"].valueReference
    restore(motor, with_number(saved(motor), first_output, struct.pack("=d", 123.0)))
    assert motor.get("T_mot") == 123.0
    motor.set(T_ref=1.0)
    assert motor.get("T_mot") != 123.0


@pytest.mark.parametrize("counter", [-(2**31), 2**31 - 1])
def test_a_controller_keeps_signals_that_are_absurd(controller, counter):
    controller.initialize()
    controller.set(omega_1_meas=math.nan, T_mot_est=math.inf, counter=counter)
    restore(controller, saved(controller))
    assert math.isnan(controller.get("omega_1_meas"))
    assert (controller.get("T_mot_est"), controller.get("counter")) == (math.inf, counter)
