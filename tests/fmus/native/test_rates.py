"""Inputs that move within a step, rates of change of outputs, directional derivatives."""

import math
import sys

import pytest
from fmpy.fmi1 import FMICallException
from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks.block.types import ContinuousBlock

CONTINUOUS = [name for name, fmu in FMUS.items() if isinstance(fmu.block, ContinuousBlock)]
every_continuous = together("name", CONTINUOUS)


def references(host, *names):
    return [host.variables[name].valueReference for name in names]


def ramp(host, **rates):
    host.fmu.setRealInputDerivatives(references(host, *rates), [1] * len(rates), list(rates.values()))


def rates_of(host, *names):
    return host.fmu.getRealOutputDerivatives(references(host, *names), [1] * len(names))


def derivative(host, unknown, known):
    return host.fmu.getDirectionalDerivative(references(host, unknown), references(host, known), [1.0])[0]


def real(host, causality):
    return [n for n in host.names(causality) if host.variables[n].type == "Real"]


def test_a_ramp_in_one_step_is_that_of_many_small_stairs(motor):
    motor.initialize()
    ramp(motor, T_ref=1000.0)
    motor.step(0.0, 0.02)
    ramped = motor.get("T_mot")
    assert motor.get("T_ref") == pytest.approx(20.0, rel=1e-12), "the input is where the ramp led it"
    motor.fmu.reset()
    motor.initialize()
    stairs = 2000
    for k in range(stairs):
        motor.set(T_ref=20.0 * (k + 0.5) / stairs)
        motor.step(k * 0.02 / stairs, 0.02 / stairs)
    assert ramped == pytest.approx(motor.get("T_mot"), rel=1e-5)


def test_a_ramp_lasts_for_one_step(motor):
    motor.initialize()
    ramp(motor, T_ref=1000.0)
    motor.step(0.0, 0.01)
    motor.step(0.01, 0.01)
    assert motor.get("T_ref") == pytest.approx(10.0)
    ramp(motor, T_ref=1000.0)
    motor.set(T_ref=5.0)
    motor.step(0.02, 0.01)
    assert motor.get("T_ref") == 5.0


def test_a_ramp_out_of_the_range_is_refused_and_nothing_moves(motor):
    motor.initialize(T_ref=1990.0)
    ramp(motor, T_ref=1000.0)
    before = motor.outputs()
    message = motor.refuses(motor.step, 0.0, 0.02)
    assert message == "T_ref = 2010.0 N.m at the end of the step is refused; allowed is -2000 to 2000 N.m"
    assert (motor.outputs(), motor.get("T_ref")) == (before, 1990.0)
    motor.step(0.0, 0.005)


@together("sign", [-1.0, 1.0])
def test_a_ramp_may_end_at_the_bound(motor, sign):
    motor.fmu.reset()
    motor.initialize()
    ramp(motor, T_ref=sign * 2000.0)
    motor.step(0.0, 1.0)
    assert motor.get("T_ref") == sign * 2000.0


def test_after_a_ramp_the_outputs_no_longer_follow_it(motor):
    motor.initialize(q_omega=0.0)
    ramp(motor, omega_1=1000.0)
    assert rates_of(motor, "omega_1_meas") == [1000.0]
    motor.step(0.0, 0.01)
    assert rates_of(motor, "omega_1_meas") == [0.0]


@together("rate", [math.nan, math.inf])
def test_a_rate_that_is_not_finite_is_refused(motor, rate):
    assert "as derivative of T_ref" in motor.refuses(ramp, motor, T_ref=rate)
    assert "T_mot is not an input" in motor.refuses(ramp, motor, T_mot=1.0)
    ramp(motor, T_ref=math.copysign(sys.float_info.max, rate))


def test_only_first_derivatives_exist(motor):
    motor.initialize()
    for call, values in ((motor.fmu.setRealInputDerivatives, [[0.0]]), (motor.fmu.getRealOutputDerivatives, [])):
        assert "order 2 is refused" in motor.refuses(call, [0], [2], *values)
        assert "reference 99" in motor.refuses(call, [99], [1], *values)


@every_continuous
def test_rates_of_outputs_are_their_differences_over_a_short_time(native, tmp_path, name):
    with opened(native / f"{name}.fmu", tmp_path) as host:
        start = {"v_0": 8.0, "T_0": 20.0} if "v_0" in host.variables else {"T_ref": 50.0, "q_omega": 0.0}
        host.initialize(**start)
        host.set(**({"T_mot": 60.0} if "T_mot" in host.names("input") else {"T_ref": 100.0}))
        host.step(0.0, 0.0053)
        outputs = real(host, "output")
        rates, before = rates_of(host, *outputs), host.outputs()
        h = 1e-7
        host.step(0.0053, h)
        after = host.outputs()
        for output, rate in zip(outputs, rates, strict=True):
            assert (after[output] - before[output]) / h == pytest.approx(rate, rel=2e-2, abs=1e-3 * (1 + abs(rate)))


