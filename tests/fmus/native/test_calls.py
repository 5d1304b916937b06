"""Calls out of place, arguments that make no sense, messages: answered with an error, never with a crash."""

import ctypes
import zlib
from dataclasses import replace

import pytest
from fmpy.fmi1 import FMICallException
from fmutesting.forged import forged, sealed
from fmutesting.host import opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks.block.declaration import with_defaults
from tests.fmus.native.test_places import CO_SIMULATION, arguments_of, call

OK, DISCARD, ERROR = 0, 2, 3
DO_STEP_STATUS, PENDING_STATUS, LAST_SUCCESSFUL_TIME, TERMINATED = range(4)


@together("function", ["SetReal", "GetReal", "SetInteger", "GetBoolean", "SetBoolean", "GetString"])
def test_missing_arrays_are_refused(motor, function):
    two = ctypes.c_size_t(2)
    references = (ctypes.c_uint * 2)(0, 1)
    values = (ctypes.c_double * 2)()
    assert call(motor, f"fmi2{function}", None, two, values) == ERROR
    assert call(motor, f"fmi2{function}", references, two, None) == ERROR
    assert "NULL" in motor.message
    assert call(motor, f"fmi2{function}", None, ctypes.c_size_t(0), None) == OK


@together(
    "function",
    [
        *CO_SIMULATION,
        *("fmi2GetReal", "fmi2SetReal", "fmi2GetString", "fmi2SetString", "fmi2SetDebugLogging"),
        *("fmi2GetFMUstate", "fmi2SetFMUstate", "fmi2FreeFMUstate", "fmi2SerializedFMUstateSize"),
        *("fmi2SerializeFMUstate", "fmi2DeSerializeFMUstate", "fmi2GetStatus", "fmi2GetStringStatus"),
    ],
)
def test_without_an_instance_every_function_is_an_error(motor, function):
    binary = ctypes.CDLL(motor.fmu.dll._name)
    zeros = (ctypes.c_size_t(0), ctypes.c_size_t(0), ctypes.c_size_t(0), ctypes.c_size_t(0))
    assert getattr(binary, function)(ctypes.c_void_p(), *(arguments_of(function, motor) or zeros)) == ERROR


def test_freeing_nothing_is_no_error(motor):
    binary = ctypes.CDLL(motor.fmu.dll._name)
    binary.fmi2FreeInstance.restype = None
    binary.fmi2FreeInstance(ctypes.c_void_p())


@together(
    "what, expected",
    [
        ({"guid": b"{other}"}, "GUID"),
        ({"guid": None}, "GUID"),
        ({"name": b""}, "name"),
        ({"name": None}, "name"),
        ({"kind": 0}, "co-simulation"),
        ({"kind": 2}, "co-simulation"),
    ],
)
def test_what_cannot_be_instantiated_is_said(can, what, expected):
    binary = ctypes.CDLL(can.fmu.dll._name)
    binary.fmi2Instantiate.restype = ctypes.c_void_p
    right = {"name": b"instance", "kind": 1, "guid": str(can.description.guid).encode()}
    given = right | what
    made = binary.fmi2Instantiate(given["name"], given["kind"], given["guid"], None, ctypes.byref(can._callbacks), 0, 1)
    assert made is None
    assert expected in can.message
    assert can.named == (given["name"] or b"").decode()
    assert binary.fmi2Instantiate(given["name"], 1, given["guid"], None, None, 0, 1) is None


@together("missing", ["allocateMemory", "freeMemory"])
def test_without_callbacks_for_memory_nothing_is_instantiated(motor, missing):
    binary = ctypes.CDLL(motor.fmu.dll._name)
    binary.fmi2Instantiate.restype = ctypes.c_void_p
    callbacks = type(motor._callbacks).from_buffer_copy(motor._callbacks)
    setattr(callbacks, missing, type(getattr(callbacks, missing))())
    guid = str(motor.description.guid).encode()
    assert binary.fmi2Instantiate(b"other", 1, guid, None, ctypes.byref(callbacks), 0, 1) is None
    assert (motor.named, "callbacks for memory" in motor.message) == ("other", True)


ONE = ctypes.c_size_t(1)

COMPLETE = {
    "fmi2SetDebugLogging": (1, ONE, (ctypes.c_char_p * 1)(b"logStatusError")),
    "fmi2GetFMUstate": (ctypes.byref(ctypes.c_void_p()),),
    "fmi2SetFMUstate": ("state",),
    "fmi2SerializedFMUstateSize": ("state", ctypes.byref(ctypes.c_size_t())),
    "fmi2SerializeFMUstate": ("state", ctypes.create_string_buffer(10000), ctypes.c_size_t(10000)),
    "fmi2DeSerializeFMUstate": ("bytes", "size", ctypes.byref(ctypes.c_void_p())),
    "fmi2GetDirectionalDerivative": (
        *((ctypes.c_uint * 1)(2), ONE, (ctypes.c_uint * 1)(0), ONE),
        *((ctypes.c_double * 1)(1.0), (ctypes.c_double * 1)()),
    ),
}
"""Arguments of calls that succeed; the state, its bytes and their number stand for those of the test."""


@together("function", COMPLETE)
def test_an_argument_that_is_missing_is_an_error(native, tmp_path, function):
    with opened(native / "MotorTorqueLoop.fmu", tmp_path) as host:
        host.initialize()
        state = host.fmu.getFMUstate()
        saved = bytes(host.fmu.serializeFMUstate(state))
        ours = {"state": state, "bytes": saved, "size": ctypes.c_size_t(len(saved))}
        given = [ours.get(each, each) if isinstance(each, str) else each for each in COMPLETE[function]]
        for k, each in enumerate(given):
            if isinstance(each, int | ctypes.c_size_t):
                continue
            assert call(host, function, *given[:k], None, *given[k + 1 :]) == ERROR
            assert (host.named, host.message) == ("instance", f"{function}: an argument is NULL")
        assert call(host, function, *given) == OK


