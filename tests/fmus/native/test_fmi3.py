"""The FMI 3.0 builds pass the tests of those of FMI 2.0, in the words of that; and what they have of their own."""

import ctypes
import re
import zipfile
from typing import Any

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import fmi3LogMessageCallback
from fmpy.model_description import read_build_description
from fmpy.validation import validate_fmu
from fmutesting.host import in_words_of_fmi2, opened
from fmutesting.together import together

from driveline.fmus.catalogue import EVERY, FMUS
from driveline.fmus.names import COMPARATORS
from fmublocks.builds import NotPossible, builders
from fmublocks.description.units import base_exponents
from fmublocks.description.variables import interface
from fmublocks.native.packaging import FMI_HEADERS
from tests.fmus.native.any_build import *  # noqa: F403
from tests.fmus.native.test_rates import (  # noqa: F401
    ramp,
    rates_of,
    test_a_derivative_that_is_no_number_is_refused_and_not_given_out,
    test_a_ramp_in_one_step_is_that_of_many_small_stairs,
    test_a_ramp_may_end_at_the_bound,
    test_a_ramp_out_of_the_range_is_refused_and_nothing_moves,
    test_a_rate_of_an_output_that_is_no_number_is_refused,
    test_after_initialization_inputs_and_states_can_be_known,
    test_directional_derivatives_are_differences,
    test_during_initialization_parameters_can_be_known_too,
    test_rates_of_outputs_are_their_differences_over_a_short_time,
)

every_fmu = together("name", FMUS)
OK, ERROR = 0, 3


@pytest.fixture(scope="module")
def built(fmi3):
    """What the tests of others call the folder of the FMUs."""
    return fmi3


@pytest.fixture(scope="module")
def native(fmi3):
    """What the tests of rates call it."""
    return fmi3


@pytest.mark.slow
@together("name", COMPARATORS)
def test_the_comparators_are_built_too(fmi3, tmp_path, name):
    (build,) = builders("native", fmi=3)
    assert validate_fmu(str(build(EVERY[name], tmp_path))) == []


def test_there_is_no_such_build_in_python():
    for build in ("python", "both"):
        with pytest.raises(NotPossible, match=r"for FMI 3\.0 there are native builds only"):
            builders(build, fmi=3)


@every_fmu
def test_all_functions_of_the_standard_are_there_and_nothing_else_is(fmi3, tmp_path, name):
    header = (FMI_HEADERS / "fmi3Functions.h").read_text()
    functions = set(re.findall(r"FMI3_Export \w+\s+(\w+);", header))
    assert len(functions) == 75
    with opened(fmi3 / f"{name}.fmu", tmp_path) as host:
        assert all(hasattr(host.fmu.dll, function) for function in functions)
        assert not hasattr(host.fmu.dll, "fmi2DoStep")


@every_fmu
def test_value_references_are_those_of_fmi_2_and_behind_what_follows_from_the_state_come_time_and_rates(fmi3, name):
    block = FMUS[name].block
    variables: Any = fmpy.read_model_description(str(fmi3 / f"{name}.fmu")).modelVariables
    ours = interface(block)
    assert [(v.name, v.valueReference) for v in variables[: len(ours)]] == [(v.name, v.reference) for v in ours]
    time, *rates = (v for v in variables[len(ours) :] if v.causality != "local")
    assert (time.name, time.causality) == ("time", "independent")
    assert [v.valueReference for v in variables] == list(range(len(variables)))
    assert variables[-1 - len(rates) :] == [time, *rates]
    moving = [v.name for v in ours if v.causality == "input" and hasattr(block, "derivative")]
    assert [rate.derivative.name for rate in rates] == moving
    for rate in rates:
        assert rate.name == f"der({rate.derivative.name})"
        assert rate.valueReference == time.valueReference + 1 + rate.derivative.valueReference
        assert base_exponents(rate.unit).get("s", 0) == base_exponents(rate.derivative.unit).get("s", 0) - 1


def test_its_sources_are_described(fmi3):
    (configuration,) = read_build_description(str(fmi3 / "MotorTorqueLoop.fmu"))
    assert configuration.modelIdentifier == "MotorTorqueLoop"
    assert configuration.sourceFileSets[0].sourceFiles == ["all.c"]
    with zipfile.ZipFile(fmi3 / "MotorTorqueLoop.fmu") as archive:
        names = set(archive.namelist())
    assert {"sources/all.c", "documentation/index.html", "documentation/diagram.png"} <= names
    assert not any("fmi2" in name for name in names)


