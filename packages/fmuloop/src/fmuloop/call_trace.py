"""The call trace: the present FMI call, noted where another process can read it when this one has ended or hangs."""

from ctypes import Structure, c_double, c_int32, c_int64
from mmap import mmap

TYPES_OF_FMI3 = (
    *("Float32", "Float64", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64"),
    *("Boolean", "String", "Binary", "Clock"),
)

FUNCTIONS = (
    "loading its binary",
    "fmi2Instantiate",
    "fmi2SetupExperiment",
    "fmi2EnterInitializationMode",
    "fmi2ExitInitializationMode",
    "fmi2DoStep",
    *(f"fmi2{access}{kind}" for access in ("Get", "Set") for kind in ("Real", "Integer", "Boolean", "String")),
    "fmi2GetRealOutputDerivatives",
    "fmi2SetRealInputDerivatives",
    "fmi2GetFMUstate",
    "fmi2SetFMUstate",
    "fmi2FreeFMUstate",
    "fmi2SerializedFMUstateSize",
    "fmi2SerializeFMUstate",
    "fmi2DeSerializeFMUstate",
    "fmi2Terminate",
    "fmi2Reset",
    "fmi2FreeInstance",
    *(f"fmi2{mode}" for mode in ("EnterEventMode", "NewDiscreteStates", "EnterContinuousTimeMode")),
    *("fmi2CompletedIntegratorStep", "fmi2SetTime", "fmi2SetContinuousStates"),
    *(f"fmi2Get{what}" for what in ("Derivatives", "EventIndicators", "ContinuousStates")),
    "fmi2GetNominalsOfContinuousStates",
    "fmi3InstantiateCoSimulation",
    "fmi3EnterInitializationMode",
    "fmi3ExitInitializationMode",
    "fmi3DoStep",
    *(f"fmi3{access}{kind}" for access in ("Get", "Set") for kind in TYPES_OF_FMI3),
    "fmi3GetOutputDerivatives",
    "fmi3GetFMUState",
    "fmi3SetFMUState",
    "fmi3FreeFMUState",
    "fmi3SerializedFMUStateSize",
    "fmi3SerializeFMUState",
    "fmi3DeserializeFMUState",
    "fmi3Terminate",
    "fmi3Reset",
    "fmi3FreeInstance",
    "fmi3InstantiateModelExchange",
    *(f"fmi3{mode}" for mode in ("EnterEventMode", "UpdateDiscreteStates", "EnterContinuousTimeMode")),
    *("fmi3CompletedIntegratorStep", "fmi3SetTime", "fmi3SetContinuousStates"),
    *("fmi3GetNumberOfContinuousStates", "fmi3GetNumberOfEventIndicators"),
    *(f"fmi3Get{what}" for what in ("ContinuousStateDerivatives", "EventIndicators", "ContinuousStates")),
    "fmi3GetNominalsOfContinuousStates",
    *("fmi3EnterStepMode", "fmi3GetIntervalDecimal"),
    *("fmi2GetVersion", "fmi2GetTypesPlatform", "fmi2GetDirectionalDerivative"),
    *("fmi3GetVersion", "fmi3GetDirectionalDerivative", "fmi3GetAdjointDerivative"),
)
"""What is called, numbered from 1."""

NUMBERS = {function: number for number, function in enumerate(FUNCTIONS, start=1)}

AT_START = -1.0
"""The time of calls outside the steps."""


class CallRecord(Structure):
    """The call that was begun last; `struct call_record` in steps.c.

    Attributes:
        instance: its number.
        function: the number of the function; 0: of none.
        time: of the instant at work, in s.
        calls: how many were begun, so that one is told from the next one to the same function.
    """

    _fields_ = (("instance", c_int32), ("function", c_int32), ("time", c_double), ("calls", c_int64))


_current = CallRecord()


def current() -> CallRecord:
    """The record of the calls of this process."""
    return _current


def share(memory: mmap) -> None:
    """From now on the calls are noted in memory that another process sees."""
    global _current
    _current = CallRecord.from_buffer(memory)


def rest() -> None:
    """Notes that no call is being made."""
    _current.function = 0


def note(instance: int, function: str, time: float = AT_START) -> None:
    """Notes a call that is about to be made."""
    _current.instance, _current.function, _current.time = instance, NUMBERS[function], time
    _current.calls += 1
