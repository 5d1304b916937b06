"""Both builds refuse the same call with the same sentence, and with the same status as far as PythonFMU knows it."""

import math
import re
from collections.abc import Callable
from string import Formatter
from typing import Any, NamedTuple

import pytest
from fmutesting.forged import forged
from fmutesting.host import Host, opened
from fmutesting.together import together

from driveline.fmus.catalogue import FMUS
from fmublocks import protocol
from fmublocks.description.variables import interface
from fmublocks.native.records import paths, records_of

DISCARD, ERROR, FATAL = 2, 3, 4

Call = Callable[[Host], Any]


def set_by(verb: str, **values: Any) -> Call:
    return lambda host: getattr(host.fmu, verb)([host.variables[n].valueReference for n in values], [*values.values()])


def get_by(verb: str, reference: int) -> Call:
    return lambda host: getattr(host.fmu, verb)([reference])


def step(time: float, step_size: float) -> Call:
    return lambda host: host.step(time, step_size)


def initialized(call: Call) -> Call:
    return lambda host: (host.initialize(start_time=1.0), call(host))


def initializing(call: Call) -> Call:
    return lambda host: (host.fmu.setupExperiment(), host.fmu.enterInitializationMode(), call(host))


def stopping(call: Call) -> Call:
    return lambda host: (host.initialize(start_time=1.0, stop_time=1.001), call(host))


def terminated(call: Call) -> Call:
    return initialized(lambda host: (host.fmu.terminate(), call(host)))


def restored(change: Callable[[bytes], bytes]) -> Call:
    return lambda host: host.fmu.setFMUstate(
        host.fmu.deSerializeFMUstate(change(bytes(host.fmu.serializeFMUstate(host.fmu.getFMUstate()))))
    )


def with_content(place: str, value: float, fmu: str, coming: bool = False) -> Call:
    """After a step of 10 ms from 1 s on."""
    states = len([*paths("", records_of(FMUS[fmu].block)["x"])])
    restore = restored(lambda saved: forged(saved, place, value, states, coming))
    return initialized(lambda host: (host.step(1.0, 0.01), restore(host)))


def bad_content(fmu: str) -> "list[Refusal]":
    """Of a state, in places that all blocks have."""
    wrong = [("start_time", math.inf), ("time", math.nan), ("stop_time", math.nan), ("stop_time", 0.999)]
    wrong += [("state", math.nan), ("state", -math.inf)]
    return [Refusal("BAD_STATE", with_content(place, value, fmu), fmu) for place, value in wrong]


class Refusal(NamedTuple):
    """A call, the name of the sentence with which it is refused, and the status."""

    sentence: str
    call: Call
    fmu: str = "MotorTorqueLoop"
    status: int = ERROR


TO_TICK = (-1e18, -1.0000000000000002, 1.0000000000000002, math.inf, math.nan)

NOISY = ("DampingController",)

BEHIND = len(interface(FMUS["WheelSpeedCan"].block))

OF_TIME_IN_FMI_3 = Refusal("UNKNOWN_REFERENCE", get_by("getReal", BEHIND), "WheelSpeedCan")

