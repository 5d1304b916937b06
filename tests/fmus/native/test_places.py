"""Every function of FMI has its place in the sequence of calls, and says so elsewhere: for co-simulation and for model
exchange, of FMI 2.0 and, in the words of that, of FMI 3.0."""

import ctypes

import pytest
from fmpy.fmi2 import FMU2Model, FMU2Slave
from fmpy.fmi3 import FMU3Model
from fmutesting.host import of_fmi3, opened
from fmutesting.together import together

OK, ERROR = 0, 3


@pytest.fixture(params=["native", "fmi3"])
def folder(request):
    """Of the FMUs of FMI 2.0, and of those of FMI 3.0."""
    return request.getfixturevalue(request.param)


BEFORE, DURING, EVENT, INTEGRATING, STEPPING, ENDED = (
    *("before initialization mode", "in initialization mode", "in event mode", "in continuous-time mode"),
    *("after initialization", "after termination"),
)
ALL = (BEFORE, DURING, EVENT, INTEGRATING, ENDED)

EXCHANGING = {
    "fmi2SetupExperiment": {BEFORE},
    "fmi2EnterInitializationMode": {BEFORE},
    "fmi2ExitInitializationMode": {DURING},
    "fmi2EnterEventMode": {EVENT, INTEGRATING},
    "fmi2NewDiscreteStates": {EVENT},
    "fmi2EnterContinuousTimeMode": {EVENT},
    "fmi2CompletedIntegratorStep": {INTEGRATING},
    "fmi2SetTime": {EVENT, INTEGRATING},
    "fmi2SetContinuousStates": {INTEGRATING},
    "fmi2GetContinuousStates": {DURING, EVENT, INTEGRATING, ENDED},
    "fmi2GetDerivatives": {DURING, EVENT, INTEGRATING, ENDED},
    "fmi2GetEventIndicators": {DURING, EVENT, INTEGRATING, ENDED},
    "fmi2GetNominalsOfContinuousStates": set(ALL),
    "fmi2GetDirectionalDerivative": {DURING, EVENT, INTEGRATING, ENDED},
    "fmi2Terminate": {EVENT, INTEGRATING},
    "fmi2Reset": set(ALL),
}
CO_SIMULATION = {
    "fmi2SetupExperiment": {BEFORE},
    "fmi2EnterInitializationMode": {BEFORE},
    "fmi2ExitInitializationMode": {DURING},
    "fmi2DoStep": {STEPPING},
    "fmi2Terminate": {STEPPING},
    "fmi2SetRealInputDerivatives": {BEFORE, DURING, STEPPING},
    "fmi2GetRealOutputDerivatives": {STEPPING, ENDED},
    "fmi2GetDirectionalDerivative": {DURING, STEPPING, ENDED},
    "fmi2GetRealStatus": {STEPPING, ENDED},
    "fmi2Reset": {BEFORE, DURING, STEPPING, ENDED},
    "fmi2CancelStep": set(),
}
PLACES = {FMU2Model: (EXCHANGING, ALL), FMU2Slave: (CO_SIMULATION, (BEFORE, DURING, STEPPING, ENDED))}
"""By kind of instance the functions with the modes in which they are allowed, and all modes in their order."""

STEPPING_ALONE = ("fmi2DoStep", "fmi2CancelStep", "fmi2SetRealInputDerivatives", "fmi2GetRealOutputDerivatives")
EXCHANGING_ALONE = [name for name in EXCHANGING if "Event" in name or "Continuous" in name or "Derivatives" in name]

ROOM = (ctypes.c_double * 100)(*[0.5] * 100)


TOLD = (ctypes.byref(ctypes.c_double()),) * 6

ARGUMENTS_OF_FMI3 = {
    "fmi2EnterInitializationMode": (0, ctypes.c_double(), ctypes.c_double(), 0, ctypes.c_double()),
    "fmi2NewDiscreteStates": TOLD,
    "fmi2DoStep": (ctypes.c_double(), ctypes.c_double(1e-3), 0, *TOLD[:4]),
    "fmi2GetRealOutputDerivatives": (None, ctypes.c_size_t(), None, None, ctypes.c_size_t()),
    "fmi2GetDirectionalDerivative": (None, ctypes.c_size_t()) * 4,
}
"""Of functions that FMI 2.0 gives others, or none."""