def test_a_rate_holds_until_it_is_set(motor):
    rate = motor.fmu.rates[motor.variables["T_ref"].valueReference]
    assert motor.fmu.getFloat64([rate]) == [0.0]
    motor.initialize()
    ramp(motor, T_ref=1000.0)
    motor.step(0.0, 0.01)
    motor.step(0.01, 0.01)
    assert motor.get("T_ref") == pytest.approx(20.0)
    motor.set(T_ref=5.0)
    assert motor.fmu.getFloat64([rate]) == [1000.0]
    motor.step(0.02, 0.01)
    assert motor.get("T_ref") == pytest.approx(15.0)
    ramp(motor, T_ref=0.0)
    motor.step(0.03, 0.01)
    assert motor.get("T_ref") == pytest.approx(15.0)
    motor.fmu.terminate()
    message = motor.refuses(ramp, motor, T_ref=1.0)
    assert message.startswith("der(T_ref) = 1.0 is refused; a fixed parameter can be set until")


def test_rates_are_part_of_a_saved_state_and_forgotten_by_a_reset(motor):
    rate = [motor.fmu.rates[motor.variables["omega_1"].valueReference]]
    motor.initialize(q_omega=0.0)
    ramp(motor, omega_1=1000.0)
    state = motor.fmu.getFMUState()
    assert rates_of(motor, "omega_1_meas") == [1000.0]
    motor.fmu.reset()
    assert motor.fmu.getFloat64(rate) == [0.0]
    motor.fmu.setFMUState(state)
    motor.fmu.freeFMUState(state)
    assert motor.fmu.getFloat64(rate) == [1000.0]


def test_one_bad_rate_among_good_values_keeps_them_all_out(motor):
    references = [motor.variables["T_ref"].valueReference, motor.fmu.rates[0]]
    assert "as derivative of T_ref" in motor.refuses(motor.fmu.setFloat64, references, [50.0, float("nan")])
    assert motor.fmu.getFloat64(references) == [0.0, 0.0]


def test_a_truth_value_that_was_refused_with_another_one_does_not_come_back_in_a_step(plant):
    """The first instance knows its parameters twice, to see what a tool has written."""
    assert "T_mot is of type Real" in plant.refuses(
        plant.fmu.setBoolean,
        [plant.variables[name].valueReference for name in ("recorded_load", "T_mot")],
        [True] * 2,
    )
    plant.initialize()
    plant.step(0.0, 0.01)
    assert plant.get("recorded_load") is False


def test_a_sampled_block_has_no_rates(can):
    last = can.variables["time"].valueReference
    assert can.fmu.rates == {}
    assert f"has 0 to {last}" in can.refuses(can.fmu.getFloat64, [last + 1])


def test_time_is_told_and_cannot_be_set(motor):
    motor.initialize(start_time=1.0)
    motor.step(1.0, 0.25)
    assert motor.get("time") == 1.25
    assert motor.fmu.doStep(1.25, 0.25) == (False, False, False, 1.5)
    assert motor.refuses(motor.set, time=0.0) == "time is the independent variable and cannot be set"


def test_time_and_rates_have_a_type(motor):
    motor.initialize()
    names = {"time": motor.variables["time"].valueReference, "der(T_ref)": motor.fmu.rates[0]}
    for name, reference in names.items():
        for kind in ("Int32", "Int64", "Boolean", "Float32", "UInt8"):
            told = motor.refuses(getattr(motor.fmu, f"get{kind}"), [reference])
            assert re.fullmatch(rf"{re.escape(name)} is of type (Real|Float64), not \w+", told), kind
        told = motor.refuses(motor.fmu.getDirectionalDerivative, [reference], [0], [1.0])
        assert told == f"{name} has no derivative here, and is none"


def test_an_enumeration_is_no_whole_number_and_a_type_without_variables_has_none(controller):
    status = [controller.variables["status"].valueReference]
    controller.refuses(controller.fmu.getInt32, status)
    for kind in ("Float32", "Int8", "UInt8", "Int16", "UInt16", "UInt32", "UInt64", "String"):
        get, put = getattr(controller.fmu, f"get{kind}"), getattr(controller.fmu, f"set{kind}")
        assert get([]) == []
        assert f"of type Integer, not {kind}" in controller.refuses(get, status)
        assert f", not {kind}" in controller.refuses(put, status, ["1" if kind == "String" else 1])
        assert "reference 999 is unknown" in controller.refuses(get, [999])


@together("value", [2**31, -(2**31) - 1, 2**63 - 1])
def test_a_whole_number_that_the_fmu_does_not_have_is_out_of_bounds(motor, value):
    seed = [motor.variables["seed"].valueReference]
    assert "seed is of type Integer" in motor.refuses(motor.fmu.setInt64, seed, [value])