@every_continuous
@together("initializing", [True, False])
def test_directional_derivatives_are_differences(native, tmp_path, name, initializing):
    with opened(native / f"{name}.fmu", tmp_path) as host:
        start = {"v_0": 8.0, "T_0": 20.0} if "v_0" in host.variables else {"T_ref": 50.0, "q_omega": 0.0}
        host.set(**start)
        host.fmu.setupExperiment(startTime=0.0)
        host.fmu.enterInitializationMode()
        if not initializing:
            host.fmu.exitInitializationMode()
            host.step(0.0, 0.0053)
        for known in real(host, "input") + (real(host, "parameter") if initializing else []):
            at = host.get(known)
            h = 1e-6 * max(1.0, abs(at)) if at else 1e-6
            before = host.outputs()
            host.set(**{known: at + h})
            after = host.outputs()
            host.set(**{known: at})
            for unknown in real(host, "output"):
                difference = (after[unknown] - before[unknown]) / h
                if initializing and known in ("v_0", "z_br", "omega_sat", "q_omega"):
                    continue  # where the start is not smooth
                assert derivative(host, unknown, known) == pytest.approx(difference, rel=1e-3, abs=1e-4)


@together("initializing", [True, False])
def test_a_derivative_that_is_no_number_is_refused_and_not_given_out(native, tmp_path, initializing):
    with opened(native / "TwoMassDriveline.fmu", tmp_path) as host:
        host.fmu.enterInitializationMode() if initializing else host.initialize()
        along = host.fmu.getDirectionalDerivative
        unknown, known = references(host, "omega_1", "a_body"), references(host, "slope")
        for change in (math.nan, math.inf):
            message = f"{change!r} is refused as change of slope; allowed is any finite number"
            assert host.refuses(along, unknown, known, [change]) == message
        largest = sys.float_info.max
        for some in (unknown, unknown[1:]):
            message = host.refuses(along, some, known, [largest])
            assert message == "the derivative of a_body is refused; it would be -inf"
        assert along(unknown[:1], known, [largest]) == [0.0]


def test_a_rate_of_an_output_that_is_no_number_is_refused(plant):
    plant.initialize()
    ramp(plant, slope=sys.float_info.max)
    message = "the derivative of a_body is refused; it would be -inf"
    assert plant.refuses(rates_of, plant, "omega_1", "a_body") == message


def test_after_initialization_inputs_and_states_can_be_known(motor):
    motor.initialize()
    assert derivative(motor, "omega_1_meas", "omega_1") == 0.0, "it is rounded"
    message = motor.refuses(derivative, motor, "T_mot", "tau")
    assert message == "tau cannot be a known of a directional derivative; allowed is any input or state"
    message = motor.refuses(derivative, motor, "T_ref", "T_ref")
    allowed = "allowed is any output or derivative of a state"
    assert message == f"T_ref cannot be the unknown of a directional derivative; {allowed}"


def test_during_initialization_parameters_can_be_known_too(motor):
    motor.fmu.setupExperiment()
    motor.fmu.enterInitializationMode()
    allowed = "allowed is any output, state or its derivative"
    message = motor.refuses(derivative, motor, "T_ref", "T_ref")
    assert message == f"T_ref cannot be the unknown of a directional derivative; {allowed}"
    message = motor.refuses(derivative, motor, "T_mot", "T_mot")
    assert message == "T_mot cannot be a known of a directional derivative; allowed is any input or parameter"


@together("name", [name for name in FMUS if name not in CONTINUOUS])
def test_sampled_blocks_claim_no_rates_and_refuse_them(native, tmp_path, name):
    with opened(native / f"{name}.fmu", tmp_path) as host:
        claims = host.description.coSimulation
        assert claims
        assert not claims.canInterpolateInputs
        assert not claims.providesDirectionalDerivative
        assert claims.maxOutputDerivativeOrder == 0
        host.initialize()
        with pytest.raises(FMICallException):
            ramp(host, **{real(host, "input")[0]: 1.0})
        assert "is a sampled block and has no output derivatives" in host.refuses(
            rates_of, host, real(host, "output")[0]
        )