def is_there(function, host):
    """Whether the FMU has the function."""
    return host.description.fmiVersion == "2.0" or hasattr(ctypes.CDLL(host.fmu.dll._name), of_fmi3(function))


def arguments_of(function, host):
    """Arguments that make sense."""
    nothing, none = ctypes.c_size_t(0), ctypes.c_void_p()
    indicators = host.description.numberOfEventIndicators
    count = indicators if "Indicators" in function else host.description.numberOfContinuousStates
    if function == "fmi2CompletedIntegratorStep":
        return 1, ctypes.byref(ctypes.c_int()), ctypes.byref(ctypes.c_int())
    if host.description.fmiVersion == "3.0" and function in ARGUMENTS_OF_FMI3:
        return ARGUMENTS_OF_FMI3[function]
    if "ContinuousStates" in function or "Indicators" in function or function == "fmi2GetDerivatives":
        return ROOM, ctypes.c_size_t(count)
    return {
        "fmi2SetupExperiment": (0, ctypes.c_double(), ctypes.c_double(), 0, ctypes.c_double()),
        "fmi2NewDiscreteStates": (ctypes.create_string_buffer(100),),
        "fmi2SetTime": (ctypes.c_double(1.0),),
        "fmi2DoStep": (ctypes.c_double(), ctypes.c_double(1e-3), 0),
        "fmi2SetRealInputDerivatives": (none, nothing, none, none),
        "fmi2GetRealOutputDerivatives": (none, nothing, none, none),
        "fmi2GetDirectionalDerivative": (none, nothing, none, nothing, none, none),
        "fmi2GetRealStatus": (2, ctypes.byref(ctypes.c_double())),  # the last successful time
    }.get(function, ())


def call(host, function, *arguments):
    binary = ctypes.CDLL(host.fmu.dll._name)
    known = function if host.description.fmiVersion == "2.0" else of_fmi3(function)
    return binary[known](ctypes.c_void_p(host.fmu.component), *arguments)


def bring(host, mode):
    """Through the sequence of calls up to a mode."""
    fmu, exchanging = host.fmu, isinstance(host.fmu, FMU2Model | FMU3Model)
    steps = {BEFORE: lambda: None, DURING: fmu.enterInitializationMode}
    steps |= {EVENT if exchanging else STEPPING: fmu.exitInitializationMode}
    steps |= ({INTEGRATING: fmu.enterContinuousTimeMode} if exchanging else {}) | {ENDED: fmu.terminate}
    for reached, step in steps.items():
        step()
        if reached == mode:
            return


@pytest.mark.parametrize("kind", PLACES)
def test_a_function_is_refused_outside_its_place_and_says_where_that_is(folder, tmp_path, kind):
    allowed, modes = PLACES[kind]
    for function in allowed:
        for mode in modes:
            with opened(folder / "MotorTorqueLoop.fmu", tmp_path, kind=kind) as host:
                bring(host, mode)
                if not is_there(function, host):
                    continue
                status = call(host, function, *arguments_of(function, host))
                assert status == (OK if mode in allowed[function] else ERROR), (function, mode)
                first = next((place for place in modes if place in allowed[function]), None)
                if function == "fmi2Terminate":
                    first = "after initialization"
                told = f"{function} is refused {mode}; its place is {first}" if first else f"{function} is refused"
                assert status == OK or host.message.startswith(told), (function, mode)


@together("mode", ALL)
@together("function", STEPPING_ALONE)
def test_a_function_of_co_simulation_is_refused_in_model_exchange(folder, tmp_path, function, mode):
    with opened(folder / "MotorTorqueLoop.fmu", tmp_path, kind=FMU2Model) as host:
        bring(host, mode)
        if not is_there(function, host):
            return
        assert call(host, function, *arguments_of(function, host)) == ERROR
        assert host.message == f"{function} is refused; the instance was made for model exchange"


@together("function", EXCHANGING_ALONE)
def test_a_function_of_model_exchange_is_refused_in_co_simulation(folder, tmp_path, function):
    with opened(folder / "MotorTorqueLoop.fmu", tmp_path) as host:
        for change in (lambda: None, host.initialize, host.fmu.terminate):
            change()
            assert call(host, function, *arguments_of(function, host)) == ERROR
            assert host.message == f"{function} is refused; the instance was made for co-simulation"