@together("values", [0, 2])
def test_as_many_values_as_references_are_asked_for(motor, values):
    message = motor.refuses(motor.fmu.getFloat64, [0], values)
    assert message == (
        f"fmi2GetFloat64: {values} values are refused; allowed is one for each of the 1 value references"
    )


@together("name", ["Float64", "Int32", "Int64", "Boolean"])
def test_missing_arrays_are_refused(motor, name):
    one, arrays = ctypes.c_size_t(1), ((ctypes.c_uint * 1)(0), (ctypes.c_double * 1)())
    component = ctypes.c_void_p(motor.fmu.component)
    for verb in ("Get", "Set"):
        function = ctypes.CDLL(motor.fmu.dll._name)[f"fmi3{verb}{name}"]
        for references, values in ((None, arrays[1]), (arrays[0], None)):
            assert function(component, references, one, values, one) == ERROR
            assert "an argument is NULL" in motor.message
        assert function(component, None, ctypes.c_size_t(0), None, ctypes.c_size_t(0)) == OK
        assert function(None, *arrays[:1], one, arrays[1], one) == ERROR


NOT_OFFERED = {
    "event mode": ("EnterEventMode", "UpdateDiscreteStates"),
    "event mode in co-simulation": ("EnterStepMode",),
    "evaluation of discrete states": ("EvaluateDiscreteStates",),
    "time-based clocks": ("GetIntervalDecimal", "SetShiftFraction", "ActivateModelPartition"),
    "structural parameters": ("EnterConfigurationMode", "ExitConfigurationMode"),
    "adjoint derivatives": ("GetAdjointDerivative",),
    "array variables": ("GetNumberOfVariableDependencies", "GetVariableDependencies"),
    "model exchange": ("EnterContinuousTimeMode", "GetContinuousStates", "GetNumberOfEventIndicators"),
}


@together("what, function", [(what, name) for what, names in NOT_OFFERED.items() for name in names])
def test_what_is_not_offered_says_so(controller, what, function):
    called = ctypes.CDLL(controller.fmu.dll._name)[f"fmi3{function}"]
    zeros = [ctypes.c_size_t(0)] * 8
    assert called(ctypes.c_void_p(controller.fmu.component), *zeros) == ERROR
    assert controller.message == in_words_of_fmi2(f"fmi3{function} is refused; the FMU has no {what}")
    assert called(ctypes.c_void_p(), *zeros) == ERROR


def test_what_cannot_be_instantiated_is_said(fmi3, tmp_path):
    told = []
    log = fmi3LogMessageCallback(lambda *message: told.append(message[3].decode()))
    with opened(fmi3 / "DampingController.fmu", tmp_path) as host:
        token = host.description.instantiationToken.encode()
        binary = ctypes.CDLL(host.fmu.dll._name)

        def made(name: Any = b"one", token: Any = token, event: Any = False, variables: Any = 0):
            function = binary.fmi3InstantiateCoSimulation
            function.restype = ctypes.c_void_p
            truth = ctypes.c_bool(True), ctypes.c_bool(event), ctypes.c_bool(True)
            references = (ctypes.c_uint * 1)(), ctypes.c_size_t(variables)
            return function(name, token, None, ctypes.c_bool(), *truth, *references, None, log, None)

        for wrong in ({"name": b""}, {"name": None}, {"token": b"{other}"}, {"token": None}):
            assert made(**wrong) is None
        assert made(event=True) is None
        assert made(variables=1) is None
        assert [message.partition(": ")[2] for message in told] == [
            *["an instance needs a name"] * 2,
            *["the instantiation token is that of another FMU"] * 2,
            "the FMU has no event mode",
            "the FMU has no intermediate update",
        ]
        binary.fmi3FreeInstance(ctypes.c_void_p(made()))
        binary.fmi3FreeInstance(None)
        for kind in ("ModelExchange", "ScheduledExecution"):
            function = binary[f"fmi3Instantiate{kind}"]
            function.restype = ctypes.c_void_p
            nothing = [ctypes.c_bool(), ctypes.c_bool(), None, log, None, None, None]
            assert function(b"one", token, None, *nothing) is None
            assert told[-1].startswith(f"fmi3Instantiate{kind}: the FMU has no ")


def test_messages_are_given_out_by_category(motor):
    motor.fmu.setDebugLogging(False, ["logStatusError"])
    with pytest.raises(FMICallException):
        motor.fmu.getFloat64([99])
    assert motor.message == ""
    motor.fmu.setDebugLogging(True, [])
    assert "log category logEvents is unknown" in motor.refuses(motor.fmu.setDebugLogging, True, ["logEvents"])