def status(host, function, kind, value):
    return call(host, function, kind, ctypes.byref(value)), value.value


def test_the_status_is_that_of_the_last_step(motor):
    motor.initialize()
    motor.step(0.0, 0.25)
    assert status(motor, "fmi2GetStatus", DO_STEP_STATUS, ctypes.c_int(-1)) == (OK, OK)
    for step, expected in (((0.0, 0.25), ERROR), ((0.25, 1001.0), DISCARD)):
        with pytest.raises(FMICallException):
            motor.step(*step)
        assert status(motor, "fmi2GetStatus", DO_STEP_STATUS, ctypes.c_int(-1)) == (OK, expected)
    assert status(motor, "fmi2GetRealStatus", LAST_SUCCESSFUL_TIME, ctypes.c_double(-1.0)) == (OK, 0.25)
    assert status(motor, "fmi2GetBooleanStatus", TERMINATED, ctypes.c_int(-1)) == (OK, 0)
    assert status(motor, "fmi2GetStringStatus", PENDING_STATUS, ctypes.c_char_p()) == (OK, b"")


@together("function", ["GetStatus", "GetRealStatus", "GetIntegerStatus", "GetBooleanStatus"])
def test_a_status_that_does_not_exist_is_discarded(native, tmp_path, function):
    with opened(native / "MotorTorqueLoop.fmu", tmp_path) as host:
        host.initialize()
        assert status(host, f"fmi2{function}", PENDING_STATUS, ctypes.c_double(-1.0)) == (DISCARD, -1.0)


def test_messages_are_given_out_by_category(motor):
    motor.initialize()

    def messages():
        """Which of a discarded step and an unknown reference is told."""
        has_message = []
        for call_wrongly in (lambda: motor.step(0.0, 1001.0), lambda: motor.fmu.getReal([99])):
            motor.message = ""
            with pytest.raises(FMICallException):
                call_wrongly()
            has_message.append(bool(motor.message))
        return has_message

    assert messages() == [True, True]
    motor.fmu.setDebugLogging(False, ["logStatusDiscard"])
    assert messages() == [False, True]
    motor.fmu.setDebugLogging(False, ["logStatusError"])
    assert messages() == [False, False]
    motor.fmu.setDebugLogging(True, [])
    motor.fmu.setDebugLogging(False, [])
    assert messages() == [False, False]
    motor.fmu.setDebugLogging(True, ["logStatusDiscard"])
    assert messages() == [True, False]
    motor.fmu.setDebugLogging(True, [])
    message = motor.refuses(motor.fmu.setDebugLogging, True, ["logEvents"])
    assert message == "log category logEvents is unknown; there are logStatusError and logStatusDiscard"
    assert call(motor, "fmi2SetDebugLogging", 1, ONE, (ctypes.c_char_p * 1)()) == ERROR
    assert "log category NULL is unknown" in motor.message
    assert messages() == [True, True]


@together("change", [lambda saved: forged(saved, "mode", 3), lambda saved: sealed(saved[4:] + bytes(8))])
def test_a_state_that_no_instance_can_have_written_is_refused_for_all_its_checksum(motor, change):
    """With a mode that does not exist; with more in it than there is."""
    saved = change(bytes(motor.fmu.serializeFMUstate(motor.fmu.getFMUstate())))
    assert "its bytes are damaged" in motor.refuses(motor.fmu.deSerializeFMUstate, saved)


def test_a_saved_state_tells_its_checksum_and_its_build(motor):
    """The CRC-32 of the rest, the GUID filled up with zeros, whole multiples of 8 bytes."""
    saved = bytes(motor.fmu.serializeFMUstate(motor.fmu.getFMUstate()))
    assert saved[:4] == zlib.crc32(saved[4:]).to_bytes(4, "little")
    assert saved[4:48] == str(motor.description.guid).encode().ljust(44, b"\0")
    assert len(saved) % 8 == 0


def test_a_build_whose_name_does_not_end_is_named_as_far_as_there_is_room(motor):
    body = bytes(motor.fmu.serializeFMUstate(motor.fmu.getFMUstate()))[4:]
    saved = sealed(b"x" * 44 + body[44:])
    assert f"saved by {43 * 'x'}, this is" in motor.refuses(motor.fmu.deSerializeFMUstate, saved)


@together("name", FMUS)
def test_a_reset_instance_is_as_new(native, tmp_path, name):
    with opened(native / f"{name}.fmu", tmp_path) as host:
        new = host.fmu.serializeFMUstate(host.fmu.getFMUstate())
        host.initialize(start_time=3.0)
        host.step(3.0, 0.01)
        host.fmu.reset()
        assert host.fmu.serializeFMUstate(host.fmu.getFMUstate()) == new


def test_the_first_variable_too_starts_where_it_is_declared(native_builder, tmp_path):
    fmu = FMUS["MotorTorqueLoop"]
    block = replace(fmu.block, Input=with_defaults(fmu.block.Input, {"T_ref": 5.0}))
    with opened(native_builder(replace(fmu, block=block), tmp_path), tmp_path / "unpacked") as host:
        assert host.variables["T_ref"].valueReference == 0
        assert host.get("T_ref") == 5.0