REFUSALS = [
    *(
        Refusal("BAD_VALUE", set_by("setReal", T_ref=value))
        for value in (math.nan, -math.inf, 1e300, 2000.0040000000001)
    ),
    *(Refusal("BAD_VALUE", set_by("setReal", g_T=value), status=DISCARD) for value in (-5e-324, math.inf)),
    *(Refusal("BAD_VALUE", set_by("setInteger", seed=value), status=DISCARD) for value in (-1, 1_000_001, -(2**31))),
    Refusal("BAD_VALUE", initialized(set_by("setReal", T_ref=0.0, omega_1=1e9))),
    Refusal("SET_TOO_LATE", initialized(set_by("setReal", tau=0.01))),
    Refusal("SET_TOO_LATE", initialized(set_by("setInteger", seed=7))),
    *(
        Refusal("SET_TOO_LATE", initialized(set_by("setBoolean", recorded_load=value)), "TwoMassDriveline")
        for value in (True, False)
    ),
    Refusal("SET_TOO_LATE", terminated(set_by("setReal", T_ref=1e-7))),
    Refusal("SET_TOO_LATE", terminated(set_by("setInteger", counter=-3)), "DampingController"),
    Refusal("OUTPUT_SET", set_by("setReal", T_mot=1.0)),
    Refusal("OUTPUT_SET", terminated(set_by("setReal", T_mot=math.nan))),
    Refusal("WRONG_TYPE", set_by("setReal", T_ref=math.nan, seed=1.0)),
    Refusal("WRONG_TYPE", set_by("setInteger", T_ref=1)),
    Refusal("WRONG_TYPE", set_by("setBoolean", tau=True)),
    Refusal("WRONG_TYPE", set_by("setString", T_mot="1")),
    *(Refusal("WRONG_TYPE", get_by(f"get{kind}", 0)) for kind in ("Integer", "Boolean", "String")),
    OF_TIME_IN_FMI_3,
    Refusal("UNKNOWN_REFERENCE", get_by("getBoolean", 2**32 - 1), "WheelSpeedCan"),
    Refusal("WRONG_MODE", step(0.0, 0.001)),
    Refusal("WRONG_MODE", terminated(step(1.0, 0.001))),
    Refusal("WRONG_MODE", lambda host: host.fmu.exitInitializationMode()),
    Refusal("WRONG_MODE", initialized(lambda host: host.initialize())),
    Refusal("WRONG_MODE", initialized(lambda host: host.fmu.enterInitializationMode())),
    Refusal("WRONG_MODE", terminated(lambda host: host.fmu.terminate())),
    *(
        Refusal("BAD_START_TIME", lambda host, time=time: host.initialize(start_time=time))
        for time in (math.nan, math.inf)
    ),
    *(
        Refusal("BAD_STOP_TIME", lambda host, time=time: host.initialize(start_time=1.0, stop_time=time))
        for time in (math.nan, 0.9999999999999999)
    ),
    *(Refusal("BAD_STEP_SIZE", initialized(step(1.0, size))) for size in (0.0, -0.0, math.nan, math.inf)),
    *(Refusal("BAD_STEP_SIZE", initialized(step(1.0, size)), status=DISCARD) for size in (1000.0000000000001, 1e300)),
    *(Refusal("STEP_LOST", initialized(step(1.0, size))) for size in (5e-324, 1.1e-16)),
    Refusal("PAST_STOP_TIME", stopping(step(1.0, 0.002))),
    *(Refusal("BAD_TIME", initialized(step(time, 1e-3))) for time in (0.1 + 0.2, -math.inf)),
    *bad_content("MotorTorqueLoop"),
    *bad_content("TwoMassDriveline"),
    Refusal("BAD_STATE", with_content("input", 2000.0000000000002, "MotorTorqueLoop")),
    Refusal("BAD_STATE", with_content("input", math.nan, "MotorTorqueLoop")),
    *(Refusal("BAD_STATE", with_content("to_tick", n, "WheelSpeedCan"), "WheelSpeedCan") for n in TO_TICK),
    *(
        Refusal("BAD_STATE", restored(lambda saved, t=t: forged(saved, "time", t)), "WheelSpeedCan")
        for t in (1e9, -1e9)
    ),
    Refusal("BAD_STATE", initializing(restored(lambda saved: forged(saved, "time", 1e9))), "WheelSpeedCan"),
    Refusal("BAD_STATE", restored(lambda saved: forged(saved, "start_time", 1e9)), "WheelSpeedCan"),
    *(Refusal("BAD_STATE", with_content("state", math.nan, fmu, coming=True), fmu) for fmu in NOISY),
    *(Refusal("DAMAGED_STATE", with_content("mode", mode, "WheelSpeedCan"), "WheelSpeedCan") for mode in (0, 3, 16)),
    Refusal("DAMAGED_STATE", restored(lambda saved: saved[:-1])),
    Refusal("DAMAGED_STATE", restored(lambda saved: b"\xff" * 5)),
]


def message(folder, unpacked, refusal):
    with opened(folder / f"{refusal.fmu}.fmu", unpacked) as host:
        return host.refuses(refusal.call, host), host.status


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory):
    return {build: tmp_path_factory.mktemp(build) for build in ("python", "native", "fmi3")}


@together("refusal", REFUSALS)
def test_both_builds_say_the_same(built, native, unpacked, refusal):
    in_python, status_in_python = message(built, unpacked["python"] / refusal.fmu, refusal)
    in_c, status_in_c = message(native, unpacked["native"] / refusal.fmu, refusal)
    assert in_c == in_python
    assert status_in_c == refusal.status
    is_step = refusal.sentence == "BAD_STEP_SIZE"  # PythonFMU has no discard of anything else
    assert status_in_python == (DISCARD if is_step and refusal.status == DISCARD else FATAL)
    parts = Formatter().parse(getattr(protocol, refusal.sentence))
    assert re.fullmatch("".join(re.escape(text) + (".+" if field else "") for text, field, _, _ in parts), in_c)


@together("refusal", [each for each in REFUSALS if each != OF_TIME_IN_FMI_3])
def test_fmi_3_says_what_fmi_2_says(native, fmi3, unpacked, refusal):
    expected, status = message(native, unpacked["native"] / refusal.fmu, refusal)
    expected = expected.replace("fmi2SetupExperiment", "fmi2EnterInitializationMode")
    expected = expected.replace(f"has 0 to {BEHIND - 1}", f"has 0 to {BEHIND}")  # where the time is
    assert message(fmi3, unpacked["fmi3"] / refusal.fmu, refusal) == (expected, status)


@together("to_tick", [-1.0, 1.0])
@together("build", ["python", "native", "fmi3"])
def test_the_next_tick_of_a_state_is_a_sample_away_at_most(request, unpacked, build, to_tick):
    folder = request.getfixturevalue({"python": "built"}.get(build, build))
    with opened(folder / "WheelSpeedCan.fmu", unpacked[build] / "WheelSpeedCan") as host:
        with_content("to_tick", to_tick, "WheelSpeedCan")(host)
        host.step(1.01, 0.01)
